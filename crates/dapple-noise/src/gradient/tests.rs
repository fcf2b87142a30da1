//! Tests of the noise against its formula as a sum over all corners, and of its bounds, periods, sampling methods and
//! pinned values.

use super::{GradientNoise, GradientNoise2, GradientNoise3, GradientNoise4, Place, fade};
use crate::gradients::{all, gradient};
use dapple_hash::{LatticeHash, Seed, hash1};
use dapple_raster::glam::DVec2;
use dapple_raster::simd::{Level, for_every_level};
use dapple_raster::{Field, FieldExt as _, FractalShape, RasterErrorKind, Window};
use proptest::prelude::*;

const SEED: Seed = Seed(7);

/// Returns the noise in `f64`: the sum over the 2^N corners of each gradient's linear function times the blends along
/// all axes.
fn oracle<const N: usize>(noise: &GradientNoise<N>, position: [f64; N]) -> f64 {
    let blend = |t: f64| t * t * t * (10.0 + t * (6.0 * t - 15.0));
    let mut sum = 0.0;
    for corner in 0..1 << N {
        let far: [i64; N] = core::array::from_fn(|axis| corner >> axis & 1);
        let cell: [i64; N] = core::array::from_fn(|axis| position[axis].floor() as i64 + far[axis]);
        let gradient = noise.line(Level::baseline(), cell, &cell[..1])[0];
        let (mut weight, mut plane) = (1.0, 0.0);
        for axis in 0..N {
            let t = position[axis] - position[axis].floor();
            let to_far = blend(t);
            weight *= if far[axis] == 1 { to_far } else { 1.0 - to_far };
            plane += f64::from(gradient[axis]) * (position[axis] - cell[axis] as f64);
        }
        sum += weight * plane;
    }
    sum
}

/// Returns pseudorandom positions within 50 cells of the origin.
fn positions<const N: usize>(count: u32) -> impl Iterator<Item = [f64; N]> {
    (0..count).map(|index| {
        core::array::from_fn(|axis| {
            let bits = hash1(Seed(9), [i64::from(index)], axis as u32) >> 11;
            bits as f64 / (1_u64 << 53) as f64 * 100.0 - 50.0
        })
    })
}

#[test]
fn values_are_the_sum_over_all_corners() {
    fn check<const N: usize>(noise: &GradientNoise<N>) {
        for position in positions(2000) {
            let difference = f64::from(noise.sample(position)) - oracle(noise, position);
            // Tolerance: a dozen roundings of numbers up to 3.
            assert!(difference.abs() < 2e-6, "{difference} at {position:?}");
        }
    }
    check(&GradientNoise2::new(SEED));
    check(&GradientNoise3::new(SEED));
    check(&GradientNoise4::new(SEED));
    check(
        &GradientNoise2::new(SEED)
            .with_period([Some(3), None])
            .unwrap(),
    );
}

/// Returns the maximum value over all choices of gradients at an offset in a cell.
fn supremum<const N: usize>(offset: [f64; N]) -> f64 {
    (0..1 << N)
        .map(|corner: usize| {
            let (mut weight, mut to_corner) = (1.0, [0.0; N]);
            for axis in 0..N {
                let far = corner >> axis & 1;
                let to_far = f64::from(fade(offset[axis] as f32));
                weight *= if far == 1 { to_far } else { 1.0 - to_far };
                to_corner[axis] = offset[axis] - far as f64;
            }
            let plane = |gradient: [f32; N]| {
                let parts = gradient.into_iter().zip(to_corner);
                parts.map(|(part, t)| f64::from(part) * t).sum::<f64>()
            };
            weight * all().into_iter().map(plane).fold(f64::MIN, f64::max)
        })
        .sum()
}

