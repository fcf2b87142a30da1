//! Tests of blending in bands: exact results, and sharper transitions.

use super::{Pyramid, sharpen};
use crate::blend::linear;
use crate::{TileErrorKind, weighting};
use dapple_hash::{Seed, hash2, unit_f64};
use dapple_raster::{Raster, Wrap};
use dapple_wavelet::{Border, SplineFilter};

fn noise(size: [u32; 2], seed: u64) -> Raster<f32> {
    Raster::from_fn(size, |column, row| {
        unit_f64(hash2(Seed(seed), [column.into(), row.into()], 0)) as f32
    })
    .unwrap()
}

/// Returns two shares that sum to 1.
fn shares(size: [u32; 2], seed: u64) -> Vec<Raster<f32>> {
    let weights = [seed, seed + 1].map(|seed| noise(size, seed));
    weighting::normalize(&weights.each_ref(), &|| false).unwrap()
}

fn mix(pyramid: &Pyramid, planes: &[Raster<f32>], shares: &[Raster<f32>]) -> Raster<f32> {
    let shares = pyramid.shares(shares.to_vec(), &|| false).unwrap();
    pyramid.mix(planes, &shares, &|| false).unwrap()
}

fn difference(a: &Raster<f32>, b: &Raster<f32>) -> f32 {
    a.zip_map(b, |a, b| (a - b).abs()).unwrap().statistics().max
}

#[test]
fn pyramid_without_levels_is_the_mean() {
    let planes = [1, 2].map(|seed| noise([7, 5], seed));
    let shares = shares([7, 5], 3);
    let pyramid = Pyramid {
        levels: 0,
        ..Pyramid::default()
    };
    let off = difference(
        &mix(&pyramid, &planes, &shares),
        &linear(&planes, &shares, &|| false).unwrap(),
    );
    // The shares are divided by their maximum and by their sum once more.
    assert!(off < 1e-6, "{off}");
}

#[test]
fn pyramid_with_shares_that_are_the_same_everywhere_is_a_mean_in_each_band() {
    let size = [21, 16];
    let planes = [1, 2].map(|seed| noise(size, seed));
    let shares = [0.25, 0.75].map(|share| Raster::filled(size, share).unwrap());
    let soft = Pyramid {
        levels: 3,
        sharpness: 0.0,
        ..Pyramid::default()
    };
    let off = difference(
        &mix(&soft, &planes, &shares),
        &linear(&planes, &shares, &|| false).unwrap(),
    );
    // Some roundings of `f32` per level.
    assert!(off < 2e-6, "{off}");

    // One level with a sharpness of 1: the detail has 1 : 9, the rest 1 : 3.
    let pyramid = Pyramid {
        levels: 1,
        sharpness: 1.0,
        ..Pyramid::default()
    };
    let filter = SplineFilter::default();
    let [a, b] = planes
        .each_ref()
        .map(|plane| filter.project(plane, 1, [Border::Mirror; 2]).unwrap());
    let mixed = mix(&pyramid, &planes, &shares);
    for index in 0..mixed.pixels().len() {
        let at = |raster: &Raster<f32>| raster.pixels()[index];
        let rest = 0.25 * at(&a) + 0.75 * at(&b);
        let detail = 0.1 * (at(&planes[0]) - at(&a)) + 0.9 * (at(&planes[1]) - at(&b));
        let off = (at(&mixed) - rest - detail).abs();
        assert!(off < 2e-6, "pixel {index} is off by {off}");
    }
}

#[test]
fn pyramid_mixes_fine_details_over_a_narrower_band_than_coarse_ones() {
    // Two checkerboards, of pixels and of squares of 16 pixels, fade out to the right.
    let size = [128, 32];
    let ramp = |column: u32| (column as f32 + 0.5) / 128.0;
    let weights = [
        Raster::from_fn(size, |column, _| 1.0 - ramp(column)).unwrap(),
        Raster::from_fn(size, |column, _| ramp(column)).unwrap(),
    ];
    let contrast = |side: u32| {
        let checker = Raster::from_fn(size, |column, row| {
            if (column / side + row / side).is_multiple_of(2) {
                1.0
            } else {
                -1.0
            }
        });
        let planes = [checker.unwrap(), Raster::filled(size, 0.0).unwrap()];
        let mixed = mix(&Pyramid::default(), &planes, &weights);
        // Positions at a quarter and at three quarters of the ramp.
        [24, 88].map(|first| {
            mixed
                .crop([first, 0], [16, 32])
                .unwrap()
                .statistics()
                .deviation
        })
    };
    let [fine, coarse] = [1, 16].map(contrast);
    // With the weights alone, both contrasts would be 0.75 and 0.25. Measured: 0.9998 and 0.0003, and 0.85 and 0.22.
    assert!(fine[0] > 0.99 && fine[1] < 0.01, "{fine:?}");
    assert!(coarse[0] < 0.9 && coarse[1] > 0.15, "{coarse:?}");
}

