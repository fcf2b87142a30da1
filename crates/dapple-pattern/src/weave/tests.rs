//! Compares weaves with drafts written as grids, and with the surfaces of all threads around a position.

use super::{Draft, Weave, WeaveOptions, WeaveValue};
use crate::PatternErrorKind;
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Field as _, FieldExt as _, Named as _, Window};
use proptest::prelude::*;

/// A draft, its parameters `over`, `under` and `step`, and its grid.
type Grid = (Draft, [Option<u32>; 3], &'static [&'static str]);

/// Drafts as in weavers' books: a column for each warp thread, a row for each weft thread, `#` where the warp is on
/// top.
const GRIDS: [Grid; 5] = [
    (Draft::Plain, [None; 3], &["#.", ".#"]),
    (Draft::Twill, [None; 3], &["##..", ".##.", "..##", "#..#"]),
    (
        Draft::Twill,
        [Some(2), Some(1), Some(2)],
        &["##.", "#.#", ".##"],
    ),
    (
        Draft::Satin,
        [None; 3],
        &["####.", "#.###", "###.#", ".####", "##.##"],
    ),
    (
        Draft::Basket,
        [Some(2), None, None],
        &["##..", "##..", "..##", "..##"],
    ),
];

fn options(draft: Draft, [over, under, step]: [Option<u32>; 3]) -> WeaveOptions {
    WeaveOptions {
        frequency: [1.0, 1.0],
        draft,
        over,
        under,
        step,
        ..WeaveOptions::default()
    }
}

#[test]
fn drafts_equal_those_of_weavers() {
    for (draft, numbers, grid) in GRIDS {
        let weave = Weave::new(Seed(1), options(draft, numbers)).unwrap();
        let side = grid.len() as i64;
        for (row, column) in (-9..9).flat_map(|row| (-9..9).map(move |column| (row, column))) {
            let text = grid[i64::rem_euclid(row, side) as usize].as_bytes();
            let expected = text[i64::rem_euclid(column, side) as usize] == b'#';
            let at = [column as f64 + 0.5, row as f64 + 0.5];
            let is_warp = weave.field(WeaveValue::Direction).sample(at) == 0.0;
            assert_eq!(is_warp, expected, "{draft} at column {column}, row {row}");
            // The thread on top is highest at the crossing.
            assert_eq!(weave.field(WeaveValue::Height).sample(at), 1.0);
        }
    }
}

/// Returns the height and direction of the highest thread around a position, and its height above the next highest.
fn highest(weave: &Weave, grid: &[&str], at: [f64; 2]) -> (f64, usize, f64) {
    let options = weave.options;
    let side = grid.len() as i64;
    let above = |warp: i64, weft: i64| {
        let text = grid[weft.rem_euclid(side) as usize].as_bytes();
        text[warp.rem_euclid(side) as usize] == b'#'
    };
    let mut heights = vec![(0.0, 0)];
    for (axis, thread) in (0..2).flat_map(|axis| (-12..12_i64).map(move |thread| (axis, thread))) {
        let hash = CellHash::new(weave.seed, [axis as i64, thread]);
        let width = options.width * (1.0 - 0.5 * options.jitter * unit_f64(hash.at(2)));
        let moved = options.jitter * (1.0 - width) * (unit_f64(hash.at(3)) - 0.5);
        let across = (at[axis] - (thread as f64 + 0.5 + moved)) / (width / 2.0);
        if across.abs() >= 1.0 {
            continue;
        }
        let along = at[1 - axis];
        let first = (along - 0.5).floor();
        let is_above = |crossing: f64| match axis {
            0 => above(thread, crossing as i64),
            _ => !above(crossing as i64, thread),
        };
        let ends = [is_above(first), is_above(first + 1.0)]
            .map(|is_above| if is_above { 1.0 } else { 0.0 });
        let t = along - 0.5 - first;
        let smooth = 3.0 * t * t - 2.0 * t * t * t;
        let level = ends[0] * (1.0 - smooth) + ends[1] * smooth;
        let profile =
            (1.0 - options.roundness) + options.roundness * (1.0 - across * across).sqrt();
        heights.push(((level + profile) / 2.0, axis));
    }
    heights.sort_by(|a, b| b.0.total_cmp(&a.0));
    let margin = heights
        .get(1)
        .map_or(f64::INFINITY, |next| heights[0].0 - next.0);
    (heights[0].0, heights[0].1, margin)
}

