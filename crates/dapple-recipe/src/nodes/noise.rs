//! Sums octaves of noise to fractal noise with values from 0 to 1.

use super::fractal::sum_code;
use super::{Frequency, NodeKind, NodeSeed, pups, wavelet};
use crate::plan::{Builder, FREQUENCY, Step, Work};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{RecipeError, RecipeErrorKind};
use dapple_noise::GradientNoise2;
use dapple_pups::{NetField as _, NetOptions, OctavesOptions, PupsRecipe as _, Spacing, octaves};
use dapple_raster::{FieldExt, FractalShape};
use dapple_raster::{Range, range};
use dapple_wgsl::{Module, double_value, gradient_noise_value};
use serde::{Deserialize, Serialize};

/// Fractal noise with values from 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct FractalNode {
    /// Noise of each octave.
    pub basis: FractalBasis,
    /// Frequency of the first octave, in bumps or cells per unit of the plane: one number, or one for each axis.
    ///
    /// For PUPs, the frequency is the approximate number of bumps, and the same along both axes. For gradient and
    /// wavelet noise, it is the number of cells.
    pub frequency: Frequency,
    /// Number of octaves, from 1 to 16; each octave has twice the frequency of the previous one.
    #[cfg_attr(feature = "schema", schemars(transform = { OCTAVES }))]
    pub octaves: u32,
    /// Amplitude ratio of successive octaves, above 0 and at most 1.
    #[serde(alias = "persistence")]
    #[cfg_attr(feature = "schema", schemars(transform = { GAIN }))]
    pub gain: f64,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for FractalNode {
    fn default() -> Self {
        Self {
            basis: FractalBasis::Pups,
            frequency: Frequency([8.0; 2]),
            octaves: 4,
            gain: 0.5,
            seed: None,
        }
    }
}

/// Noise of an octave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FractalBasis {
    /// Interpolated random values at Poisson-disk points; the sum is divided by its largest possible value.
    #[default]
    Pups,
    /// Perlin's gradient noise; the result is `½ + sum / 6σ`, clamped to 0 to 1, with the standard deviation `σ` of the
    /// sum.
    #[serde(alias = "perlin")]
    Gradient,
    /// Wavelet noise; the result is `½ + sum / 6σ`, clamped to 0 to 1, with the standard deviation `σ` of the sum.
    Wavelet,
}

const OCTAVES: Range = range!(from 1 to 16);
const GAIN: Range = range!(above 0 to 1);

