//! Tests of corner tiles: their fit and order, windows, and the variance.

use super::{CornerTiles, Cuts};
use crate::disturb::rolled;
use crate::test_fields::{beside, fbm, gravel, same_on_threads, seam_ratio_of, turned, variance};
use crate::{Map, SeamOptions, SeamReport, TileError, TileErrorKind};
use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_raster::Raster;
use proptest::prelude::*;

/// Builds the tiles of sources that have a single value map each.
fn of(sources: &[Raster<f32>]) -> Result<CornerTiles, TileError> {
    let maps = sources
        .iter()
        .map(|source| vec![Map::Value(source.clone())]);
    CornerTiles::new(&maps.collect::<Vec<_>>())
}

fn tiles(count: u64, size: [u32; 2]) -> CornerTiles {
    let sources: Vec<_> = (0..count).map(|seed| gravel(seed, size, true)).collect();
    of(&sources).unwrap()
}

/// Returns the values of a single map.
fn value(maps: Vec<Map>) -> Raster<f32> {
    match <[Map; 1]>::try_from(maps) {
        Ok([Map::Value(raster)]) => raster,
        other => panic!("{other:?}"),
    }
}

#[test]
fn all_tiles_are_in_the_order_of_their_colors() {
    for count in [2, 3, 4] {
        let tiles = tiles(count, [18, 18]);
        let all = tiles.all().unwrap();
        assert_eq!(all.len() as u64, count.pow(4));
        let colors = [1, 0, count as u8 - 1, 1];
        let index: u64 = (0..4)
            .map(|place| u64::from(colors[place as usize]) * count.pow(place))
            .sum();
        assert_eq!(all[index as usize], tiles.tile(colors).unwrap());
        assert_eq!(
            value(all[0].clone()),
            tiles.sources[0][0],
            "one color shows its source"
        );
    }
}

#[test]
fn tile_shows_at_each_corner_its_source() {
    let tiles = tiles(4, [36, 36]).with_width(0.5).unwrap();
    let tile = value(tiles.tile([2, 0, 3, 1]).unwrap());
    for (first, source) in [([0, 0], 2), ([27, 0], 0), ([0, 27], 3), ([27, 27], 1)] {
        let here = tile.crop(first, [9, 9]).unwrap();
        let there = tiles.sources[source][0].crop(first, [9, 9]).unwrap();
        assert_eq!(here, there, "source {source}");
    }
}

#[test]
fn tiles_fit_wherever_their_corners_agree() {
    for (width, texture) in [
        (0.2, gravel as fn(u64, [u32; 2], bool) -> _),
        (0.5, fbm),
        (1.0, gravel),
    ] {
        let sources = [1, 2].map(|seed| texture(seed, [63, 63], true));
        let set = of(&sources).unwrap().with_width(width).unwrap();
        let all: Vec<_> = set.all().unwrap().into_iter().map(value).collect();
        let turned: Vec<_> = all.iter().map(turned).collect();
        let corner = |index: usize, place: u32| index / 2_usize.pow(place) % 2;
        let (mut sum, mut count) = (0.0, 0);
        for (a, b) in (0..16).flat_map(|a| (0..16).map(move |b| (a, b))) {
            let right = corner(a, 1) == corner(b, 0) && corner(a, 3) == corner(b, 2);
            let below = corner(a, 2) == corner(b, 0) && corner(a, 3) == corner(b, 1);
            for (fits, tiles) in [(right, &all), (below, &turned)] {
                if fits {
                    let ratio = seam_ratio_of(&tiles[a], &tiles[b], 1);
                    // Borders of 63 pixels cross seven stones, some at more edges than others.
                    assert!((0.5..1.7).contains(&ratio), "{a} and {b}: {ratio}");
                    sum += ratio;
                    count += 1;
                }
            }
        }
        assert_eq!(count, 128, "64 pairs each way");
        let mean = sum / f64::from(count);
        assert!(
            (0.8..1.25).contains(&mean),
            "mean seam ratio {mean} at width {width}"
        );
    }
}

