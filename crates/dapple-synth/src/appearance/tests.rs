//! Tests of corrections on surfaces.

use super::links::Links;
use super::{Appearance, Choice, choose};
use crate::endless::stage::DIAGONALS;
use crate::places::{Frame, Frames};
use crate::shapes::{on_threads, sheet, sphere, synthesizer};
use crate::{
    Edges, Exemplar, Matching, Options, SiteIdx, SurfaceTexture, SynthErrorKind, Synthesizer,
};
use core::ops::ControlFlow;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::Raster;
use glam::{DVec3, Vec2};

fn noise(edges: Edges) -> Exemplar {
    let value =
        |x: u32, y: u32| unit_f32((hash2(Seed(4), [x / 2, y / 3].map(i64::from), 0) >> 32) as u32);
    let plane = Raster::from_fn([24, 20], value).unwrap();
    Exemplar::from_planes(&[(&plane, 1.0)], edges).unwrap()
}

fn ball() -> Synthesizer {
    synthesizer(sphere(), 1500, |at, normal| normal.cross(at + DVec3::X))
}

fn options() -> Options {
    Options {
        n_levels: 2,
        matching: Matching::Appearance,
        ..Options::default()
    }
}

fn sources(texture: &SurfaceTexture) -> Vec<[u32; 2]> {
    texture.sources(0).collect()
}

/// The way from one site to another one in pixels.
fn way(ball: &Synthesizer, frames: &[Frame], [from, to]: [usize; 2]) -> Vec2 {
    let positions = ball.hierarchy().sites().positions();
    let way = (positions[to] - positions[from]).as_vec3();
    0.5 * (frames[from].flat(way) + frames[to].flat(way))
}

#[test]
fn links_are_the_sites_on_the_diagonals_that_two_edges_reach() {
    let ball = ball();
    let frames = Frames::new(&ball, &[]).of_site;
    for level in 0..2 {
        let links = Links::new(ball.hierarchy(), &frames, level);
        let graph = ball.hierarchy().levels()[level].graph();
        let spacing = (1 << level) as f32;
        for site in 0..graph.len() {
            let connected = |a: usize, b: usize| {
                let near = graph.neighbors(SiteIdx(a as u32));
                near.contains(&SiteIdx(b as u32))
            };
            let read = links.of(site);
            let near: Vec<usize> = (0..graph.len())
                .filter(|&other| connected(site, other))
                .collect();
            assert!(
                read.near
                    .iter()
                    .map(|link| link.site as usize)
                    .eq(near.iter().copied()),
                "neighbors of {site}"
            );
            for (corner, diagonal) in DIAGONALS.iter().enumerate() {
                let middle = Vec2::from(diagonal.map(|at| 1.6 * at as f32)) * spacing;
                let is_there = |&other: &usize| {
                    let is_reached =
                        connected(site, other) || near.iter().any(|&near| connected(near, other));
                    let way = way(&ball, &frames, [site, other]);
                    other != site
                        && is_reached
                        && way.distance(middle) < 1.1 * spacing
                        && way.x * middle.x > 0.0
                        && way.y * middle.y > 0.0
                };
                let found = read.corners[corner].iter().map(|link| link.site as usize);
                let expected = (0..graph.len()).filter(is_there);
                assert!(found.eq(expected), "site {site}, diagonal {diagonal:?}");
            }
        }
    }
}

#[test]
fn classes_have_every_site_once_and_no_two_that_are_connected() {
    let ball = ball();
    let frames = Frames::new(&ball, &[]).of_site;
    let links = Links::new(ball.hierarchy(), &frames, 0);
    let graph = ball.hierarchy().levels()[0].graph();
    let mut all = links.classes.concat();
    all.sort_unstable();
    assert!(all.into_iter().eq(0..graph.len() as u32), "every site once");
    for class in &links.classes {
        for &site in class {
            let near = graph.neighbors(SiteIdx(site));
            assert!(near.iter().all(|near| !class.contains(&near.0)), "{site}");
        }
    }
}

#[test]
fn sites_take_the_place_that_comparing_with_all_they_may_take_finds() {
    let ball = ball();
    let exemplar = noise(Edges::Cut);
    let appearance = Appearance::new(&ball, &exemplar, &options()).unwrap();
    let (frames, stage) = (&appearance.frames, &appearance.stages[0]);
    let links = Links::new(ball.hierarchy(), frames, 0);
    let usable = stage.usable_pixels();
    let places: Vec<[u32; 2]> = (0..1500)
        .map(|site: usize| usable[site * 7 % usable.len()])
        .map(|pixel| [pixel % 24, pixel / 24])
        .collect();
    let from = |site: usize, way: Vec2| {
        let way = way.round();
        let [x, y] = places[site];
        [i64::from(x) + way.x as i64, i64::from(y) + way.y as i64]
    };
    for site in 0..1500 {
        let read = links.of(site);
        let around = DIAGONALS.iter().zip(read.corners).map(|(diagonal, sites)| {
            let diagonal = Vec2::from(diagonal.map(|at| at as f32));
            let there = sites.iter().map(|link| {
                let way = way(&ball, frames, [site, link.site as usize]);
                *stage.features(from(link.site as usize, diagonal - way))
            });
            let there: Vec<[f32; 8]> = there.collect();
            core::array::from_fn::<f32, 8, _>(|i| {
                there.iter().map(|features| features[i]).sum::<f32>() / there.len() as f32
            })
        });
        let around: Vec<[f32; 8]> = around.collect();
        let unlike = |[x, y]: [i64; 2]| -> f32 {
            let corners = around.iter().zip(DIAGONALS);
            let squares = corners.flat_map(|(own, [i, j])| {
                let other = stage.features([x + i, y + j]);
                own.iter().zip(other).map(|(a, b)| (a - b) * (a - b))
            });
            squares.sum()
        };
        let coherent = read.near.iter().filter_map(|link| {
            let way = way(&ball, frames, [site, link.site as usize]);
            stage.usable(from(link.site as usize, -way))
        });
        let mut coherent: Vec<[i64; 2]> = coherent.collect();
        coherent.push(places[site].map(i64::from));
        let alike = coherent.iter().filter_map(|&place| stage.similar(place));
        let alike = alike.map(|place| 3.0 * unlike(place));
        let least = coherent
            .iter()
            .map(|&place| unlike(place))
            .chain(alike)
            .fold(f32::INFINITY, f32::min);
        let Choice { distance_sq, .. } = choose(stage, &links, site, &places, 2.0);
        // Sums of the same squares in another order.
        assert!(
            (distance_sq - least).abs() <= 1e-4 * least,
            "{site}: {distance_sq}, {least}"
        );
    }
}

