//! Periodic functions of a number.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
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
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(FINITE, "frequency of the wave", self.frequency)?;
        RecipeError::check_in(FINITE, "phase", self.phase)?;
        let (frequency, phase, form) = (self.frequency, self.phase, self.form);
        plan.each(&self.input, move |value| {
            form.at(f64::from(value) * frequency + phase) as f32
        })
    }
}

impl Waveform {
    /// Returns the value of the wave, from 0 to 1, at a phase of `t` periods.
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
