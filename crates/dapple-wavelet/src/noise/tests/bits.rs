//! Tests of bit-exact guarantees, and of invalid input.

use super::positions;
use crate::{WaveletError, WaveletErrorKind, WaveletNoise2, WaveletNoise3, wavelet_tile};
use dapple_hash::Seed;
use dapple_raster::{Field, FieldExt as _, Raster, RasterErrorKind, Window};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

const WEIGHTS: [f32; 4] = [1.0, 0.0, 0.5, -0.25];

#[test]
fn period_is_exact_for_dyadic_positions_near_and_far() {
    for size in [6, 64, 100] {
        let plane = WaveletNoise2::new(size, Seed(1)).unwrap();
        let plane = plane.with_weights(&WEIGHTS).unwrap();
        let space = WaveletNoise3::new(size, Seed(1)).unwrap();
        for position in positions::<3>(100, 40.0) {
            let position = (DVec3::from(position) * 256.0).floor() / 256.0;
            for periods in [1.0, -1.0, 1e3, -1e7, 1e9, 1e10] {
                let moved = position + f64::from(size) * periods * DVec3::new(1.0, -2.0, 3.0);
                let [here, there] = [position, moved].map(|at| plane.sample(at.truncate()));
                assert_eq!(here.to_bits(), there.to_bits(), "{position} {moved}");
                let [here, there] = [position, moved].map(|at| space.sample(at));
                assert_eq!(here.to_bits(), there.to_bits(), "{position} {moved}");
            }
        }
    }
}

#[test]
fn period_is_exact_past_all_fractions() {
    let noise = WaveletNoise2::new(6, Seed(1)).unwrap();
    // 2^60 is 4 more than a multiple of 6.
    let far = (1_u64 << 60) as f64;
    let [here, there] = [DVec2::new(4.0, 2.0), DVec2::new(far, -far)].map(|at| noise.sample(at));
    assert_eq!(here.to_bits(), there.to_bits());
}

#[test]
fn render_equals_sample_bit_for_bit() {
    let one = WaveletNoise2::new(32, Seed(5)).unwrap();
    let many = one.clone().with_weights(&WEIGHTS).unwrap();
    let oblong = WaveletNoise2::of_size([12, 32], Seed(5)).unwrap();
    let oblong = oblong.with_weights(&WEIGHTS).unwrap();
    for window in windows() {
        for noise in [&one, &many, &oblong] {
            let raster = noise.to_raster(&window).unwrap();
            check(&raster, &window, |position| noise.sample(position));
        }
    }
}

#[test]
fn render_slice_equals_sample_bit_for_bit() {
    let one = WaveletNoise3::new(16, Seed(5)).unwrap();
    let many = one.clone().with_weights(&WEIGHTS).unwrap();
    let oblong = WaveletNoise3::of_size([6, 16, 10], Seed(5)).unwrap();
    let oblong = oblong.with_weights(&WEIGHTS).unwrap();
    for window in windows() {
        for (noise, z) in [
            (&one, 0.3),
            (&many, -7e8 - 0.1),
            (&many, f64::NAN),
            (&oblong, 1e6 + 0.7),
        ] {
            let mut raster = Raster::filled(window.size, 0.0).unwrap();
            noise.slice([z]).render(&window, raster.view_mut()).unwrap();
            check(&raster, &window, |position| {
                noise.sample(position.extend(z))
            });
        }
    }
}

/// Returns wide, narrow, distant and flipped windows, and one with columns and rows at infinity.
fn windows() -> Vec<Window> {
    let window = |x, y, pixel, size| Window {
        origin: [x, y],
        pixel,
        first: [-3, 7],
        size,
        scale: [1.0; 2],
    };
    vec![
        window(0.1, 0.2, DVec2::splat(0.37).into(), [70, 40]),
        window(-5.0, 0.2, DVec2::splat(0.25).into(), [3, 33]),
        window(1e9, -1e12, DVec2::new(0.125, -3.5).into(), [40, 3]),
        window(0.0, 0.0, DVec2::splat(5e307).into(), [50, 30]),
    ]
}

fn check(raster: &Raster<f32>, window: &Window, sample: impl Fn(DVec2) -> f32) {
    for row in 0..window.size[1] {
        for column in 0..window.size[0] {
            let [here, there] = [
                raster.row(row)[column as usize],
                sample(window.position(column, row).into()),
            ];
            assert_eq!(here.to_bits(), there.to_bits(), "{window:?} {column} {row}");
        }
    }
}

