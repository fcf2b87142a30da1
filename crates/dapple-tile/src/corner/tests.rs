//! Corner tiles: that they fit, their order, windows, and the variance.

use super::CornerTiles;
use crate::TileErrorKind;
use crate::test_fields::{fbm, gravel, same_on_threads, seam_ratio_of, turned, variance};
use dapple_hash::Seed;
use dapple_raster::Raster;
use proptest::prelude::*;

fn tiles(count: u64, size: [u32; 2]) -> CornerTiles {
    let sources: Vec<_> = (0..count).map(|seed| gravel(seed, size, true)).collect();
    CornerTiles::new(&sources).unwrap()
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
        assert_eq!(all[0], tiles.sources[0], "one color shows its source");
    }
}

#[test]
fn tile_shows_at_each_corner_its_source() {
    let tiles = tiles(4, [36, 36]).with_width(0.5).unwrap();
    let tile = tiles.tile([2, 0, 3, 1]).unwrap();
    for (first, source) in [([0, 0], 2), ([27, 0], 0), ([0, 27], 3), ([27, 27], 1)] {
        let here = tile.crop(first, [9, 9]).unwrap();
        let there = tiles.sources[source].crop(first, [9, 9]).unwrap();
        let pixels = here.pixels().iter().zip(there.pixels());
        // Weights of 0 and 1: only the mean is taken off and put back.
        assert!(
            pixels.clone().all(|(a, b)| (a - b).abs() < 1e-6),
            "source {source}"
        );
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
        let set = CornerTiles::new(&sources)
            .unwrap()
            .with_width(width)
            .unwrap();
        let all = set.all().unwrap();
        let turned: Vec<_> = all.iter().map(turned).collect();
        let corner = |index: usize, place: u32| index / 2_usize.pow(place) % 2;
        let (mut sum, mut count) = (0.0, 0);
        for (a, b) in (0..16).flat_map(|a| (0..16).map(move |b| (a, b))) {
            let right = corner(a, 1) == corner(b, 0) && corner(a, 3) == corner(b, 2);
            let below = corner(a, 2) == corner(b, 0) && corner(a, 3) == corner(b, 1);
            for (fits, tiles) in [(right, &all), (below, &turned)] {
                if fits {
                    let ratio = seam_ratio_of(&tiles[a], &tiles[b], 1);
                    // Borders of 63 pixels cross seven stones: some have more of their edges than others.
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
fn tiles_of_smooth_sources_are_continuous_to_the_second_derivative() {
    // Slow waves: where tiles meet, a fourth difference is as small as inside of them.
    let wave = |turns: f64| {
        let angle = move |x: u32| f64::from(x) / 64.0 * turns * core::f64::consts::TAU;
        Raster::from_fn([64, 64], move |x, y| {
            (libm::sin(angle(x)) + libm::cos(angle(y))) as f32
        })
    };
    let set = CornerTiles::new(&[wave(1.0).unwrap(), wave(2.0).unwrap()]).unwrap();
    let map = set.render(Seed(2), [0, 0], [64 * 8, 64]).unwrap();
    let fourth = |at: usize, row: &[f32]| {
        let v = [0, 1, 2, 3, 4].map(|step| f64::from(row[at + step]));
        (v[0] - 4.0 * v[1] + 6.0 * v[2] - 4.0 * v[3] + v[4]).abs()
    };
    let worst = |columns: &dyn Fn(usize) -> bool| {
        let ats = (0..64 * 8 - 4).filter(|at| columns(*at));
        let rows = (0..64).flat_map(|row| ats.clone().map(move |at| (row, at)));
        rows.fold(0.0_f64, |worst, (row, at)| {
            worst.max(fourth(at, map.row(row)))
        })
    };
    let [seam, inside] = [worst(&|at| at % 64 >= 60), worst(&|at| at % 64 < 60)];
    assert!(seam <= inside, "{seam} where tiles meet, {inside} inside");
}

#[test]
fn render_shows_the_tiles_of_its_corners() {
    let tiles = tiles(3, [20, 22]);
    let map = tiles.render(Seed(3), [0, 0], [100, 88]).unwrap();
    let all = tiles.all().unwrap();
    for (i, j) in (0..4).flat_map(|j| (0..5).map(move |i| (i, j))) {
        let here = map.crop([i * 20, j * 22], [20, 22]).unwrap();
        assert!(all.contains(&here), "tile {i}, {j}");
    }
}

#[test]
fn render_of_a_window_is_the_crop_of_the_whole() {
    let tiles = tiles(4, [19, 23]);
    let whole = tiles.render(Seed(5), [-50, -60], [130, 140]).unwrap();
    for (first, size) in [([0, 0], [1, 1]), ([17, 30], [70, 50]), ([129, 0], [1, 140])] {
        let origin = [first[0] as i64 - 50, first[1] as i64 - 60];
        let part = tiles.render(Seed(5), origin, size).unwrap();
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
        let map = CornerTiles::new(&four)
            .unwrap()
            .render(Seed(set), [0, 0], [side * 4; 2])
            .unwrap();
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
    // Four regions: corners, middles of edges along x and along y, and the middle.
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
        let kind = CornerTiles::new(&sources).unwrap_err().kind().clone();
        assert!(
            matches!(kind, TileErrorKind::Count { .. }),
            "{count}: {kind:?}"
        );
    }
    let other = gravel(1, [18, 19], true);
    assert!(
        CornerTiles::new(&[source.clone(), other]).is_err(),
        "two sizes"
    );
    let bad = source.map(|_| f32::INFINITY);
    assert!(
        CornerTiles::new(&[source.clone(), bad]).is_err(),
        "not finite"
    );
    let tiles = CornerTiles::new(&[source.clone(), source]).unwrap();
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
        let tiles = CornerTiles::new(&sources)
            .unwrap()
            .with_width(1e-300)
            .unwrap();
        let map = tiles.render(Seed(1), [-3, -3], [8, 8]).unwrap();
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
        let map = CornerTiles::new(&sources)
            .and_then(|tiles| tiles.with_width(width))
            .and_then(|tiles| tiles.render(Seed(seed), first, size));
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
    assert!(same_on_threads(|| tiles
        .render(Seed(5), [-9, 4], [150, 170])
        .unwrap()));
}

#[test]
fn value_stability_corner() {
    let map = tiles(3, [36, 45])
        .render(Seed(7), [-30, -30], [90, 90])
        .unwrap();
    let bits = [[0, 0], [10, 15], [50, 50], [89, 89]]
        .map(|[x, y]: [usize; 2]| map.row(y as u32)[x].to_bits());
    assert_eq!(bits, [1046551758, 1059443493, 1044759232, 1051641123]);
}
