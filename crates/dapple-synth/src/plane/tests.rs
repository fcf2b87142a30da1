//! Tests synthesis in the plane against the paper's pseudocode.

use super::{MAX_PIXELS, PlaneDomain, PlaneTexture, synthesize_plane, synthesize_plane_with};
use crate::domain::SynthesisDomain;
use crate::{
    CoarserCenter, Coherence, Edges, Exemplar, Likeness, Options, Part, Pass, Reads, Schedule,
    Shape, SynthErrorKind,
};
use core::ops::ControlFlow;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::{Raster, Wrap};
use naive::naive;
use proptest::prelude::*;

mod guides;
mod naive;

/// Returns an exemplar of periodic smooth noise with two channels.
fn exemplar(size: [u32; 2], edges: Edges) -> Exemplar {
    let noise = |x: u32, y: u32, channel: u64| {
        let cell = [x % size[0] / 3, y % size[1] / 2].map(i64::from);
        unit_f32((hash2(Seed(channel), cell, 0) >> 32) as u32)
    };
    let planes = [0, 1].map(|channel| Raster::from_fn(size, |x, y| noise(x, y, channel)).unwrap());
    Exemplar::from_planes(&[(&planes[0], 1.0), (&planes[1], 0.5)], edges).unwrap()
}

fn paper(n_levels: usize, center: CoarserCenter) -> Options {
    Options {
        n_levels,
        center,
        ..Options::paper()
    }
}

/// Returns the sources of a texture as pixel indices.
fn made(exemplar: &Exemplar, size: [u32; 2], edges: [Edges; 2], options: &Options) -> Vec<u32> {
    let texture = synthesize_plane(exemplar, size, edges, options).unwrap();
    let pixel = |&[column, row]: &[u32; 2]| row * exemplar.size()[0] + column;
    texture.sources().pixels().iter().map(pixel).collect()
}

#[test]
fn textures_equal_the_pseudo_code_of_the_paper() {
    use Edges::{Cut, Wrap};
    for (size, edges, n_levels, tile) in [
        ([20, 14], [Cut, Cut], 1, Wrap),
        ([19, 13], [Cut, Cut], 2, Cut),
        ([20, 12], [Wrap, Cut], 2, Wrap),
        ([8, 16], [Wrap, Wrap], 3, Wrap),
        ([17, 8], [Cut, Wrap], 3, Cut),
        ([1, 1], [Cut, Cut], 2, Wrap),
        ([1, 9], [Wrap, Cut], 1, Wrap),
        ([4, 4], [Wrap, Wrap], 3, Wrap),
    ] {
        let exemplar = exemplar([24, 20], tile);
        for center in [CoarserCenter::Exact, CoarserCenter::Floor] {
            let options = paper(n_levels, center);
            let expected = naive(&exemplar, size, edges, &options);
            assert_eq!(
                made(&exemplar, size, edges, &options),
                expected,
                "{size:?} {edges:?} {n_levels} {center:?}"
            );
        }
    }
}

#[test]
fn schedules_of_the_user_equal_the_pseudo_code() {
    let exemplar = exemplar([24, 20], Edges::Wrap);
    let causal = Part::new(Shape::Causal, 5, Reads::Same);
    let coarser = Part::new(Shape::Full, 3, Reads::Coarser).with_weight(0.5);
    // Wei and Levoy: each level is filled with random pixels and visited once.
    let passes = vec![
        Pass {
            level: 1,
            parts: vec![causal],
        },
        Pass {
            level: 0,
            parts: vec![causal, coarser],
        },
        Pass {
            level: 0,
            parts: vec![Part::new(Shape::HalfWithRow, 15, Reads::Same)],
        },
    ];
    let two = Options {
        schedule: Some(Schedule { passes }),
        ..paper(2, CoarserCenter::Exact)
    };
    let one = Options {
        schedule: Some(Schedule::single_level(Shape::Full, 9)),
        ..paper(1, CoarserCenter::Exact)
    };
    for options in [one, two] {
        let size = [18, 12];
        let edges = [Edges::Wrap, Edges::Cut];
        assert_eq!(
            made(&exemplar, size, edges, &options),
            naive(&exemplar, size, edges, &options),
            "{options:?}"
        );
    }
}