#[test]
fn pyramid_on_the_torus_commutes_with_shifts_of_whole_coarse_pixels() {
    let size = [32, 16];
    let pyramid = Pyramid {
        levels: 3,
        borders: [Border::Periodic; 2],
        ..Pyramid::default()
    };
    let shift = |raster: &Raster<f32>| {
        let at = |x: u32, y: u32| *raster.at(i64::from(x) + 8, i64::from(y) - 8, [Wrap::Repeat; 2]);
        Raster::from_fn(size, at).unwrap()
    };
    let planes = [1, 2].map(|seed| noise(size, seed));
    let shares = shares(size, 3);
    let shifted = mix(
        &pyramid,
        &planes.each_ref().map(shift),
        &shares.iter().map(shift).collect::<Vec<_>>(),
    );
    // The recursions of the filter start at another pixel, which changes the rounding.
    let off = difference(&shifted, &shift(&mix(&pyramid, &planes, &shares)));
    assert!(off < 2e-6, "{off}");
}

#[test]
fn sharpened_shares_sum_to_one_for_any_power() {
    // Values that a filter may produce: slightly below zero and above one.
    let share = noise([9, 9], 1).map(|value| 1.2 * value - 0.1);
    let shares = [share.map(|share| 1.0 - share), share];
    for power in [1.0, 2.5, 9.0, 1e6, 1e300] {
        let sharp = sharpen(&shares, power, &|| false).unwrap();
        for (before, (a, b)) in shares[1]
            .pixels()
            .iter()
            .zip(sharp[0].pixels().iter().zip(sharp[1].pixels()))
        {
            assert!((a + b - 1.0).abs() < 1e-6, "{power}: {a} and {b}");
            assert!(*a >= 0.0 && *b >= 0.0, "{power}: {a} and {b}");
            let grows = if *before > 0.5 {
                *b >= before.min(1.0) - 1e-6
            } else {
                *b <= before.max(0.0) + 1e-6
            };
            assert!(grows, "{power}: {b} of {before}");
        }
    }
}

#[test]
fn pyramid_with_mirrored_borders_takes_any_size_above_half_of_a_coarse_pixel() {
    for size in [[9, 9], [9, 31], [17, 64], [15, 10]] {
        let planes = [1, 2].map(|seed| noise(size, seed));
        let mixed = mix(&Pyramid::default(), &planes, &shares(size, 3));
        assert_eq!(mixed.size(), size);
        assert_eq!(mixed.statistics().n_not_finite, 0, "{size:?}");
    }
}

#[test]
fn pyramid_refuses_bad_numbers_and_sizes() {
    let refuse = |pyramid: Pyramid, size: [u32; 2]| {
        pyramid
            .shares(shares(size, 1), &|| false)
            .unwrap_err()
            .kind()
            .clone()
    };
    let default = Pyramid::default();
    let kind = refuse(
        Pyramid {
            levels: 31,
            ..default
        },
        [8, 8],
    );
    assert!(
        matches!(
            kind,
            TileErrorKind::Range {
                what: "number of levels",
                ..
            }
        ),
        "{kind:?}"
    );
    for sharpness in [-0.5, f64::NAN, f64::INFINITY] {
        let kind = refuse(
            Pyramid {
                sharpness,
                ..default
            },
            [8, 8],
        );
        assert!(
            matches!(
                kind,
                TileErrorKind::Range {
                    what: "sharpness",
                    ..
                }
            ),
            "{kind:?}"
        );
    }
    let periodic = Pyramid {
        borders: [Border::Periodic; 2],
        ..default
    };
    for (pyramid, size) in [(default, [1, 1]), (default, [8, 64]), (periodic, [24, 16])] {
        let kind = refuse(pyramid, size);
        assert!(
            matches!(kind, TileErrorKind::Wavelet(_)),
            "{size:?}: {kind:?}"
        );
    }
}