#[test]
fn textures_have_the_same_bits_on_any_number_of_threads() {
    for edges in [Edges::Cut, Edges::Wrap] {
        let [one, two, seven] =
            on_threads(|| ball().synthesize(&noise(edges), &options()).unwrap());
        assert!(one == two && one == seven, "{edges}");
    }
}

#[test]
fn textures_have_nothing_that_a_mask_leaves_out() {
    let is_clean = |x: u32, y: u32| x.abs_diff(12) > 2 || y.abs_diff(9) > 2;
    let mask = Raster::from_fn([24, 20], is_clean).unwrap();
    let exemplar = noise(Edges::Wrap).with_mask(&mask).unwrap();
    let texture = ball().synthesize(&exemplar, &options()).unwrap();
    for [x, y] in sources(&texture) {
        assert!(is_clean(x, y), "column {x}, row {y}");
    }
}

#[test]
fn progress_goes_over_all_levels_and_can_stop() {
    let (ball, exemplar) = (ball(), noise(Edges::Wrap));
    let mut last = (0, 0);
    let texture = ball.synthesize_with(&exemplar, &options(), |progress| {
        assert_eq!(progress.n_passes, 3, "one for the sweep and two levels");
        assert!(progress.done <= progress.n_sites, "{progress:?}");
        assert!(
            (progress.pass, progress.done) > last,
            "{progress:?}, {last:?}"
        );
        last = (progress.pass, progress.done);
        ControlFlow::Continue(())
    });
    assert!(texture.is_ok(), "{texture:?}");
    assert_eq!(last, (2, 3 * 1500), "all");
    let stopped = ball.synthesize_with(&exemplar, &options(), |progress| match progress.pass {
        2 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    });
    let kind = stopped.unwrap_err().kind().clone();
    assert!(matches!(kind, SynthErrorKind::Cancelled), "{kind:?}");
}

#[test]
fn strands_go_on_from_one_side_to_the_other() {
    // Strands that sway, every 16 pixels.
    let is_strand = |x: u32, y: u32| {
        let sway = (x % 32).abs_diff(16) / 3;
        (y + sway) % 16 < 5
    };
    let plane = Raster::from_fn([32, 32], |x, y| f32::from(is_strand(x, y))).unwrap();
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap).unwrap();
    let square = sheet([4; 2], [true; 2], |u, v| DVec3::new(u, v, 0.0));
    let flat = synthesizer(square, 6000, |_, _| DVec3::NEG_Y);
    let texture = flat.synthesize(&exemplar, &options()).unwrap();
    let (n_pieces, n_torn) = pieces(&flat, &texture.transfer(&plane).unwrap());
    assert_eq!(n_torn, 0, "strands with an end within");
    assert!(n_pieces >= 4, "{n_pieces} strands");
}

/// The pieces of more than 8 connected sites with a value above 0.5, and how many of them do not go from x = 0 to 1 though they
/// are away from the edges along y.
fn pieces(flat: &Synthesizer, values: &[f32]) -> (usize, usize) {
    let graph = flat.hierarchy().levels()[0].graph();
    let positions = flat.hierarchy().sites().positions();
    let mut is_seen = vec![false; values.len()];
    let (mut n_pieces, mut n_torn) = (0, 0);
    for first in 0..values.len() {
        let mut piece = vec![first];
        let mut at = 0;
        while at < piece.len() && values[first] > 0.5 && !is_seen[first] {
            for near in graph.neighbors(SiteIdx(piece[at] as u32)) {
                let near = near.index();
                if values[near] > 0.5 && !piece.contains(&near) {
                    piece.push(near);
                }
            }
            at += 1;
        }
        for &site in &piece {
            is_seen[site] |= values[first] > 0.5;
        }
        if piece.len() > 8 {
            n_pieces += 1;
            let along = |axis: usize| piece.iter().map(move |&site| positions[site][axis]);
            let is_inner = along(1).all(|y| (0.1..0.9).contains(&y));
            let low = along(0).fold(1.0, f64::min);
            let high = along(0).fold(0.0, f64::max);
            n_torn += usize::from(is_inner && (low > 0.05 || high < 0.95));
        }
    }
    (n_pieces, n_torn)
}

#[test]
fn value_stability_appearance() {
    let texture = ball().synthesize(&noise(Edges::Wrap), &options()).unwrap();
    let sources: Vec<[u32; 2]> = texture.sources(0).step_by(300).collect();
    assert_eq!(
        sources,
        [[23, 7], [19, 2], [14, 12], [13, 7], [18, 12]],
        "some sources"
    );
}
