//! Converts an image with alpha to an opaque image.

use crate::input::hex_from_color;
use dapple_color::LinearRgb;
use serde::de::{Deserialize, Deserializer, Error, Unexpected};
use serde::ser::{Serialize, Serializer};

/// Conversion of an image with alpha to an opaque one.
///
/// In a recipe file, the conversion is written as `"drop"` or `"over:#rrggbb"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImageAlpha {
    /// Uses the colors and drops alpha.
    Drop,
    /// Composites the image over this color, in linear light.
    Over(LinearRgb),
}

impl Serialize for ImageAlpha {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Drop => serializer.serialize_str("drop"),
            Self::Over(color) => {
                serializer.serialize_str(&format!("over:{}", hex_from_color(*color)))
            }
        }
    }
}

impl<'de> Deserialize<'de> for ImageAlpha {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let color = |text: &str| LinearRgb::from_hex(text).ok().map(Self::Over);
        let alpha = match text.split_once(':') {
            None if text == "drop" => Some(Self::Drop),
            Some(("over", background)) => color(background),
            _ => None,
        };
        let expected = "\"drop\", or \"over:\" and a color such as \"over:#ffffff\"";
        alpha.ok_or_else(|| D::Error::invalid_value(Unexpected::Str(&text), &expected))
    }
}