#[test]
fn textures_do_not_depend_on_threads() {
    let exemplar = exemplar([24, 20], Edges::Cut);
    for edges in [[Edges::Wrap; 2], [Edges::Cut; 2]] {
        for (coherence, evenness) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)] {
            let options = Options {
                coherence: Coherence::Factor(coherence),
                evenness,
                ..Options::default()
            };
            let with = |n_threads| {
                let pool = rayon::ThreadPoolBuilder::new()
                    .num_threads(n_threads)
                    .build()
                    .unwrap();
                pool.install(|| made(&exemplar, [48, 40], edges, &options))
            };
            let one = with(1);
            assert_eq!(
                [with(2), with(7)],
                [one.clone(), one],
                "{edges:?} {coherence} {evenness}"
            );
        }
    }
}

#[test]
fn turns_keep_the_order_of_sites_that_read_each_other() {
    use Edges::{Cut, Wrap};
    for (size, edges) in [
        ([21, 9], [Cut, Cut]),
        ([16, 12], [Wrap, Wrap]),
        ([4, 16], [Wrap, Cut]),
        ([56, 8], [Wrap, Wrap]),
    ] {
        let domain = PlaneDomain::new(size, edges, &paper(2, CoarserCenter::Exact)).unwrap();
        for (level, half) in [(0, 3), (0, 7), (1, 1), (1, 3)] {
            let order = domain.order(level);
            let mut rank = vec![0; order.len()];
            for (at, &site) in order.iter().enumerate() {
                rank[site as usize] = at;
            }
            let turns = domain.turns(level, &half);
            let mut turn_of = vec![usize::MAX; order.len()];
            for turn in 0..turns.len() {
                turn_of[turns.turn(turn).0 as usize] = turn;
            }
            for &site in &order {
                for &other in near(&domain, level, site, half)
                    .iter()
                    .filter(|&&other| other != site)
                {
                    let [first, second] = [site, other].map(|site| site as usize);
                    let (first, second) = if rank[first] < rank[second] {
                        (first, second)
                    } else {
                        (second, first)
                    };
                    let (_, wait) = turns.turn(turn_of[second]);
                    assert!(
                        turn_of[first] < wait && wait <= turn_of[second],
                        "{size:?} {edges:?}: {second} does not wait for {first}"
                    );
                }
            }
        }
    }
}

/// Returns the sites that a site reads, without those past a cut edge.
fn near(domain: &PlaneDomain, level: usize, site: u32, half: i32) -> Vec<u32> {
    let size = domain.sizes[level];
    let [x, y] = domain.pixel(level, site).map(i64::from);
    let half = i64::from(half);
    let places = (-half..=half).flat_map(|j| (-half..=half).map(move |i| [x + i, y + j]));
    let inside = places.filter(|place| {
        (0..2).all(|axis| {
            domain.wrap[axis] == Wrap::Repeat || (0..i64::from(size[axis])).contains(&place[axis])
        })
    });
    inside
        .map(|[x, y]| Wrap::Repeat.index(y, size[1]) * size[0] + Wrap::Repeat.index(x, size[0]))
        .collect()
}

#[test]
fn slanted_lines_of_a_torus_wait_only_for_earlier_lines() {
    let domain = PlaneDomain::new(
        [512, 256],
        [Edges::Wrap; 2],
        &paper(2, CoarserCenter::Exact),
    )
    .unwrap();
    let turns = domain.turns(0, &3);
    // A new line begins with the first site that waits for a site of the current line.
    let (mut n_lines, mut first) = (1, 0);
    for turn in 0..turns.len() {
        if turns.turn(turn).1 > first {
            (n_lines, first) = (n_lines + 1, turn);
        }
    }
    // The number is the same as on a plane: lines through opposite corners are 511 + 4 · 255 apart.
    assert_eq!(n_lines, 512 + 4 * 255, "lines of 512 x 256 pixels");
}

/// Returns smooth waves with a period of 8 pixels in both directions.
fn waves() -> Raster<f32> {
    let wave = |at: u32| ((at % 8) as f32 - 3.5).abs() / 4.0;
    Raster::from_fn([32, 32], |x, y| wave(x) + 0.5 * wave(y)).unwrap()
}

/// Returns the mean absolute difference between neighbors within rows, and between the last and the first pixel of a
/// row.
fn jumps(made: &Raster<f32>) -> [f64; 2] {
    let [width, height] = made.size();
    let (mut sums, mut counts) = ([0.0; 2], [0; 2]);
    for [x, y] in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
        let next = made.row(y)[((x + 1) % width) as usize];
        let meets = usize::from(x + 1 == width);
        sums[meets] += f64::from((made.row(y)[x as usize] - next).abs());
        counts[meets] += 1;
    }
    [0, 1].map(|meets| sums[meets] / f64::from(counts[meets]))
}

