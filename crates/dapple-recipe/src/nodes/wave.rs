//! Periodic functions of a number.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use dapple_wgsl::{Module, double_value};
use serde::{Deserialize, Serialize};

/// Periodic wave of a number, with values from 0 to 1.
///
/// Examples are veins from a sum of coordinates and noise, and rings from a distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Argument of the wave: a number.
    pub input: Input,
    /// Frequency, in waves per unit of the input. For a coordinate along which the recipe repeats, the tile must hold a
    /// whole number of waves.
    #[serde(default = "one")]
    pub frequency: f64,
    /// Phase at an input of 0, in waves.
    #[serde(default)]
    pub phase: f64,
    /// Shape of the wave.
    #[serde(default)]
    pub form: Waveform,
}

fn one() -> f64 {
    1.0
}

const FINITE: Range = range!(finite);

/// Shape of a wave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Waveform {
    /// Sine wave `½ + ½ sin 2πt`.
    #[default]
    Sine,
    /// Triangle wave: linear from 0 to 1 and back to 0.
    Triangle,
    /// Sawtooth wave: linear from 0 to 1, then a jump to 0.
    Sawtooth,
    /// Square wave: 0 in the first half of a period, 1 in the second.
    Square,
}

impl NodeKind for Wave {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(FINITE, "frequency of the wave", self.frequency)?;
        RecipeError::check_in(FINITE, "phase", self.phase)?;
        let (frequency, phase, form) = (self.frequency, self.phase, self.form);
        plan.each(&self.input, move |value| {
            form.at(f64::from(value) * frequency + phase) as f32
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.number(&self.input)?;
        shader.needs(Module::Double);
        let mut t = format!("double_from({input})");
        if self.frequency != 1.0 {
            t = format!("double_mul({t}, {})", double_value(self.frequency));
        }
        if self.phase != 0.0 {
            t = format!("double_add({t}, {})", double_value(self.phase));
        }
        let t = shader.name("phase", t);
        let t = format!("double_sub({t}, double_floor({t}))");
        Ok(Code::number(match self.form {
            Waveform::Sine => {
                shader.needs(Module::DoubleSine);
                let half = double_value(0.5);
                let angle = format!("double_mul({t}, {})", double_value(core::f64::consts::TAU));
                let sine = format!("double_mul({half}, double_sine({angle}))");
                format!("double_to_float(double_add({half}, {sine}))")
            }
            Waveform::Sawtooth => format!("double_to_float({t})"),
            Waveform::Triangle => {
                // `1 - |2 t - 1|`
                let one = double_value(1.0);
                let twice = format!("double_mul({t}, {})", double_value(2.0));
                let size = format!("double_abs(double_sub({twice}, {one}))");
                format!("double_to_float(double_sub({one}, {size}))")
            }
            // The upper word of ½ is 0x3fe00000.
            Waveform::Square => format!("select(0.0, 1.0, {t}.x >= 0x3fe00000u)"),
        }))
    }
}

impl Waveform {
    /// Returns the wave's value, from 0 to 1, at `t` periods.
    fn at(self, t: f64) -> f64 {
        let t = t - t.floor();
        match self {
            Self::Sine => 0.5 + 0.5 * libm::sin(core::f64::consts::TAU * t),
            Self::Triangle => 1.0 - (2.0 * t - 1.0).abs(),
            Self::Sawtooth => t,
            Self::Square if t < 0.5 => 0.0,
            Self::Square if t.is_nan() => t,
            Self::Square => 1.0,
        }
    }
}
