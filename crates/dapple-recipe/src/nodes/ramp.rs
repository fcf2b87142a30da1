//! Color ramps.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, color_literal, lerp, literal, quotient};
use crate::{Input, RecipeError, RecipeErrorKind, Values};
use core::fmt::Write as _;
use dapple_color::{ColorRamp, ColorStop, Interpolation, LinearRgb, Outside, Palette, RampSpace};
use dapple_wgsl::{Module, double_value, number_value};
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
    inputs!(input);

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

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let mixes = self.interpolation != Interpolation::Stepped;
        if mixes && self.space == RampSpace::Srgb {
            return Err(Refusal::new("ramps that mix in sRGB have no shader"));
        }
        if self.outside == Outside::Repeat {
            return Err(Refusal::new("ramps that repeat have no shader"));
        }
        if mixes && self.space == RampSpace::Oklab {
            shader.needs(Module::Oklab);
        }
        let body = self.body(&self.ramp()?);
        let function = shader.function("ramp", &body);
        let input = shader.number(&self.input)?;
        Ok(Code::color(format!("{function}({input}, zero)")))
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

impl Ramped {
    /// Writes the body of the WGSL function that evaluates the ramp, with a branch for each interval between stops.
    fn body(&self, ramp: &ColorRamp) -> String {
        let stops = ramp.stops();
        let mut text = "(value: f32, zero: u32) -> vec4<f32> {\n".to_owned();
        let mut arms = Vec::new();
        for (at, after) in stops.iter().enumerate() {
            let position = number_value(after.position);
            let Some(before) = at.checked_sub(1) else {
                // NaN gets the color of the first stop, too.
                let color = color_literal(after.color);
                let _ = writeln!(text, "    if !(value >= {position}) {{ return {color}; }}");
                continue;
            };
            if after.position > stops[before].position {
                let mixture = self.mixture(ramp, before);
                arms.push(format!("    if value < {position} {{ {mixture} }}"));
            }
        }
        let last = color_literal(stops.last().map_or(LinearRgb::BLACK, |stop| stop.color));
        if !arms.iter().any(|arm| arm.contains("start = ")) {
            arms.push(format!("    return {last};\n}}"));
            return text + &arms.join("\n");
        }
        // Mix in one place: a compiler copies the function to every call.
        text += "    var start: array<vec2<u32>, 3>;\n    var end: array<vec2<u32>, 3>;\n    var mixed = 0.0;\n";
        let arms = arms.join(" else\n");
        text + &format!(
            "{arms} else {{ return {last}; }}\n    return oklab_mix(start, end, mixed);\n}}"
        )
    }

    /// Writes the WGSL statements for the interval after the stop `from`: they return a color, or set the arguments of
    /// `oklab_mix`.
    fn mixture(&self, ramp: &ColorRamp, from: usize) -> String {
        let [before, after] = [from, from + 1].map(|stop| ramp.stops()[stop]);
        let [start, end] = [before.color, after.color].map(color_literal);
        let is_oklab = self.space == RampSpace::Oklab;
        if self.interpolation == Interpolation::Stepped || (is_oklab && start == end) {
            return format!("return {start};");
        }
        let [first, last] = [before.position * 0.5, after.position * 0.5];
        let above = format!(
            "number_sub(number_mul(value, 0.5, zero), {}, zero)",
            literal(first)
        );
        let t = quotient(&above, last - first);
        let part = match self.interpolation {
            Interpolation::Smooth => {
                format!("let t = {t}; let part = number_smooth(t, zero);")
            }
            _ => format!("let part = {t};"),
        };
        if !is_oklab {
            return format!("{part} return {};", lerp(&start, &end, "part"));
        }
        // The conversion to Oklab and back rounds; the colors of stops are returned unchanged.
        let [a, b] = [from, from + 1].map(|stop| {
            let [lightness, a, b] = ramp.stops()[stop].color.to_oklab().map(double_value);
            format!("array({lightness}, {a}, {b})")
        });
        format!("{part} if part == 0.0 {{ return {start}; }} start = {a}; end = {b}; mixed = part;")
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