#[test]
fn a_texture_that_wraps_has_no_seam() {
    let plane = waves();
    // A width of 44 pixels ends in the middle of a wave.
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap).unwrap();
    let with = |edges| {
        let texture = synthesize_plane(&exemplar, [44, 64], [edges; 2], &Options::default());
        jumps(&texture.unwrap().transfer(&plane).unwrap())
    };
    let [inside, seam] = with(Edges::Wrap);
    assert!(seam < 1.3 * inside, "wrapping: {seam} beside {inside}");
    let [inside, seam] = with(Edges::Cut);
    assert!(seam > 1.5 * inside, "cut: {seam} beside {inside}");
}

#[test]
fn textures_look_like_their_exemplar() {
    let plane = waves();
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap).unwrap();
    let likeness = |image: &Raster<f32>| {
        let image = Exemplar::from_planes(&[(image, 1.0)], Edges::Cut).unwrap();
        Likeness::new(&exemplar, &image).unwrap()
    };
    let size = [44, 64];
    let texture = synthesize_plane(&exemplar, size, [Edges::Cut; 2], &Options::default()).unwrap();
    let made = likeness(&texture.transfer(&plane).unwrap());
    let pixel = |x: u32, y: u32| hash2(Seed(5), [x.into(), y.into()], 0) as usize % 1024;
    let random = likeness(&Raster::from_fn(size, |x, y| plane.pixels()[pixel(x, y)]).unwrap());
    assert!(
        made.patches < 0.4 * random.patches,
        "{made:?} beside random pixels: {random:?}"
    );
}

#[test]
fn evenness_makes_more_of_the_exemplar_used() {
    let exemplar = exemplar([64, 64], Edges::Cut);
    let used = |evenness| {
        let options = Options {
            evenness,
            ..Options::default()
        };
        let mut sources = made(&exemplar, [96, 96], [Edges::Cut; 2], &options);
        sources.sort_unstable();
        sources.dedup();
        sources.len()
    };
    let [plain, even] = [0.0, 1.0].map(used);
    assert!(even > plain, "{even} beside {plain} pixels");
}

#[test]
fn maps_follow_the_sources() {
    let exemplar = exemplar([12, 9], Edges::Wrap);
    let texture = synthesize_plane(
        &exemplar,
        [8, 6],
        [Edges::Cut; 2],
        &paper(1, CoarserCenter::Exact),
    )
    .unwrap();
    let places = Raster::from_fn([12, 9], |x, y| [x, y]).unwrap();
    assert_eq!(
        texture.transfer(&places).unwrap(),
        *texture.sources(),
        "places"
    );
    let other = Raster::filled([9, 12], 0.0).unwrap();
    let refused = texture.transfer(&other).unwrap_err();
    assert!(
        matches!(refused.kind(), SynthErrorKind::Detail { .. }),
        "{refused}"
    );
}

/// Returns the kind of a synthesis's error.
fn kind(size: [u32; 2], edges: Edges, options: &Options) -> SynthErrorKind {
    let exemplar = exemplar([24, 20], Edges::Wrap);
    let result = synthesize_plane(&exemplar, size, [edges; 2], options);
    result.unwrap_err().kind().clone()
}

#[test]
fn bad_sizes_are_refused() {
    let three = paper(3, CoarserCenter::Exact);
    for size in [
        [0, 8],
        [8, 0],
        [u32::MAX, u32::MAX],
        [1 << 14, (MAX_PIXELS >> 14) as u32 + 1],
    ] {
        assert!(
            matches!(kind(size, Edges::Cut, &three), SynthErrorKind::Range { .. }),
            "{size:?}"
        );
    }
    for size in [[8, 6], [6, 8], [1, 8], [9, 8]] {
        assert!(
            matches!(
                kind(size, Edges::Wrap, &three),
                SynthErrorKind::Range { .. }
            ),
            "{size:?}"
        );
    }
}

