//! Tests for endless textures.

use super::evenness::Costs;
use super::level::{AppearanceLevel, DIAGONALS, N_FEATURES};
use super::window::{N_PASSES, QUARTERS};
use super::{Endless, EndlessOptions};
use crate::{Edges, Exemplar, PlaneTexture, Progress, SynthErrorKind};
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use dapple_hash::{Seed, hash2, unit_f32, unit_f64};
use dapple_raster::{Raster, parallel};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// Returns an image of spots with two channels; it wraps.
fn spots(size: [u32; 2], edges: Edges) -> Exemplar {
    let noise = |x: u32, y: u32, channel: u64| {
        let cell = [x % size[0] / 3, y % size[1] / 2].map(i64::from);
        unit_f32((hash2(Seed(channel), cell, 0) >> 32) as u32)
    };
    let planes = [0, 1].map(|channel| Raster::from_fn(size, |x, y| noise(x, y, channel)).unwrap());
    Exemplar::from_planes(&[(&planes[0], 1.0), (&planes[1], 0.5)], edges).unwrap()
}

fn endless(exemplar: &Exemplar, n_levels: u32, period: [Option<u32>; 2]) -> Endless {
    let options = EndlessOptions {
        seed: Seed(5),
        n_levels: Some(n_levels),
        period,
    };
    Endless::new(exemplar, &options).unwrap()
}

fn window(texture: &Endless, first: [i64; 2], size: [u32; 2]) -> PlaneTexture {
    let go_on = |_| ControlFlow::Continue(());
    texture.window(first, size, go_on).unwrap()
}

/// Reference for the source of a pixel after a number of subpasses, computed recursively for each pixel.
struct Naive<'a> {
    texture: &'a Endless,
    known: BTreeMap<(usize, usize, [i64; 2]), [i64; 2]>,
}

impl Naive<'_> {
    fn n_corrections(&self, level: usize) -> usize {
        let is_coarsest = level + 1 == self.texture.stages.len();
        QUARTERS.len() * N_PASSES * if is_coarsest { 2 } else { 1 }
    }

    fn place(&mut self, level: usize, n_corrections: usize, at: [i64; 2]) -> [i64; 2] {
        let key = (level, n_corrections, at);
        if let Some(&place) = self.known.get(&key) {
            return place;
        }
        let place = match n_corrections.checked_sub(1) {
            None => self.start(level, at),
            Some(before) if at.map(|at| at.rem_euclid(2)) == QUARTERS[before % 4] => {
                self.corrected(level, before, at)
            }
            Some(before) => self.place(level, before, at),
        };
        self.known.insert(key, place);
        place
    }

    fn start(&mut self, level: usize, at: [i64; 2]) -> [i64; 2] {
        let texture = self.texture;
        if level + 1 == texture.stages.len() {
            let part = unit_f64(hash2(texture.seed.child("endless", 0), at, 0));
            if texture.is_lattice {
                let stage = &texture.stages[level];
                let size = texture.size.map(i64::from);
                let copy = [0, 1].map(|axis| (at[axis] * stage.spacing).rem_euclid(size[axis]));
                let n_moves = (part * 8.0) as usize;
                let moved = |place: &[i64; 2]| stage.similar(*place);
                let mut places = core::iter::successors(Some(copy), moved);
                return places.nth(n_moves).expect("everything is like something");
            }
            let usable = texture.stages[level].usable_pixels();
            let pixel = usable[(part * usable.len() as f64) as usize];
            return [pixel % texture.size[0], pixel / texture.size[0]].map(i64::from);
        }
        let parent = at.map(|at| at.div_euclid(2));
        let parent = self.place(level + 1, self.n_corrections(level + 1), parent);
        texture.stages[level].child(parent, at)
    }

    fn corrected(&mut self, level: usize, before: usize, at: [i64; 2]) -> [i64; 2] {
        let stage = &self.texture.stages[level];
        let h = stage.spacing;
        let mut goes_on = |[x, y]: [i64; 2], [left, up]: [i64; 2]| {
            let [column, row] = self.place(level, before, [at[0] + x, at[1] + y]);
            [column - left * h, row - up * h]
        };
        let around: [[f32; N_FEATURES]; 4] = DIAGONALS.map(|[x, y]| {
            let places = [
                goes_on([x, y], [0, 0]),
                goes_on([2 * x, y], [x, 0]),
                goes_on([x, 2 * y], [0, y]),
            ];
            let [a, b, c] = places.map(|place| *stage.features(place));
            core::array::from_fn(|i| ((a[i] + b[i]) + c[i]) / 3.0)
        });
        let neighbors = (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y]));
        let coherent: Vec<_> = neighbors
            .filter_map(|step| stage.usable(goes_on(step, step)))
            .collect();
        let similar = coherent.iter().filter_map(|&place| stage.similar(place));
        let similar = similar.map(|place| (place, 1.0 + stage.coherence));
        let candidates = coherent.iter().map(|&place| (place, 1.0)).chain(similar);
        let steps = (-2..=2).flat_map(|y: i64| (-2..=2).map(move |x: i64| [x, y]));
        // Pixels of the same subpass do not read each other.
        let near = steps.filter(|[x, y]| x % 2 != 0 || y % 2 != 0);
        let near = near.map(|[x, y]| {
            let should_be = x.abs().max(y.abs()) as f64 * h as f64;
            (goes_on([x, y], [0, 0]), should_be)
        });
        let near: Vec<_> = near.collect();
        let distance = |(place, factor): ([i64; 2], f32)| {
            let repeats = near.iter().any(|(other, should_be)| {
                let apart = [0, 1].map(|axis| (other[axis] - place[axis]).abs() as f64);
                apart[0].max(apart[1]) < should_be / 2.0
            });
            let cost = stage.costs.of(place);
            let distance_sq = factor * stage.distance_sq(&around, place) + cost;
            match repeats {
                true => distance_sq + stage.repetition_cost,
                false => distance_sq,
            }
        };
        candidates
            .reduce(|best, other| {
                if distance(other) < distance(best) {
                    other
                } else {
                    best
                }
            })
            .map_or_else(|| goes_on([0, 0], [0, 0]), |(place, _)| place)
    }
}