/// Returns the maximum value of any noise: the best value on a grid over half a cell (the rest is symmetric), refined
/// on ever finer grids around it.
fn largest<const N: usize>() -> f64 {
    let steps: i32 = [0, 0, 40, 20, 10][N];
    let (mut center, mut reach) = ([0.25; N], 0.25);
    let mut best = 0.0;
    for _ in 0..12 {
        let mut found = center;
        for place in 0..(steps + 1).pow(N as u32) {
            let offset: [f64; N] = core::array::from_fn(|axis| {
                let step = place / (steps + 1).pow(axis as u32) % (steps + 1);
                center[axis] + reach * f64::from(2 * step - steps) / f64::from(steps)
            });
            let value = supremum(offset);
            if value > best {
                (best, found) = (value, offset);
            }
        }
        center = found;
        reach *= 0.3;
    }
    best
}

#[test]
fn bounds_are_the_largest_values_that_gradients_can_make() {
    for (largest, bound) in [
        (largest::<2>(), GradientNoise2::BOUND),
        (largest::<3>(), GradientNoise3::BOUND),
        (largest::<4>(), GradientNoise4::BOUND),
    ] {
        let bound = f64::from(bound);
        // The search ends within 1e-6 of the maximum, and the bounds are rounded up at the fourth digit.
        assert!(largest <= bound + 1e-6, "{largest} is past {bound}");
        assert!(largest > bound - 1e-3, "{largest} is far from {bound}");
    }
}

#[test]
fn mean_and_variance_are_the_stated_ones() {
    fn moments<const N: usize>(noise: &GradientNoise<N>) -> [f64; 2] {
        let values: Vec<f64> = positions(100_000)
            .map(|at| noise.sample(at).into())
            .collect();
        let mean = values.iter().sum::<f64>() / 1e5;
        [
            mean,
            values
                .iter()
                .map(|value| (value - mean) * (value - mean))
                .sum::<f64>()
                / 1e5,
        ]
    }
    for (axes, [mean, variance], stated) in [
        (
            2,
            moments(&GradientNoise2::new(SEED)),
            GradientNoise2::VARIANCE,
        ),
        (
            3,
            moments(&GradientNoise3::new(SEED)),
            GradientNoise3::VARIANCE,
        ),
        (
            4,
            moments(&GradientNoise4::new(SEED)),
            GradientNoise4::VARIANCE,
        ),
    ] {
        // Ten standard errors for some 10,000 cells
        assert!(mean.abs() < 0.03, "the mean of {axes} axes is {mean}");
        assert!(
            (variance / f64::from(stated) - 1.0).abs() < 0.05,
            "the variance of {axes} axes is {variance}"
        );
    }
}

#[test]
fn every_corner_of_the_lattice_is_zero() {
    let noise = GradientNoise3::new(SEED);
    for corner in positions::<3>(100) {
        assert_eq!(noise.sample(corner.map(f64::round)), 0.0, "at {corner:?}");
    }
}

#[test]
fn fractal_sums_stay_in_their_ranges_and_leave_the_range_of_one_octave() {
    let noise = GradientNoise2::new(SEED);
    for (count, gain) in [(1, 0.5), (2, 1.0), (6, 0.5), (8, 0.9), (3, 0.0)] {
        let weights = core::iter::successors(Some(1.0), |weight| Some(weight * gain));
        let weight: f64 = weights.take(count as usize).sum();
        // Each of at most 8 additions rounds by at most half of the last bit.
        let most = weight as f32 * (1.0 + 8.0 * f32::EPSILON);
        for (shape, least) in [
            (FractalShape::Sum, -most),
            (FractalShape::Ridged, 0.0),
            (FractalShape::Billow, 0.0),
        ] {
            let fractal = noise.fractal(count, gain, 2.0, shape).unwrap();
            assert!((f64::from(fractal.weight()) - weight).abs() < 1e-5);
            let values = positions::<2>(20_000).map(|at| fractal.sample(at));
            let values: Vec<f32> = values.collect();
            let [lowest, highest] = values.iter().fold([f32::MAX, f32::MIN], |[low, high], &v| {
                [low.min(v), high.max(v)]
            });
            assert!(
                least <= lowest && highest <= most,
                "{shape:?}: {lowest} to {highest}"
            );
            if count == 8 {
                // One octave stays within 1.
                assert!(highest > 1.0, "{shape:?}: {highest}");
            }
        }
    }
}