impl NodeKind for FractalNode {
    fn work(&self, plan: &Builder<'_>) -> Result<Work, RecipeError> {
        match self.basis {
            FractalBasis::Pups => Ok(Work {
                control_points: self.pups(plan).expected_points(),
                ..Work::default()
            }),
            FractalBasis::Gradient => Ok(Work::default()),
            FractalBasis::Wavelet => wavelet::work(plan, self.frequency.0),
        }
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (seed, frequency) = (plan.seed(self.seed.as_ref()), self.frequency.0);
        for frequency in frequency {
            RecipeError::check_in(FREQUENCY, "frequency", frequency)?;
        }
        if self.basis == FractalBasis::Pups && frequency[0] != frequency[1] {
            return Err(RecipeError::new(RecipeErrorKind::Conflict {
                rule: "the basis `pups` has the same `frequency` along both axes; `gradient` and `wavelet` can have two",
            }));
        }
        RecipeError::check_in(OCTAVES, "number of octaves", self.octaves.into())?;
        RecipeError::check_in(GAIN, "gain", self.gain)?;
        Ok(match self.basis {
            FractalBasis::Pups => Step::field(octaves(&self.pups(plan), seed)?.normalized()),
            FractalBasis::Wavelet => {
                let noise = wavelet::noise(plan, seed, frequency, &self.weights(1.0))?;
                Step::field(noise.frequency_per_axis(frequency).map(about_half))
            }
            FractalBasis::Gradient => {
                let noise = GradientNoise2::new(seed).with_period(plan.periods(frequency)?)?;
                let octaves = noise.fractal(self.octaves, self.gain, 2.0, FractalShape::Sum)?;
                let scale = self.weights(GradientNoise2::VARIANCE.into())[0];
                let noise = octaves.frequency_per_axis(frequency);
                Step::field(noise.map(move |sum| about_half(scale * sum)))
            }
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        match self.basis {
            FractalBasis::Gradient => {}
            FractalBasis::Pups => {
                let seed = shader.seed(self.seed.as_ref());
                let sum = shader.build(|plan| Ok(octaves(&self.pups(plan), seed)?.normalized()))?;
                return pups::code(shader, &sum.shader_layers());
            }
            FractalBasis::Wavelet => {
                let seed = shader.seed(self.seed.as_ref());
                let noise = wavelet::code(shader, seed, self.frequency.0, &self.weights(1.0))?;
                return Ok(Code::number(about_half_code(&noise.text)));
            }
        }
        let frequency = self.frequency.0;
        let noise = GradientNoise2::new(shader.seed(self.seed.as_ref()));
        let noise = noise.with_period(shader.periods(frequency))?;
        let octaves = noise.fractal(self.octaves, self.gain, 2.0, FractalShape::Sum)?;
        let first = shader.position(frequency);
        let octaves = octaves.octaves();
        let sum = shader.at(first, |shader| {
            sum_code(shader, FractalShape::Sum, octaves, |shader, noise, at| {
                gradient_code(shader, noise, &at)
            })
        })?;
        let scale = literal(self.weights(GradientNoise2::VARIANCE.into())[0]);
        let sum = format!("number_mul({scale}, {sum}, zero)");
        Ok(Code::number(about_half_code(&sum)))
    }
}

impl FractalNode {
    /// Returns the node's options as options of PUPs noise.
    fn pups(&self, plan: &Builder<'_>) -> OctavesOptions {
        OctavesOptions {
            domain: plan.domain(),
            spacing: Spacing::from(1.0 / self.frequency.0[0]),
            octaves: self.octaves,
            gain: self.gain,
            net: NetOptions {
                parts: plan.parts().clone(),
                cancel: plan.watch().cancel(),
                ..NetOptions::default()
            },
            ..OctavesOptions::default()
        }
    }

    /// Returns the octave weights, scaled so that the sum of octaves has a standard deviation of 1/6. `variance` is the
    /// variance of a single octave.
    #[doc(hidden)]
    #[must_use]
    pub fn weights(&self, variance: f64) -> Vec<f32> {
        let weights = core::iter::successors(Some(1.0), |weight| Some(weight * self.gain));
        let weights: Vec<f64> = weights.take(self.octaves as usize).collect();
        let squares = weights.iter().map(|weight| weight * weight * variance);
        let deviation = squares.sum::<f64>().sqrt();
        let weights = weights.into_iter();
        weights
            .map(|weight| (weight / (6.0 * deviation)) as f32)
            .collect()
    }
}

/// Writes WGSL for gradient noise at a position in cells.
pub(crate) fn gradient_code(
    shader: &mut NodeShader<'_, '_>,
    noise: &GradientNoise2,
    at: &str,
) -> Result<String, Refusal> {
    shader.needs(Module::GradientNoise2d);
    // The sum has the weight of an octave, which the noise itself does not use.
    let mut words = noise.shader_words(1.0)?;
    // Add the offset of the octave to the position with 64 bits, as the CPU does.
    let offset = [8, 9].map(|at| f64::from(words[at]) / f64::from(1 << 24));
    words[8..12].fill(0);
    let mut at = at.to_owned();
    if offset != [0.0; 2] {
        let [x, y] = offset.map(double_value);
        at = shader.name("position", format!("shifted_2d({at}, {x}, {y})"));
    }
    let noise = shader.constant("NOISE", gradient_noise_value(&words));
    Ok(format!(
        "gradient_noise_2d({noise}, noise_place_2d({at}), zero)"
    ))
}

/// Returns `0.5 + value`, clamped to 0 to 1.
pub(super) fn about_half(value: f32) -> f32 {
    (0.5 + value).clamp(0.0, 1.0)
}

/// Writes WGSL for [`about_half`].
pub(super) fn about_half_code(value: &str) -> String {
    format!("number_clamp(number_add(0.5, {value}, zero), 0.0, 1.0, zero)")
}
