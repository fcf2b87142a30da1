//! Tests of matched borders: any two tiles fit, and the rest does not change.

use super::{BorderSource, MatchBorders};
use crate::test_fields::{fbm, gravel, seam_ratio_of, top_power, turned};
use crate::{Map, TileErrorKind};
use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_raster::Raster;
use proptest::prelude::*;

fn matched(source: BorderSource, tiles: &[Raster<f32>]) -> Vec<Raster<f32>> {
    MatchBorders { width: 16, source }.apply(tiles).unwrap()
}

/// Returns the mean seam ratio of each ordered pair of tiles, along both axes, over many sets of tiles.
fn pair_ratios(source: BorderSource, set: impl Fn(u64) -> [Raster<f32>; 3]) -> [f64; 9] {
    let n_sets = 12;
    let mut ratios = [0.0; 9];
    for seed in 0..n_sets {
        let tiles = matched(source, &set(3 * seed));
        let turned: Vec<_> = tiles.iter().map(turned).collect();
        for (pair, ratio) in ratios.iter_mut().enumerate() {
            let [a, b] = [pair / 3, pair % 3];
            let both =
                seam_ratio_of(&tiles[a], &tiles[b], 1) + seam_ratio_of(&turned[a], &turned[b], 1);
            *ratio += both / (2.0 * n_sets as f64);
        }
    }
    ratios
}

#[test]
fn every_tile_fits_beside_every_other() {
    let size = [72, 72];
    for texture in [fbm, gravel] {
        let repeating = |seed: u64| [0, 1, 2].map(|index| texture(seed + index, size, true));
        let others = |seed: u64| [0, 1, 2].map(|index| texture(seed + index, size, false));
        for (what, ratios) in [
            (
                "tiles that repeat",
                pair_ratios(BorderSource::Border, repeating),
            ),
            (
                "tiles that do not",
                pair_ratios(BorderSource::Middle, others),
            ),
        ] {
            // 12 sets, 144 pixels of border each.
            assert!(
                ratios.iter().all(|ratio| (0.8..1.25).contains(ratio)),
                "{what}: {ratios:?}"
            );
        }
    }
}

#[test]
fn borders_of_all_tiles_are_the_same_pixels() {
    let tiles = [0, 1, 2].map(|seed| gravel(seed, [64, 48], false));
    for source in [BorderSource::Border, BorderSource::Middle] {
        let tiles = matched(source, &tiles);
        for (x, y) in (0..48).flat_map(|y| (0..64).map(move |x| (x, y))) {
            if x.min(63 - x).min(y.min(47 - y)) < 4 {
                let [a, b, c] = [0, 1, 2].map(|tile: usize| tiles[tile].row(y)[x as usize]);
                assert!(a == b && b == c, "{source:?} at {x}, {y}: {a} {b} {c}");
            }
        }
    }
}

#[test]
fn pixels_past_the_width_are_unchanged() {
    let tiles = [0, 1].map(|seed| fbm(seed, [50, 60], false));
    for source in [BorderSource::Border, BorderSource::Middle] {
        for (before, after) in tiles.iter().zip(matched(source, &tiles)) {
            let inside = |tile: &Raster<f32>| tile.crop([16, 16], [18, 28]).unwrap();
            assert_eq!(inside(before), inside(&after), "{source:?}");
        }
    }
}

#[test]
fn the_seam_of_the_first_tile_is_nowhere_seen_for_any_width() {
    for side in [4, 5, 12, 13, 40] {
        let first = Raster::from_fn(
            [side; 2],
            |x, y| if x == 0 || y == 0 { 1000.0 } else { 0.0 },
        );
        let tiles = [first.unwrap(), Raster::filled([side; 2], 0.0).unwrap()];
        let most = side / 2 - 1;
        for width in 1..=most {
            let options = MatchBorders {
                width,
                source: BorderSource::Middle,
            };
            let matched = options.apply(&tiles).unwrap();
            let flat = matched
                .iter()
                .all(|tile| tile.pixels().iter().all(|value| *value == 0.0));
            assert!(flat, "side {side}, width {width}");
        }
        let kind = MatchBorders {
            width: most + 1,
            source: BorderSource::Middle,
        };
        assert_eq!(
            kind.apply(&tiles).unwrap_err().kind(),
            &TileErrorKind::Margin {
                margin: most + 1,
                length: side,
                most
            }
        );
    }
}

#[test]
fn render_lays_each_place_with_one_of_the_tiles_and_windows_are_crops() {
    let tiles = [1, 2, 3].map(|seed| gravel(seed, [40, 44], true));
    let maps = tiles.each_ref().map(|tile| vec![Map::Value(tile.clone())]);
    let value = |first, size| {
        let options = MatchBorders::default();
        match options
            .render(&maps, Seed(3), first, size)
            .unwrap()
            .remove(0)
        {
            Map::Value(raster) => raster,
            other => panic!("{other:?}"),
        }
    };
    let matched = MatchBorders::default().apply(&tiles).unwrap();
    let whole = value([-80, -44], [240, 220]);
    let mut seen = [false; 3];
    for (i, j) in (0..5).flat_map(|j| (0..6).map(move |i| (i, j))) {
        let here = whole.crop([i * 40, j * 44], [40, 44]).unwrap();
        let index = matched.iter().position(|tile| *tile == here);
        seen[index.expect("one of the tiles")] = true;
    }
    assert_eq!(seen, [true; 3]);
    let part = value([-75, 30], [100, 60]);
    assert_eq!(part, whole.crop([5, 74], [100, 60]).unwrap());
}

