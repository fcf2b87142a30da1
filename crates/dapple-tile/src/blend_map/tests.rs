//! Blend maps of stones with known cracks.

use super::BlendMap;
use crate::{TileErrorKind, rank_equalize};
use core::ops::Range;
use dapple_color::LinearRgb;
use dapple_hash::{Seed, hash2, unit_f64};
use dapple_raster::{Raster, Wrap};
use proptest::prelude::*;

const SIDE: u32 = 128;

/// Gray stones around jittered points on a torus.
#[derive(Clone, Copy, Debug)]
struct Stones {
    seed: u64,
    /// Distance between neighboring points, in pixels.
    cell: u32,
    /// Width of the cracks, in pixels.
    crack_width: f64,
    /// Gray values of the darkest and the lightest stone.
    grays: [f64; 2],
    crack_gray: f64,
    /// Amplitude of the noise on the stones.
    noise: f64,
}

const GRAY: Stones = Stones {
    seed: 1,
    cell: 32,
    crack_width: 6.0,
    grays: [0.2, 0.8],
    crack_gray: 0.06,
    noise: 0.07,
};

impl Stones {
    /// Returns the image, and the signed distance of each pixel from the border of its stone, negative in cracks.
    fn render(&self) -> (Raster<f32>, Raster<f64>) {
        let places = Seed(self.seed).child("place", 0);
        let grain = Seed(self.seed).child("grain", 0);
        let n = SIDE / self.cell;
        let points: Vec<[f64; 3]> = (0..n * n)
            .map(|index| {
                let cell = [index % n, index / n];
                let [x, y, gray] =
                    [0, 1, 2].map(|part| unit_f64(hash2(places, cell.map(i64::from), part)));
                let at = |cell: u32, jitter: f64| {
                    (f64::from(cell) + 0.5 + 0.8 * (jitter - 0.5)) * f64::from(self.cell)
                };
                let [low, high] = self.grays;
                [at(cell[0], x), at(cell[1], y), low + gray * (high - low)]
            })
            .collect();
        let pixel = |column: u32, row: u32| {
            let (border, gray) = nearest(&points, [column, row].map(|at| f64::from(at) + 0.5));
            let grain = unit_f64(hash2(grain, [column.into(), row.into()], 0)) * 2.0 - 1.0;
            let inside = border - 0.5 * self.crack_width;
            let [gray, noise] = if inside < 0.0 {
                [self.crack_gray, 0.3 * self.noise]
            } else {
                [gray, self.noise]
            };
            ((gray + noise * grain) as f32, inside)
        };
        let both = Raster::from_fn([SIDE; 2], pixel).unwrap();
        (both.map(|pixel| pixel.0), both.map(|pixel| pixel.1))
    }
}

