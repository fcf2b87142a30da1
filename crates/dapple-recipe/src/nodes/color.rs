//! Nodes with the same color at every position.

use super::NodeKind;
use crate::RecipeError;
use crate::input::hex_from_color;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, color_literal};
use dapple_color::LinearRgb;
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

/// Constant color at every position.
///
/// In a recipe file, the color is written in hexadecimal sRGB, such as `"#c08040"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorOf(pub LinearRgb);

impl NodeKind for ColorOf {
    fn build(&self, _: &mut Builder<'_>) -> Result<Step, RecipeError> {
        Ok(Step::Color(self.0))
    }

    fn shader(&self, _: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        Ok(Code::color(color_literal(self.0)))
    }
}

impl Serialize for ColorOf {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&hex_from_color(self.0))
    }
}

impl<'de> Deserialize<'de> for ColorOf {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        LinearRgb::from_hex(&text)
            .map(Self)
            .map_err(D::Error::custom)
    }
}