#[test]
fn windows_equal_corrections_of_one_pixel_after_the_other() {
    let square = |x: u32, y: u32| f32::from((x / 2 + y / 2).is_multiple_of(2));
    let checker = Raster::from_fn([12, 16], square).unwrap();
    let checker = Exemplar::from_planes(&[(&checker, 1.0)], Edges::Wrap).unwrap();
    for (exemplar, n_levels, is_lattice) in [
        (spots([21, 16], Edges::Wrap), 1, false),
        (spots([21, 16], Edges::Cut), 2, false),
        (spots([21, 16], Edges::Wrap), 3, false),
        (spots([21, 16], Edges::Cut), 3, false),
        (checker, 2, true),
    ] {
        let texture = endless(&exemplar, n_levels, [None; 2]);
        assert_eq!(texture.is_lattice, is_lattice, "{n_levels} levels");
        let (first, size) = ([-7, 3], [5, 4]);
        let made = window(&texture, first, size);
        let mut naive = Naive {
            texture: &texture,
            known: BTreeMap::new(),
        };
        let n_corrections = naive.n_corrections(0);
        let expected = Raster::from_fn(size, |x, y| {
            let at = [first[0] + i64::from(x), first[1] + i64::from(y)];
            naive.place(0, n_corrections, at).map(|at| at as u32)
        });
        assert_eq!(
            made.sources(),
            &expected.unwrap(),
            "{}, {n_levels} levels",
            exemplar.edges()
        );
    }
}

#[test]
fn pixels_that_are_alike_are_those_that_comparing_with_all_finds() {
    for edges in [Edges::Wrap, Edges::Cut] {
        let texture = endless(&spots([40, 30], edges), 3, [None; 2]);
        for stage in &texture.stages {
            let (width, apart) = (i64::from(texture.size[0]), stage.apart());
            let of_grid = |pixel: &i64| {
                let place = [pixel % width, pixel / width];
                let is_on_grid = place.iter().all(|at| at % stage.step == 0);
                (is_on_grid && stage.usable(place).is_some()).then_some(place)
            };
            let n_pixels = width * i64::from(texture.size[1]);
            let grid: Vec<[i64; 2]> = (0..n_pixels).filter_map(|pixel| of_grid(&pixel)).collect();
            for &place in &grid {
                let around = around(stage, place);
                let distance = |other: [i64; 2]| stage.distance_sq(&around, other);
                let is_apart = |other: &&[i64; 2]| {
                    let [x, y]: [i64; 2] = core::array::from_fn(|axis| {
                        let n_steps = (i64::from(texture.size[axis]) - 1) / stage.step + 1;
                        let way = (place[axis] - other[axis]).abs() / stage.step;
                        if edges == Edges::Wrap {
                            way.min(n_steps - way)
                        } else {
                            way
                        }
                    });
                    x * x + y * y > apart * apart
                };
                let least = grid.iter().filter(is_apart).map(|&other| distance(other));
                let least = least.fold(f32::INFINITY, f32::min);
                let found = stage.similar(place).map_or(f32::INFINITY, distance);
                // The terms are summed in a different order than in the code.
                assert!(
                    (found - least).abs() <= 1e-5 * least,
                    "{place:?}: {found}, {least}"
                );
            }
        }
    }
}

