//! Tests of mean, variance and spectrum.

use super::super::LineSums;
use super::scattered;
use crate::{Border, SplineFilter, WaveletNoise2, WaveletNoise3};
use dapple_hash::Seed;
use dapple_raster::Raster;
use glam::{DVec2, DVec3};

#[test]
fn coefficients_have_the_variance_of_theory_and_no_mean() {
    let plane = coefficients(&WaveletNoise2::new(512, Seed(1)).unwrap());
    // For white noise of variance 1: variance of the coefficients over variance of the values
    check_moments(plane.pixels(), 0.7528213402 / 0.1349676017);
    let space = WaveletNoise3::new(64, Seed(1)).unwrap();
    let cells = (0..64 * 64 * 64).map(|at| [at % 64, at / 64 % 64, at / 4096]);
    let space: Vec<f32> = cells.map(|cell| space.tile.coefficient(cell)).collect();
    check_moments(&space, 0.8771219640 / 0.0978027802);
}

fn check_moments(values: &[f32], expected: f64) {
    let n = values.len() as f64;
    let mean = values.iter().map(|&value| f64::from(value)).sum::<f64>() / n;
    let squares = values.iter().map(|&value| square(value));
    let variance = squares.sum::<f64>() / n;
    // Projection preserves the mean, so the noise has a mean of zero up to rounding to `f32`.
    assert!(mean.abs() < 1e-6, "{mean}");
    // The mean of a quarter of a million nearly independent squares is accurate to 0.3 %.
    assert!(
        (variance / expected - 1.0).abs() < 0.01,
        "{variance} {expected}"
    );
}

fn square(value: f32) -> f64 {
    f64::from(value) * f64::from(value)
}

#[test]
fn values_have_a_variance_of_one_for_large_and_tiny_tiles() {
    let mean_square = |size, seeds: u64, count| {
        let mut sum = [0.0; 2];
        for seed in 0..seeds {
            let [x, y, _] = size;
            let plane = WaveletNoise2::of_size([x, y], Seed(seed)).unwrap();
            let space = WaveletNoise3::of_size(size, Seed(seed)).unwrap();
            for position in scattered::<3>(count, 1000.0) {
                // Different fractions for every seed
                let shift = seed as f64 * DVec3::new(0.618, 0.414, 0.732);
                let position = DVec3::from(position) + shift;
                sum[0] += square(plane.sample(position.truncate()));
                sum[1] += square(space.sample(position));
            }
        }
        sum.map(|sum| sum / (seeds as f64 * count as f64))
    };
    for (size, seeds, count) in [
        ([64; 3], 2, 20_000),
        ([4; 3], 2000, 20),
        ([6; 3], 2000, 20),
        ([4, 64, 6], 100, 400),
    ] {
        for mean_square in mean_square(size, seeds, count) {
            // About 20000 independent values whose squares have a variance of 2: 1 %, four standard deviations.
            assert!((mean_square - 1.0).abs() < 0.04, "{size:?}: {mean_square}");
        }
    }
}

#[test]
fn variance_depends_on_the_place_between_coefficients_as_documented() {
    const N: usize = 32;
    // Projection as a matrix, one column per impulse
    let column = |at: usize| {
        let impulse: Vec<f64> = (0..N).map(|i| f64::from(u8::from(i == at))).collect();
        let projected = SplineFilter::default().project_line(&impulse, 1, Border::Periodic);
        projected.unwrap()
    };
    let columns: Vec<Vec<f64>> = (0..N).map(column).collect();
    // Along an axis, a value is the sum of coefficients times weights `w`: w·w, w·Pw and the square of Pᵀw.
    let sums = |x: f64| {
        let weight = |i: usize| super::b_spline(x - (i as f64 + 0.5));
        let transposed = columns.iter().map(|column| {
            let terms = column
                .iter()
                .enumerate()
                .map(|(i, value)| weight(i) * value);
            terms.sum::<f64>()
        });
        let terms = transposed.enumerate().map(|(i, low)| {
            let weight = weight(i);
            [weight * weight, weight * low, low * low]
        });
        terms.fold([0.0; 3], |sum, term| [0, 1, 2].map(|i| sum[i] + term[i]))
    };
    let factor = LineSums::factor([LineSums::of_values(N).unwrap(); 2]);
    let variance =
        |[x, y]: [[f64; 3]; 2]| factor * factor * (x[0] * y[0] - 2.0 * x[1] * y[1] + x[2] * y[2]);
    // Over two cells along each axis, far from the wrap, in steps of 1/32
    let lines: Vec<[f64; 3]> = (0..64).map(|i| sums(16.0 + f64::from(i) / 32.0)).collect();
    let variances = lines.iter().map(|&y| lines.iter().map(move |&x| [x, y]));
    let variances: Vec<f64> = variances.flatten().map(variance).collect();
    let most = variances.iter().copied().fold(0.0, f64::max);
    let corners = [0, 32, 32 * 64, 32 * 65].map(|at| variances[at]);
    let least = corners.into_iter().fold(f64::MAX, f64::min);
    let lower = variances
        .iter()
        .filter(|&&value| value < least - 1e-9)
        .count();
    assert_eq!(lower, 0, "no place has less than {least}, of {corners:?}");
    // The documentation has two digits.
    assert!((least - 0.31).abs() < 0.005, "{corners:?}");
    assert!((most - 1.38).abs() < 0.005, "{most}");
    let mean = variances.iter().sum::<f64>() / variances.len() as f64;
    assert!((mean - 1.0).abs() < 1e-3, "{mean}");
}

