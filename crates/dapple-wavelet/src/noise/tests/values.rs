//! Tests of values and gradients against the oracle.

use super::{oracle, positions};
use crate::{WaveletNoise2, WaveletNoise3};
use dapple_hash::Seed;
use glam::{DVec2, DVec3};

const WEIGHTS: [f32; 5] = [0.5, -1.0, 0.0, 0.25, 2.0];

/// Tolerance: sums of nine or 27 products in `f32` of numbers below 10, in bands with a total weight of up to 4.
const TOLERANCE: f64 = 3e-5;

#[test]
fn value_equals_the_sum_of_all_b_splines_in_the_plane() {
    for size in [[4; 2], [6; 2], [32; 2], [100; 2], [12, 8], [4, 100]] {
        let one = WaveletNoise2::of_size(size, Seed(1)).unwrap();
        let many = one.clone().with_weights(&WEIGHTS).unwrap();
        for position in positions(500, 300.0) {
            for noise in [&one, &many] {
                let value = f64::from(noise.sample(position));
                let expected = oracle(noise, position);
                assert!(
                    (value - expected).abs() < TOLERANCE,
                    "{position:?}: {value} {expected}"
                );
            }
        }
    }
}

#[test]
fn value_equals_the_sum_of_all_b_splines_in_space() {
    for size in [[4; 3], [10; 3], [32; 3], [12, 8, 6], [4, 6, 32]] {
        let one = WaveletNoise3::of_size(size, Seed(1)).unwrap();
        let many = one.clone().with_weights(&WEIGHTS).unwrap();
        for position in positions(300, 100.0) {
            for noise in [&one, &many] {
                let value = f64::from(noise.sample(position));
                let expected = oracle(noise, position);
                assert!(
                    (value - expected).abs() < TOLERANCE,
                    "{position:?}: {value} {expected}"
                );
            }
        }
    }
}

#[test]
fn gradient_equals_differences_of_the_oracle() {
    let plane = WaveletNoise2::new(32, Seed(2)).unwrap();
    let space = WaveletNoise3::new(16, Seed(2)).unwrap();
    for weights in [&[1.0], &WEIGHTS[..]] {
        let plane = plane.clone().with_weights(weights).unwrap();
        for position in positions::<2>(300, 100.0) {
            let (value, gradient) = plane.sample_with_gradient(position);
            assert_eq!(value, plane.sample(position), "{position:?}");
            let expected = differences(position, |position| oracle(&plane, position));
            check_gradient(&gradient.to_array(), &expected);
        }
        let space = space.clone().with_weights(weights).unwrap();
        for position in positions::<3>(200, 100.0) {
            let (value, gradient) = space.sample_with_gradient(position);
            assert_eq!(value, space.sample(position), "{position:?}");
            let expected = differences(position, |position| oracle(&space, position));
            check_gradient(&gradient.to_array(), &expected);
        }
    }
}

/// Returns central differences along each axis. They are exact up to rounding if both positions are on one piece of
/// the spline.
fn differences<const N: usize>(position: [f64; N], value: impl Fn([f64; N]) -> f64) -> [f64; N] {
    let step = 1.0 / 1_048_576.0;
    core::array::from_fn(|axis| {
        let [mut before, mut after] = [position; 2];
        before[axis] -= step;
        after[axis] += step;
        (value(after) - value(before)) / (2.0 * step)
    })
}

fn check_gradient(gradient: &[f64], expected: &[f64]) {
    for (slope, expected) in gradient.iter().zip(expected) {
        // The finest band has a weight of 2 and 16 cells per unit: slopes of up to some hundreds, rounded to `f32`,
        // and second derivatives of some thousands, which may jump between the two positions.
        let tolerance = 2e-2;
        assert!(
            (slope - expected).abs() < tolerance,
            "{gradient:?} {expected:?}"
        );
    }
}

#[test]
fn value_and_gradient_are_continuous_at_cells_and_at_the_seam() {
    let noise = WaveletNoise2::new(6, Seed(3)).unwrap();
    let step = 1e-9;
    for x in [0.0, 1.0, 5.0, 6.0, -6.0, 12.0] {
        for y in [0.0, 0.25, 3.0, 5.999] {
            for swap in [false, true] {
                let at = |x: f64| {
                    let position = if swap {
                        DVec2::new(y, x)
                    } else {
                        DVec2::new(x, y)
                    };
                    noise.sample_with_gradient(position)
                };
                let [before, after] = [at(x - step), at(x + step)];
                // Values and slopes are below 20, so their roundings are below 1e-5.
                assert!(
                    (before.0 - after.0).abs() < 1e-5,
                    "{x} {y}: {before:?} {after:?}"
                );
                let gradients_agree = (before.1 - after.1).abs().max_element() < 1e-5;
                assert!(gradients_agree, "{x} {y}: {before:?} {after:?}");
            }
        }
    }
}

#[test]
fn value_just_below_a_whole_number_is_that_of_the_number() {
    let noise = WaveletNoise3::new(6, Seed(3)).unwrap();
    for position in [DVec3::splat(-1e-300), DVec3::new(0.0, -1e-20, 6.0)] {
        let difference = noise.sample(position) - noise.sample(DVec3::ZERO);
        assert!(difference.abs() < 1e-5, "{position}: {difference}");
    }
}

#[test]
fn bands_add_up_and_are_not_copies_at_the_origin() {
    let noise = WaveletNoise2::new(64, Seed(4)).unwrap();
    let band = |weights: &[f32]| noise.clone().with_weights(weights).unwrap();
    let [first, second, both] = [band(&[0.5]), band(&[0.0, 2.0]), band(&[0.5, 2.0])];
    for position in positions::<2>(200, 50.0) {
        let position = DVec2::from(position);
        let sum = first.sample(position) + second.sample(position);
        assert_eq!(both.sample(position), sum, "{position}");
    }
    let copy = 2.0 * noise.sample(DVec2::ZERO);
    assert!(
        (second.sample(DVec2::ZERO) - copy).abs() > 1e-3,
        "band 1 is a copy"
    );
}

#[test]
fn no_band_of_weight_is_nothing_everywhere() {
    let noise = WaveletNoise2::new(8, Seed(4))
        .unwrap()
        .with_weights(&[0.0; 16])
        .unwrap();
    assert_eq!((noise.sample(DVec2::splat(0.3)), noise.bound()), (0.0, 0.0));
}
