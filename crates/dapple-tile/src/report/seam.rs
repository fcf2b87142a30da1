//! The step across the wrap, compared with the steps inside of the tile.
//!
//! Reference: our own.

use super::{SeamOptions, quotient, visible};
use crate::TileError;
use crate::axis::transpose;
use dapple_raster::Raster;

/// The widths of the means on either side of a boundary, in pixels.
const WIDTHS: [u32; 4] = [1, 2, 4, 8];

/// The ratio of the step across the wrap and the steps inside of the tile, at one scale.
///
/// The step across a boundary is the difference of the means of the `width` pixels before it and the `width` pixels after
/// it, along one line; its absolute value is averaged over all lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Seam {
    /// The number of pixels in a mean.
    pub width: u32,
    /// The seam from the last column to the first.
    ///
    /// `None` if the tile does not repeat along this axis, or if no boundary of the lattice inside of the tile has
    /// `width` pixels on either side.
    pub x: Option<SeamRatio>,
    /// The seam from the last row to the first; `None` as for x.
    pub y: Option<SeamRatio>,
    /// Both axes together: the sum of the steps across their wraps divided by the sum of their steps inside. `None` if
    /// a repeating axis has none.
    pub both: Option<SeamRatio>,
    /// How much more visible the wrap is than the most visible boundary inside, in standard deviations of the
    /// boundaries inside, along the axis where this is larger; 0 if it is less visible.
    ///
    /// The visibility of a boundary is the mean over lines of its step divided by the mean of the 8 steps on either
    /// side on that line and a tenth of the mean step of the line. Deviations are at least 5 % of the mean. `None` if
    /// there is no room on an axis.
    pub stands_out: Option<f64>,
}

/// A step across the wrap as a multiple of the mean step inside.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeamRatio {
    /// 1 for a wrap like any other boundary, more for a seam, less where the tile has gone soft; 1 for a flat tile. At
    /// least 0.
    pub ratio: f64,
    /// The standard deviation of the same ratio for the boundaries inside, as if each was the wrap: how far from 1 the
    /// ratio of a good tile may be. At least 0; `None` if there are fewer than two such boundaries.
    pub spread: Option<f64>,
}

/// The seams of a tile at all widths.
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

/// How much the wrap stands out, along the axis where it does so most; `None` if one of them has no room.
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

/// The steps of one axis at one width, each a mean over all lines.
#[derive(Clone, Copy)]
struct Steps {
    wrap: f64,
    /// The mean step of the boundaries inside.
    inside: f64,
    /// The variance of the steps inside.
    variance: Option<f64>,
}

impl Steps {
    /// The steps of the wrap and of the boundaries inside.
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

    /// The sums of the steps of two axes, which count as independent.
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

/// The steps along rows, at all widths.
fn axis_steps(tile: &Raster<f32>, lattice: usize) -> [Option<Steps>; 4] {
    let n = tile.width() as usize;
    let boundaries = WIDTHS.map(|width| boundaries(n, width as usize, lattice));
    let mut steps = boundaries.each_ref().map(|of| vec![0.0; of.len()]);
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
    let n_lines = f64::from(tile.height());
    core::array::from_fn(|index| {
        let count = n_lines * f64::from(WIDTHS[index]);
        let means: Vec<f64> = steps[index].iter().map(|sum| sum / count).collect();
        let (&wrap, inside) = means.split_first()?;
        (!inside.is_empty()).then(|| Steps::new(wrap, inside))
    })
}

/// The first pixels of the two means at the wrap, and then at every boundary of the lattice with room for both. Empty
/// if there is no boundary inside.
pub(super) fn boundaries(n: usize, width: usize, lattice: usize) -> Vec<[usize; 2]> {
    let last = n.saturating_sub(width);
    let inside = (lattice..=last).step_by(lattice);
    let inside = inside.filter(|&at| at >= width).map(|at| [at - width, at]);
    let mut all = vec![[last, 0]];
    all.extend(inside);
    if all.len() > 1 { all } else { Vec::new() }
}

/// Replaces the sums of `half` pixels from each pixel on by those of twice as many.
///
/// In this order the sums of the same pixels, backward, are the same to the last bit, and the seam of a mirror image is
/// exactly 0.
fn double(sums: &mut Vec<f64>, half: usize) {
    let n = sums.len().saturating_sub(half);
    for at in 0..n {
        sums[at] += sums[at + half];
    }
    sums.truncate(n);
}

#[cfg(test)]
mod tests;
