//! Color ramps.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, RecipeErrorKind, Values};
use dapple_color::{ColorRamp, ColorStop, Interpolation, LinearRgb, Outside, Palette, RampSpace};
use serde::{Deserialize, Serialize};

/// Color ramp: a color for each number, from a palette or a list of colors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Ramped {
    /// Number that the ramp maps to a color.
    pub input: Input,
    /// Named palette; cannot be combined with `colors`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub palette: Option<Palette>,
    /// Colors in sRGB, such as `["#204060", "#ffffff"]`; cannot be combined with `palette`.
    #[serde(default, skip_serializing_if = "Vec::is_empty", with = "colors")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<crate::ColorOf>"))]
    pub colors: Vec<LinearRgb>,
    /// Position of each color on the ramp [default: evenly spaced from 0 to 1].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub positions: Vec<f32>,
    /// Color space in which neighboring colors are mixed.
    #[serde(default)]
    pub space: RampSpace,
    /// Interpolation between neighboring colors.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// Colors past the ends of the ramp.
    #[serde(default)]
    pub outside: Outside,
}

impl NodeKind for Ramped {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let ramp = self.ramp()?;
        let inputs = vec![plan.number(&self.input)?];
        let step = plan.local(inputs, move |inputs| {
            // Reuse the last color: neighboring pixels often have equal numbers, such as the value of their cell.
            let mut last = (f32::NAN.to_bits(), ramp.at(f32::NAN));
            let color = |&value: &f32| {
                if value.to_bits() != last.0 {
                    last = (value.to_bits(), ramp.at(value));
                }
                last.1
            };
            let numbers = inputs[0].numbers().iter();
            Ok(Values::Colors(numbers.map(color).collect()))
        });
        Ok(step.with_colors())
    }
}

impl Ramped {
    /// Returns the color ramp of the palette, or of the node's colors.
    fn ramp(&self) -> Result<ColorRamp, RecipeError> {
        let conflict = |rule| Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
        let colors = match (self.palette, self.colors.is_empty()) {
            (Some(palette), true) => palette.colors(),
            (None, false) => self.colors.clone(),
            (Some(_), false) => {
                return conflict("a ramp has a `palette` or `colors`, but not both");
            }
            (None, true) => return conflict("a ramp needs a `palette` or `colors`"),
        };
        let ramp = if self.positions.is_empty() {
            ColorRamp::even(&colors)?
        } else if self.positions.len() == colors.len() {
            let stops = self.positions.iter().zip(colors);
            let stops = stops.map(|(&position, color)| ColorStop { position, color });
            ColorRamp::new(stops.collect::<Vec<_>>())?
        } else {
            return conflict("a ramp has as many `positions` as colors, or none");
        };
        Ok(ramp
            .with_space(self.space)
            .with_interpolation(self.interpolation)
            .with_outside(self.outside))
    }
}

/// Serializes lists of colors as hexadecimal sRGB.
mod colors {
    use crate::ColorOf;
    use dapple_color::LinearRgb;
    use serde::de::{Deserialize, Deserializer};
    use serde::ser::Serializer;

    pub(super) fn serialize<S: Serializer>(
        colors: &[LinearRgb],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(colors.iter().map(|&color| ColorOf(color)))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<LinearRgb>, D::Error> {
        let colors = Vec::<ColorOf>::deserialize(deserializer)?;
        Ok(colors.into_iter().map(|ColorOf(color)| color).collect())
    }
}