#[test]
fn fractal_sums_vary_from_one_whole_position_to_the_next() {
    for shape in [
        FractalShape::Sum,
        FractalShape::Ridged,
        FractalShape::Billow,
    ] {
        let sum = GradientNoise2::new(SEED)
            .fractal(6, 0.5, 2.0, shape)
            .unwrap();
        let values: Vec<f32> = positions::<2>(1000)
            .map(|corner| sum.sample(corner.map(f64::round)))
            .collect();
        let elsewhere: Vec<f32> = positions::<2>(1000).map(|at| sum.sample(at)).collect();
        let [variance, expected] = [values, elsewhere].map(|values| {
            let mean = values.iter().sum::<f32>() / 1000.0;
            let squares = values.iter().map(|value| (value - mean) * (value - mean));
            squares.sum::<f32>() / 1000.0
        });
        // Offsets differ between octaves, so that some octaves are near corners and others are not.
        assert!(
            variance > 0.25 * expected,
            "{shape:?}: {variance} and {expected}"
        );
    }
}

#[test]
fn a_window_has_the_values_of_its_positions_bit_for_bit() {
    let plane = GradientNoise2::new(SEED)
        .with_period([Some(5), None])
        .unwrap();
    let clouds = GradientNoise3::new(SEED).with_period([Some(3); 3]).unwrap();
    let clouds = clouds.fractal(4, 0.5, 2.0, FractalShape::Sum).unwrap();
    let fields: [&dyn Field; 6] = [
        &plane,
        &(&clouds).slice([0.75]),
        &(&clouds).warp([&clouds; 3], 0.5).slice([0.75]),
        &GradientNoise3::new(SEED).slice([0.3]),
        &GradientNoise4::new(SEED).slice([-2.75, 1e6 + 0.1]),
        &plane.fractal(3, 0.5, 2.0, FractalShape::Billow).unwrap(),
    ];
    for extent in [[1.3, 0.7], [-40.0, 90.0], [700.0, 1e9]] {
        let origin = DVec2::new(-3.3, 1e7 + 0.2);
        let whole = Window::new(origin, extent, [90, 70]).unwrap();
        let window = whole.crop([-5, 3], [85, 67]).unwrap();
        for field in fields {
            let raster = field.to_raster(&window).unwrap();
            for (row, values) in (0..).zip(raster.view().rows()) {
                for (column, value) in (0..).zip(values) {
                    let sampled = field.sample(window.position(column, row));
                    assert_eq!(value.to_bits(), sampled.to_bits(), "at {column}, {row}");
                }
            }
        }
    }
}

#[test]
fn every_simd_level_finds_the_same_gradients() {
    let noise = GradientNoise3::new(SEED)
        .with_period([Some(7), None, None])
        .unwrap();
    let columns: Vec<i64> = (-20..50).chain([i64::MIN, i64::MAX]).collect();
    let at = [0, i64::MIN, 3];
    let expected: Vec<[f32; 3]> = (columns.iter())
        .map(|&column| {
            gradient(LatticeHash::<3>::bits(
                noise.row(at) ^ noise.part(0, column),
            ))
        })
        .collect();
    for_every_level(|level| assert_eq!(noise.line(level, at, &columns), expected, "{level:?}"));
}

