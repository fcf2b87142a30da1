//! Compares the step across the wrap with the steps inside the tile.
//!
//! Reference: our own.

use super::{SeamOptions, quotient, visible};
use crate::TileError;
use crate::axis::transpose;
use dapple_raster::Raster;

/// Widths of the pixel ranges that are averaged on either side of a boundary, in pixels.
const WIDTHS: [u32; 4] = [1, 2, 4, 8];

/// The ratio of the step across the wrap to the steps inside the tile, at one scale.
///
/// The step across a boundary is the difference between the mean of the `width` pixels before it and the mean of the
/// `width` pixels after it, along one line. Its absolute value is averaged over all lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Seam {
    /// Number of pixels that are averaged on either side.
    pub width: u32,
    /// Seam from the last column to the first.
    ///
    /// `None` if the tile does not repeat along this axis, or if no boundary of the lattice inside the tile has `width`
    /// pixels on either side.
    pub x: Option<SeamRatio>,
    /// Seam from the last row to the first; `None` under the same conditions as `x`.
    pub y: Option<SeamRatio>,
    /// Both axes together: the sum of the steps across their wraps, divided by the sum of their steps inside. `None` if
    /// a repeating axis has no ratio.
    pub both: Option<SeamRatio>,
    /// Difference between the visibility of the wrap and that of the most visible boundary inside, in standard
    /// deviations of the boundaries inside. The axis with the larger difference counts. 0 if the wrap is less visible.
    ///
    /// The visibility of a boundary is a mean over all lines. On each line, it is the step divided by a reference,
    /// which is the mean of the 8 steps on either side plus a tenth of the mean step of the line. Deviations are at
    /// least 5 % of the mean. `None` if an axis is too short.
    pub stands_out: Option<f64>,
}

/// The step across the wrap as a multiple of the mean step inside.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeamRatio {
    /// The ratio, at least 0. It is 1 if the wrap is like any other boundary, more for a seam, and less where the tile
    /// is soft. It is 1 for a flat tile.
    pub ratio: f64,
    /// Standard deviation of the ratio over the boundaries inside, each taken as the wrap. This is the deviation from 1
    /// to expect for a good tile. At least 0; `None` if there are fewer than two such boundaries.
    pub spread: Option<f64>,
}

/// Measures the seams of a tile at all widths.
pub(super) fn seams(tile: &Raster<f32>, options: &SeamOptions) -> Result<[Seam; 4], TileError> {
    let [along_x, along_y] = options.axes;
    let steps =
        |lines: &Raster<f32>, axis: usize| axis_steps(lines, options.lattice[axis] as usize);
    let turned = along_y.then(|| transpose(tile)).transpose()?;
    let x = along_x.then(|| steps(tile, 0));
    let y = turned.as_ref().map(|turned| steps(turned, 1));
    let lines = [along_x.then_some(tile), turned.as_ref()];
    Ok(core::array::from_fn(|index| {
        let at = |steps: &Option<[Option<Steps>; 4]>| steps.as_ref().and_then(|all| all[index]);
        let (x_steps, y_steps) = (at(&x), at(&y));
        // Combine both axes, or take the one that repeats.
        let both = match options.axes {
            [true, true] => x_steps.zip(y_steps).map(|(x, y)| x.plus(y)),
            [true, false] => x_steps,
            _ => y_steps,
        };
        Seam {
            width: WIDTHS[index],
            x: x_steps.map(Steps::ratio),
            y: y_steps.map(Steps::ratio),
            both: both.map(Steps::ratio),
            stands_out: stands_out(lines, WIDTHS[index], options),
        }
    }))
}

/// Returns the wrap's excess visibility (see [`Seam::stands_out`]), for the axis where it is largest. Returns `None` if
/// an axis is too short.
fn stands_out(lines: [Option<&Raster<f32>>; 2], width: u32, options: &SeamOptions) -> Option<f64> {
    let mut most: f64 = 0.0;
    for (lines, lattice) in lines.into_iter().zip(options.lattice) {
        if let Some(lines) = lines {
            most = most.max(visible::stands_out(
                lines,
                width as usize,
                lattice as usize,
            )?);
        }
    }
    Some(most)
}

