//! Blur along the paths on which water runs down a height.
//!
//! The path of a pixel follows the gradient of the height uphill, in steps of equal length. Values are averaged along it,
//! so that they run downhill, in the way of line integral convolution (Brian Cabral and Leith Leedom, "Imaging vector
//! fields using line integral convolution", SIGGRAPH 1993). Gradients and values are interpolated between pixels. Paths
//! are in pixels relative to the pixel, so that they have the same bits in every window.

use super::NodeKind;
use super::blur::weights;
use crate::plan::{Builder, Step, Surroundings};
use crate::{Input, RecipeError, Values};
use dapple_color::LinearRgb;
use dapple_raster::parallel;
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Blur of a number or a color along the slope of a height: values run downhill, as rust and dirt do.
///
/// The value of a pixel is the weighted mean along the path that leads uphill from it, up to three radii. On level
/// ground the path ends. Values stay the same if the radius is below a third of a pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SlopeBlur {
    /// Number or color to blur.
    pub input: Input,
    /// Height whose slope the values follow: a number.
    pub height: Input,
    /// Standard deviation of the Gaussian weights along the path, in units of the plane.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
}

/// Maximum number of steps of a path. Longer paths have longer steps.
const MAX_STEPS: u32 = 32;

impl NodeKind for SlopeBlur {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input, &self.height]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let radius = plan.radius(Some(self.radius), 0.0)?;
        let height = plan.number(&self.height)?;
        let input = plan.any(&self.input)?;
        let halo = move |pixel| Steps::new(radius, pixel).halo(pixel);
        let is_color = plan.is_color(input);
        let step = plan.neighborhood(vec![input, height], halo, move |around| {
            let steps = Steps::new(radius, around.pixel);
            Ok(match &*around.inputs[0] {
                Values::Numbers(numbers) => {
                    Values::Numbers(run(around, &steps, |index| [numbers[index]], |[a]| a))
                }
                Values::Colors(colors) => Values::Colors(run(
                    around,
                    &steps,
                    |index| colors[index].to_array(),
                    |[r, g, b]| LinearRgb::new(r, g, b),
                )),
            })
        });
        Ok(if is_color { step } else { step.with_numbers() })
    }
}

/// The steps of all paths.
struct Steps {
    /// Length of a step, in units of the plane.
    length: f64,
    /// Weight of the value after each step.
    weights: Vec<f32>,
}

impl Steps {
    fn new(radius: f64, pixel: DVec2) -> Self {
        let reach = 3.0 * radius;
        let length = pixel.min_element().max(reach / f64::from(MAX_STEPS));
        // The small factor keeps a whole number of steps whole, whatever the rounding error of the pixel size.
        let count = (reach / length * (1.0 + 1e-9)).floor() as u32;
        Self {
            length,
            weights: weights(radius, length, count, 1.0),
        }
    }

    /// Returns the columns and rows that a path can reach, with the pixels that interpolation and gradients read.
    fn halo(&self, pixel: DVec2) -> [u32; 2] {
        if self.weights.is_empty() {
            return [0; 2];
        }
        let reach = self.length * self.weights.len() as f64;
        // The small term covers the rounding of the steps.
        [pixel.x, pixel.y].map(|pixel| (reach / pixel + 1e-6).ceil() as u32 + 2)
    }
}

/// Averages the values along the path of each pixel. `value` reads a pixel of the window and its halo.
fn run<const N: usize, T: Copy + Default + Send>(
    around: &Surroundings<'_>,
    steps: &Steps,
    value: impl Fn(usize) -> [f32; N] + Sync,
    result: impl Fn([f32; N]) -> T + Sync,
) -> Vec<T> {
    let width = around.size[0] as usize;
    let [left, above] = around.halo.map(|side| side as usize);
    let wide = around.input_size()[0] as usize;
    let heights = around.inputs[1].numbers();
    // The rise over two pixels along each axis, at pixels with neighbors on all sides.
    let rise = |index: usize| {
        let difference = |a: usize, b: usize| f64::from(heights[b]) - f64::from(heights[a]);
        [
            difference(index - 1, index + 1),
            difference(index - wide, index + wide),
        ]
    };
    let n_pixels = width * around.size[1] as usize;
    let mut values = vec![T::default(); n_pixels];
    parallel::for_each_chunk(&mut values, width, |row, out| {
        for (column, out) in out.iter_mut().enumerate() {
            let first = (row + above) * wide + column + left;
            let here = value(first);
            let mut sum = here;
            let mut offset = DVec2::ZERO;
            for &weight in &steps.weights {
                // Find the direction uphill, and take a step.
                let uphill = DVec2::from(interpolated(first, wide, offset, &rise)) / around.pixel;
                let length = uphill.length();
                // On level ground the path stays where it is.
                if length > 0.0 && length.is_finite() {
                    offset += steps.length / length * uphill / around.pixel;
                }
                let there = interpolated(first, wide, offset, &|index| value(index).map(f64::from));
                for ((sum, there), here) in sum.iter_mut().zip(there).zip(here) {
                    *sum += weight * (there as f32 - here);
                }
            }
            *out = result(sum);
        }
    });
    values
}

/// Interpolates between the four pixels around an offset from a pixel, in columns and rows.
#[inline(always)]
fn interpolated<const N: usize>(
    first: usize,
    wide: usize,
    offset: DVec2,
    value: &impl Fn(usize) -> [f64; N],
) -> [f64; N] {
    let floor = offset.floor();
    let part = offset - floor;
    let index = (first as i64 + floor.y as i64 * wide as i64 + floor.x as i64) as usize;
    let mix = |a: [f64; N], b: [f64; N], part: f64| {
        core::array::from_fn(|channel| a[channel] + part * (b[channel] - a[channel]))
    };
    let upper = mix(value(index), value(index + 1), part.x);
    let lower = mix(value(index + wide), value(index + wide + 1), part.x);
    mix(upper, lower, part.y)
}