#[test]
fn a_tile_is_made_of_whole_pieces_of_its_sources() {
    // A cut blends three pixels of each line that it crosses. One or two cuts run from top to bottom, one from left to
    // right.
    let most = 3 * 3 * 60;
    for texture in [fbm, gravel] {
        for seed in 0..6 {
            let sources = [0, 1, 2, 3].map(|index| texture(4 * seed + index, [60, 60], true));
            let tile = value(of(&sources).unwrap().tile([0, 1, 2, 3]).unwrap());
            let is_copy = |at: usize| {
                let values = sources.each_ref().map(|source| source.pixels()[at]);
                values.contains(&tile.pixels()[at])
            };
            let n_mixed = (0..3600).filter(|at| !is_copy(*at)).count();
            assert!(n_mixed <= most, "{n_mixed} of 3600 pixels are mixed");
        }
    }
}

#[test]
fn cuts_pass_the_seam_report_of_a_picture_that_wraps_there() {
    // Two tiles that repeat together, rolled so that the band of the top-to-bottom cut is where the image wraps.
    let n_sets = 12;
    let mut ratio = 0.0;
    for seed in 0..n_sets {
        let sources = [2 * seed, 2 * seed + 1].map(|seed| gravel(seed, [64, 64], true));
        let set = of(&sources).unwrap();
        let [left, right] = [[0, 1, 0, 1], [1, 0, 1, 0]].map(|colors| set.tile(colors));
        let both = beside(&value(left.unwrap()), &value(right.unwrap()));
        for at in (20..44).step_by(4) {
            let rolled = rolled(&both, [at, 0]).unwrap();
            let report = SeamReport::of(&rolled, &SeamOptions::default()).unwrap();
            ratio += report.seams[0].x.unwrap().ratio / (6 * n_sets) as f64;
        }
    }
    // 72 columns of 64 pixels, of stones of 9.
    assert!((0.9..1.1).contains(&ratio), "seam ratio {ratio}");
}

#[test]
fn cuts_go_on_in_the_tile_beside() {
    let set = tiles(3, [40, 52]);
    let n = 3;
    for (index, cut) in set.cuts.across.iter().enumerate() {
        for (next, other) in set.cuts.across.iter().enumerate() {
            let corner = |index: usize, place: u32| index / 3_usize.pow(place) % n;
            let [upper, lower] = [corner(index, 1), corner(index, 3)];
            let fits = [corner(next, 0), corner(next, 2)] == [upper, lower];
            // A cut between two pieces of one source should be invisible.
            if fits && upper != lower {
                let step = cut.ends()[1].abs_diff(other.ends()[0]);
                assert!(step <= 1, "{step} pixels from tile {index} to {next}");
            }
        }
    }
    for cut in &set.cuts.beside {
        assert!(cut.ends()[0].abs_diff(cut.ends()[1]) <= 1, "{cut:?}");
    }
}

#[test]
fn all_maps_are_cut_alike() {
    let sources = [1, 2].map(|seed| gravel(seed, [36, 36], true));
    let color = |gray: f32| LinearRgb::new(gray, gray, gray);
    let maps = sources.each_ref().map(|source| {
        vec![
            Map::Value(source.clone()),
            Map::Color(source.map(|&value| color(value))),
        ]
    });
    let set = CornerTiles::new(&maps).unwrap();
    let alone = of(&sources).unwrap();
    let both = set.render(Seed(2), [5, -7], [90, 80]).unwrap();
    let expected = value(alone.render(Seed(2), [5, -7], [90, 80]).unwrap());
    assert_eq!(both[0], Map::Value(expected.clone()));
    assert_eq!(both[1], Map::Color(expected.map(|&value| color(value))));
}

#[test]
fn render_with_a_period_repeats_exactly() {
    let tiles = tiles(4, [19, 23]).with_period([Some(3), Some(2)]).unwrap();
    let map = value(tiles.render(Seed(5), [0, 0], [19 * 6, 23 * 4]).unwrap());
    let period = map.crop([0, 0], [19 * 3, 23 * 2]).unwrap();
    assert_eq!(map, period.tile([2, 2]).unwrap());
    let error = tiles.with_period([None, Some(0)]).unwrap_err();
    assert!(matches!(error.kind(), TileErrorKind::Range { .. }));
}