/// Returns the features on the diagonals of a pixel.
fn around(stage: &AppearanceLevel, [column, row]: [i64; 2]) -> [[f32; N_FEATURES]; 4] {
    let h = stage.spacing;
    DIAGONALS.map(|[x, y]| *stage.features([column + x * h, row + y * h]))
}

#[test]
fn a_period_repeats_every_pixel_and_its_window_wraps() {
    let exemplar = spots([24, 20], Edges::Cut);
    let texture = endless(&exemplar, 3, [Some(16), Some(24)]);
    let period = window(&texture, [0, 0], [16, 24]);
    let larger = window(&texture, [-21, -30], [40, 60]);
    for y in 0..60 {
        for x in 0..40_u32 {
            let [column, row] = [(x + 32 - 21) % 16, (y + 48 - 30) % 24];
            let pixel = larger.sources().row(y)[x as usize];
            assert_eq!(
                pixel,
                period.sources().row(row)[column as usize],
                "{x}, {y}"
            );
        }
    }
    let half = endless(&exemplar, 3, [Some(16), None]);
    let [one, next] = [0, 24].map(|row| window(&half, [3, row], [16, 24]));
    assert!(one.sources() != next.sources(), "no period along columns");
}

#[test]
fn windows_have_the_same_bits_on_any_number_of_threads() {
    let made = [1, 2, 7].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        pool.install(|| {
            let texture = endless(&spots([50, 40], Edges::Cut), 4, [None; 2]);
            window(&texture, [100, -50], [70, 60])
        })
    });
    assert!(made[0] == made[1] && made[0] == made[2], "bits differ");
}

#[test]
fn costs_make_textures_have_all_parts_of_an_exemplar() {
    // Grain that is brighter on one side.
    let grain = |x: u32, y: u32| {
        let cell = [x / 2, y / 2].map(i64::from);
        unit_f32((hash2(Seed(0), cell, 0) >> 32) as u32) + 0.02 * x as f32
    };
    let plane = Raster::from_fn([64, 48], grain).unwrap();
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Cut).unwrap();
    let texture = endless(&exemplar, 4, [None; 2]);
    let mut free = texture.clone();
    for stage in &mut free.stages {
        stage.costs = Costs::default();
    }
    let finest = &texture.stages[0];
    let pixels = finest.usable_pixels().into_iter();
    let wanted = finest
        .costs
        .shares(pixels.map(|pixel| [pixel % 64, pixel / 64]));
    let uneven = |texture: &Endless| -> f32 {
        let made = window(texture, [5000, -700], [256; 2]);
        let shares = finest.costs.shares(made.sources().pixels().iter().copied());
        let pairs = shares.iter().zip(&wanted);
        pairs.map(|(a, b)| (a - b).abs()).sum()
    };
    let [with, without] = [&texture, &free].map(uneven);
    // For photographs the ratio is from 0.2 to 0.5.
    assert!(with < 0.7 * without, "{with} with costs, {without} without");
}

#[test]
fn what_lies_side_by_side_is_repeated_less_where_that_costs() {
    let grain = |x: u32, y: u32| {
        let cell = [x / 3, y / 3].map(i64::from);
        unit_f32((hash2(Seed(1), cell, 0) >> 32) as u32)
    };
    let plane = Raster::from_fn([64, 64], grain).unwrap();
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Cut).unwrap();
    let mut texture = endless(&exemplar, 5, [None; 2]);
    for stage in &mut texture.stages {
        // Coherence also lowers repetition; turn it off to test the cost alone.
        stage.coherence = 0.0;
    }
    let mut free = texture.clone();
    for stage in &mut free.stages {
        assert!(stage.repetition_cost > 0.0);
        stage.repetition_cost = 0.0;
    }
    // Count the pixels whose source occurs again at most 8 columns and rows away.
    let n_repeated = |texture: &Endless| {
        let made = window(texture, [0, 0], [128; 2]);
        let source = |[x, y]: [i64; 2]| made.sources().row(y as u32)[x as usize];
        let places = (8..120).flat_map(|y| (8..120).map(move |x| [x, y]));
        let is_repeated = |&[x, y]: &[i64; 2]| {
            let near = (-8..=8).flat_map(|down| (-8..=8).map(move |across| [across, down]));
            let mut near = near.filter(|step| *step != [0, 0]);
            near.any(|step| source([x + step[0], y + step[1]]) == source([x, y]))
        };
        places.filter(is_repeated).count()
    };
    let [with, without] = [&texture, &free].map(n_repeated);
    // For photographs the ratio is from a quarter to two thirds.
    assert!(
        10 * with < 9 * without,
        "{with} where it costs, {without} elsewhere"
    );
}