#[test]
fn a_crop_equals_the_part_of_the_whole_bit_for_bit() {
    let noise = WaveletNoise2::new(32, Seed(5))
        .unwrap()
        .with_weights(&WEIGHTS)
        .unwrap();
    let whole = Window::new(DVec2::new(0.1, -1e6), DVec2::splat(77.0), [60, 50]).unwrap();
    let part = whole.crop([13, 8], [5, 30]).unwrap();
    let expected = noise
        .to_raster(&whole)
        .unwrap()
        .crop([13, 8], [5, 30])
        .unwrap();
    assert_eq!(noise.to_raster(&part).unwrap(), expected);
}

#[test]
fn noise_is_the_same_at_any_number_of_threads() {
    let window = Window::new(DVec2::ZERO, DVec2::splat(40.0), [100, 90]).unwrap();
    let render = || {
        let plane = WaveletNoise2::new(34, Seed(6))
            .unwrap()
            .with_weights(&WEIGHTS)
            .unwrap();
        let space = WaveletNoise3::new(18, Seed(6)).unwrap();
        let mut slice = Raster::filled(window.size, 0.0).unwrap();
        (&space)
            .slice([0.7])
            .render(&window, slice.view_mut())
            .unwrap();
        (plane.to_raster(&window).unwrap(), slice)
    };
    let expected = render();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let rendered = pool.unwrap().install(render);
        assert!(rendered == expected, "{threads} threads give other bits");
    }
}

#[test]
fn value_is_nan_where_the_position_is_not_finite() {
    let plane = WaveletNoise2::new(8, Seed(7)).unwrap();
    let space = WaveletNoise3::new(8, Seed(7)).unwrap();
    for bad in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for position in [
            DVec3::new(bad, 0.0, 0.0),
            DVec3::new(0.0, bad, 0.0),
            DVec3::splat(bad),
        ] {
            let value = plane.sample(position.truncate());
            assert_eq!(value.to_bits(), f32::NAN.to_bits(), "{position}");
            let (value, gradient) = space.sample_with_gradient(position);
            assert_eq!(value.to_bits(), f32::NAN.to_bits(), "{position}");
            assert!(gradient.is_nan_mask().all(), "{position}: {gradient}");
        }
    }
}

#[test]
fn equal_sizes_have_the_bits_of_squares() {
    assert!(WaveletNoise2::of_size([10; 2], Seed(7)) == WaveletNoise2::new(10, Seed(7)));
    assert!(WaveletNoise3::of_size([10; 3], Seed(7)) == WaveletNoise3::new(10, Seed(7)));
}

#[test]
fn noise_of_a_size_that_is_not_square_repeats_after_its_own_period_and_no_shorter_one() {
    let size = [12, 8, 6];
    let plane = WaveletNoise2::of_size([12, 8], Seed(1)).unwrap();
    let plane = plane.with_weights(&WEIGHTS).unwrap();
    let space = WaveletNoise3::of_size(size, Seed(1)).unwrap();
    let space = space.with_weights(&WEIGHTS).unwrap();
    let moved = |step: DVec3| {
        let same = positions::<3>(100, 40.0).map(|position| {
            let here = (DVec3::from(position) * 256.0).floor() / 256.0;
            let there = here + step;
            let in_plane = plane.sample(here.truncate()) == plane.sample(there.truncate());
            (in_plane, space.sample(here) == space.sample(there))
        });
        let same: Vec<_> = same.collect();
        let count = |part: fn(&(bool, bool)) -> bool| same.iter().filter(|both| part(both)).count();
        [count(|both| both.0), count(|both| both.1)]
    };
    let periods = DVec3::from(size.map(f64::from));
    assert_eq!(moved(periods * DVec3::new(1.0, -2.0, 1e9)), [100, 100]);
    for step in [
        DVec3::X * 4.0,
        DVec3::X * 6.0,
        DVec3::Y * 4.0,
        DVec3::Y * 6.0,
    ] {
        assert!(
            moved(step).iter().all(|&same| same < 5),
            "{step} is a period"
        );
    }
}

#[test]
fn sizes_out_of_range_are_refused() {
    let (sides, cells) = ("size of the tile", "number of cells of the tile");
    for size in [0, 1, 2, 3] {
        check_range(WaveletNoise2::new(size, Seed(0)), sides, size.into());
        check_range(
            WaveletNoise2::of_size([8, size], Seed(0)),
            sides,
            size.into(),
        );
        check_range(
            WaveletNoise3::of_size([8, size, 8], Seed(0)),
            sides,
            size.into(),
        );
    }
    for size in [11_586, u32::MAX] {
        let value = f64::from(size) * f64::from(size);
        check_range(WaveletNoise2::new(size, Seed(0)), cells, value);
        check_range(WaveletNoise2::of_size([size; 2], Seed(0)), cells, value);
    }
    check_range(
        WaveletNoise2::of_size([1 << 25, 6], Seed(0)),
        cells,
        6.0 * f64::from(1 << 25),
    );
    check_range(
        WaveletNoise3::new(514, Seed(0)),
        cells,
        f64::from(514 * 514 * 514),
    );
    let odd = WaveletErrorKind::NotDivisible {
        length: 5,
        levels: 1,
    };
    for error in [
        WaveletNoise2::new(5, Seed(0)).unwrap_err(),
        WaveletNoise2::of_size([8, 5], Seed(0)).unwrap_err(),
        WaveletNoise3::new(5, Seed(0)).unwrap_err(),
        WaveletNoise3::of_size([8, 8, 5], Seed(0)).unwrap_err(),
    ] {
        assert_eq!(*error.kind(), odd);
    }
}