#[test]
fn every_simd_level_has_the_values_of_single_positions() {
    fn check<const N: usize>(noise: &GradientNoise<N>) {
        let far = [
            0.0,
            -0.0,
            1e-30,
            3e9,
            -3e9,
            1e15,
            -5e15,
            1e17,
            1e300,
            f64::INFINITY,
            f64::NAN,
        ];
        let far = far.into_iter().map(|x| {
            let mut position = [0.3; N];
            position[0] = x;
            position[N - 1] -= x;
            position
        });
        let positions: Vec<[f64; N]> = positions(1003).chain(far).collect();
        let expected: Vec<u32> = (positions.iter())
            .map(|&position| noise.sample(position).to_bits())
            .collect();
        for_every_level(|level| {
            let mut values = vec![0.0; positions.len()];
            noise
                .sample_many(&positions, &mut values)
                .expect("as many values as positions");
            for (at, value) in values.iter().enumerate() {
                assert_eq!(
                    value.to_bits(),
                    expected[at],
                    "{level:?} at {:?}",
                    positions[at]
                );
            }
        });
    }
    check(&GradientNoise2::new(SEED));
    check(&GradientNoise3::new(SEED));
    check(&GradientNoise4::new(SEED));
    check(
        &GradientNoise2::new(SEED)
            .with_period([Some(3), None])
            .unwrap(),
    );
    for period in [1 << 31, 3_000_000_000, u32::MAX] {
        check(
            &GradientNoise2::new(SEED)
                .with_period([Some(period), Some(12)])
                .unwrap(),
        );
    }
    check(
        &GradientNoise3::new(SEED)
            .with_period([None, Some(1), Some(7)])
            .unwrap(),
    );
}

#[test]
fn cells_and_offsets_are_those_of_the_floor() {
    let powers = (0..1074).map(|power| f64::from_bits((power + 973) << 52));
    let near = powers.flat_map(|x| [x, x.next_down(), x.next_up(), x + 0.5, x - 0.5]);
    for x in near
        .chain([0.0, f64::MAX, f64::MIN_POSITIVE])
        .flat_map(|x| [x, -x])
    {
        let place = Place::of(x);
        assert_eq!(place.cell, x.floor() as i64, "{x}");
        assert_eq!(
            place.offset.to_bits(),
            ((x - x.floor()) as f32).to_bits(),
            "{x}"
        );
    }
}

#[test]
fn a_tile_repeats_exactly_along_each_axis_that_was_asked_for() {
    let noise = GradientNoise4::new(SEED).with_period([Some(3), None, Some(1), Some(70_000)]);
    let noise = noise.unwrap();
    for position in positions::<4>(500) {
        // Round to multiples of 2^-20, for which sums are exact.
        let position = position.map(|x| (x * 1_048_576.0).round() / 1_048_576.0);
        let value = noise.sample(position);
        for (axis, period) in [(0, -3.0), (2, 1.0), (3, 140_000.0)] {
            let mut repeat = position;
            repeat[axis] += period;
            assert_eq!(noise.sample(repeat), value, "axis {axis} at {position:?}");
        }
        let mut other = position;
        other[1] += 3.0;
        assert_ne!(noise.sample(other), value, "axis 1 at {position:?}");
    }
    assert_eq!(noise.slice([0.0, 0.0]).period(), [Some(3.0), None]);
}

#[test]
fn octaves_differ_and_keep_the_period() {
    let noise = GradientNoise2::new(SEED)
        .with_period([Some(3), Some(5)])
        .unwrap();
    let sum = noise.fractal(4, 0.5, 2.0, FractalShape::Sum).unwrap();
    assert_eq!(sum.period(), [Some(3.0), Some(5.0)]);
    assert_ne!(sum.sample(DVec2::new(1.25, 2.5)), 0.0);
    assert_ne!(
        noise.octaves(2, 2.0).unwrap()[0].seed,
        SEED,
        "the first, too, is a child"
    );
    let position = DVec2::new(1.25, 2.5);
    assert_eq!(
        sum.sample(position),
        sum.sample(position + DVec2::new(3.0, -5.0))
    );
}

