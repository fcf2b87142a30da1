//! Wavelet noise.

use super::{Frequency, NodeKind, NodeSeed};
use crate::RecipeError;
use crate::plan::{Builder, Step, Work};
use crate::shader::{Code, NodeShader, Refusal};
use dapple_hash::Seed;
use dapple_raster::FieldExt;
use dapple_wavelet::WaveletNoise2;
use dapple_wgsl::Module;
use serde::{Deserialize, Serialize};

/// Wavelet noise: nearly normally distributed values with mean 0 and, for a single band, variance 1.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct WaveletNode {
    /// Frequency of the coarsest band, in cells per unit of the plane: one number, or one for each axis. Along an axis
    /// on which the recipe repeats, the tile must have an even number of cells, at least 4.
    pub frequency: Frequency,
    /// Weight of each band, coarsest first; each band has twice the frequency of the previous one.
    pub weights: Vec<f32>,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for WaveletNode {
    fn default() -> Self {
        Self {
            frequency: Frequency([8.0; 2]),
            weights: vec![1.0],
            seed: None,
        }
    }
}

/// Side of a wavelet noise tile, in cells, along axes on which the recipe does not repeat.
const UNBOUND_TILE: u32 = 128;

impl NodeKind for WaveletNode {
    fn work(&self, plan: &Builder<'_>) -> Result<Work, RecipeError> {
        work(plan, self.frequency.0)
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let seed = plan.seed(self.seed.as_ref());
        let noise = noise(plan, seed, self.frequency.0, &self.weights)?;
        Ok(Step::field(noise.frequency_per_axis(self.frequency.0)))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let seed = shader.seed(self.seed.as_ref());
        code(shader, seed, self.frequency.0, &self.weights)
    }
}

/// Writes WGSL for the node's noise, and adds its tile of coefficients to the shader's `data` texture.
pub(super) fn code(
    shader: &mut NodeShader<'_, '_>,
    seed: Seed,
    frequency: [f64; 2],
    weights: &[f32],
) -> Result<Code, Refusal> {
    let noise = shader.build(|plan| noise(plan, seed, frequency, weights))?;
    noise_code(shader, &noise, frequency)
}

/// Writes WGSL for wavelet noise at the position times a frequency.
pub(crate) fn noise_code(
    shader: &mut NodeShader<'_, '_>,
    noise: &WaveletNoise2,
    frequency: [f64; 2],
) -> Result<Code, Refusal> {
    let first = shader.data(&noise.shader_words())?;
    shader.needs(Module::WaveletNoise2d);
    let at = shader.position(frequency);
    Ok(Code::number(format!(
        "wavelet_noise_2d(data, {first}u, {at}, zero)"
    )))
}

/// Builds wavelet noise with these band weights. `frequency` is in cells of the coarsest band per unit of the plane;
/// the caller multiplies positions by it.
pub(super) fn noise(
    plan: &Builder<'_>,
    seed: Seed,
    frequency: [f64; 2],
    weights: &[f32],
) -> Result<WaveletNoise2, RecipeError> {
    let size = cells(plan, frequency)?;
    let tile = plan.parts().get_or_make(
        |tile: &Tile| tile.noise.size() == size && tile.seed == seed,
        || {
            let watch = plan.watch();
            let is_cancelled = || watch.is_cancelled();
            let noise = WaveletNoise2::of_size_cancellable(size, seed, &is_cancelled)?;
            Ok::<_, RecipeError>(Tile { noise, seed })
        },
    )?;
    Ok(tile.noise.clone().with_weights(weights)?)
}

/// Wavelet noise with a single band, stored with its seed for reuse with other weights.
struct Tile {
    noise: WaveletNoise2,
    seed: Seed,
}

/// Estimates the work of building wavelet noise. `frequency` is in cells per unit of the plane.
pub(super) fn work(plan: &Builder<'_>, frequency: [f64; 2]) -> Result<Work, RecipeError> {
    let [across, down] = cells(plan, frequency)?.map(f64::from);
    Ok(Work {
        wavelet_cells: across * down,
        ..Work::default()
    })
}

/// Returns the number of cells of the wavelet noise tile along each axis. Fails if it is odd or below 4 along an axis
/// that repeats.
fn cells(plan: &Builder<'_>, frequency: [f64; 2]) -> Result<[u32; 2], RecipeError> {
    let periods = plan.periods(frequency)?;
    for cells in periods.into_iter().flatten() {
        let holds = cells >= 4 && cells.is_multiple_of(2);
        let range = "even, at least 4 (extent times frequency, since the recipe repeats)";
        let what = "number of cells of wavelet noise along a side of the tile";
        RecipeError::check(holds, what, cells.into(), range)?;
    }
    Ok(periods.map(|cells| cells.unwrap_or(UNBOUND_TILE)))
}
