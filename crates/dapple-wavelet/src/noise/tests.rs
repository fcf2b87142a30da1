//! Shared code of the noise tests: an oracle, and random positions.

mod bits;
mod statistics;
mod values;

use super::WaveletNoise;
use dapple_hash::{Seed, hash1, unit_f64};

/// Returns random positions in a box with the given half width around the origin.
fn scattered<const N: usize>(count: i64, half_width: f64) -> impl Iterator<Item = [f64; N]> {
    (0..count).map(move |index| {
        core::array::from_fn(|axis| {
            let bits = hash1(Seed(11), [index], axis as u32);
            (2.0 * unit_f64(bits) - 1.0) * half_width
        })
    })
}

/// Returns random positions in a box with the given half width around the origin. In each, one coordinate or none is
/// an integer.
fn positions<const N: usize>(count: i64, half_width: f64) -> impl Iterator<Item = [f64; N]> {
    scattered::<N>(count, half_width)
        .enumerate()
        .map(|(index, mut position)| {
            let axis = index % 4;
            if axis < N {
                position[axis] = position[axis].floor();
            }
            position
        })
}

/// Returns the noise by its definition: the sum over the bands of all coefficients times their B-splines.
fn oracle<const N: usize>(noise: &WaveletNoise<N>, position: [f64; N]) -> f64 {
    let bands = noise.bands.iter().map(|band| {
        let axes = 0..N;
        let place = axes.map(|axis| position[axis] * band.frequency + band.offset[axis]);
        f64::from(band.weight) * spline(noise, &place.collect::<Vec<_>>(), [0; N], N)
    });
    bands.sum()
}

/// Returns the sum of coefficients times B-spline weights at `position`, summed over the cells along the first `axes`
/// axes. `cell` gives the cell along the remaining axes.
fn spline<const N: usize>(
    noise: &WaveletNoise<N>,
    position: &[f64],
    cell: [usize; N],
    axes: usize,
) -> f64 {
    let Some(axis) = axes.checked_sub(1) else {
        return f64::from(noise.tile.coefficient(cell));
    };
    let first = position[axis].floor() - 3.0;
    let terms = (0..7).map(|step| {
        let at = first + f64::from(step);
        let mut cell = cell;
        cell[axis] = at.rem_euclid(f64::from(noise.size()[axis])) as usize;
        let weight = b_spline(position[axis] - (at + 0.5));
        weight * spline(noise, position, cell, axis)
    });
    terms.sum()
}

/// Returns the value at `x` of the quadratic B-spline centered on 0.
fn b_spline(x: f64) -> f64 {
    match x.abs() {
        x if x <= 0.5 => 0.75 - x * x,
        x if x <= 1.5 => 0.5 * (1.5 - x) * (1.5 - x),
        _ => 0.0,
    }
}
