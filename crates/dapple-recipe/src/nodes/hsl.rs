//! Changes the hue, the saturation and the lightness of colors.
//!
//! HSL of the sRGB components, as in A. R. Smith, "Color Gamut Transform Pairs", SIGGRAPH 1978,
//! <https://doi.org/10.1145/800248.807361>, and in CSS.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError, Values};
use dapple_color::{LinearRgb, srgb_shader_words};
use dapple_wgsl::Module;
use serde::{Deserialize, Serialize};

/// Color with another hue, saturation and lightness (HSL of the sRGB color).
///
/// Results have 16 bits per channel. Components below 0 or above 1 are clamped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HslChange {
    /// Color to change.
    pub input: Input,
    /// Number of turns that is added to the hue; 1/3 leads from red to green.
    #[serde(default = "zero")]
    pub hue: Input,
    /// Factor of the saturation: a number.
    #[serde(default = "one")]
    pub saturation: Input,
    /// Factor of the lightness: a number.
    #[serde(default = "one")]
    pub lightness: Input,
}

fn zero() -> Input {
    Input::Number(0.0)
}

fn one() -> Input {
    Input::Number(1.0)
}

impl NodeKind for HslChange {
    inputs!(input, hue, saturation, lightness);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let inputs = vec![
            plan.any(&self.input)?,
            plan.number(&self.hue)?,
            plan.number(&self.saturation)?,
            plan.number(&self.lightness)?,
        ];
        let step = plan.local(inputs, |inputs| {
            let [turns, saturation, lightness] =
                [1, 2, 3].map(|index: usize| inputs[index].numbers());
            let colors = inputs[0].colors();
            let changes = turns.iter().zip(saturation).zip(lightness);
            let changed = colors.iter().zip(changes);
            Ok(Values::Colors(
                changed
                    .map(|(&color, ((&hue, &saturation), &lightness))| {
                        changed_color(color, [hue, saturation, lightness])
                    })
                    .collect(),
            ))
        });
        Ok(step.with_colors())
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let [borders, linear] = srgb_shader_words();
        let (borders, linear) = (shader.data(&borders)?, shader.data(&linear)?);
        shader.needs(Module::Hsl);
        let color = shader.any(&self.input)?.to_color();
        let [turns, saturation, lightness] = [
            shader.number(&self.hue)?,
            shader.number(&self.saturation)?,
            shader.number(&self.lightness)?,
        ];
        Ok(Code::color(format!(
            "changed_color(data, vec2({borders}u, {linear}u), {color}, {turns}, {saturation}, {lightness}, zero)"
        )))
    }
}

/// Writes WGSL for the sRGB components of a color, each from 0 to 1.
pub(super) fn components_code(
    shader: &mut NodeShader<'_, '_>,
    color: &Input,
) -> Result<String, Refusal> {
    let [borders, _] = srgb_shader_words();
    let borders = shader.data(&borders)?;
    shader.needs(Module::Hsl);
    let color = shader.any(color)?.to_color();
    let components = format!("srgb_components(data, {borders}u, {color}, zero)");
    Ok(shader.name("rgb", components))
}

/// Adds `change[0]` turns to the hue, and multiplies the saturation by `change[1]` and the lightness by `change[2]`.
fn changed_color(color: LinearRgb, change: [f32; 3]) -> LinearRgb {
    if change == [0.0, 1.0, 1.0] {
        return color;
    }
    let [turns, more, lighter] = change;
    let rgb = encoded(color);
    let [low, high] = ends(rgb);
    let lightness = 0.5 * (low + high);
    // Saturation is relative to the largest difference of components at the lightness.
    let room = 1.0 - (2.0 * lightness - 1.0).abs();
    let saturation = if room > 0.0 { (high - low) / room } else { 0.0 };
    let lightness = (lightness * lighter).clamp(0.0, 1.0);
    let saturation = (saturation * more).clamp(0.0, 1.0);
    let chroma = saturation * (1.0 - (2.0 * lightness - 1.0).abs());
    let hue = hue(rgb) + turns;
    // Each component is a trapezoid wave of the hue.
    let code = |phase: f32| {
        let t = hue + phase;
        let t = 6.0 * (t - t.floor());
        let wave = ((t - 3.0).abs() - 1.0).clamp(0.0, 1.0);
        let component = lightness + chroma * (wave - 0.5);
        (component * 65535.0 + 0.5) as u16
    };
    LinearRgb::from_srgb([code(0.0), code(-1.0 / 3.0), code(-2.0 / 3.0)])
}

/// Returns the sRGB components of a color, from 0 to 1 and quantized to 16 bits.
pub(super) fn encoded(color: LinearRgb) -> [f32; 3] {
    color.to_srgb::<u16>().map(|code| f32::from(code) / 65535.0)
}

/// Returns the minimum and maximum of the components.
pub(super) fn ends([r, g, b]: [f32; 3]) -> [f32; 2] {
    [r.min(g).min(b), r.max(g).max(b)]
}

/// Returns the hue in turns, from 0 to below 1; 0 for grays.
pub(super) fn hue([r, g, b]: [f32; 3]) -> f32 {
    let [low, high] = ends([r, g, b]);
    let chroma = high - low;
    if chroma <= 0.0 {
        return 0.0;
    }
    let sextants = if high == r {
        (g - b) / chroma
    } else if high == g {
        2.0 + (b - r) / chroma
    } else {
        4.0 + (r - g) / chroma
    };
    let turns = sextants / 6.0;
    turns - turns.floor()
}
