//! Tests of shares: partitions of unity, and the order of layers.

use super::{Weighting, normalize, step};
use crate::{Layer, TileErrorKind, rank_equalize};
use dapple_hash::{Seed, hash2, unit_f64};
use dapple_raster::Raster;
use proptest::prelude::*;

const SIZE: [u32; 2] = [16, 8];

fn noise(size: [u32; 2], seed: u64) -> Raster<f32> {
    Raster::from_fn(size, |column, row| {
        unit_f64(hash2(Seed(seed), [column.into(), row.into()], 0)) as f32
    })
    .unwrap()
}

/// Returns the shares of layers with the given weights and heights.
fn shares(
    weighting: Weighting,
    weights: &[Raster<f32>],
    heights: &[Raster<f32>],
    tile: Option<&Raster<f32>>,
) -> Vec<Raster<f32>> {
    let layers = layers(weights, heights);
    weighting.shares(&layers, tile, &|| false).unwrap()
}

fn layers<'a>(weights: &'a [Raster<f32>], heights: &'a [Raster<f32>]) -> Vec<Layer<'a>> {
    let layer = |(index, weight)| Layer {
        maps: &[],
        weight,
        height: heights.get(index),
    };
    weights.iter().enumerate().map(layer).collect()
}

fn all() -> [Weighting; 6] {
    [
        Weighting::Given,
        Weighting::Height { depth: 0.2 },
        Weighting::Height { depth: 1e-300 },
        Weighting::Mask { gain: 0.3 },
        Weighting::Mask { gain: 5.0 },
        Weighting::Mask { gain: 1e9 },
    ]
}

#[test]
fn shares_sum_to_one_and_none_is_negative() {
    for n_layers in 1..5 {
        // A quarter of all weights are zero, but never all weights of a pixel.
        let weights: Vec<_> = (0..n_layers)
            .map(|seed| noise(SIZE, seed).map(|weight| (4.0 * weight - 1.0).max(0.0)))
            .collect();
        let always = noise(SIZE, 99).map(|weight| weight + 0.01);
        let never = always.map(|_| 0.0);
        let weights = [weights, vec![always, never]].concat();
        let heights: Vec<_> = (0..n_layers + 2)
            .map(|seed| noise(SIZE, seed + 10))
            .collect();
        // Many values are 0 or 1.
        let tile = noise(SIZE, 20).map(|value| (2.0 * value - 0.5).clamp(0.0, 1.0));
        for weighting in all() {
            let shares = shares(weighting, &weights, &heights, Some(&tile));
            for index in 0..tile.pixels().len() {
                let of_pixel: Vec<f32> = shares.iter().map(|s| s.pixels()[index]).collect();
                let sum: f64 = of_pixel.iter().copied().map(f64::from).sum();
                // Each share is rounded to at most 2^-25.
                assert!((sum - 1.0).abs() < 6.0 * 3e-8, "{weighting:?}: {sum}");
                for (share, weight) in of_pixel.iter().zip(&weights) {
                    let weight = weight.pixels()[index];
                    assert!(*share >= 0.0, "{weighting:?}: {share}");
                    assert!(
                        weight > 0.0 || *share == 0.0,
                        "{weighting:?}: {share} of nothing"
                    );
                }
            }
        }
    }
}

#[test]
fn a_layer_that_is_alone_has_all_whatever_the_others_heights() {
    let [one, none] = [0.7, 0.0].map(|weight| Raster::filled(SIZE, weight).unwrap());
    let [high, low] = [5.0, 0.0].map(|height| Raster::filled(SIZE, height).unwrap());
    let tile = noise(SIZE, 1).map(|value| (value * 3.0).floor() / 2.0);
    let weights = [none.clone(), one, none];
    let heights = [high.clone(), low, high];
    for weighting in all() {
        let shares = shares(weighting, &weights, &heights, Some(&tile));
        for (layer, expected) in [(0, 0.0), (1, 1.0), (2, 0.0)] {
            let shares = shares[layer].pixels();
            assert!(
                shares.iter().all(|&share| share == expected),
                "{weighting:?}, layer {layer}"
            );
        }
    }
}