/// Steps along one axis for one width, each a mean over all lines.
#[derive(Clone, Copy)]
struct Steps {
    /// Step across the wrap.
    wrap: f64,
    /// Mean step of the boundaries inside.
    inside: f64,
    /// Variance of the steps inside; `None` for a single boundary.
    variance: Option<f64>,
}

impl Steps {
    /// Computes the mean and the variance of the steps inside.
    fn new(wrap: f64, inside: &[f64]) -> Self {
        let mean = inside.iter().sum::<f64>() / inside.len() as f64;
        let squares: f64 = inside
            .iter()
            .map(|step| (step - mean) * (step - mean))
            .sum();
        Self {
            wrap,
            inside: mean,
            variance: (inside.len() > 1).then(|| squares / (inside.len() - 1) as f64),
        }
    }

    /// Adds the steps of two axes, which are treated as independent.
    fn plus(self, other: Self) -> Self {
        let variances = self.variance.zip(other.variance);
        Self {
            wrap: self.wrap + other.wrap,
            inside: self.inside + other.inside,
            variance: variances.map(|(a, b)| a + b),
        }
    }

    fn ratio(self) -> SeamRatio {
        let relative = |deviation: f64| {
            if deviation == 0.0 {
                0.0
            } else {
                quotient(deviation, self.inside)
            }
        };
        SeamRatio {
            ratio: quotient(self.wrap, self.inside),
            spread: self.variance.map(|variance| relative(variance.sqrt())),
        }
    }
}

/// Measures the steps along rows, at all widths.
fn axis_steps(tile: &Raster<f32>, lattice: usize) -> [Option<Steps>; 4] {
    let n = tile.width() as usize;
    let boundaries = WIDTHS.map(|width| boundaries(n, width as usize, lattice));
    let mut steps = boundaries.each_ref().map(|of| vec![0.0; of.len()]);
    // Sum the steps of all lines. The sums of pixels are doubled from width to width.
    let mut sums = vec![0.0; n];
    for line in tile.view().rows() {
        sums.clear();
        sums.extend(line.iter().map(|&value| f64::from(value)));
        for (index, &width) in WIDTHS.iter().enumerate() {
            let width = width as usize;
            if boundaries[index].is_empty() {
                break;
            }
            if width > 1 {
                double(&mut sums, width / 2);
            }
            for (step, &[before, after]) in steps[index].iter_mut().zip(&boundaries[index]) {
                *step += (sums[after] - sums[before]).abs();
            }
        }
    }
    // Divide by the number of lines and pixels.
    let n_lines = f64::from(tile.height());
    core::array::from_fn(|index| {
        let count = n_lines * f64::from(WIDTHS[index]);
        let means: Vec<f64> = steps[index].iter().map(|sum| sum / count).collect();
        let (&wrap, inside) = means.split_first()?;
        (!inside.is_empty()).then(|| Steps::new(wrap, inside))
    })
}

/// Returns the first pixels of the two averaged ranges at the wrap, and then at every boundary of the lattice with
/// enough pixels for both. Empty if there is no boundary inside.
pub(super) fn boundaries(n: usize, width: usize, lattice: usize) -> Vec<[usize; 2]> {
    let last = n.saturating_sub(width);
    let inside = (lattice..=last).step_by(lattice);
    let inside = inside.filter(|&at| at >= width).map(|at| [at - width, at]);
    // The first pair is the wrap: the last `width` pixels and the first ones.
    let mut all = vec![[last, 0]];
    all.extend(inside);
    if all.len() > 1 { all } else { Vec::new() }
}

/// Replaces the sums of `half` pixels, which start at each pixel, by sums of twice as many pixels.
///
/// The order of additions is symmetric: sums of the same pixels in reverse order have the same bits. So the seam of a
/// mirror image is exactly 0.
fn double(sums: &mut Vec<f64>, half: usize) {
    let n = sums.len().saturating_sub(half);
    for at in 0..n {
        // Two adjacent sums of half the width are a sum of the whole width.
        sums[at] += sums[at + half];
    }
    sums.truncate(n);
}

#[cfg(test)]
mod tests;