/// Returns the distance to the nearest border between two stones, and the stone's gray value.
fn nearest(points: &[[f64; 3]], at: [f64; 2]) -> (f64, f64) {
    let side = f64::from(SIDE);
    let offset = |a: f64, b: f64| (a - b) - side * ((a - b) / side).round();
    let mut found: Vec<(f64, [f64; 2], f64)> = points
        .iter()
        .map(|&[x, y, gray]| {
            let offset = [offset(x, at[0]), offset(y, at[1])];
            (offset[0] * offset[0] + offset[1] * offset[1], offset, gray)
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(f1, a, gray), (f2, b, _)] = [found[0], found[1]];
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    ((f2 - f1) / (2.0 * (x * x + y * y).sqrt()), gray)
}

/// Returns the fraction of the lowest quarter of a map that is in cracks.
fn quarter_in_cracks(map: &Raster<f32>, inside: &Raster<f64>) -> f64 {
    let ranks = rank_equalize(map).unwrap();
    let pixels = ranks.pixels().iter().zip(inside.pixels());
    let low: Vec<_> = pixels.filter(|(rank, _)| **rank < 0.25).collect();
    let cracks = low.iter().filter(|(_, inside)| **inside < 0.0).count();
    cracks as f64 / low.len() as f64
}

/// Returns the mean of the map over the pixels whose distance from the border of their stone is in a range.
fn mean_where(map: &Raster<f32>, inside: &Raster<f64>, range: Range<f64>) -> f64 {
    let pixels = map.pixels().iter().zip(inside.pixels());
    let chosen: Vec<f64> = pixels
        .filter(|(_, inside)| range.contains(inside))
        .map(|(value, _)| f64::from(*value))
        .collect();
    chosen.iter().sum::<f64>() / chosen.len() as f64
}

#[test]
fn the_lowest_quarter_lies_in_the_cracks_of_dark_light_and_noisy_stones() {
    let dark = Stones {
        grays: [0.12, 0.3],
        crack_gray: 0.04,
        noise: 0.035,
        ..GRAY
    };
    let light = Stones {
        grays: [0.6, 0.9],
        crack_gray: 0.1,
        ..GRAY
    };
    let noisy = Stones { noise: 0.2, ..GRAY };
    let pebbles = Stones {
        cell: 16,
        crack_width: 3.5,
        ..GRAY
    };
    for stones in [GRAY, dark, light, noisy, pebbles] {
        for seed in 1..4 {
            let stones = Stones { seed, ..stones };
            let (texture, inside) = stones.render();
            let map = BlendMap::new(stones.cell.into()).apply(&texture).unwrap();
            let covered = inside
                .pixels()
                .iter()
                .filter(|inside| **inside < 0.0)
                .count();
            assert!(covered >= texture.pixels().len() / 4, "{covered} pixels");
            // More than 0.997 was measured for all of them. The rest are noise minima on stones, and rims.
            let share = quarter_in_cracks(&map, &inside);
            assert!(share > 0.97, "{stones:?}: {share}");
            // Measured: at most 0.12 in cracks, at least 0.66 on stones.
            let mean = |range| mean_where(&map, &inside, range);
            let [low, high] = [mean(-99.0..0.0), mean(0.0..99.0)];
            assert!(low < 0.15 && high > 0.6, "{stones:?}: {low} and {high}");
        }
    }
}

#[test]
fn the_map_rises_from_the_cracks_to_the_middles_of_the_stones() {
    for seed in 1..3 {
        let (texture, inside) = Stones { seed, ..GRAY }.render();
        let map = BlendMap::new(32.0).apply(&texture).unwrap();
        let steps = [-3.0..-1.0, -1.0..1.0, 1.0..3.0, 3.0..6.0, 6.0..99.0];
        let means = steps.map(|range| mean_where(&map, &inside, range));
        for pair in means.windows(2) {
            assert!(pair[0] < pair[1], "{means:?}");
        }
    }
}

#[test]
fn the_lowest_quarter_lies_in_the_cracks_under_uneven_light() {
    let (texture, inside) = GRAY.render();
    // Light that falls to almost nothing in the middle column, and haze that increases toward the middle row.
    let away = |at: u32| (at as f32 / 64.0 - 1.0).abs();
    let lit = Raster::from_fn([SIDE; 2], |column, row| {
        let value = texture.row(row)[column as usize];
        value * (0.2 + 0.8 * away(column)) + 0.3 * (1.0 - away(row))
    })
    .unwrap();
    let map = BlendMap::new(32.0).apply(&lit).unwrap();
    // Measured: 0.997 and 0.83. By luminance alone, shaded stones look like cracks.
    let [by_map, by_luminance] = [&map, &lit].map(|map| quarter_in_cracks(map, &inside));
    assert!(by_map > 0.97, "{by_map} by the map");
    assert!(by_luminance < 0.9, "{by_luminance} by the luminance");
}

#[test]
fn a_feature_size_that_is_off_by_a_factor_of_two_does_little_harm() {
    for seed in 1..3 {
        let (texture, inside) = Stones { seed, ..GRAY }.render();
        for (size, bar) in [(16.0, 0.97), (24.0, 0.97), (48.0, 0.93), (64.0, 0.8)] {
            let map = BlendMap::new(size).apply(&texture).unwrap();
            // Measured: 1.00, 1.00, 0.97, 0.87; by chance it would be 0.33.
            let share = quarter_in_cracks(&map, &inside);
            assert!(share > bar, "{size}: {share}");
        }
    }
}

#[test]
fn the_map_of_a_shifted_texture_is_the_shifted_map_bit_for_bit() {
    let (texture, _) = Stones { seed: 4, ..GRAY }.render();
    let shift = |raster: &Raster<f32>| {
        Raster::from_fn([SIDE; 2], |x, y| {
            *raster.at(i64::from(x) - 37, i64::from(y) + 21, [Wrap::Repeat; 2])
        })
        .unwrap()
    };
    let map = BlendMap::new(20.0);
    assert_eq!(
        map.apply(&shift(&texture)).unwrap(),
        shift(&map.apply(&texture).unwrap())
    );
}

#[test]
fn the_map_does_not_depend_on_exposure() {
    let (texture, _) = GRAY.render();
    let brighter = texture.map(|value| value * 4.0);
    let map = BlendMap::default();
    assert_eq!(
        map.apply(&brighter).unwrap(),
        map.apply(&texture).unwrap(),
        "a power of two changes no rounding"
    );
}

#[test]
fn the_map_of_a_color_is_that_of_its_luminance() {
    let (texture, _) = GRAY.render();
    let color = texture.map(|&value| LinearRgb::new(value, 0.5 * value, 0.1));
    let map = BlendMap::default().with_contrast(2.0);
    assert_eq!(
        map.apply_color(&color).unwrap(),
        map.apply(&color.map(|color| color.luminance())).unwrap()
    );
}

#[test]
fn the_map_of_a_constant_is_one_half() {
    for value in [0.0, 0.3, -7.0, f32::MAX] {
        let flat = Raster::filled([17, 5], value).unwrap();
        let map = BlendMap::default().apply(&flat).unwrap();
        assert!(map.pixels().iter().all(|&value| value == 0.5), "{value}");
    }
}

#[test]
fn contrast_goes_from_one_gray_to_black_and_white() {
    let (texture, _) = GRAY.render();
    let with_contrast = |contrast| {
        let map = BlendMap::default().with_contrast(contrast);
        map.apply(&texture).unwrap()
    };
    assert!(
        with_contrast(0.0)
            .pixels()
            .iter()
            .all(|&value| value == 0.5)
    );
    let [one, two] = [1.0, 2.0].map(|contrast| with_contrast(contrast).statistics().deviation);
    assert!(one < two, "{one} and {two}");
    let sharp = with_contrast(1e300);
    let gray = sharp
        .pixels()
        .iter()
        .filter(|value| (0.1..0.9).contains(*value));
    // Only the median itself.
    assert!(gray.count() < 9, "gray is left");
}

#[test]
fn value_stability_blend_map() {
    let (texture, _) = Stones { seed: 9, ..GRAY }.render();
    let map = BlendMap::new(24.0)
        .with_contrast(1.5)
        .with_wrap([Wrap::Clamp, Wrap::Mirror])
        .apply(&texture)
        .unwrap();
    let some = [(0, 0), (127, 127), (64, 3), (20, 99)].map(|(x, y)| map.row(y)[x as usize]);
    assert_eq!(some, [0.16345759, 0.2097802, 0.029803846, 0.7061611]);
}

#[test]
fn blend_map_refuses_bad_numbers() {
    let texture = Raster::filled([4, 4], 0.5_f32).unwrap();
    for size in [0.5, 5000.0, f64::NAN, -3.0, f64::INFINITY] {
        let error = BlendMap::new(size).apply(&texture).unwrap_err();
        assert!(
            matches!(
                error.kind(),
                TileErrorKind::Range {
                    what: "feature size",
                    ..
                }
            ),
            "{size}: {error}"
        );
    }
    for contrast in [-0.1, f64::NAN, f64::INFINITY] {
        let map = BlendMap::default().with_contrast(contrast);
        let error = map.apply(&texture).unwrap_err();
        assert!(
            matches!(
                error.kind(),
                TileErrorKind::Range {
                    what: "contrast",
                    ..
                }
            ),
            "{contrast}: {error}"
        );
    }
    let bad = texture.map(|_| f32::NAN);
    let error = BlendMap::default().apply(&bad).unwrap_err();
    assert!(
        matches!(
            error.kind(),
            TileErrorKind::NotFinite {
                column: 0,
                row: 0,
                ..
            }
        ),
        "{error}"
    );
}

proptest! {
    #[test]
    fn values_lie_between_zero_and_one(
        width in 1_u32..9,
        height in 1_u32..9,
        values in prop::collection::vec(prop::num::f32::NORMAL | prop::num::f32::ZERO, 64),
        feature_size in 1.0..200.0_f64,
        contrast in 0.0..1e9_f64,
    ) {
        let n = (width * height) as usize;
        let texture = Raster::from_vec([width, height], values[..n].to_vec()).unwrap();
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            let map = BlendMap::new(feature_size).with_contrast(contrast).with_wrap([wrap; 2]);
            let map = map.apply(&texture).unwrap();
            prop_assert!(map.pixels().iter().all(|value| (0.0..=1.0).contains(value)), "{:?}", map);
        }
    }
}