#[test]
fn masks_give_every_layer_its_share_of_the_area_for_every_gain() {
    let size = [64, 64];
    let tile = rank_equalize(&noise(size, 1)).unwrap();
    let parts = [0.05_f32, 0.25, 0.6, 0.1];
    let weights = parts.map(|part| Raster::filled(size, 3.0 * part).unwrap());
    for gain in [0.1, 1.0, 4.0, 12.0, 1e9] {
        let shares = shares(Weighting::Mask { gain }, &weights, &[], Some(&tile));
        for (shares, part) in shares.iter().zip(parts) {
            let covered = shares.statistics().mean;
            // The error is at most one of 4096 pixels at either threshold.
            let off = covered - f64::from(part);
            assert!(
                off.abs() < 2.0 / 4096.0,
                "gain {gain}: {covered} for {part}"
            );
        }
    }
}

#[test]
fn masks_lay_the_first_layer_where_the_tile_is_lowest() {
    let tile = rank_equalize(&noise(SIZE, 2)).unwrap();
    let weights = [0.25, 0.5, 0.25].map(|weight| Raster::filled(SIZE, weight).unwrap());
    let gain = 1e9;
    let shares = shares(Weighting::Mask { gain }, &weights, &[], Some(&tile));
    for (index, &rank) in tile.pixels().iter().enumerate() {
        let expected = [rank < 0.25, (0.25..0.75).contains(&rank), rank >= 0.75];
        for (shares, expected) in shares.iter().zip(expected) {
            assert_eq!(
                shares.pixels()[index],
                f32::from(u8::from(expected)),
                "rank {rank}"
            );
        }
    }
}

#[test]
fn steps_grow_with_the_threshold_and_fall_with_the_mask() {
    for half_width in [0.0, 0.01, 0.125, 0.5, 7.0] {
        for mask in [0.0, 0.1, 0.5, 0.73, 1.0_f32] {
            let mut before = 0.0;
            for threshold in 0..=1000 {
                let threshold = f64::from(threshold) / 1000.0;
                let here = step(threshold, mask, half_width);
                assert!(
                    (before..=1.0).contains(&here),
                    "{half_width} {mask} {threshold}"
                );
                assert!(
                    step(threshold, (mask - 0.07).max(0.0), half_width) >= here,
                    "{half_width} {mask} {threshold}"
                );
                before = here;
            }
        }
        assert_eq!(step(0.0, 0.0, half_width), 0.0);
        assert_eq!(step(1.0, 1.0, half_width), 1.0);
    }
}

#[test]
fn heights_equal_the_formula_pixel_by_pixel() {
    let weights = [0, 1, 2].map(|seed| noise(SIZE, seed));
    let heights = [3, 4, 5].map(|seed| noise(SIZE, seed));
    let depth = 0.15;
    let shares = shares(Weighting::Height { depth }, &weights, &heights, None);
    for index in 0..weights[0].pixels().len() {
        let [w, h] = [&weights, &heights]
            .map(|rasters| [0, 1, 2].map(|layer| f64::from(rasters[layer].pixels()[index])));
        let sum = w[0] + w[1] + w[2];
        let alpha = w.map(|w| w / sum);
        let level = [0, 1, 2].map(|layer| {
            let lowered = (0.25 / alpha[layer] - 1.0).max(0.0);
            h[layer] + alpha[layer] - lowered
        });
        let top = level[0].max(level[1]).max(level[2]);
        let raw = [0, 1, 2].map(|layer| alpha[layer] * (level[layer] - (top - depth)).max(0.0));
        for layer in 0..3 {
            let expected = raw[layer] / (raw[0] + raw[1] + raw[2]);
            let share = f64::from(shares[layer].pixels()[index]);
            // The weights were rounded to `f32`, and a depth of 0.15 amplifies the error by 7.
            assert!((share - expected).abs() < 2e-6, "{share} for {expected}");
        }
    }
}

