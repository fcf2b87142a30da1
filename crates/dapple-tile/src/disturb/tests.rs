//! Tests of disturbed copies: unchanged borders, changed interiors, windows, and the variance.

use super::{Disturbance, shift};
use crate::test_fields::{check_cancel, gravel, same_on_threads, seam_ratio_of, variance};
use crate::{
    Blend, BlendMap, CornerTiles, Layer, Map, MatchBorders, Mixing, Pyramid, TileErrorKind,
    Weighting, blend, blend_cancellable,
};
use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_raster::Raster;
use proptest::prelude::*;

#[test]
fn render_keeps_the_frozen_border_of_every_copy_bit_for_bit() {
    let tile = gravel(1, [48, 56], true);
    let disturbance = Disturbance {
        frozen: 5,
        margin: 10,
        seed: Seed(3),
    };
    let map = disturbance.render(&tile, [-96, -56], [192, 168]).unwrap();
    let mut n_changed = 0;
    for row in 0..168 {
        for column in 0..192 {
            let [x, y] = [column % 48, row % 56];
            let from_border = x.min(47 - x).min(y.min(55 - y));
            let [own, there] = [tile.row(y)[x as usize], map.row(row)[column as usize]];
            if from_border < 5 {
                assert_eq!(own.to_bits(), there.to_bits(), "column {column}, row {row}");
            } else {
                n_changed += usize::from(own != there);
            }
        }
    }
    // Stones have a constant shade, so some pixels are replaced by equal ones.
    assert!(n_changed > 192 * 168 / 4, "only {n_changed} pixels changed");
}

#[test]
fn render_shows_a_shifted_tile_in_the_middle_of_each_copy() {
    let tile = gravel(2, [40, 40], true);
    let disturbance = Disturbance {
        frozen: 2,
        margin: 12,
        seed: Seed(4),
    };
    let map = disturbance.render(&tile, [0, 0], [80, 40]).unwrap();
    let twice = tile.tile([2, 2]).unwrap();
    let middles = [[20, 20], [60, 20]].map(|[x, y]| map.crop([x - 1, y - 1], [3, 3]).unwrap());
    let shifts = middles.each_ref().map(|middle| {
        let shifts = (0..40).flat_map(|y| (0..40).map(move |x| [x, y]));
        let fits = |at: &[u32; 2]| twice.crop(*at, [3, 3]).unwrap().pixels() == middle.pixels();
        shifts.filter(fits).collect::<Vec<_>>()
    });
    assert!(
        shifts.iter().all(|found| !found.is_empty()),
        "a piece of the tile: {shifts:?}"
    );
    assert_ne!(middles[0], middles[1], "copies differ");
}

#[test]
fn render_of_a_window_is_the_crop_of_the_whole() {
    let tile = gravel(3, [57, 60], true);
    let disturbance = Disturbance::new(Seed(5));
    let whole = disturbance.render(&tile, [-100, -70], [260, 200]).unwrap();
    for (first, size) in [
        ([0, 0], [1, 1]),
        ([37, 90], [120, 60]),
        ([259, 0], [1, 200]),
    ] {
        let origin = [first[0] as i64 - 100, first[1] as i64 - 70];
        let part = disturbance.render(&tile, origin, size).unwrap();
        assert_eq!(part, whole.crop(first, size).unwrap(), "{first:?} {size:?}");
    }
    for far in [i64::MIN, i64::MAX] {
        assert!(
            disturbance.render(&tile, [far; 2], [50, 50]).is_ok(),
            "no overflow"
        );
    }
}

#[test]
fn render_keeps_the_variance_and_has_no_seam() {
    let (mut tiles, mut maps, mut ratio) = (Vec::new(), Vec::new(), 0.0);
    for seed in 0..12 {
        let tile = gravel(seed, [63, 63], true);
        let map = Disturbance::new(Seed(seed))
            .render(&tile, [0, 0], [252, 252])
            .unwrap();
        let [left, right] = [[0, 0], [63, 0]].map(|first| map.crop(first, [63, 252]).unwrap());
        ratio += seam_ratio_of(&left, &right, 1) / 12.0;
        tiles.push(tile);
        maps.push(map);
    }
    let kept = variance(&maps) / variance(&tiles);
    // 12 tiles of 49 stones, whose variance is known up to a few percent.
    assert!((0.95..1.05).contains(&kept), "variance {kept}");
    // The frozen border is the only part of the tile that does not vary: 12 · 63 pixels of stones of 9 pixels.
    assert!((0.85..1.15).contains(&ratio), "seam ratio {ratio}");
}