#[test]
fn variances_of_bands_add_up() {
    let noise = WaveletNoise2::new(128, Seed(2))
        .unwrap()
        .with_weights(&[1.0, 0.5, 0.25])
        .unwrap();
    let positions = scattered::<2>(40_000, 1000.0);
    let squares = positions.map(|position| square(noise.sample(position)));
    let mean_square = squares.sum::<f64>() / 40_000.0;
    // Tolerance for independent bands, plus the correlation of neighboring bands
    assert!((mean_square / 1.3125 - 1.0).abs() < 0.05, "{mean_square}");
}

#[test]
fn halving_leaves_nothing() {
    for size in [4, 6, 34, 128] {
        let noise = WaveletNoise2::new(size, Seed(3)).unwrap();
        let coarse = SplineFilter::default().down(&coefficients(&noise), [Border::Periodic; 2]);
        let most = coarse
            .unwrap()
            .pixels()
            .iter()
            .fold(0.0, |most: f32, value| most.max(value.abs()));
        // Coefficients are below 16, and each was rounded three times.
        assert!(most < 1e-5, "{size}: {most}");
    }
}

fn coefficients(noise: &WaveletNoise2) -> Raster<f32> {
    Raster::from_fn(noise.size(), |column, row| {
        noise.tile.coefficient([column as usize, row as usize])
    })
    .unwrap()
}

#[test]
fn power_lies_between_a_quarter_and_half_a_cycle_per_cell() {
    const SIZE: usize = 32;
    const PER_CELL: usize = 4;
    const N: usize = SIZE * PER_CELL;
    let noise = WaveletNoise2::new(SIZE as u32, Seed(4)).unwrap();
    let value = |at: usize| {
        let position = DVec2::new((at % N) as f64, (at / N) as f64) / PER_CELL as f64;
        f64::from(noise.sample(position))
    };
    let power = power_spectrum::<N>(&(0..N * N).map(value).collect::<Vec<_>>());
    let total: f64 = power.iter().sum();
    let share = |from: f64, to: f64| {
        let frequency = |at: usize| at.min(N - at) as f64 / SIZE as f64;
        let is_inside = |at: usize| (from..to).contains(&frequency(at % N).max(frequency(at / N)));
        let inside = (0..N * N).filter(|&at| is_inside(at)).map(|at| power[at]);
        inside.sum::<f64>() / total
    };
    // In theory 3e-5 of the power, 81/1000 and 846/1000; a tile has about 900 independent frequencies.
    assert!(
        share(0.0, 0.125) < 1e-4,
        "below an eighth: {}",
        share(0.0, 0.125)
    );
    assert!(
        share(0.0, 0.25) < 0.1,
        "below a quarter: {}",
        share(0.0, 0.25)
    );
    assert!(
        share(0.25, 0.5 + 1e-9) > 0.8,
        "between: {}",
        share(0.25, 0.5 + 1e-9)
    );
}

/// Returns the power at each frequency of `N × N` real values, row by row, by the definition of the Fourier transform.
fn power_spectrum<const N: usize>(values: &[f64]) -> Vec<f64> {
    let roots = roots_of_unity::<N>();
    let mut lines: Vec<[f64; 2]> = values.iter().map(|&value| [value, 0.0]).collect();
    for _ in 0..2 {
        // The second pass runs along the former columns.
        let term = |line: usize, frequency: usize, place: usize| {
            multiply(lines[line * N + place], roots[place * frequency % N])
        };
        let add = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        let sum = |at: usize| {
            let terms = (0..N).map(|place| term(at % N, at / N, place));
            terms.fold([0.0; 2], add)
        };
        lines = (0..N * N).map(sum).collect();
    }
    lines.iter().map(|[re, im]| re * re + im * im).collect()
}

/// Returns the `N` powers of the complex root of unity of order `N`, a power of two of at least 4, by repeatedly
/// halving a right angle.
fn roots_of_unity<const N: usize>() -> Vec<[f64; 2]> {
    let mut root: [f64; 2] = [0.0, 1.0];
    for _ in 2..N.trailing_zeros() {
        root = [1.0 + root[0], 1.0 - root[0]].map(|double| (0.5 * double).sqrt());
    }
    let powers = core::iter::successors(Some([1.0, 0.0]), |&power| Some(multiply(power, root)));
    powers.take(N).collect()
}

fn multiply(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

#[test]
fn values_stay_within_the_bound_and_come_near_to_it() {
    let noise = WaveletNoise2::new(64, Seed(5)).unwrap();
    let center = |at: u32| DVec2::new(f64::from(at % 64) + 0.5, f64::from(at / 64) + 0.5);
    let most = (0..64 * 64).fold(0.0, |most: f32, at| {
        most.max(noise.sample(center(at)).abs())
    });
    // At its center, a coefficient has 9/16 of the weight.
    assert!(
        most <= noise.bound() && most > 0.4 * noise.bound(),
        "{most} {}",
        noise.bound()
    );
}
