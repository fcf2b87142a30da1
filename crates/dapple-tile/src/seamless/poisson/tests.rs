//! Tests of Poisson images against dense least squares.

use super::*;
use crate::fourier::BAND;
use crate::seamless::periodic::Smooth;
use crate::{Method, Seamless};
use proptest::prelude::*;

/// Returns unstructured values of about 1, over a ramp.
fn image(size: [u32; 2], seed: u32) -> Raster<f32> {
    Raster::from_fn(size, |column, row| {
        let mixed = (column * 89 + row * 57 + seed * 7 + 3) * (column + 2 * row + 5);
        (mixed % 64) as f32 / 64.0 + 0.25 * column as f32 - 0.5 * row as f32
    })
    .expect("the size is small and not empty")
}

fn tile_of(plane: &Raster<f32>, wrap: WrapGradient, axes: [bool; 2]) -> Raster<f32> {
    let seamless = Seamless::new(Method::Poisson(wrap)).with_axes(axes);
    seamless.apply(plane).expect("all is finite")
}

/// Solves the least-squares problem by the definition, with the whole field of differences, its divergence, and a dense
/// solver.
fn by_divergence(plane: &Raster<f32>, wrap: WrapGradient, axes: [bool; 2]) -> Vec<f64> {
    let n = plane.pixels().len();
    let mut matrix = vec![vec![0.0; n + 1]; n];
    for (from, to, wanted) in field(plane, wrap, axes) {
        // Half of the derivative of (p[to] − p[from] − wanted)².
        for (row, column, sign) in [
            (to, to, 1.0),
            (from, from, 1.0),
            (to, from, -1.0),
            (from, to, -1.0),
        ] {
            matrix[row][column] += sign;
        }
        matrix[to][n] += wanted;
        matrix[from][n] -= wanted;
    }
    // Only differences are determined, so one equation is redundant. It is replaced by the sum of the pixels.
    matrix[0] = vec![1.0; n + 1];
    matrix[0][n] = plane.pixels().iter().map(|&value| f64::from(value)).sum();
    solve(matrix)
}

/// Returns all pairs of neighbors, and the target difference between them.
fn field(plane: &Raster<f32>, wrap: WrapGradient, axes: [bool; 2]) -> Vec<(usize, usize, f64)> {
    let [width, height] = plane.size().map(|length| length as usize);
    let value = |at: usize| f64::from(plane.pixels()[at]);
    let mut field = Vec::new();
    for at in 0..width * height {
        for (place, length, step, repeats) in [
            (at % width, width, 1, axes[0]),
            (at / width, height, width, axes[1]),
        ] {
            if place + 1 < length {
                field.push((at, at + step, value(at + step) - value(at)));
            } else if repeats && length > 1 {
                let first = at - place * step;
                let inside = value(first + step) - value(first) + value(at) - value(at - step);
                let wanted = match wrap {
                    WrapGradient::Zero => 0.0,
                    WrapGradient::Extrapolate => 0.5 * inside,
                };
                field.push((at, first, wanted));
            }
        }
    }
    field
}

/// Solves a linear system by Gaussian elimination with pivoting. The last column is the right-hand side.
fn solve(mut matrix: Vec<Vec<f64>>) -> Vec<f64> {
    let n = matrix.len();
    for column in 0..n {
        let size = |row: &usize| matrix[*row][column].abs();
        let pivot = (column..n).max_by(|a, b| size(a).total_cmp(&size(b)));
        matrix.swap(column, pivot.expect("there is a row left"));
        let pivot = matrix[column].clone();
        for row in (0..n).filter(|&row| row != column) {
            let factor = matrix[row][column] / pivot[column];
            for at in column..=n {
                matrix[row][at] -= factor * pivot[at];
            }
        }
    }
    (0..n).map(|at| matrix[at][n] / matrix[at][at]).collect()
}

#[test]
fn poisson_equals_the_solution_by_divergence() {
    for size in [[1, 1], [1, 4], [5, 1], [2, 2], [2, 5], [9, 8], [18, 3]] {
        for axes in [[true, true], [true, false], [false, true], [false, false]] {
            for wrap in [WrapGradient::Zero, WrapGradient::Extrapolate] {
                let plane = image(size, 1);
                let errors = |axis: usize| axes[axis].then(|| wrap_errors(&plane, wrap, axis));
                let sides = size.map(|n| n as usize);
                let smooth = Smooth::new(sides, &[errors(0), errors(1)], &|| false).unwrap();
                let bands = 0..size[1].div_ceil(BAND as u32) as usize;
                let smooth = bands.flat_map(|band| smooth.rows(band));
                let wanted = by_divergence(&plane, wrap, axes);
                for ((value, smooth), wanted) in plane.pixels().iter().zip(smooth).zip(wanted) {
                    let error = (f64::from(*value) - smooth - wanted).abs();
                    // The elimination rounds some hundred times at values below 8.
                    assert!(error < 1e-12, "{size:?}, {axes:?}, {wrap:?}: {error}");
                }
            }
        }
    }
}

#[test]
fn extrapolated_ramp_becomes_flat() {
    let ramp = Raster::from_fn([20, 12], |column, row| (column + 3 * row) as f32);
    let tile = tile_of(
        &ramp.expect("the size is good"),
        WrapGradient::Extrapolate,
        [true; 2],
    );
    for value in tile.pixels() {
        // The mean of the ramp remains: the slope continues across the wrap, so the whole ramp is removed as error.
        assert!((value - 26.0).abs() < 1e-5, "{value} is not the mean");
    }
}

proptest! {
    #[test]
    fn poisson_with_zero_equals_periodic_bit_for_bit(
        width in 2_u32..40, height in 2_u32..40, axes: [bool; 2], seed in 0_u32..100,
    ) {
        let plane = image([width, height], seed);
        let periodic = Seamless::new(Method::Periodic).with_axes(axes);
        let periodic = periodic.apply(&plane).expect("all is finite");
        prop_assert_eq!(tile_of(&plane, WrapGradient::Zero, axes), periodic);
    }
}

#[test]
fn value_stability_poisson() {
    let plane = image([15, 22], 2);
    let tile = tile_of(&plane, WrapGradient::Extrapolate, [true; 2]);
    let bits = [tile.row(0)[0], tile.row(8)[11], tile.row(21)[14]].map(f32::to_bits);
    let pinned = [3_224_944_656, 3_227_456_064, 3_224_825_557];
    assert_eq!(bits, pinned, "the bits have not changed");
}
