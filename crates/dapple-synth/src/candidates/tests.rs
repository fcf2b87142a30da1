//! Tests of the rows of neighborhoods against a naive computation.

use super::{Candidates, CoarserCenter, FEW};
use crate::{
    Edges, Exemplar, Options, Part, Pass, Pyramid, Reads, Schedule, Shape, SynthErrorKind,
};
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::{Raster, Wrap};
use proptest::prelude::*;

/// Noise of two channels.
fn noise(size: [u32; 2], edges: Edges, n_levels: usize) -> Pyramid {
    let planes = [0, 1].map(|seed| {
        let bits = |x: u32, y: u32| hash2(Seed(seed), [x.into(), y.into()], 0);
        Raster::from_fn(size, |x, y| unit_f32((bits(x, y) >> 32) as u32)).unwrap()
    });
    let planes = [(&planes[0], 1.0), (&planes[1], 1.0)];
    let exemplar = Exemplar::from_planes(&planes, edges).unwrap();
    exemplar.pyramid(n_levels).unwrap()
}

/// Channel of a pixel that may lie past the edges.
fn pixel(level: &Exemplar, [column, row]: [i64; 2], channel: usize) -> f64 {
    let wrap = if level.edges == Edges::Wrap {
        Wrap::Repeat
    } else {
        Wrap::Mirror
    };
    let x = wrap.index(column, level.size[0]) as usize;
    let y = wrap.index(row, level.size[1]) as usize;
    level.pixels[(y * level.size[0] as usize + x) * level.n_channels + channel].into()
}

/// Reference for a row, in `f64`, and whether it stays within edges that are cut.
fn naive(pyramid: &Pyramid, pass: &Pass, center: CoarserCenter, at: [u32; 2]) -> (Vec<f64>, bool) {
    let mut row = Vec::new();
    let mut within = true;
    for part in &pass.parts {
        let level = &pyramid.levels[pass.level + usize::from(part.reads == Reads::Coarser)];
        for [i, j] in part.offsets() {
            let [x, y] = [0, 1].map(|axis| {
                let halved = f64::from(at[axis]) / 2.0;
                let middle = match (part.reads, center) {
                    (Reads::Same, _) => f64::from(at[axis]),
                    (Reads::Coarser, CoarserCenter::Exact) => halved,
                    (Reads::Coarser, CoarserCenter::Floor) => halved.floor(),
                };
                middle + f64::from([i, j][axis])
            });
            let end = level.size.map(|side| f64::from(side) - 1.0);
            within &=
                level.edges == Edges::Wrap || (x >= 0.0 && y >= 0.0 && x <= end[0] && y <= end[1]);
            for channel in 0..level.n_channels {
                let value = bilinear(level, x, y, channel);
                row.push(value * f64::from(part.weight).sqrt());
            }
        }
    }
    (row, within)
}

fn bilinear(level: &Exemplar, x: f64, y: f64, channel: usize) -> f64 {
    let [fx, fy] = [x - x.floor(), y - y.floor()];
    let at = |i, j| pixel(level, [x.floor() as i64 + i, y.floor() as i64 + j], channel);
    let top = at(0, 0) * (1.0 - fx) + at(1, 0) * fx;
    let bottom = at(0, 1) * (1.0 - fx) + at(1, 1) * fx;
    top * (1.0 - fy) + bottom * fy
}

/// Pass with parts of several shapes, levels and weights.
fn mixed(level: usize) -> Pass {
    let parts = vec![
        Part::new(Shape::Causal, 5, Reads::Same).with_weight(2.0),
        Part::new(Shape::Full, 3, Reads::Coarser).with_weight(0.3),
        Part::new(Shape::Half, 7, Reads::Same),
    ];
    Pass { level, parts }
}