#[test]
fn bad_options_are_refused() {
    let three = paper(3, CoarserCenter::Exact);
    for n_levels in [0, 17, usize::MAX] {
        let options = paper(n_levels, CoarserCenter::Exact);
        assert!(
            matches!(
                kind([8, 8], Edges::Cut, &options),
                SynthErrorKind::Range { .. }
            ),
            "{n_levels} levels"
        );
    }
    let deep = kind([8, 8], Edges::Cut, &paper(4, CoarserCenter::Exact));
    assert!(
        matches!(
            deep,
            SynthErrorKind::Exemplar {
                level: 3,
                side: 7,
                ..
            }
        ),
        "{deep:?}"
    );
    for coherence in [-1.0, f32::NAN, f32::INFINITY] {
        let options = Options {
            coherence: Coherence::Factor(coherence),
            ..three.clone()
        };
        assert!(
            matches!(
                kind([8, 8], Edges::Cut, &options),
                SynthErrorKind::Range { .. }
            ),
            "{coherence}"
        );
    }
    for evenness in [-1.0, 1001.0, f32::NAN, f32::INFINITY] {
        let options = Options {
            evenness,
            ..three.clone()
        };
        assert!(
            matches!(
                kind([8, 8], Edges::Cut, &options),
                SynthErrorKind::Range { .. }
            ),
            "{evenness}"
        );
    }
    let unfilled = Options {
        schedule: Some(Schedule {
            passes: Schedule::paper(3).passes[3..].to_vec(),
        }),
        ..three
    };
    assert_eq!(
        kind([8, 8], Edges::Cut, &unfilled),
        SynthErrorKind::Unfilled { pass: 0, level: 1 },
        "schedule"
    );
}

#[test]
fn the_callback_can_stop() {
    let exemplar = exemplar([24, 20], Edges::Wrap);
    let mut calls = 0;
    let result = synthesize_plane_with(
        &exemplar,
        [16, 16],
        [Edges::Cut; 2],
        &Options::default(),
        |progress| {
            calls += 1;
            if progress.pass == 2 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    );
    assert_eq!(
        *result.unwrap_err().kind(),
        SynthErrorKind::Cancelled,
        "stopped"
    );
    assert_eq!(calls, 3, "one call for each small pass until then");
}

#[test]
fn value_stability_plane() {
    let exemplar = exemplar([24, 20], Edges::Cut);
    let row = made(&exemplar, [16, 12], [Edges::Wrap; 2], &Options::default())[..8].to_vec();
    assert_eq!(
        row,
        [293, 294, 295, 297, 298, 299, 300, 301],
        "sources of the first pixels"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_sizes_give_a_texture_or_an_error(
        tile in [1_u32..20, 1_u32..20], size in [1_u32..20, 1_u32..20], wrap: [bool; 3], n_levels in 1_usize..5,
    ) {
        let [a, b, c] = wrap.map(|wrap| if wrap { Edges::Wrap } else { Edges::Cut });
        let exemplar = exemplar(tile, a);
        let options = Options { n_levels, ..Options::default() };
        if let Ok(texture) = synthesize_plane(&exemplar, size, [b, c], &options) {
            prop_assert_eq!(texture.sources().size(), size);
            prop_assert!(texture.sources().pixels().iter().all(|[x, y]| *x < tile[0] && *y < tile[1]));
        }
    }
}

/// Returns a texture that consists of a single piece of an exemplar with 12 × 9 pixels.
fn one_piece() -> PlaneTexture {
    PlaneTexture {
        sources: Raster::from_fn([24, 18], |x, y| [(x + 5) % 12, (y + 7) % 9]).unwrap(),
        edges: [Edges::Wrap; 2],
        exemplar_size: [12, 9],
        exemplar_edges: Edges::Wrap,
    }
}

#[test]
fn larger_map_is_copied_where_the_texture_goes_on_with_it() {
    let places = Raster::from_fn([48, 36], |x, y| [x, y]).unwrap();
    let enlarged = one_piece().transfer(&places).unwrap();
    let expected = Raster::from_fn([96, 72], |x, y| [(x + 20) % 48, (y + 28) % 36]).unwrap();
    assert_eq!(enlarged, expected);
}

#[test]
fn pixel_alone_among_others_is_rounded_off_in_a_larger_texture() {
    let mut texture = one_piece();
    texture.sources.pixels_mut()[5 * 24 + 8] = [2, 2];
    let places = Raster::from_fn([96, 72], |x, y| [x, y]).unwrap();
    let enlarged = texture.transfer(&places).unwrap();
    let plain = one_piece().transfer(&places).unwrap();
    let others = || {
        (0..)
            .zip(enlarged.pixels())
            .filter(|&(at, place)| plain.pixels()[at] != *place)
    };
    // The corners of the square of 8 × 8 pixels belong to the piece around it.
    assert!((20..60).contains(&others().count()), "{}", others().count());
    for (at, &[x, y]) in others() {
        let [column, row] = [at as u32 % 192, at as u32 / 192];
        assert_eq!(
            [column - 8 * 8, row - 5 * 8],
            [x - 2 * 8, y - 2 * 8],
            "its own pixel"
        );
    }
}