proptest! {
    #[test]
    fn surfaces_equal_the_highest_of_all_threads(
        index in 0..GRIDS.len(),
        seed in any::<u64>(),
        width in 0.1..=1.0_f64,
        roundness in 0.0..=1.0_f64,
        jitter in 0.0..=1.0_f64,
        at in [-8.0..8.0_f64, -8.0..8.0_f64],
    ) {
        let (draft, numbers, grid) = GRIDS[index];
        let options = WeaveOptions { width, roundness, jitter, ..options(draft, numbers) };
        let weave = Weave::new(seed, options).unwrap();
        let (height, axis, margin) = highest(&weave, grid, at);
        let found = f64::from(weave.field(WeaveValue::Height).sample(at));
        // The field rounds to single precision; a root next to 0 magnifies the rounding of a position.
        prop_assert!((found - height).abs() < 1e-6, "{found}, but {height}");
        if height > 0.0 && margin > 1e-6 {
            prop_assert_eq!(weave.field(WeaveValue::Direction).sample(at), axis as f32);
        }
    }

    #[test]
    fn values_are_within_their_ranges_at_any_position(
        draft in proptest::sample::select(Draft::ALL),
        jitter in 0.0..=1.0_f64,
        seed in any::<u64>(),
        at in [-2_147_483_648.0..2_147_483_648.0_f64, -2_147_483_648.0..2_147_483_648.0_f64],
    ) {
        let weave = Weave::new(seed, WeaveOptions { draft, jitter, ..WeaveOptions::default() }).unwrap();
        for &value in WeaveValue::ALL {
            let found = weave.field(value).sample(at);
            prop_assert!((0.0..=1.0).contains(&found), "{value}: {found}");
        }
    }
}

fn periodic(draft: Draft) -> Weave {
    let period = if draft == Draft::Satin {
        [Some(20), Some(40)]
    } else {
        [Some(16), Some(32)]
    };
    let options = WeaveOptions {
        frequency: [4.0, 8.0],
        period,
        draft,
        jitter: 0.5,
        ..WeaveOptions::default()
    };
    Weave::new(Seed(3), options).unwrap()
}

#[test]
fn values_repeat_exactly_and_windows_equal_samples() {
    for (&draft, &value) in Draft::ALL
        .iter()
        .flat_map(|draft| WeaveValue::ALL.iter().map(move |value| (draft, value)))
    {
        let field = periodic(draft).field(value);
        let side = field.period()[0].unwrap();
        assert_eq!(field.period(), [Some(side); 2]);
        let window = Window::new([0.0; 2], [4.0; 2], [64, 64]).unwrap();
        let raster = field.to_raster(&window).unwrap();
        for far in [
            [side, 0.0],
            [0.0, -side],
            [side * 268_435_456.0, side * -268_435_456.0],
        ] {
            let moved = Window::new(far, [4.0; 2], [64, 64]).unwrap();
            assert_eq!(
                field.to_raster(&moved).unwrap(),
                raster,
                "{draft} {value} at {far:?}"
            );
        }
        for (column, row) in [(0, 0), (17, 41), (63, 5)] {
            let sample = field.sample(window.position(column, row));
            assert_eq!(raster.row(row)[column as usize], sample, "{draft} {value}");
        }
    }
}

#[test]
fn drafts_that_do_not_fit_are_refused() {
    let refused = |options: WeaveOptions| {
        let error = Weave::new(Seed(1), options).unwrap_err();
        assert!(
            matches!(error.kind(), PatternErrorKind::Range { .. }),
            "{error}"
        );
        error.to_string()
    };
    let twill = options(Draft::Twill, [None; 3]);
    assert_eq!(
        refused(WeaveOptions {
            period: [Some(6), None],
            ..twill
        }),
        "the number of threads in the period is 6, but it must be a multiple of the threads in a repeat of the draft"
    );
    assert_eq!(
        refused(WeaveOptions {
            step: Some(2),
            ..twill
        }),
        "the step of the draft is 2, but it must be without a common factor with the sum of `over` and `under`"
    );
    assert_eq!(
        refused(WeaveOptions {
            over: Some(0),
            ..twill
        }),
        "the number of crossings over is 0, but it must be from 1 to 32"
    );
    assert_eq!(
        refused(WeaveOptions {
            width: 0.0,
            ..twill
        }),
        "the width of threads is 0, but it must be above 0 and at most 1"
    );
}

#[test]
fn positions_that_are_not_finite_have_no_value() {
    let field = periodic(Draft::Plain).field(WeaveValue::Height);
    for at in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert!(field.sample(at).is_nan(), "{at:?}");
    }
    assert!(field.sample([1e300, -1e300]).is_finite());
}

#[test]
fn value_stability_weaves() {
    let values = [WeaveValue::Height, WeaveValue::Random, WeaveValue::V];
    let found: Vec<[f32; 3]> = Draft::ALL
        .iter()
        .map(|&draft| values.map(|value| periodic(draft).field(value).sample([2.63, 2.45])))
        .collect();
    assert_eq!(found, PINNED);
}

const PINNED: [[f32; 3]; 4] = [
    [0.9880581, 0.6440259, 0.60592973],
    [0.9880581, 0.6440259, 0.60592973],
    [0.99846375, 0.02048707, 0.4608347],
    [0.9844637, 0.02048707, 0.4608347],
];
