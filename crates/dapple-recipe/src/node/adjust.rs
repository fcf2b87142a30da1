//! Nodes that change one number into another.

use crate::Input;
use dapple_worley::Profile;
use serde::{Deserialize, Serialize};

/// A range stretched to another: how most textures become heights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// The number.
    pub input: Input,
    /// The range that is stretched; 0 to 1 by default. Its ends may lie either way round, but must differ.
    #[serde(default = "unit")]
    pub from: [f32; 2],
    /// What it becomes; 0 to 1 by default.
    #[serde(default = "unit")]
    pub to: [f32; 2],
    /// What lies in between; a line by default.
    #[serde(default)]
    pub curve: LevelsCurve,
}

fn unit() -> [f32; 2] {
    [0.0, 1.0]
}

/// What lies between the ends of a range. All but the first stay at its ends outside of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LevelsCurve {
    /// A line that goes on past the ends.
    Unclamped,
    /// A line.
    #[default]
    Linear,
    /// `3t² − 2t³`, which is flat at its ends.
    Smooth,
}

/// A number to a power.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Power {
    /// The number; below 0 it counts as 0.
    pub input: Input,
    /// The exponent, above 0.
    pub exponent: f32,
}

/// A wave of a number, from 0 to 1: veins of a sum of coordinates and noise, rings of a distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// The number.
    pub input: Input,
    /// Waves per unit of the number; 1 by default. Of a coordinate along which the recipe repeats, the tile must hold a
    /// whole number of them.
    #[serde(default = "one")]
    pub frequency: f64,
    /// How far the wave has come at 0, in waves; 0 by default.
    #[serde(default)]
    pub phase: f64,
    /// Its form; a sine by default.
    #[serde(default)]
    pub form: Waveform,
}

fn one() -> f64 {
    1.0
}

/// The form of a wave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Waveform {
    /// `½ + ½ sin 2πt`.
    #[default]
    Sine,
    /// From 0 up to 1 and down again, in lines.
    Triangle,
    /// From 0 up to 1, then 0 at once.
    Sawtooth,
    /// 0 in the first half, 1 in the second.
    Square,
}

/// A cross-section: how high a bump is where a number has a value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProfileOf {
    /// The number; 0 is in the middle of the bump.
    pub input: Input,
    /// The cross-section, such as `{ channels = { width = 0.1 } }` or `{ spots = { radius = 0.3 } }`.
    pub shape: Profile,
}
