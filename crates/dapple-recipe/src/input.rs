//! Inputs to nodes, which are numbers, colors, or the names of other nodes.

use core::fmt;
use dapple_color::LinearRgb;
use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use serde::ser::{Serialize, Serializer};

/// Input to a node, or to a map of the material.
///
/// In a recipe file, an input is written as a number, a color such as `"#c08040"`, or the name of a node such as
/// `"stones"`.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// Constant number.
    Number(f64),
    /// Constant color.
    Color(LinearRgb),
    /// Values of the node that has this name.
    Node(String),
}

impl From<f64> for Input {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<&str> for Input {
    fn from(name: &str) -> Self {
        Self::Node(name.to_owned())
    }
}

impl Input {
    /// Returns the name of the node, if the input refers to one.
    pub(crate) fn node(&self) -> Option<&str> {
        match self {
            Self::Node(name) => Some(name),
            Self::Number(_) | Self::Color(_) => None,
        }
    }
}

/// Formats a color as hexadecimal sRGB with 8 bits per channel.
pub(crate) fn hex_from_color(color: LinearRgb) -> String {
    let [r, g, b] = color.to_srgb::<u8>();
    format!("#{r:02x}{g:02x}{b:02x}")
}

impl Serialize for Input {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(number) => serializer.serialize_f64(*number),
            Self::Color(color) => serializer.serialize_str(&hex_from_color(*color)),
            Self::Node(name) => serializer.serialize_str(name),
        }
    }
}

impl<'de> Deserialize<'de> for Input {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(InputVisitor)
    }
}

struct InputVisitor;

impl Visitor<'_> for InputVisitor {
    type Value = Input;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, a color such as \"#c08040\", or the name of a node")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Input, E> {
        Ok(Input::Number(number))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Input, E> {
        Ok(Input::Number(number as f64))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Input, E> {
        Ok(Input::Number(number as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Input, E> {
        if !text.starts_with('#') {
            return Ok(Input::Node(text.to_owned()));
        }
        let color = LinearRgb::from_hex(text)
            .map_err(|_| E::invalid_value(Unexpected::Str(text), &"a color such as \"#c08040\""))?;
        Ok(Input::Color(color))
    }
}