#[test]
fn a_wider_band_never_costs_more() {
    let sources = [1, 2].map(|seed| vec![fbm(seed, [48, 48], true)]);
    let seam = |width: f64| {
        let cuts = Cuts::new(&sources, width, &|| false).unwrap();
        let row = |row: u32| {
            let cut = cuts.beside[2].clone();
            let weights = (0..48).map(move |column| cut.weight(column, row));
            let pixels = sources[0][0].row(row).iter().zip(sources[1][0].row(row));
            let lost = weights
                .zip(pixels)
                .map(|(w, (a, b))| w * (1.0 - w) * f64::from(a - b) * f64::from(a - b));
            lost.sum::<f64>()
        };
        (0..48).map(row).sum::<f64>()
    };
    let seams = [0.2, 0.4, 0.6, 0.8].map(seam);
    // Sums of the same terms in another order.
    assert!(
        seams
            .windows(2)
            .all(|pair| pair[1] <= pair[0] * (1.0 + 1e-9)),
        "{seams:?}"
    );
    assert!(seams[3] < seams[0], "{seams:?}");
}

#[test]
fn render_shows_the_tiles_of_its_corners() {
    let tiles = tiles(3, [20, 22]);
    let map = value(tiles.render(Seed(3), [0, 0], [100, 88]).unwrap());
    let all: Vec<_> = tiles.all().unwrap().into_iter().map(value).collect();
    for (i, j) in (0..4).flat_map(|j| (0..5).map(move |i| (i, j))) {
        let here = map.crop([i * 20, j * 22], [20, 22]).unwrap();
        assert!(all.contains(&here), "tile {i}, {j}");
    }
}

#[test]
fn render_of_a_window_is_the_crop_of_the_whole() {
    let tiles = tiles(4, [19, 23]);
    let whole = value(tiles.render(Seed(5), [-50, -60], [130, 140]).unwrap());
    for (first, size) in [([0, 0], [1, 1]), ([17, 30], [70, 50]), ([129, 0], [1, 140])] {
        let origin = [first[0] as i64 - 50, first[1] as i64 - 60];
        let part = value(tiles.render(Seed(5), origin, size).unwrap());
        assert_eq!(part, whole.crop(first, size).unwrap(), "{first:?} {size:?}");
    }
    for far in [i64::MIN, i64::MAX] {
        assert!(
            tiles.render(Seed(5), [far; 2], [50, 50]).is_ok(),
            "no overflow"
        );
    }
}

#[test]
fn render_has_the_variance_of_its_sources_at_every_place_of_a_tile() {
    let side = 64;
    let mut sums = vec![[0.0; 2]; (side * side) as usize];
    let mut sources = Vec::new();
    let n_sets = 60;
    for set in 0..n_sets {
        let four = [0, 1, 2, 3].map(|index| gravel(4 * set + index, [side; 2], true));
        let map = of(&four).unwrap().render(Seed(set), [0, 0], [side * 4; 2]);
        let map = value(map.unwrap());
        sources.extend(four);
        for (row, values) in map.view().rows().enumerate() {
            for (column, value) in values.iter().enumerate() {
                let sum = &mut sums[row % 64 * 64 + column % 64];
                sum[0] += f64::from(*value);
                sum[1] += f64::from(*value) * f64::from(*value);
            }
        }
    }
    let expected = variance(&sources);
    let n_values = 16.0 * n_sets as f64;
    let whole = sums
        .iter()
        .fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    let mean = whole[0] / (n_values * 4096.0);
    let all = whole[1] / (n_values * 4096.0) - mean * mean;
    assert!((all / expected - 1.0).abs() < 0.05, "{all} of {expected}");
    // Four regions: corners, centers of edges along x and along y, and the center.
    let near = |at: usize, place: usize| at.abs_diff(place) < 10 || (place == 0 && at > 54);
    for (x, y) in [(0, 0), (32, 0), (0, 32), (32, 32)] {
        let region = (0..4096).filter(|at| near(at % 64, x) && near(at / 64, y));
        let (mut sum, mut count) = (0.0, 0.0);
        for at in region {
            sum += sums[at][1] / n_values - mean * mean;
            count += 1.0;
        }
        let ratio = sum / count / expected;
        // 60 sets of independent sources, 4 stones in each region.
        assert!((0.9..1.1).contains(&ratio), "around {x}, {y}: {ratio}");
    }
}