#[test]
fn render_shows_the_tile_or_its_shifted_self_but_along_a_thin_line() {
    let tile = gravel(2, [60, 60], true);
    let disturbance = Disturbance::new(Seed(4));
    let map = disturbance.render(&tile, [0, 0], [240, 240]).unwrap();
    // Three adjacent pixels that do not occur in the tile contain a blended pixel.
    let bits = |piece: &[f32]| [0, 1, 2].map(|at| piece[at].to_bits());
    let tripled = tile.tile([2, 1]).unwrap();
    let pieces = tripled.view();
    let known: Vec<_> = pieces
        .rows()
        .flat_map(|row| row.windows(3).map(bits))
        .collect();
    let map = map.view();
    let pieces = map.rows().flat_map(|row| row.windows(3).map(bits));
    let (mut n_pieces, mut n_strange) = (0, 0);
    for piece in pieces {
        n_pieces += 1;
        n_strange += u32::from(!known.contains(&piece));
    }
    // A cut has the length of about four sides of 50 pixels, and each of its rows affects five runs of three pixels.
    let most = 16 * 4 * 50 * 5;
    assert!(n_strange < most, "{n_strange} of {n_pieces}");
}

#[test]
fn render_maps_shifts_all_maps_alike() {
    let tile = gravel(6, [48, 48], true);
    let color = tile.map(|&value| LinearRgb::new(value, value, value));
    let maps = [Map::Value(tile.clone()), Map::Color(color)];
    let disturbance = Disturbance {
        margin: 20,
        ..Disturbance::new(Seed(8))
    };
    let maps = disturbance.render_maps(&maps, [7, -9], [100, 70]).unwrap();
    let expected = disturbance.render(&tile, [7, -9], [100, 70]).unwrap();
    assert_eq!(maps[0], Map::Value(expected.clone()));
    assert_eq!(
        maps[1],
        Map::Color(expected.map(|&value| LinearRgb::new(value, value, value)))
    );
    let none = disturbance.render_maps(&[], [0, 0], [9, 9]).unwrap_err();
    assert!(matches!(none.kind(), TileErrorKind::Count { .. }), "{none}");
    let other = Map::Value(gravel(6, [48, 49], true));
    assert!(
        disturbance
            .render_maps(&[maps[0].clone(), other], [0, 0], [9, 9])
            .is_err()
    );
}

#[test]
fn shift_is_at_least_a_quarter_of_the_side_either_way_round() {
    for side in (2..=40).chain([1 << 20, u32::MAX]) {
        let shifts = [0, 1 << 31, 1 << 63, u64::MAX].map(|bits| shift(bits, side));
        for shift in shifts.map(u64::from) {
            let side = u64::from(side);
            assert!(
                4 * shift >= side && 4 * (side - shift) >= side,
                "{shift} of {side}"
            );
        }
        // Both limits are reached: one pixel less or more would be outside of the range.
        let [least, most] = [shifts[0], shifts[3]].map(u64::from);
        assert!(4 * (least - 1) < side.into(), "{least} of {side}");
        assert!(4 * (most + 1) > 3 * u64::from(side), "{most} of {side}");
    }
    assert_eq!([0, u64::MAX].map(|bits| shift(bits, 1)), [0, 0]);
}

#[test]
fn render_refuses_what_does_not_fit() {
    let disturbance = Disturbance::new(Seed(1));
    for size in [[1, 1], [2, 2], [1, 64], [64, 55]] {
        let error = disturbance.render(
            &gravel(1, [64, 64], true).crop([0, 0], size).unwrap(),
            [0, 0],
            [9, 9],
        );
        let kind = error.unwrap_err().kind().clone();
        assert!(
            matches!(kind, TileErrorKind::Margin { margin: 28, .. }),
            "{size:?}: {kind:?}"
        );
    }
    let hard = Disturbance {
        frozen: 0,
        margin: 0,
        seed: Seed(1),
    };
    for size in [[1, 1], [2, 2], [1, 5], [5, 4]] {
        let tile = Raster::from_fn(size, |x, y| (x + y) as f32).unwrap();
        assert!(hard.render(&tile, [-3, -3], [9, 9]).is_ok(), "{size:?}");
    }
    let vast = Disturbance {
        frozen: u32::MAX,
        margin: u32::MAX,
        seed: Seed(1),
    };
    let tile = gravel(1, [64, 64], true);
    assert!(matches!(
        vast.render(&tile, [0, 0], [9, 9]).unwrap_err().kind(),
        TileErrorKind::Margin { .. }
    ));
    let empty = disturbance.render(&tile, [0, 0], [0, 9]).unwrap_err();
    assert!(matches!(empty.kind(), TileErrorKind::Raster(_)), "{empty}");
    let bad = tile.map(|_| f32::NAN);
    assert!(matches!(
        disturbance.render(&bad, [0, 0], [9, 9]).unwrap_err().kind(),
        TileErrorKind::NotFinite { .. }
    ));
}

