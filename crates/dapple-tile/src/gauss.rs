//! Gaussian blur, applied row by row and column by column.
//!
//! The weights are `exp(-k² / 2σ²)` up to 3.5 standard deviations, normalized to a sum of 1. Less than 0.05 % of the
//! Gaussian is beyond. Each pixel is summed in `f32` from the center outward, in the same order at every position. So
//! the blur of a raster that is shifted around the torus is the shifted blur, bit for bit.

use crate::TileError;
use dapple_raster::{Raster, Wrap, parallel};

/// Radius of the blur, in standard deviations.
const REACH: f64 = 3.5;

/// Number of columns that are summed at a time. Their sums (4 kB) fit into the first-level cache.
const BLOCK: usize = 1024;

/// Blurs a raster by a Gaussian with a standard deviation of `sigma` pixels, from 0 to 65536.
///
/// `wrap` is the wrapping beyond the edges, along x and y.
///
/// # Errors
///
/// [`TileErrorKind::Range`](crate::TileErrorKind::Range) if `sigma` is out of its range.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Raster, Wrap};
///
/// let point = Raster::from_fn([9, 9], |x, y| f32::from(x == 4 && y == 4))?;
/// let spot = dapple_tile::blur(&point, 1.0, [Wrap::Repeat; 2])?;
/// assert!((spot.row(4)[4] - 0.159).abs() < 0.001); // 1 / 2π
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn blur(raster: &Raster<f32>, sigma: f64, wrap: [Wrap; 2]) -> Result<Raster<f32>, TileError> {
    let holds = (0.0..=65536.0).contains(&sigma);
    TileError::check(holds, "sigma of a blur", sigma, "from 0 to 65536")?;
    let weights = weights(sigma);
    // Blur the rows.
    let along_rows = rows(raster.size(), |row, blurred| {
        blur_row(raster.row(row), &weights, wrap[0], blurred);
    })?;
    // Blur the columns, by sums of whole rows.
    let height = raster.height();
    rows(raster.size(), |row, blurred| {
        let at = |step: i64| along_rows.row(wrap[1].index(i64::from(row) + step, height));
        sum_up(at, &weights, blurred);
    })
}

/// Builds a raster whose rows are written by `fill`. With the feature `rayon`, rows are written in parallel.
fn rows(size: [u32; 2], fill: impl Fn(u32, &mut [f32]) + Sync) -> Result<Raster<f32>, TileError> {
    let mut raster = Raster::filled(size, 0.0)?;
    let width = size[0] as usize;
    parallel::for_each_chunk(raster.pixels_mut(), width, |row, pixels| {
        fill(row as u32, pixels);
    });
    Ok(raster)
}

/// Returns the weight of the center, followed by the weight of each distance from it.
fn weights(sigma: f64) -> Vec<f32> {
    let reach = libm::ceil(REACH * sigma) as u32;
    // Compute the right half of the Gaussian, including its center.
    let bell: Vec<f64> = (0..=reach)
        .map(|k| f64::from(k) / sigma.max(f64::MIN_POSITIVE))
        .map(|distance| libm::exp(-0.5 * distance * distance))
        .collect();
    // Divide by the sum of both halves, which share the center.
    let sum = 2.0 * bell.iter().sum::<f64>() - bell[0];
    bell.iter().map(|weight| (weight / sum) as f32).collect()
}

fn blur_row(row: &[f32], weights: &[f32], wrap: Wrap, blurred: &mut [f32]) {
    let reach = weights.len() - 1;
    let width = row.len() as u32;
    let past = |at: i64| row[wrap.index(at, width) as usize];
    // Extend the row on both sides by the radius, as the wrap mode determines.
    let mut padded = Vec::with_capacity(row.len() + 2 * reach);
    padded.extend((1..=reach as i64).rev().map(|step| past(-step)));
    padded.extend_from_slice(row);
    padded.extend((0..reach as i64).map(|step| past(i64::from(width) + step)));
    let at = |step: i64| &padded[(reach as i64 + step) as usize..];
    sum_up(at, weights, blurred);
}