#[test]
fn new_and_tile_refuse_what_does_not_fit() {
    let source = gravel(1, [18, 18], true);
    for count in [0, 1, 5] {
        let sources = vec![source.clone(); count];
        let kind = of(&sources).unwrap_err().kind().clone();
        assert!(
            matches!(kind, TileErrorKind::Count { .. }),
            "{count}: {kind:?}"
        );
    }
    let other = gravel(1, [18, 19], true);
    assert!(of(&[source.clone(), other]).is_err(), "two sizes");
    let bad = source.map(|_| f32::INFINITY);
    assert!(of(&[source.clone(), bad]).is_err(), "not finite");
    let maps = vec![Map::Value(source.clone())];
    let count = |maps: &[Vec<Map>]| CornerTiles::new(maps).unwrap_err().kind().clone();
    for bad in [vec![], [maps.clone(), maps.clone()].concat()] {
        let kind = count(&[maps.clone(), bad]);
        assert!(
            matches!(kind, TileErrorKind::Count { what: "maps", .. }),
            "{kind:?}"
        );
    }
    let color = source.map(|_| LinearRgb::BLACK);
    let kind = count(&[maps.clone(), vec![Map::Color(color)]]);
    assert_eq!(kind, TileErrorKind::KindMismatch { map: 0 });
    let tiles = of(&[source.clone(), source]).unwrap();
    for width in [0.0, -1.0, 1.1, f64::NAN, f64::INFINITY] {
        assert!(tiles.clone().with_width(width).is_err(), "{width}");
    }
    let kind = tiles.tile([0, 1, 2, 0]).unwrap_err().kind().clone();
    assert!(matches!(kind, TileErrorKind::Range { .. }), "{kind:?}");
    assert!(
        tiles.render(Seed(1), [0, 0], [0, 1]).is_err(),
        "an empty map"
    );
    for size in [[1, 1], [2, 2], [1, 7]] {
        let sources = [1.0, 2.0].map(|value| Raster::filled(size, value).unwrap());
        let tiles = of(&sources).unwrap().with_width(1e-300).unwrap();
        let map = value(tiles.render(Seed(1), [-3, -3], [8, 8]).unwrap());
        assert!(
            map.pixels().iter().all(|value| (1.0..=2.0).contains(value)),
            "{size:?}"
        );
    }
}

proptest! {
    #[test]
    fn corner_tiles_are_finite_or_refused_with_a_typed_error(
        sizes in prop::collection::vec([1_u32..9, 1_u32..9], 0..6), same: bool,
        width in prop_oneof![-0.5..1.5, Just(f64::NAN)], seed: u64,
        first: [i64; 2], size in [0_u32..20, 0_u32..20],
        bad in prop_oneof![Just(0.0), Just(f32::NAN), Just(f32::INFINITY)],
    ) {
        let size_of = |index: usize| if same { sizes[0] } else { sizes[index] };
        let sources: Vec<_> = (0..sizes.len())
            .map(|index| Raster::from_fn(size_of(index), |x, y| if x + y == 0 { bad } else { y as f32 }).unwrap())
            .collect();
        let map = of(&sources)
            .and_then(|tiles| tiles.with_width(width))
            .and_then(|tiles| tiles.render(Seed(seed), first, size))
            .map(value);
        match map {
            Ok(map) => {
                prop_assert_eq!(map.size(), size);
                prop_assert!(map.pixels().iter().all(|value| value.is_finite()));
            }
            Err(error) => prop_assert!(matches!(
                error.kind(),
                TileErrorKind::Count { .. } | TileErrorKind::Range { .. } | TileErrorKind::Raster(_)
                    | TileErrorKind::NotFinite { .. }
            ), "{}", error),
        }
    }
}

#[test]
fn render_has_the_same_bits_on_any_number_of_threads() {
    let tiles = tiles(3, [19, 23]);
    assert!(same_on_threads(|| value(
        tiles.render(Seed(5), [-9, 4], [150, 170]).unwrap()
    )));
}

#[test]
fn value_stability_corner() {
    let tiles = tiles(3, [36, 45]);
    let map = value(tiles.render(Seed(7), [-30, -30], [90, 90]).unwrap());
    let bits = [[0, 0], [10, 15], [50, 50], [89, 89]]
        .map(|[x, y]: [usize; 2]| map.row(y as u32)[x].to_bits());
    assert_eq!(bits, [1046551758, 1059186353, 1042645693, 1051661856]);
}