/// Returns the shares by height at a single pixel.
fn at_a_pixel(weights: &[f32], heights: &[f32], depth: f64) -> Vec<f32> {
    let rasters = |values: &[f32]| -> Vec<_> {
        let values = values.iter();
        values
            .map(|&v| Raster::filled([1, 1], v).unwrap())
            .collect()
    };
    let how = Weighting::Height { depth };
    let shares = shares(how, &rasters(weights), &rasters(heights), None);
    shares.iter().map(|share| share.pixels()[0]).collect()
}

#[test]
fn layers_fade_in_from_nothing_however_high_they_are() {
    let low = at_a_pixel(&[1e-6, 0.5, 0.5], &[1.0, 0.0, 0.0], 0.1);
    assert_eq!(low, [0.0, 0.5, 0.5], "next to no weight");
    for heights in [[1.0, 0.0, 0.0], [30.0, -5.0, -4.9], [1e6, 0.0, 0.0]] {
        for depth in [0.02, 0.1, 0.3, 5.0] {
            let share = |weight: f32| {
                let rest = 0.5 - 0.5 * weight;
                at_a_pixel(&[weight, rest, rest], &heights, depth)[0]
            };
            // Weights from almost 0 to 1, each 2 % below the next.
            let smaller = core::iter::successors(Some(1.0_f32), |weight| Some(0.98 * weight));
            let mut weights: Vec<f32> = smaller.take(1500).collect();
            weights.reverse();
            let all: Vec<f32> = weights.iter().map(|&weight| share(weight)).collect();
            assert_eq!(share(0.0), 0.0, "{heights:?} {depth}");
            assert!(all[0] < 1e-9, "{heights:?} {depth}: {}", all[0]);
            assert_eq!(all[1499], 1.0, "{heights:?} {depth}");
            for pair in all.windows(2) {
                assert!(pair[1] >= pair[0] - 1e-6, "{heights:?} {depth}: {pair:?}");
            }
        }
    }
}

#[test]
fn a_sixteenth_of_the_weights_is_out_for_heights_from_zero_to_one() {
    for n_others in 1..4_u8 {
        for depth in [0.01, 0.3, 1.0] {
            let rest = 15.0 / 16.0 / f32::from(n_others);
            let weights = [&[1.0 / 16.0][..], &vec![rest; n_others.into()]].concat();
            let heights = [&[1.0][..], &vec![0.0; n_others.into()]].concat();
            let share = at_a_pixel(&weights, &heights, depth)[0];
            assert_eq!(share, 0.0, "{n_others} others, depth {depth}");
        }
    }
}

#[test]
fn layers_fade_in_continuously() {
    for depth in [0.1, 0.3] {
        let share = |weight: f32| {
            let rest = 0.5 - 0.5 * weight;
            at_a_pixel(&[weight, rest, rest], &[1.0, 0.0, 0.0], depth)[0]
        };
        let n = 10_000_u16;
        let all: Vec<f32> = (0..=n)
            .map(|i| share(f32::from(i) / f32::from(n)))
            .collect();
        // The layer passes the others at a weight of about 0.15. There, the difference of levels increases by 1.5 + 1 /
        // 4α², or 13, per weight. The share changes by at most (1 - α) / α / depth, or 57, times as much: by 0.074 per
        // step.
        for (index, pair) in all.windows(2).enumerate() {
            assert!((pair[1] - pair[0]).abs() < 0.08, "{depth} at {index}");
        }
    }
}

#[test]
fn of_two_layers_the_higher_one_wins_around_the_middle() {
    for (weight, expected) in [(0.0, 0.0), (0.01, 0.0), (0.4, 1.0), (0.5, 1.0), (1.0, 1.0)] {
        let of_pixel = at_a_pixel(&[weight, 1.0 - weight], &[0.9, 0.5], 0.1);
        assert_eq!(of_pixel[0], expected, "weight {weight}");
    }
}