#[test]
fn squares_of_a_checker_stay_whole() {
    let checker = |x: u32, y: u32| f32::from((x / 5 + y / 5).is_multiple_of(2));
    let plane = Raster::from_fn([40, 40], checker).unwrap();
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap).unwrap();
    let texture = Endless::new(&exemplar, &EndlessOptions::default()).unwrap();
    let made = window(&texture, [1000, -3000], [120, 90])
        .transfer(&plane)
        .unwrap();
    let differing = |offset: [u32; 2]| {
        let differs = |x: u32, y: u32| {
            let expected = checker(x + offset[0], y + offset[1]);
            made.row(y)[x as usize] != expected
        };
        let pixels = (0..90).flat_map(|y| (0..120).map(move |x| (x, y)));
        pixels.filter(|&(x, y)| differs(x, y)).count()
    };
    let offsets = (0..10).flat_map(|y| (0..10).map(move |x| [x, y]));
    assert_eq!(
        offsets.map(differing).min(),
        Some(0),
        "pixels off the best checker"
    );
}

#[test]
fn textures_have_nothing_that_a_mask_leaves_out() {
    let exemplar = spots([40, 32], Edges::Wrap);
    let is_clean = |x: u32, y: u32| x.abs_diff(12) > 3 || y.abs_diff(9) > 5;
    let mask = Raster::from_fn([40, 32], is_clean).unwrap();
    let texture = endless(&exemplar.clone().with_mask(&mask).unwrap(), 3, [None; 2]);
    for &[x, y] in window(&texture, [0, 0], [80, 80]).sources().pixels() {
        // Features of the finest level depend on two more pixels in each direction.
        assert!(
            x.abs_diff(12) > 5 || y.abs_diff(9) > 7,
            "column {x}, row {y}"
        );
    }
    let nothing = Raster::filled([40, 32], false).unwrap();
    let refused = Endless::new(
        &exemplar.with_mask(&nothing).unwrap(),
        &EndlessOptions::default(),
    );
    let kind = refused.unwrap_err().kind().clone();
    assert!(matches!(kind, SynthErrorKind::Masked { .. }), "{kind:?}");
}

#[test]
fn limits_are_named() {
    let exemplar = spots([16, 12], Edges::Cut);
    let refused = |options: EndlessOptions| {
        let error = Endless::new(&exemplar, &options).unwrap_err();
        error.to_string()
    };
    for n_levels in [0, 5, 17] {
        let message = refused(EndlessOptions {
            n_levels: Some(n_levels),
            ..EndlessOptions::default()
        });
        assert!(message.contains("number of levels"), "{message}");
    }
    for period in [0, 12, 20] {
        let message = refused(EndlessOptions {
            n_levels: Some(3),
            period: [None, Some(period)],
            ..EndlessOptions::default()
        });
        assert!(message.contains("period"), "{message}");
    }
    let texture = endless(&exemplar, 2, [None; 2]);
    let go_on = |_| ControlFlow::Continue(());
    for (first, size) in [
        ([0, 0], [0, 5]),
        ([0, 0], [1 << 14, 1 << 13]),
        ([i64::MIN, 0], [1, 1]),
        ([0, i64::MAX], [1, 1]),
    ] {
        assert!(
            texture.window(first, size, go_on).is_err(),
            "{first:?}, {size:?}"
        );
    }
    let stopped = texture.window([0, 0], [4, 4], |_| ControlFlow::Break(()));
    let kind = stopped.unwrap_err().kind().clone();
    assert!(matches!(kind, SynthErrorKind::Cancelled), "{kind:?}");
    for size in [[1, 1], [1, 50], [3, 2]] {
        for edges in [Edges::Cut, Edges::Wrap] {
            let tiny = Endless::new(&spots(size, edges), &EndlessOptions::default()).unwrap();
            let made = window(&tiny, [-(1 << 52), 1 << 52], [9, 9]);
            assert_eq!(made.sources().size(), [9, 9], "{size:?}");
        }
    }
}