#[test]
fn numbers_out_of_range_are_refused() {
    let noise = GradientNoise2::new(SEED);
    let tiled = noise.with_period([Some(1 << 30), None]).unwrap();
    for (error, part) in [
        (
            noise.with_period([None, Some(0)]).unwrap_err(),
            "period is 0",
        ),
        (
            noise.fractal(0, 0.5, 2.0, FractalShape::Sum).unwrap_err(),
            "octaves is 0",
        ),
        (
            noise.fractal(33, 0.5, 2.0, FractalShape::Sum).unwrap_err(),
            "octaves is 33",
        ),
        (
            noise
                .fractal(3, 0.5, f64::NAN, FractalShape::Sum)
                .unwrap_err(),
            "lacunarity",
        ),
        (
            tiled.fractal(2, 0.5, 1.5, FractalShape::Sum).unwrap_err(),
            "whole number",
        ),
        (
            tiled.fractal(4, 0.5, 2.0, FractalShape::Sum).unwrap_err(),
            "below 2^32",
        ),
    ] {
        let is_range = matches!(error.kind(), RasterErrorKind::Range { .. });
        assert!(is_range && error.to_string().contains(part), "{error}");
    }
}

#[test]
fn positions_that_are_not_finite_have_one_value() {
    let noise = GradientNoise2::new(SEED);
    let nan = f32::NAN.to_bits();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(noise.sample([bad, 0.5]).to_bits(), nan, "{bad} along x");
        assert_eq!(noise.sample([0.5, bad]).to_bits(), nan, "{bad} along y");
    }
    // Columns range from finite to infinite.
    let window = Window::new(DVec2::ZERO, DVec2::splat(1e308), [4, 4]).unwrap();
    let window = window.crop([0, 0], [20, 20]).unwrap();
    let raster = noise.to_raster(&window).unwrap();
    for (index, value) in (0..).zip(raster.pixels()) {
        let sampled = noise.sample(window.position(index % 20, index / 20));
        assert_eq!(value.to_bits(), sampled.to_bits(), "pixel {index}");
    }
    assert_eq!(raster.row(0)[19].to_bits(), nan, "past the largest number");
}

#[test]
fn value_stability_gradient_noise() {
    let values = [
        GradientNoise2::new(SEED).sample([0.25, 0.5]),
        GradientNoise2::new(SEED).sample([-1e9 + 0.25, 3.7]),
        GradientNoise3::new(SEED).sample([0.25, 0.5, 0.75]),
        GradientNoise4::new(SEED).sample([0.25, 0.5, 0.75, 0.3]),
    ];
    assert_eq!(
        values,
        [0.019_226_529, -0.268_234_55, -0.056_363_106, 0.243_122_58]
    );
}

proptest! {
    #[test]
    fn values_stay_within_the_bounds(seed: u64, position: [f64; 4]) {
        let [x, y, z, w] = position;
        let finite = position.iter().all(|part| part.is_finite());
        let plane = GradientNoise2::new(Seed(seed)).sample([x, y]);
        let space = GradientNoise3::new(Seed(seed)).sample([x, y, z]);
        let time = GradientNoise4::new(Seed(seed)).sample([x, y, z, w]);
        prop_assert!(!finite || plane.abs() <= GradientNoise2::BOUND);
        prop_assert!(!finite || space.abs() <= GradientNoise3::BOUND);
        prop_assert!(!finite || time.abs() <= GradientNoise4::BOUND);
    }
}

