//! Measures the visibility of the step across the wrap, compared with the boundaries inside.
//!
//! A step is masked by changes around it, and visible on even ground (contrast masking). So each step is divided by the
//! mean of the steps next to it on its line before lines are averaged. This distinguishes a cut through a brick from
//! the joints between bricks, which a mean of the undivided steps does not.
//!
//! Reference: our own.

use super::quotient;
use super::seam::boundaries;
use core::ops::Range;
use dapple_raster::Raster;

/// Number of steps on either side that can mask a step.
const AROUND: usize = 8;

/// Fraction of a line's mean step that is added to the mean of the surrounding steps, to avoid a division by zero.
const FLOOR: f64 = 0.1;

/// Minimum standard deviation of the boundaries inside, as a fraction of their mean; smaller differences are invisible.
const LEAST_DEVIATION: f64 = 0.05;

/// Computes [`Seam::stands_out`](super::Seam::stands_out) along the rows of a tile, for means of `width` pixels.
pub(super) fn stands_out(tile: &Raster<f32>, width: usize, lattice: usize) -> Option<f64> {
    let n = tile.width() as usize;
    let around = AROUND.min((n / 2).saturating_sub(width));
    let at: Vec<usize> = boundaries(n, width, lattice)
        .into_iter()
        .map(|[_, after]| after)
        .collect();
    // The wrap and at least two boundaries inside are needed.
    if around == 0 || at.len() < 3 {
        return None;
    }
    // Add up the masked steps of all lines.
    let mut shown = vec![0.0; at.len()];
    for line in tile.view().rows() {
        let steps = steps(line, width);
        let floor = FLOOR * steps.iter().sum::<f64>() / n as f64;
        let beside = sums_beside(&steps, width..width + around);
        // Divide the step at each boundary by the mean of the steps around it.
        for (shown, &at) in shown.iter_mut().zip(&at) {
            let beside = beside[at] / (2 * around) as f64 + floor;
            if beside > 0.0 {
                *shown += steps[at] / beside;
            }
        }
    }
    let (&wrap, inside) = shown.split_first()?;
    Some(above(wrap, inside))
}

/// Returns the difference between `wrap` and the largest number of `inside`, in standard deviations of `inside`; at
/// least 0.
fn above(wrap: f64, inside: &[f64]) -> f64 {
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    let squares = inside.iter().map(|shown| (shown - mean) * (shown - mean));
    let variance = squares.sum::<f64>() / (inside.len() - 1) as f64;
    let most = inside.iter().copied().fold(0.0, f64::max);
    match wrap > most {
        true => quotient(wrap - most, variance.sqrt().max(LEAST_DEVIATION * mean)),
        false => 0.0,
    }
}

/// Computes the steps between the means of `width` pixels before and after the left border of each pixel, on a circular
/// line.
fn steps(line: &[f32], width: usize) -> Vec<f64> {
    let n = line.len();
    let values: Vec<f64> = once_more(line, width).map(f64::from).collect();
    // Sum `width` values, starting at each pixel.
    let mut sums = vec![0.0; n];
    for off in 0..width {
        for (sum, value) in sums.iter_mut().zip(&values[off..]) {
            *sum += value;
        }
    }
    // Compare each sum with the sum that ends where it begins.
    let before = sums[n - width..].iter().chain(&sums);
    let pairs = sums.iter().zip(before);
    pairs
        .map(|(after, before)| f64::abs(after - before))
        .collect()
}

/// Computes, for each step, the sum of the steps at the given distances before and after it, on a circular line.
fn sums_beside(steps: &[f64], distances: Range<usize>) -> Vec<f64> {
    let (n, reach) = (steps.len(), distances.end);
    // Extend the circular line by the reach on both sides.
    let before = &steps[n - reach..];
    let around: Vec<f64> = before
        .iter()
        .copied()
        .chain(once_more(steps, reach))
        .collect();
    let mut sums = vec![0.0; n];
    for off in distances {
        let pairs = around[reach + off..].iter().zip(&around[reach - off..]);
        for (sum, (after, before)) in sums.iter_mut().zip(pairs) {
            *sum += after + before;
        }
    }
    sums
}

/// Iterates over all values, and then over the first `more` values again.
fn once_more<T: Copy>(values: &[T], more: usize) -> impl Iterator<Item = T> {
    values.iter().chain(&values[..more]).copied()
}

#[cfg(test)]
mod tests {
    use super::{stands_out, steps, sums_beside};
    use dapple_hash::{Seed, hash2, unit_f32};
    use dapple_raster::Raster;

    fn noise(x: u32, y: u32) -> f32 {
        unit_f32(hash2(Seed(3), [x.into(), y.into()], 0) as u32)
    }

    /// Returns evenly spaced bricks of 32 × 32 pixels with bright joints, whose sides rise over 4 pixels.
    fn bricks(x: u32, y: u32) -> f32 {
        let [x, y] = [x, y].map(|at| (at % 32).min(32 - at % 32));
        0.2 + 0.15 * (4.0 - x.min(y) as f32).max(0.0)
    }

    #[test]
    fn steps_and_their_sums_go_once_around() {
        let line: Vec<f32> = (0..13).map(|x| noise(x, 0)).collect();
        let sum = |first: usize, width| {
            let values = (first..first + width).map(|at| f64::from(line[at % 13]));
            values.sum::<f64>()
        };
        for width in 1..=4 {
            let steps = steps(&line, width);
            let sums = sums_beside(&steps, width..width + 2);
            for at in 0..13 {
                assert_eq!(
                    steps[at],
                    (sum(at, width) - sum(at + 13 - width, width)).abs()
                );
                let beside = (width..width + 2)
                    .map(|off| steps[(at + off) % 13] + steps[(at + 13 - off) % 13]);
                assert_eq!(sums[at], beside.sum::<f64>());
            }
        }
    }

    #[test]
    fn a_joint_at_the_wrap_is_like_the_joints_inside() {
        let tile = Raster::from_fn([128; 2], bricks).unwrap();
        assert_eq!(stands_out(&tile, 1, 1), Some(0.0));
        assert_eq!(stands_out(&tile, 4, 1), Some(0.0));
    }

    #[test]
    fn a_step_on_even_ground_stands_out_among_stronger_steps() {
        // The wrap is in the middle of bricks, which become lighter. Its step is smaller than the steps of the joints.
        let lit = |x: u32, y| bricks(x + 16, y) + 0.001 * x as f32;
        let lit = Raster::from_fn([96, 128], lit).unwrap();
        let shown = stands_out(&lit, 1, 1).unwrap();
        assert!(shown > 2.5, "{shown}");
    }

    #[test]
    fn flat_and_mirrored_borders_do_not_stand_out() {
        let framed = Raster::from_fn([64; 2], |x, y| match x.min(y).min(63 - x).min(63 - y) {
            0..4 => 1.0,
            _ => noise(x, y),
        });
        assert_eq!(stands_out(&framed.unwrap(), 1, 1), Some(0.0));
        let even = Raster::filled([64; 2], 0.5).unwrap();
        assert_eq!(stands_out(&even, 1, 1), Some(0.0));
    }

    #[test]
    fn too_few_boundaries_are_not_judged() {
        let small = Raster::filled([9, 9], 0.5).unwrap();
        assert_eq!(stands_out(&small, 4, 1), None);
        assert_eq!(
            stands_out(&Raster::filled([64, 9], 0.5).unwrap(), 1, 32),
            None
        );
    }
}