#[test]
fn weights_at_their_limit_give_finite_values() {
    let weights = [1e30, -1e30].repeat(8);
    let noise = WaveletNoise2::new(8, Seed(0)).unwrap();
    let noise = noise.with_weights(&weights).unwrap();
    for position in positions::<2>(200, 10.0) {
        let (value, gradient) = noise.sample_with_gradient(position);
        assert!(
            value.abs() <= noise.bound() && gradient.is_finite(),
            "{position:?}: {value}"
        );
    }
    let tile = wavelet_tile([1 << 8, 1 << 8], &weights[..8], Seed(0)).unwrap();
    assert!(
        tile.pixels().iter().all(|value| value.is_finite()),
        "a pixel is not finite"
    );
}

#[test]
fn weights_out_of_range_are_refused() {
    let noise = WaveletNoise2::new(4, Seed(0)).unwrap();
    check_range(noise.clone().with_weights(&[]), "number of weights", 0.0);
    check_range(
        noise.clone().with_weights(&[1.0; 17]),
        "number of weights",
        17.0,
    );
    check_range(
        noise.clone().with_weights(&[1.0, -1.1e30]),
        "weight",
        f64::from(-1.1e30_f32),
    );
    let error = noise.with_weights(&[1.0, f32::INFINITY]).unwrap_err();
    let expected = WaveletErrorKind::NotFinite {
        index: 1,
        value: f64::INFINITY,
    };
    assert_eq!(*error.kind(), expected);
}

fn check_range<T: core::fmt::Debug>(
    result: Result<T, WaveletError>,
    expected: &'static str,
    number: f64,
) {
    let error = result.unwrap_err();
    let fits = matches!(error.kind(), WaveletErrorKind::Range { what, value, .. }
        if *what == expected && *value == number);
    assert!(fits, "{error}");
}

#[test]
fn memory_of_another_size_is_refused() {
    let window = Window::unit([5, 3]).unwrap();
    let mut raster = Raster::filled([5, 4], 0.0).unwrap();
    let plane = WaveletNoise2::new(4, Seed(0)).unwrap();
    let space = WaveletNoise3::new(4, Seed(0)).unwrap();
    for result in [
        plane.render(&window, raster.view_mut()),
        (&space).slice([0.0]).render(&window, raster.view_mut()),
        (&space)
            .slice([f64::NAN])
            .render(&window, raster.view_mut()),
    ] {
        let error = result.unwrap_err();
        assert!(
            matches!(error.kind(), RasterErrorKind::SizeMismatch { .. }),
            "{error}"
        );
    }
}

proptest! {
    #[test]
    fn any_position_has_a_value_in_the_bound_or_nan(x in any::<f64>(), y in any::<f64>(), z in any::<f64>()) {
        let position = DVec3::new(x, y, z);
        let plane = WaveletNoise2::new(6, Seed(8)).unwrap().with_weights(&[1.0; 16]).unwrap();
        let value = plane.sample(position.truncate());
        let in_bound = value.abs() <= plane.bound();
        prop_assert!(in_bound == position.truncate().is_finite(), "{value}");
        let space = WaveletNoise3::new(6, Seed(8)).unwrap().with_weights(&[1.0; 16]).unwrap();
        let (value, gradient) = space.sample_with_gradient(position);
        let in_bound = value.abs() <= space.bound() && gradient.is_finite();
        prop_assert!(in_bound == position.is_finite(), "{value} {gradient}");
    }
}

#[test]
fn value_stability_wavelet_noise() {
    let plane = WaveletNoise2::new(10, Seed(7)).unwrap();
    let bands = plane.clone().with_weights(&[1.0, 0.5, 0.25]).unwrap();
    let space = WaveletNoise3::new(10, Seed(7)).unwrap();
    let position = DVec3::new(0.3, -2.75, 1e6 + 0.1);
    assert_eq!(
        [
            plane.sample(position.truncate()),
            bands.sample(position.truncate()),
            space.sample(position),
            plane.bound(),
        ],
        [-1.8847088, -2.018241, -0.46022633, 6.531162]
    );
}