#[test]
fn rows_equal_the_definition() {
    for (size, edges, few) in [
        ([30, 28], Edges::Cut, false),
        ([29, 33], Edges::Cut, false),
        ([14, 10], Edges::Cut, true),
        ([12, 16], Edges::Wrap, false),
        ([13, 16], Edges::Wrap, true),
        ([26, 27], Edges::Wrap, false),
    ] {
        let pyramid = noise(size, edges, 2);
        for center in [CoarserCenter::Exact, CoarserCenter::Floor] {
            let candidates = Candidates::new(&pyramid, &mixed(0), center).unwrap();
            let mut expected = Vec::new();
            for [x, y] in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])) {
                let (row, within) = naive(&pyramid, &mixed(0), center, [x, y]);
                if within || few {
                    expected.push(([x, y], row));
                }
            }
            assert_eq!(
                candidates.len(),
                expected.len(),
                "{size:?} {edges:?} {center:?}"
            );
            for (row, (at, values)) in expected.iter().enumerate() {
                assert_eq!(candidates.pixel(row), *at, "{size:?} {edges:?} {center:?}");
                assert_eq!(candidates.row(row).len(), values.len(), "dims");
                for (value, expected) in candidates.row(row).iter().zip(values) {
                    // A few rounding errors of `f32`, for values up to 1.5.
                    assert!(
                        (f64::from(*value) - expected).abs() < 1e-6,
                        "{at:?} {value} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn rows_are_found_by_their_pixels() {
    for (size, edges) in [
        ([30, 28], Edges::Cut),
        ([14, 10], Edges::Cut),
        ([12, 16], Edges::Wrap),
    ] {
        let candidates =
            Candidates::new(&noise(size, edges, 2), &mixed(0), CoarserCenter::Exact).unwrap();
        let mut found = 0;
        for [x, y] in (-20..50).flat_map(|x| (-20..50).map(move |y| [x, y])) {
            let inside = [(x, size[0]), (y, size[1])]
                .iter()
                .all(|&(at, side)| (0..i64::from(side)).contains(&at));
            if let Some(row) = candidates.row_of_pixel([x, y]) {
                let place = [x.rem_euclid(size[0].into()), y.rem_euclid(size[1].into())];
                assert_eq!(
                    candidates.pixel(row as usize).map(i64::from),
                    place,
                    "{size:?} {x} {y}"
                );
                assert!(inside || edges == Edges::Wrap, "{size:?} {x} {y}");
                found += usize::from(inside);
            }
        }
        assert_eq!(found, candidates.len(), "{size:?} {edges:?}: all rows");
    }
}

#[test]
fn four_pixels_share_a_row_only_with_the_floor() {
    let pass = Pass {
        level: 0,
        parts: vec![Part::new(Shape::Full, 3, Reads::Coarser)],
    };
    let pyramid = noise([16, 16], Edges::Wrap, 2);
    let [exact, floor] = [CoarserCenter::Exact, CoarserCenter::Floor]
        .map(|center| Candidates::new(&pyramid, &pass, center).unwrap());
    for [x, y] in [[0, 0], [4, 8], [14, 14]] {
        let rows = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]]
            .map(|at| floor.row_of_pixel(at).unwrap() as usize);
        for row in rows {
            assert_eq!(floor.row(row), exact.row(rows[0]), "{x} {y}");
            assert!(
                row == rows[0] || exact.row(row) != exact.row(rows[0]),
                "{x} {y}"
            );
        }
    }
}

#[test]
fn a_row_between_two_pixels_is_their_mean() {
    // The exemplar is a ramp. Away from the edges, column n of the coarser level has the value 2 n.
    let plane = Raster::from_fn([64, 64], |x, _| x as f32).unwrap();
    let pyramid = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Cut)
        .unwrap()
        .pyramid(2)
        .unwrap();
    let pass = Pass {
        level: 0,
        parts: vec![Part::new(Shape::Full, 3, Reads::Coarser)],
    };
    let values = |center| {
        let candidates = Candidates::new(&pyramid, &pass, center).unwrap();
        let row = candidates.row_of_pixel([21, 21]).unwrap() as usize;
        candidates.row(row)[..3].to_vec()
    };
    assert_eq!(
        values(CoarserCenter::Exact),
        [19.0, 21.0, 23.0],
        "around 10.5, twice that on the finer level"
    );
    assert_eq!(
        values(CoarserCenter::Floor),
        [18.0, 20.0, 22.0],
        "around 10"
    );
}

#[test]
fn pixels_at_the_edges_are_left_out_where_enough_remain() {
    let pass = Schedule::paper(1).passes.remove(0);
    let count = |size, edges| {
        let candidates =
            Candidates::new(&noise(size, edges, 1), &pass, CoarserCenter::Exact).unwrap();
        (candidates.len(), candidates.pixel(0))
    };
    // H(7, 0) reaches three columns to both sides and three rows up.
    assert_eq!(count([32, 32], Edges::Cut), (26 * 29, [3, 3]), "32 x 32");
    assert_eq!(count([32, 32], Edges::Wrap), (32 * 32, [0, 0]), "wrapping");
    assert_eq!(count([26, 23], Edges::Cut), (20 * 20, [3, 3]), "the limit");
    assert_eq!(FEW, 20 * 20, "the limit");
    assert_eq!(
        count([26, 22], Edges::Cut),
        (26 * 22, [0, 0]),
        "below the limit"
    );
    assert_eq!(count([8, 8], Edges::Cut), (64, [0, 0]), "8 x 8");
    assert_eq!(count([4, 5], Edges::Cut), (20, [0, 0]), "the smallest");
}

#[test]
fn evenness_brings_pixels_at_the_edges_but_not_for_refining() {
    let pyramid = noise([64, 64], Edges::Cut, 2);
    let even = Options {
        evenness: 0.5,
        ..Options::default()
    };
    let uneven = Options {
        evenness: 0.0,
        ..Options::default()
    };
    for (pass, all) in Schedule::paper(2).passes.iter().zip([true, true, false]) {
        let [even, uneven] =
            [&even, &uneven].map(|options| Candidates::for_options(&pyramid, pass, options));
        let [even, uneven] = [even.unwrap(), uneven.unwrap()];
        let n_pixels = if pass.level == 0 { 64 * 64 } else { 32 * 32 };
        assert!(uneven.len() < n_pixels, "{pass:?}");
        let expected = if all { n_pixels } else { uneven.len() };
        assert_eq!(even.len(), expected, "{pass:?}");
        let new = Candidates::new(&pyramid, pass, CoarserCenter::Exact).unwrap();
        assert_eq!(uneven, new, "{pass:?}");
    }
}