#[test]
fn heights_count_by_their_differences_in_any_range() {
    let weights = [0.2, 0.3, 0.5];
    let here = at_a_pixel(&weights, &[0.25, 0.5, 0.125], 0.25);
    for offset in [-3.0, 2.0, 64.0] {
        let there = at_a_pixel(&weights, &[0.25, 0.5, 0.125].map(|h| h + offset), 0.25);
        for (a, b) in here.iter().zip(there) {
            // Levels of up to 64, in `f64`.
            assert!((a - b).abs() < 1e-6, "{offset}: {here:?}");
        }
    }
}

#[test]
fn the_blend_tile_is_the_height_of_layers_without_one() {
    let weights = [0, 1].map(|seed| noise(SIZE, seed));
    let heights = [2, 3].map(|seed| noise(SIZE, seed));
    let how = Weighting::Height { depth: 0.2 };
    assert_eq!(
        shares(how, &weights, &heights[..1], Some(&heights[1])),
        shares(how, &weights, &heights, None)
    );
    let error = how
        .shares(&layers(&weights, &heights[..1]), None, &|| false)
        .unwrap_err();
    let expected = TileErrorKind::Count {
        what: "heights",
        count: 1,
        needed: "as many as layers, or a blend tile",
    };
    assert_eq!(error.kind(), &expected);
}

#[test]
fn weighting_refuses_bad_numbers() {
    let weight = [Raster::filled(SIZE, 1.0_f32).unwrap()];
    let tile = noise(SIZE, 1);
    let what = |weighting: Weighting, weights: &[Raster<f32>], tile: &Raster<f32>| {
        let error = weighting
            .shares(&layers(weights, &[]), Some(tile), &|| false)
            .unwrap_err();
        match error.kind() {
            TileErrorKind::Range { what, .. } => (*what).to_owned(),
            kind => format!("{kind:?}"),
        }
    };
    for depth in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(what(Weighting::Height { depth }, &weight, &tile), "depth");
    }
    for gain in [0.0, -1.0, f64::NAN, f64::INFINITY, 2e9] {
        assert_eq!(what(Weighting::Mask { gain }, &weight, &tile), "gain");
    }
    let mask = Weighting::Mask { gain: 1.0 };
    let outside = tile.map(|value| value + 0.5);
    assert_eq!(what(mask, &weight, &outside), "value of the blend tile");
    let nan = tile.map(|_| f32::NAN);
    assert!(what(mask, &weight, &nan).starts_with("NotFinite"));
    assert!(what(mask, std::slice::from_ref(&nan), &tile).starts_with("NotFinite"));
    let other_size = noise([3, 3], 1);
    assert!(what(mask, &weight, &other_size).starts_with("Raster"));
    let negative = [tile.map(|value| value - 0.5)];
    assert_eq!(what(mask, &negative, &tile), "smallest weight");
    let nothing = [tile.map(|_| 0.0)];
    assert_eq!(what(mask, &nothing, &tile), "sum of the weights");
    let error = mask.shares(&layers(&weight, &[]), None, &|| false);
    let error = error.unwrap_err();
    assert!(
        matches!(
            error.kind(),
            TileErrorKind::Count {
                what: "blend tiles",
                ..
            }
        ),
        "{error}"
    );
    let error = normalize(&[], &|| false).unwrap_err();
    assert!(
        matches!(error.kind(), TileErrorKind::Count { what: "layers", .. }),
        "{error}"
    );
}

proptest! {
    #[test]
    fn shares_of_any_weights_and_heights_are_finite(
        weights in prop::collection::vec(0.0..f32::MAX, 8),
        heights in prop::collection::vec(prop::num::f32::NORMAL | prop::num::f32::ZERO, 8),
        small in prop::num::f32::SUBNORMAL,
    ) {
        let raster = |values: &[f32]| Raster::from_vec([2, 2], values.to_vec()).unwrap();
        let weights = [raster(&weights[..4]), raster(&weights[4..]).map(|_| small.abs())];
        let heights = [raster(&heights[..4]), raster(&heights[4..])];
        let tile = noise([2, 2], 1);
        for weighting in all() {
            for shares in shares(weighting, &weights, &heights, Some(&tile)) {
                prop_assert!(shares.pixels().iter().all(|share| (0.0..=1.0).contains(share)));
            }
        }
    }
}
