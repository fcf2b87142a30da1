//! Sums a node at several scales.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Moved, Positions, Step};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{Input, RecipeError, RecipeErrorKind};
use dapple_raster::{Fractal, FractalShape};
use dapple_wgsl::Module;
use serde::{Deserialize, Serialize};

/// Fractal sum of a node: the node plus weaker copies of it at higher frequencies.
///
/// For noise with separate octaves, use the octaves of `noise` or `worley`. The copies of one node coincide at the
/// origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FractalOf {
    /// Number that is summed. A node that depends on the whole tile is interpolated between its pixels.
    pub input: Input,
    /// Number of octaves.
    #[serde(default = "octaves")]
    #[cfg_attr(feature = "schema", schemars(transform = { Fractal::COUNT }))]
    pub octaves: u32,
    /// Amplitude of an octave relative to the previous one.
    #[serde(default = "gain", alias = "persistence")]
    #[cfg_attr(feature = "schema", schemars(transform = { Fractal::GAIN }))]
    pub gain: f64,
    /// Frequency of an octave relative to the previous one; a whole number where the recipe repeats.
    #[serde(default = "lacunarity")]
    #[cfg_attr(feature = "schema", schemars(transform = { Fractal::LACUNARITY }))]
    pub lacunarity: f64,
    /// Function applied to the values of each octave, for values centered at 0.
    #[serde(default)]
    pub shape: FractalShape,
}

fn octaves() -> u32 {
    4
}

fn gain() -> f64 {
    0.5
}

fn lacunarity() -> f64 {
    2.0
}

impl NodeKind for FractalOf {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(Fractal::COUNT, "number of octaves", self.octaves.into())?;
        RecipeError::check_in(Fractal::GAIN, "gain", self.gain)?;
        RecipeError::check_in(Fractal::LACUNARITY, "lacunarity", self.lacunarity)?;
        if plan.domain().wrap.contains(&true) && self.lacunarity.fract() != 0.0 {
            return Err(RecipeError::new(RecipeErrorKind::Conflict {
                rule: "where the recipe repeats, the `lacunarity` of `fractal` must be a whole number",
            }));
        }
        let octaves = core::iter::repeat_n((), self.octaves as usize);
        let sum = Fractal::new(octaves, self.gain, self.lacunarity, self.shape)?;
        let octaves = sum.octaves();
        let octaves = octaves.map(|(_, frequency, weight)| (frequency, weight));
        let octaves = octaves.collect();
        Ok(Step::Moved(Moved {
            input: plan.number(&self.input)?,
            color: false,
            positions: Positions::Octaves {
                octaves,
                shape: self.shape,
            },
        }))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.moved(&self.input)?;
        let octaves = core::iter::repeat_n((), self.octaves as usize);
        let fractal = Fractal::new(octaves, self.gain, self.lacunarity, self.shape)?;
        let sum = sum_code(shader, self.shape, fractal.octaves(), |_, (), at| {
            Ok(input(&at).text)
        })?;
        Ok(Code::number(sum))
    }
}

/// Writes WGSL for a fractal sum. `octave` is a callback that writes the value of one octave, given its position.
pub(crate) fn sum_code<'a, T>(
    shader: &mut NodeShader<'_, 'a>,
    shape: FractalShape,
    octaves: impl IntoIterator<Item = (T, f64, f32)>,
    octave: impl Fn(&mut NodeShader<'_, 'a>, T, String) -> Result<String, Refusal>,
) -> Result<String, Refusal> {
    shader.needs(Module::Fractal);
    let mut sum = literal(0.0);
    for (field, frequency, weight) in octaves {
        let at = shader.position([frequency; 2]);
        let value = shaped_code(shape, octave(shader, field, at)?)?;
        let weight = literal(weight);
        sum = shader.name("sum", format!("add_octave({sum}, {weight}, {value}, zero)"));
    }
    Ok(sum)
}

/// Writes WGSL for the shaping of an octave, such as the absolute value for turbulence.
fn shaped_code(shape: FractalShape, value: String) -> Result<String, Refusal> {
    Ok(match shape {
        FractalShape::Sum => value,
        FractalShape::Ridged => format!("ridge({value}, zero)"),
        FractalShape::Billow => format!("abs({value})"),
        _ => return Err(Refusal::new("this shape of octaves has no shader")),
    })
}