#[test]
fn small_levels_are_refused() {
    // Of two levels the coarser one has half of the size; H(7, 0) and F(7, .) need four pixels, F(3, .) two.
    let passes = Schedule::paper(2).passes;
    for edges in [Edges::Cut, Edges::Wrap] {
        for (size, pass, level) in [
            ([6, 18], &passes[0], 1),
            ([18, 6], &passes[1], 1),
            ([3, 18], &passes[2], 0),
            ([18, 3], &passes[2], 0),
        ] {
            let pyramid = noise(size, edges, 2);
            let error = Candidates::new(&pyramid, pass, CoarserCenter::Exact).unwrap_err();
            let expected = SynthErrorKind::Exemplar {
                level,
                size: pyramid.levels[level].size,
                side: 7,
            };
            assert_eq!(*error.kind(), expected, "{size:?} {edges:?}");
        }
    }
}

#[test]
fn value_stability_candidates() {
    let candidates = Candidates::new(
        &noise([30, 28], Edges::Cut, 2),
        &mixed(0),
        CoarserCenter::Exact,
    )
    .unwrap();
    let bits: Vec<u32> = candidates.row(100)[46..52]
        .iter()
        .map(|value| value.to_bits())
        .collect();
    assert_eq!(
        bits,
        [
            1057788506, 1058533577, 1063000693, 1061410962, 1052900838, 1058878594
        ],
        "values of the coarser level"
    );
}

proptest! {
    #[test]
    fn any_pass_gives_candidates_or_an_error(
        width in 1_u32..24, height in 1_u32..24, wrap: bool, side in 0_u32..18, level in 0_usize..4, coarser: bool,
    ) {
        let pyramid = noise([width, height], if wrap { Edges::Wrap } else { Edges::Cut }, 3);
        let reads = if coarser { Reads::Coarser } else { Reads::Same };
        let pass = Pass { level, parts: vec![Part::new(Shape::Full, side, reads)] };
        if let Ok(candidates) = Candidates::new(&pyramid, &pass, CoarserCenter::Exact) {
            prop_assert!(side % 2 == 1 && (3..=15).contains(&side));
            prop_assert_eq!(candidates.rows.len(), candidates.len() * candidates.dims());
            prop_assert!(!candidates.is_empty());
        }
    }
}

#[test]
fn masks_leave_out_the_neighborhoods_that_they_touch() {
    let mask = Raster::from_fn([40, 36], |x, y| (x, y) != (17, 20) && x + y > 3).unwrap();
    for edges in [Edges::Cut, Edges::Wrap] {
        let some = noise([40, 36], edges, 2).levels[0].clone();
        let some = some.with_mask(&mask).unwrap().pyramid(2).unwrap();
        // The same values without the mask.
        let mut all = some.clone();
        for level in &mut all.levels {
            level.usable = None;
        }
        let passes = Schedule::paper(2).passes;
        // Exclude and include the neighborhoods that reach past an edge.
        for (pass, few) in passes
            .iter()
            .flat_map(|pass| [(pass, 0), (pass, usize::MAX)])
        {
            let center = CoarserCenter::Exact;
            let all = Candidates::within(&all, pass, center, few).unwrap();
            let rows = Candidates::within(&some, pass, center, few).unwrap();
            let mut next = 0;
            for row in 0..all.len() {
                let at = all.pixel(row).map(i64::from);
                let is_usable = pass.parts.iter().all(|part| {
                    let level = pass.level + part.reads.step();
                    let exemplar = &some.levels[level];
                    let half = i64::from(part.side / 2);
                    // A center between two pixels of the coarser level belongs to both.
                    let ends = at.map(|at| match part.reads {
                        Reads::Same => [at - half, at + half],
                        Reads::Coarser => [at / 2 - half, (at + 1) / 2 + half],
                    });
                    let usable = exemplar.usable.as_ref().unwrap();
                    let wrap = exemplar.grid().wrap;
                    (ends[1][0]..=ends[1][1]).all(|y| {
                        let y = wrap[1].index(y, exemplar.size[1]);
                        (ends[0][0]..=ends[0][1]).all(|x| {
                            let x = wrap[0].index(x, exemplar.size[0]);
                            usable[(y * exemplar.size[0] + x) as usize]
                        })
                    })
                });
                let found = rows.row_of_pixel(at);
                assert_eq!(found, is_usable.then_some(next), "{edges:?} {at:?}");
                if is_usable {
                    assert_eq!(rows.pixel(next as usize), all.pixel(row), "pixel");
                    assert_eq!(rows.row(next as usize), all.row(row), "values");
                    next += 1;
                }
            }
            assert_eq!(rows.len(), next as usize, "no other rows");
            assert!((1..all.len()).contains(&rows.len()), "some");
        }
    }
}