#[cfg(feature = "serde")]
#[test]
fn noise_is_read_from_what_it_wrote() {
    let noise = GradientNoise3::new(SEED)
        .with_period([Some(4), None, Some(7)])
        .unwrap();
    let octave = noise.octaves(2, 2.0).unwrap()[1];
    for noise in [noise, octave] {
        let text = serde_json::to_string(&noise).unwrap();
        let read: GradientNoise3 = serde_json::from_str(&text).unwrap();
        assert_eq!(read, noise, "{text}");
    }
    for (text, expected) in [
        (r#"{"seed": 7, "period": [4, null]}"#, "3"),
        (r#"{"seed": 7, "period": [0, null, null]}"#, "period"),
        (
            r#"{"seed": 7, "period": [4, null, null], "offset": [0.5]}"#,
            "3",
        ),
        (
            r#"{"seed": 7, "period": [4, null, null], "scale": 2}"#,
            "scale",
        ),
    ] {
        let error = serde_json::from_str::<GradientNoise3>(text).unwrap_err();
        assert!(error.to_string().contains(expected), "{text}: {error}");
    }
}

#[test]
fn gradients_are_those_of_differences() {
    fn check<const N: usize>(noise: GradientNoise<N>) {
        const STEP: f64 = 1.0 / 256.0;
        for position in positions::<N>(400) {
            let (value, gradient) = noise.sample_with_gradient(position);
            assert_eq!(value.to_bits(), noise.sample(position).to_bits());
            for axis in 0..N {
                let at = |step: f64| {
                    let mut moved = position;
                    moved[axis] += step;
                    f64::from(noise.sample(moved))
                };
                let difference = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                let error = (f64::from(gradient[axis]) - difference).abs();
                // Third derivatives are below 200 and discontinuous at cell borders: 200 · STEP² / 6 plus some slack.
                assert!(error < 4e-3, "{error} along {axis} at {position:?}");
            }
        }
        let (value, gradient) = noise.sample_with_gradient([f64::INFINITY; N]);
        assert!(value.is_nan() && gradient.iter().all(|part| part.is_nan()));
    }
    check(GradientNoise2::new(SEED));
    check(
        GradientNoise3::new(SEED)
            .with_period([Some(3), None, Some(1)])
            .unwrap(),
    );
    check(GradientNoise4::new(SEED));
    // At a corner the gradient equals the gradient of the corner, all of which have the same length.
    let at_corner = GradientNoise2::new(SEED)
        .sample_with_gradient([3.0, -8.0])
        .1;
    let length_sq = at_corner.iter().map(|part| part * part).sum::<f32>();
    assert!((1.0..=2.01).contains(&length_sq), "{length_sq}");
}

#[test]
fn sums_of_octaves_have_gradients() {
    let noise = GradientNoise3::new(SEED);
    let sum = noise.fractal(4, 0.5, 2.0, FractalShape::Sum).unwrap();
    let (value, gradient) = sum.sample_with_gradient([0.3, 0.7, -1.2]);
    assert_eq!(value, sum.sample([0.3, 0.7, -1.2]));
    for axis in 0..3 {
        let at = |step: f64| {
            let mut moved = [0.3, 0.7, -1.2];
            moved[axis] += step;
            f64::from(sum.sample(moved))
        };
        let difference = (at(1e-3) - at(-1e-3)) * 500.0;
        // The finest octave has 512 times the third derivative at an eighth of the amplitude: 64 · 200 · 1e-6 / 6.
        assert!((f64::from(gradient[axis]) - difference).abs() < 4e-3);
    }
}

#[test]
fn shader_words_refuse_periods_above_two_to_the_31() {
    let words = |period| {
        let noise = GradientNoise2::new(Seed(7)).with_period([None, Some(period)]);
        noise.expect("a period").shader_words(0.5)
    };
    let most = words(1 << 31).expect("a period of 2^31");
    assert_eq!(most[4..8], [0, 1 << 31, 0, 0]);
    assert_eq!(most[12], 0.5_f32.to_bits());
    let error = words((1 << 31) + 1).expect_err("one cell too many");
    assert_eq!(
        error.to_string(),
        "the period of noise in a shader is 2147483649, but it must be at most 2^31"
    );
}

#[test]
fn shader_words_of_octaves_have_their_offsets() {
    let noise = GradientNoise3::new(Seed(7));
    let octaves = noise.octaves(3, 2.0).expect("octaves");
    for octave in octaves {
        let words = octave.shader_words(1.0).expect("words");
        for axis in 0..3 {
            let offset = f64::from(words[8 + axis]) / f64::from(1 << 24);
            assert_eq!(octave.moved(0.0, axis), offset);
        }
        assert_eq!(words[11], 0);
    }
}