proptest! {
    #[test]
    fn apply_gives_finite_tiles_or_a_typed_error(
        sizes in prop::collection::vec([1_u32..12, 1_u32..12], 0..3),
        same: bool, width in 0_u32..9, middle: bool,
        bad in prop_oneof![Just(0.0), Just(f32::NAN), Just(f32::INFINITY), Just(f32::MAX)],
    ) {
        let size = |index: usize| if same { sizes[0] } else { sizes[index] };
        let tiles: Vec<_> = (0..sizes.len())
            .map(|index| Raster::from_fn(size(index), |x, y| if x + y == 0 { bad } else { x as f32 }).unwrap())
            .collect();
        let source = if middle { BorderSource::Middle } else { BorderSource::Border };
        match (MatchBorders { width, source }).apply(&tiles) {
            Ok(matched) => {
                prop_assert!(bad.is_finite(), "{} was taken", bad);
                prop_assert!(matched.iter().zip(&tiles).all(|(a, b)| a.size() == b.size()));
            }
            Err(error) => prop_assert!(matches!(
                error.kind(),
                TileErrorKind::Count { .. } | TileErrorKind::Margin { .. } | TileErrorKind::Range { .. }
                    | TileErrorKind::Raster(_) | TileErrorKind::NotFinite { .. }
            ), "{}", error),
        }
    }
}

#[test]
fn equal_tiles_that_repeat_hardly_change_and_the_first_not_at_all() {
    let tile = gravel(4, [72, 72], true);
    let tiles = matched(BorderSource::Border, &[tile.clone(), tile.clone()]);
    assert_eq!(tiles[0], tile);
    let pixels = tiles[1].pixels().iter().zip(tile.pixels());
    let worst = pixels.fold(0.0_f32, |worst, (a, b)| worst.max((a - b).abs()));
    // The mean of two equal numbers, by weights that sum to 1 up to rounding.
    assert!(worst < 1e-6, "{worst}");
}

#[test]
fn all_maps_are_cut_alike() {
    let tiles = [1, 2].map(|seed| gravel(seed, [40, 44], true));
    let color = |gray: f32| LinearRgb::new(gray, gray, gray);
    let maps = tiles.each_ref().map(|tile| {
        vec![
            Map::Value(tile.clone()),
            Map::Color(tile.map(|&value| color(value))),
        ]
    });
    let both = MatchBorders::default().apply_maps(&maps).unwrap();
    let alone = MatchBorders::default().apply(&tiles).unwrap();
    for (maps, alone) in both.iter().zip(alone) {
        assert_eq!(maps[0], Map::Value(alone.clone()));
        assert_eq!(maps[1], Map::Color(alone.map(|&value| color(value))));
    }
}

#[test]
fn matched_tiles_keep_their_detail() {
    let mut sums = [0.0; 2];
    for seed in 0..16 {
        let tiles = [2 * seed, 2 * seed + 1].map(|seed| gravel(seed, [72, 72], true));
        let after = matched(BorderSource::Middle, &tiles);
        sums[0] += tiles.iter().map(top_power).sum::<f64>();
        sums[1] += after.iter().map(top_power).sum::<f64>();
    }
    let kept = sums[1] / sums[0];
    // 32 tiles of 64 stones. A mean along the cut loses detail, and stones that the cut splits add some.
    assert!(
        (0.95..1.08).contains(&kept),
        "power of the top octave {kept}"
    );
}

#[test]
fn apply_refuses_what_does_not_fit() {
    let kind = |width, tiles: &[Raster<f32>]| {
        let options = MatchBorders {
            width,
            ..MatchBorders::default()
        };
        options.apply(tiles).unwrap_err().kind().clone()
    };
    let tile = gravel(1, [20, 30], true);
    let two = [tile.clone(), tile.clone()];
    assert!(matches!(
        kind(4, &[]),
        TileErrorKind::Count {
            what: "tiles",
            count: 0,
            ..
        }
    ));
    assert_eq!(
        kind(11, &two),
        TileErrorKind::Margin {
            margin: 11,
            length: 20,
            most: 10
        }
    );
    assert!(matches!(kind(0, &two), TileErrorKind::Range { .. }));
    let other = gravel(1, [20, 31], true);
    assert!(matches!(
        kind(4, &[tile.clone(), other]),
        TileErrorKind::Raster(_)
    ));
    let bad = tile.map(|_| f32::NAN);
    assert!(matches!(
        kind(4, &[tile, bad]),
        TileErrorKind::NotFinite { .. }
    ));
    for size in [[1, 1], [1, 9], [3, 1]] {
        let tiles = [1.0, 2.0].map(|value| Raster::filled(size, value).unwrap());
        assert!(
            matches!(kind(1, &tiles), TileErrorKind::Margin { most: 0, .. }),
            "{size:?}"
        );
    }
    for (source, size) in [
        (BorderSource::Border, [2, 3]),
        (BorderSource::Middle, [4, 5]),
    ] {
        let tiles = [1.0, 2.0].map(|value| Raster::filled(size, value).unwrap());
        let tiles = MatchBorders { width: 1, source }.apply(&tiles).unwrap();
        assert!(tiles[1].row(0).iter().all(|&v| v == 1.0), "{source:?}");
    }
}

#[test]
fn value_stability_match_borders() {
    let tiles = [1, 2].map(|seed| gravel(seed, [40, 44], false));
    let tiles = matched(BorderSource::Middle, &tiles);
    let bits =
        [[0, 0], [7, 9], [10, 30]].map(|[x, y]: [usize; 2]| tiles[1].row(y as u32)[x].to_bits());
    assert_eq!(bits, [1044736711, 1026265202, 1050118888]);
}