proptest! {
    #[test]
    fn render_gives_a_finite_map_or_a_typed_error(
        tile_size in [1_u32..24, 1_u32..24], frozen in 0_u32..6, margin in 0_u32..6, seed: u64,
        first: [i64; 2], size in [0_u32..20, 0_u32..20],
        bad in prop_oneof![Just(0.0), Just(f32::NAN), Just(f32::NEG_INFINITY)],
    ) {
        let tile = Raster::from_fn(tile_size, |x, y| if x + y == 0 { bad } else { x as f32 }).unwrap();
        let disturbance = Disturbance { frozen, margin, seed: Seed(seed) };
        match disturbance.render(&tile, first, size) {
            Ok(map) => {
                prop_assert_eq!(map.size(), size);
                prop_assert!(map.pixels().iter().all(|value| value.is_finite()));
            }
            Err(error) => prop_assert!(matches!(
                error.kind(),
                TileErrorKind::Margin { .. } | TileErrorKind::Raster(_) | TileErrorKind::NotFinite { .. }
            ), "{}", error),
        }
    }
}

#[test]
fn render_has_the_same_bits_on_any_number_of_threads() {
    let tile = gravel(3, [57, 60], true);
    let disturbance = Disturbance::new(Seed(5));
    assert!(same_on_threads(|| disturbance
        .render(&tile, [-9, 4], [150, 170])
        .unwrap()));
}

#[test]
fn value_stability_disturb() {
    let tile = gravel(9, [48, 40], true);
    let disturbance = Disturbance {
        margin: 16,
        ..Disturbance::new(Seed(7))
    };
    let map = disturbance.render(&tile, [-30, -30], [90, 90]).unwrap();
    let bits = [[0, 0], [10, 15], [50, 50], [89, 89]]
        .map(|[x, y]: [usize; 2]| map.row(y as u32)[x].to_bits());
    assert_eq!(bits, [1052928431, 1063551567, 1059975078, 1057285837]);
}

#[test]
fn work_on_whole_tiles_can_be_cancelled_at_every_call() {
    let tiles = [1, 2].map(|seed| vec![Map::Value(gravel(seed, [64; 2], true))]);
    let disturbance = Disturbance::new(Seed(7));
    let made = disturbance
        .render_maps(&tiles[0], [0, 0], [192, 128])
        .unwrap();
    let n_calls = check_cancel(&made, |stop| {
        disturbance.render_maps_cancellable(&tiles[0], [0, 0], [192, 128], stop)
    });
    assert!(n_calls > 3 * 2 * 4, "for each cut of each copy: {n_calls}");

    let matching = MatchBorders::default();
    let made = matching.apply_maps(&tiles).unwrap();
    let n_calls = check_cancel(&made, |stop| matching.apply_maps_cancellable(&tiles, stop));
    assert!(n_calls > 4, "for each cut of the second tile: {n_calls}");

    let texture = gravel(3, [64; 2], true);
    let made = BlendMap::new(8.0).apply(&texture).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        BlendMap::new(8.0).apply_cancellable(&texture, stop)
    });
    assert_eq!(n_calls, 5, "before each blur and the median");

    let made = CornerTiles::new(&tiles).unwrap().with_width(0.25).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        CornerTiles::new_cancellable(&tiles, 0.25, stop)
    });
    assert!(n_calls > 4 + 16, "before each cut: {n_calls}");
    let maps = made.render(Seed(7), [0, 0], [1000, 130]).unwrap();
    let n_calls = check_cancel(&maps, |stop| {
        made.render_cancellable(Seed(7), [0, 0], [1000, 130], stop)
    });
    assert_eq!(n_calls, 2, "once per 65,536 pixels");

    // Each pass is over three times 65,536 pixels.
    let [width, height] = [256, 768];
    let weight = Raster::filled([width, height], 1.0).unwrap();
    let tiles = [1.0, 2.0].map(|value| weight.map(|_| value));
    let [a, b] = &tiles.map(|tile| vec![Map::Value(tile)]);
    let layers = [a, b].map(|maps| Layer {
        maps,
        weight: &weight,
        height: None,
    });
    let pyramid = Mixing::Pyramid(Pyramid::default());
    for mixing in [Mixing::Linear, Mixing::KeepVariance, pyramid] {
        let how = Blend::new(Weighting::Given, mixing);
        let made = blend(&layers, &how).unwrap();
        let n_calls = check_cancel(&made, |stop| blend_cancellable(&layers, None, &how, stop));
        // Both weights are added and divided, and both planes are mixed at once. There are four calls before both layers,
        // the shares and the planes.
        let least = 3 * (4 + 1) + 4;
        assert!(n_calls >= least, "for each pass, {mixing:?}: {n_calls}");
    }
}
