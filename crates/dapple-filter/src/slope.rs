//! Blur along the paths on which water runs down a height.
//!
//! The path of a pixel follows the gradient of the height uphill, in steps of equal length. Values are averaged along it,
//! so that they run downhill, as in line integral convolution (Brian Cabral and Leith Leedom, "Imaging vector
//! fields using line integral convolution", SIGGRAPH 1993). Gradients and values are interpolated between pixels. Paths
//! are in pixels relative to the pixel, so that they have the same bits in every window.

use crate::Part;
use crate::gaussian::weights;
use crate::part::pixels_within;
use dapple_raster::parallel;
use glam::DVec2;

/// Maximum number of steps of a path. Longer paths have longer steps.
const MAX_STEPS: u32 = 32;

/// Blur along the paths on which water runs down heights.
#[derive(Clone, Debug)]
pub struct SlopeBlur {
    /// Length of a step, in units of the plane.
    length: f64,
    /// Weight of the value after each step.
    weights: Vec<f32>,
}

impl SlopeBlur {
    /// Creates a blur whose weights along a path are a Gaussian of the standard deviation `radius`, in units of the plane.
    #[must_use]
    pub fn new(radius: f64, pixel: DVec2) -> Self {
        let reach = 3.0 * radius;
        let length = pixel.min_element().max(reach / f64::from(MAX_STEPS));
        let count = pixels_within(reach, length);
        Self {
            length,
            weights: weights(radius, length, count, 1.0),
        }
    }

    /// Returns the columns and rows that a path can reach, with the pixels that interpolation and gradients read.
    #[must_use]
    pub fn halo(&self, pixel: DVec2) -> [u32; 2] {
        if self.weights.is_empty() {
            return [0; 2];
        }
        let reach = self.length * self.weights.len() as f64;
        // The small term covers the rounding of the steps.
        [pixel.x, pixel.y].map(|pixel| (reach / pixel + 1e-6).ceil() as u32 + 2)
    }

    /// Averages the numbers of a part along the path that leads uphill from each pixel.
    ///
    /// # Panics
    ///
    /// If there are fewer heights or values than in the part and its halo, which must be [`halo`](Self::halo).
    #[must_use]
    pub fn apply(&self, values: &[f32], heights: &[f32], part: &Part) -> Vec<f32> {
        let numbers = self.run(heights, part, &|index| [values[index]]);
        numbers.into_iter().map(|[number]| number).collect()
    }

    /// Averages the colors of a part along the path that leads uphill from each pixel; see [`apply`](Self::apply).
    ///
    /// # Panics
    ///
    /// Same as [`apply`](Self::apply).
    #[must_use]
    pub fn apply_colors(&self, colors: &[[f32; 3]], heights: &[f32], part: &Part) -> Vec<[f32; 3]> {
        self.run(heights, part, &|index| colors[index])
    }

    fn run<const N: usize>(
        &self,
        heights: &[f32],
        part: &Part,
        value: &(impl Fn(usize) -> [f32; N] + Sync),
    ) -> Vec<[f32; N]> {
        let width = part.size[0] as usize;
        let [left, above] = part.halo.map(|side| side as usize);
        let wide = part.input_size()[0] as usize;
        let per_pixel = [part.pixel.x, part.pixel.y].map(f64::recip);
        // Compute gradients at all pixels with neighbors on all sides.
        let mut gradients = vec![
            [0.0; 2];
            if self.weights.is_empty() {
                0
            } else {
                heights.len()
            }
        ];
        parallel::for_each_chunk(&mut gradients, wide, |row, out| {
            let is_inside = row > 0 && (row + 2) * wide <= heights.len();
            for (column, out) in out.iter_mut().enumerate().filter(|_| is_inside) {
                if (1..wide - 1).contains(&column) {
                    let index = row * wide + column;
                    let [x, y] =
                        [1, wide].map(|step| heights[index + step] - heights[index - step]);
                    *out = [x * per_pixel[0] as f32, y * per_pixel[1] as f32];
                }
            }
        });
        let mut values = vec![[0.0; N]; width * part.size[1] as usize];
        parallel::for_each_chunk(&mut values, width, |row, out| {
            for (column, out) in out.iter_mut().enumerate() {
                let first = (row + above) * wide + column + left;
                let here = value(first);
                let mut sum = here;
                let mut offset = [0.0; 2];
                for &weight in &self.weights {
                    // Find the direction uphill, and take a step.
                    let uphill = interpolated(first, wide, offset, &|index| gradients[index]);
                    let [x, y] = uphill.map(f64::from);
                    let length = (x * x + y * y).sqrt();
                    // On level ground the path stays where it is.
                    if length > 0.0 && length.is_finite() {
                        let step = self.length / length;
                        offset[0] += step * x * per_pixel[0];
                        offset[1] += step * y * per_pixel[1];
                    }
                    let there = interpolated(first, wide, offset, value);
                    for ((sum, there), here) in sum.iter_mut().zip(there).zip(here) {
                        *sum += weight * (there - here);
                    }
                }
                *out = sum;
            }
        });
        values
    }
}

/// Interpolates between the four pixels around an offset from a pixel, in columns and rows.
#[inline(always)]
fn interpolated<const N: usize>(
    first: usize,
    wide: usize,
    offset: [f64; 2],
    value: &impl Fn(usize) -> [f32; N],
) -> [f32; N] {
    // A truncation and a comparison are faster than `floor` without SSE4.1.
    let [x, y] = offset.map(|offset| offset as i64 - i64::from(offset < offset as i64 as f64));
    let part = [offset[0] - x as f64, offset[1] - y as f64].map(|part| part as f32);
    let index = (first as i64 + y * wide as i64 + x) as usize;
    let mix = |a: [f32; N], b: [f32; N], part: f32| {
        core::array::from_fn(|channel| a[channel] + part * (b[channel] - a[channel]))
    };
    let upper = mix(value(index), value(index + 1), part[0]);
    let lower = mix(value(index + wide), value(index + wide + 1), part[0]);
    mix(upper, lower, part[1])
}
