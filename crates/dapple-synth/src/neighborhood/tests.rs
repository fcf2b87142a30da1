//! Tests of shapes and schedules.

use super::{Part, Pass, Reads, Schedule, Shape};
use crate::SynthErrorKind;

const FULL: Part = Part::new(Shape::Full, 7, Reads::Same);
const COARSER: Part = Part::new(Shape::Full, 3, Reads::Coarser);

fn pass(level: usize, parts: &[Part]) -> Pass {
    let parts = parts.to_vec();
    Pass { level, parts }
}

fn refused(passes: &[Pass], n_levels: usize) -> SynthErrorKind {
    let passes = passes.to_vec();
    Schedule { passes }
        .check(n_levels)
        .unwrap_err()
        .kind()
        .clone()
}

/// Draws a part: `#` for pixels that are compared.
fn picture(shape: Shape, side: u32, reads: Reads) -> Vec<String> {
    let half = side as i32 / 2;
    let offsets = Part::new(shape, side, reads).offsets();
    let pixel = |i, j| if offsets.contains(&[i, j]) { '#' } else { '.' };
    let row = |j| (-half..=half).map(|i| pixel(i, j)).collect();
    (-half..=half).map(row).collect()
}

#[test]
fn shapes_are_those_of_figure_4() {
    let same = |shape| picture(shape, 5, Reads::Same);
    assert_eq!(
        same(Shape::Full),
        ["#####", "#####", "##.##", "#####", "#####"],
        "(a)"
    );
    assert_eq!(
        same(Shape::Causal),
        ["#####", "#####", "##...", ".....", "....."],
        "(b)"
    );
    assert_eq!(
        same(Shape::Half),
        ["#####", "#####", ".....", ".....", "....."],
        "(c)"
    );
    assert_eq!(
        same(Shape::HalfWithRow),
        ["#####", "#####", "##.##", ".....", "....."],
        "(c) with its row"
    );
    assert_eq!(
        picture(Shape::Full, 3, Reads::Coarser),
        ["###"; 3],
        "the coarser level"
    );
}

#[test]
fn offsets_go_row_by_row_from_the_top() {
    for shape in [Shape::Full, Shape::Half, Shape::HalfWithRow, Shape::Causal] {
        let offsets = Part::new(shape, 15, Reads::Same).offsets();
        assert!(offsets.is_sorted_by_key(|[i, j]| [*j, *i]), "{shape:?}");
    }
    let counts = [
        (Shape::Full, 48),
        (Shape::Half, 21),
        (Shape::HalfWithRow, 27),
        (Shape::Causal, 24),
    ];
    for (shape, count) in counts {
        assert_eq!(
            Part::new(shape, 7, Reads::Same).offsets().len(),
            count,
            "{shape:?}"
        );
    }
    assert_eq!(
        Part::new(Shape::Half, 0, Reads::Same).offsets(),
        [[0; 2]; 0],
        "no side"
    );
    assert_eq!(
        Part::new(Shape::Half, 1, Reads::Same).offsets(),
        [[0; 2]; 0],
        "nothing above"
    );
}

#[test]
fn the_schedule_of_the_paper_has_five_passes_with_three_levels() {
    let passes = Schedule::paper(3).passes;
    let levels: Vec<usize> = passes.iter().map(|pass| pass.level).collect();
    assert_eq!(levels, [2, 1, 1, 0, 0], "levels");
    assert_eq!(
        passes[0].parts,
        [Part::new(Shape::Half, 7, Reads::Same)],
        "H(7, 0)"
    );
    for refine in [&passes[2], &passes[4]] {
        assert_eq!(refine.parts, [FULL, COARSER], "F(7, 0) + F(3, 1)");
    }
    for extrapolate in [&passes[1], &passes[3]] {
        assert_eq!(
            extrapolate.parts,
            [Part::new(Shape::Full, 7, Reads::Coarser)],
            "F(7, 1)"
        );
    }
}

#[test]
fn schedules_of_the_crate_are_accepted() {
    for n_levels in 1..=16 {
        assert_eq!(
            Schedule::paper(n_levels).check(n_levels),
            Ok(()),
            "{n_levels} levels"
        );
    }
    assert_eq!(
        Schedule::single_level(Shape::Causal, 15).check(1),
        Ok(()),
        "single level"
    );
}

#[test]
fn schedules_that_read_unfilled_levels_are_refused() {
    let [fine, coarse] = [pass(0, &[FULL, COARSER]), pass(1, &[FULL])];
    let passes = vec![coarse.clone(), fine.clone()];
    assert_eq!(Schedule { passes }.check(2), Ok(()), "coarse to fine");
    let early = refused(&[fine, coarse], 2);
    assert_eq!(
        early,
        SynthErrorKind::Unfilled { pass: 0, level: 1 },
        "finer level first"
    );
    let unfinished = refused(&[pass(1, &[FULL])], 2);
    assert!(
        matches!(unfinished, SynthErrorKind::Count { count: 0, .. }),
        "{unfinished:?}"
    );
}

#[test]
fn parts_out_of_range_are_refused() {
    for side in [0, 1, 4, 16, 17, u32::MAX] {
        let kind = refused(&[pass(0, &[Part { side, ..FULL }])], 1);
        assert!(matches!(kind, SynthErrorKind::Range { .. }), "side {side}");
    }
    for weight in [0.0, -1.0, 2e6, f32::NAN, f32::INFINITY] {
        let kind = refused(&[pass(0, &[FULL.with_weight(weight)])], 1);
        assert!(
            matches!(kind, SynthErrorKind::Range { .. }),
            "weight {weight}"
        );
    }
    for (level, part) in [(1, FULL), (0, COARSER), (usize::MAX, COARSER)] {
        let kind = refused(&[pass(level, &[part])], 1);
        assert!(
            matches!(kind, SynthErrorKind::Range { .. }),
            "level {level}"
        );
    }
    for passes in [&[][..], &[pass(0, &[])]] {
        let kind = refused(passes, 1);
        assert!(
            matches!(kind, SynthErrorKind::Count { count: 0, .. }),
            "{passes:?}"
        );
    }
    assert!(
        matches!(
            refused(&[pass(0, &[FULL])], 0),
            SynthErrorKind::Range { .. }
        ),
        "no level"
    );
}