/// Writes the weighted sum of lines to `sums`. `at` returns the line at a given distance from the center.
fn sum_up<'a>(at: impl Fn(i64) -> &'a [f32], weights: &[f32], sums: &mut [f32]) {
    for (block, sums) in sums.chunks_mut(BLOCK).enumerate() {
        let range = block * BLOCK..block * BLOCK + sums.len();
        let at = |step: i64| &at(step)[range.clone()];
        // Start with the center.
        for (sum, value) in sums.iter_mut().zip(at(0)) {
            *sum = value * weights[0];
        }
        let mut k = 1;
        // Add the pixels on both sides, four distances at a time.
        let mut fours = weights[1..].chunks_exact(4);
        for four in &mut fours {
            let pairs = [0, 1, 2, 3].map(|j| [at(-k - j), at(k + j)]);
            add_four(sums, pairs, [four[0], four[1], four[2], four[3]]);
            k += 4;
        }
        for &weight in fours.remainder() {
            add_pair(sums, [at(-k), at(k)], weight);
            k += 1;
        }
    }
}

/// Adds four pairs like four calls of [`add_pair`], with a quarter of the memory traffic for the sums.
fn add_four(sums: &mut [f32], pairs: [[&[f32]; 2]; 4], weights: [f32; 4]) {
    let n = sums.len();
    let [[a0, b0], [a1, b1], [a2, b2], [a3, b3]] = pairs.map(|pair| pair.map(|row| &row[..n]));
    let [w0, w1, w2, w3] = weights;
    for i in 0..n {
        let sum = sums[i] + w0 * (a0[i] + b0[i]);
        let sum = sum + w1 * (a1[i] + b1[i]);
        let sum = sum + w2 * (a2[i] + b2[i]);
        sums[i] = sum + w3 * (a3[i] + b3[i]);
    }
}

/// Adds `weight · (a + b)` to each sum.
fn add_pair(sums: &mut [f32], [a, b]: [&[f32]; 2], weight: f32) {
    for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
        *sum += weight * (a + b);
    }
}

#[cfg(test)]
mod tests {
    use super::{blur, weights};
    use dapple_hash::{Seed, hash2, unit_f32};
    use dapple_raster::{Raster, Wrap};

    const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

    fn noise(size: [u32; 2]) -> Raster<f32> {
        Raster::from_fn(size, |column, row| {
            let bits = hash2(Seed(1), [column.into(), row.into()], 0);
            unit_f32((bits >> 32) as u32) - 0.5
        })
        .unwrap()
    }

    #[test]
    fn blur_equals_a_naive_sum_over_the_plane() {
        for (size, sigma) in [
            ([9, 7], 0.7),
            ([5, 1], 2.0),
            ([2, 3], 4.0),
            ([1500, 2], 1.5),
        ] {
            let raster = noise(size);
            for wrap in [
                [WRAPS[0], WRAPS[1]],
                [WRAPS[1], WRAPS[2]],
                [WRAPS[2], WRAPS[0]],
            ] {
                let blurred = blur(&raster, sigma, wrap).unwrap();
                let reach = (3.5 * sigma).ceil() as i64;
                let bell = |k: i64| libm::exp(-((k * k) as f64) / (2.0 * sigma * sigma));
                for at in [[0, 0], [i64::from(size[0]) - 1, i64::from(size[1]) / 2]] {
                    let [mut sum, mut total] = [0.0; 2];
                    for y in -reach..=reach {
                        for x in -reach..=reach {
                            let weight = bell(x) * bell(y);
                            total += weight;
                            sum += weight * f64::from(*raster.at(at[0] + x, at[1] + y, wrap));
                        }
                    }
                    let got = f64::from(*blurred.at(at[0], at[1], wrap));
                    // Allows for several dozen roundings of `f32` sums of numbers below ½.
                    assert!((got - sum / total).abs() < 1e-6, "{size:?} {wrap:?} {at:?}");
                }
            }
        }
    }

    #[test]
    fn blur_commutes_with_shifts_around_the_torus_bit_for_bit() {
        let wrap = [Wrap::Repeat; 2];
        let raster = noise([13, 11]);
        let shift = |raster: &Raster<f32>| {
            Raster::from_fn([13, 11], |x, y| {
                *raster.at(i64::from(x) + 4, i64::from(y) - 3, wrap)
            })
            .unwrap()
        };
        let of_shifted = blur(&shift(&raster), 2.2, wrap).unwrap();
        assert_eq!(of_shifted, shift(&blur(&raster, 2.2, wrap).unwrap()));
    }

    #[test]
    fn weights_sum_to_one_and_none_is_left_of_a_bell_without_width() {
        for sigma in [0.0, 0.01, 0.5, 3.0, 40.0] {
            let weights = weights(sigma);
            let sum: f64 = weights.iter().map(|&weight| 2.0 * f64::from(weight)).sum();
            // The relative rounding error of each weight is at most 2^-25.
            assert!((sum - f64::from(weights[0]) - 1.0).abs() < 1e-7, "{sigma}");
        }
        assert_eq!(weights(0.0), [1.0]);
    }
}