#[test]
fn value_stability_endless() {
    let texture = endless(&spots([24, 20], Edges::Cut), 3, [None; 2]);
    let made = window(&texture, [1 << 40, -5], [4, 2]);
    assert_eq!(
        made.sources().pixels(),
        [
            [4, 4],
            [5, 4],
            [6, 4],
            [7, 4],
            [4, 5],
            [5, 5],
            [6, 5],
            [7, 5],
        ],
        "sources of the first pixels"
    );
}

/// Textures of an exemplar that is cut and of one that wraps, with one to four levels.
static TEXTURES: LazyLock<[[Endless; 4]; 2]> = LazyLock::new(|| {
    [Edges::Cut, Edges::Wrap].map(|edges| {
        [1, 2, 3, 4].map(|n_levels| endless(&spots([19, 26], edges), n_levels, [None, Some(48)]))
    })
});

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn windows_are_crops_of_larger_ones(
        first in prop::array::uniform2(-200_i64..200),
        // More than twice the distance between the pixels of the coarsest level, which is eight.
        size in prop::array::uniform2(1_u32..20),
        before in prop::array::uniform2(0_u32..17),
        after in prop::array::uniform2(0_u32..17),
        n_levels in 1_u32..5,
        wraps in any::<bool>(),
    ) {
        let texture = &TEXTURES[usize::from(wraps)][n_levels as usize - 1];
        let part = window(texture, first, size);
        let start = [0, 1].map(|axis| first[axis] - i64::from(before[axis]));
        let whole = window(texture, start, [0, 1].map(|axis| before[axis] + size[axis] + after[axis]));
        for row in 0..size[1] {
            let line = &whole.sources().row(before[1] + row)[before[0] as usize..];
            prop_assert_eq!(part.sources().row(row), &line[..size[0] as usize]);
        }
    }
}

#[test]
fn preparation_can_be_cancelled_at_every_call_and_is_asked_often() {
    let exemplar = spots([64, 64], Edges::Cut);
    let options = EndlessOptions::default();
    let prepare = |last: usize| {
        let n_calls = AtomicUsize::new(0);
        let is_cancelled = || n_calls.fetch_add(1, Relaxed) >= last;
        let made = Endless::new_cancellable(&exemplar, &options, &is_cancelled);
        (made, n_calls.into_inner())
    };
    let (made, n_calls) = prepare(usize::MAX);
    let alone = window(
        &Endless::new(&exemplar, &options).unwrap(),
        [3, 5],
        [70, 40],
    );
    let same = window(&made.unwrap(), [3, 5], [70, 40]);
    assert_eq!(same.sources(), alone.sources());
    // Setup takes half a second of work.
    assert!(n_calls > 100, "{n_calls} calls");
    for last in (0..n_calls).step_by(n_calls / 12) {
        let (made, n_calls) = prepare(last);
        let error = made.unwrap_err();
        assert!(matches!(error.kind(), SynthErrorKind::Cancelled), "{error}");
        // Polling ends, except on threads that were polling at the time.
        assert!(
            n_calls <= last + parallel::n_threads(),
            "{n_calls} from {last} on"
        );
    }
}

#[test]
fn progress_of_large_windows_is_reported_within_quarters() {
    let texture = endless(&spots([32, 32], Edges::Wrap), 2, [None; 2]);
    let mut reports = Vec::new();
    let large = texture.window([0, 0], [700, 600], |progress| {
        reports.push(progress);
        ControlFlow::Continue(())
    });
    // The finest level has 420,000 pixels and 12 subpasses, each reported in parts of a few thousand pixels.
    assert!(reports.len() > 12 * 6, "{} reports", reports.len());
    let place = |progress: &Progress| (progress.pass, progress.done);
    assert!(
        reports.is_sorted_by(|a, b| place(a) < place(b)),
        "{reports:?}"
    );
    // Compare with a smaller window, whose subpasses are not split into parts.
    let small = window(&texture, [600, 500], [90, 90]);
    let rows =
        (0..90).map(|row| large.as_ref().unwrap().sources().row(500 + row)[600..690].to_vec());
    assert_eq!(rows.flatten().collect::<Vec<_>>(), small.sources().pixels());
}
