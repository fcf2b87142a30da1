//! Tests for correction in appearance space on surfaces.

use super::links::Links;
use super::{Appearance, Choice, around, choose, distance_sq, middle, pixel, quarters};
use crate::endless::level::{self, AppearanceLevel, DIAGONALS};
use crate::engine::Wanted;
use crate::guides::Targets;
use crate::orientation::offset_before;
use crate::places::{Frame, Frames};
use crate::shapes::{on_threads, sheet, sites_on, sphere, square, synthesizer};
use crate::{
    Edges, Exemplar, Matching, Options, Orientation, SiteIdx, SurfaceTexture, Symmetry,
    SynthErrorKind, Synthesizer,
};
use core::ops::ControlFlow;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_mesh::Surface;
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

fn ball_along(symmetry: Symmetry) -> Synthesizer {
    let hierarchy = sites_on(sphere(), 1500, 2);
    let axis = Orientation::AXIS;
    let orientation = Orientation::symmetric(&hierarchy, &[], axis, symmetry).unwrap();
    let surface = Surface::new(sphere()).unwrap();
    Synthesizer::from_parts(surface, hierarchy, orientation, None).unwrap()
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

/// Rotates an offset by quarter turns; each turns right into up.
fn before([mut x, mut y]: [f32; 2], quarters: u8) -> Vec2 {
    for _ in 0..quarters {
        (x, y) = (y, -x);
    }
    Vec2::new(x, y)
}

/// Returns the relative rotation of the exemplar between two sites, in quarter turns, found by comparing all rotations.
fn turn(frames: &[Frame], symmetry: Symmetry, [from, to]: [usize; 2]) -> u8 {
    let Frame { right, down, .. } = frames[from];
    let alike = |&quarters: &u8| match quarters {
        0 => down.dot(frames[to].down),
        1 => right.dot(frames[to].down),
        2 => -down.dot(frames[to].down),
        _ => -right.dot(frames[to].down),
    };
    let turns = symmetry.quarters().iter().copied();
    turns.max_by(|a, b| alike(a).total_cmp(&alike(b))).unwrap()
}

/// Returns the offset from one site to another, in pixels.
fn way(ball: &Synthesizer, frames: &[Frame], [from, to]: [usize; 2]) -> Vec2 {
    let positions = ball.hierarchy().sites().positions();
    let way = (positions[to] - positions[from]).as_vec3();
    let quarters = turn(frames, ball.orientation().symmetry(), [from, to]);
    0.5 * (frames[from].flat(way) + before(frames[to].flat(way).to_array(), quarters))
}

#[test]
fn links_are_the_sites_on_the_diagonals_that_two_edges_reach() {
    let ball = ball();
    let frames = Frames::new(&ball, &[]);
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
                    .map(|link| link.site())
                    .eq(near.iter().copied()),
                "neighbors of {site}"
            );
            for (corner, diagonal) in DIAGONALS.iter().enumerate() {
                let middle = Vec2::from(diagonal.map(|at| 1.6 * at as f32)) * spacing;
                let is_there = |&other: &usize| {
                    let is_reached =
                        connected(site, other) || near.iter().any(|&near| connected(near, other));
                    let way = way(&ball, &frames.of_site, [site, other]);
                    other != site
                        && is_reached
                        && way.distance(middle) < 1.1 * spacing
                        && way.x * middle.x > 0.0
                        && way.y * middle.y > 0.0
                };
                let found = read.corners[corner].iter().map(|link| link.site());
                let expected = (0..graph.len()).filter(is_there);
                assert!(found.eq(expected), "site {site}, diagonal {diagonal:?}");
            }
        }
    }
}

#[test]
fn classes_have_every_site_once_and_no_two_that_are_connected() {
    let ball = ball();
    let frames = Frames::new(&ball, &[]);
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
    for symmetry in [Symmetry::One, Symmetry::Two, Symmetry::Four] {
        takes_the_place_that_comparing_with_all_finds(&ball_along(symmetry));
    }
}

/// Assigns the rotations of a symmetry to the coarsest sites in turn. Returns an empty list without a symmetry.
fn all_quarters(ball: &Synthesizer) -> Vec<u8> {
    let turns = match ball.orientation().symmetry() {
        Symmetry::One => &[],
        symmetry => symmetry.quarters(),
    };
    let turns = turns.iter().copied().cycle();
    turns.take(ball.hierarchy().levels()[1].n_sites()).collect()
}

/// Returns the position at an offset from another one. Positions are in eighths of a pixel, offsets in pixels.
fn from([x, y]: [u32; 2], way: Vec2) -> [i64; 2] {
    let way = (8.0 * way).round();
    [i64::from(x) + way.x as i64, i64::from(y) + way.y as i64]
}

fn pixel_of(place: [i64; 2]) -> [i64; 2] {
    place.map(|at| at.div_euclid(8))
}

fn usable_at(stage: &AppearanceLevel, place: [i64; 2]) -> Option<[i64; 2]> {
    let pixel = stage.usable(pixel_of(place))?;
    Some([0, 1].map(|axis| 8 * pixel[axis] + place[axis].rem_euclid(8)))
}

/// Returns the usable positions half a pixel from a position.
fn aside(stage: &AppearanceLevel, [x, y]: [i64; 2]) -> Vec<[i64; 2]> {
    let aside = [[x + 4, y], [x - 4, y], [x, y + 4], [x, y - 4]].into_iter();
    aside.filter_map(|place| usable_at(stage, place)).collect()
}

/// Returns a position followed by others, keeping only the first of several in the same pixel.
fn first_in_pixels(own: [i64; 2], others: impl Iterator<Item = [i64; 2]>) -> Vec<[i64; 2]> {
    let mut places = vec![own];
    for place in others {
        if places
            .iter()
            .all(|&other| pixel_of(other) != pixel_of(place))
        {
            places.push(place);
        }
    }
    places
}

fn takes_the_place_that_comparing_with_all_finds(ball: &Synthesizer) {
    let guide = Raster::from_fn([24, 20], |x, y| (x * y % 7) as f32 / 7.0).unwrap();
    let exemplar = noise(Edges::Cut).with_guides(&[(&guide, 0.5)]).unwrap();
    let wanted: Vec<f32> = (0..1500).map(|site| (site % 5) as f32 / 5.0).collect();
    let targets = Targets::of_surface(&exemplar, &[&wanted], ball.hierarchy(), 2).unwrap();
    let symmetry = ball.orientation().symmetry();
    let quarters = all_quarters(ball);
    let appearance = Appearance::new(ball, &exemplar, &targets, &quarters, &options()).unwrap();
    let stage = &appearance.stages[0];
    let links = Links::new(ball.hierarchy(), &appearance.frames, 0);
    let frames = &appearance.frames.of_site;
    let turn = |from: usize, to: usize| turn(frames, symmetry, [from, to]);
    let mut n_turned = 0;
    let usable = stage.usable_pixels();
    let places: Vec<[u32; 2]> = (0..1500)
        .map(|site: usize| usable[site * 7 % usable.len()])
        .map(|pixel| [pixel % 24, pixel / 24])
        .enumerate()
        .map(|(site, [x, y])| [8 * x + site as u32 % 8, 8 * y + site as u32 / 8 % 8])
        .collect();
    for site in 0..1500 {
        let read = links.of(site);
        let around = DIAGONALS.iter().zip(read.corners).map(|(diagonal, sites)| {
            let diagonal = Vec2::from(diagonal.map(|at| at as f32));
            let there = sites.iter().map(|link| {
                let other = link.site();
                let quarters = turn(site, other);
                n_turned += usize::from(quarters != 0);
                let way = diagonal - way(ball, frames, [site, other]);
                let way = before(way.to_array(), (4 - quarters) % 4);
                *stage.turned_features(pixel_of(from(places[other], way)), quarters)
            });
            let there: Vec<[f32; 8]> = there.collect();
            core::array::from_fn::<f32, 8, _>(|i| {
                there.iter().map(|features| features[i]).sum::<f32>() / there.len() as f32
            })
        });
        let around: Vec<[f32; 8]> = around.collect();
        let unlike = |place: [i64; 2]| {
            // The weight 0.5, times four diagonals.
            let off = guide.row(place[1] as u32)[place[0] as usize] - wanted[site];
            unlike(stage, &around, place) + 2.0 * off * off
        };
        let same = read.near.iter();
        let same = same.filter(|link| turn(site, link.site()) == 0);
        let ahead = same.filter_map(|link| {
            let way = way(ball, frames, [site, link.site()]);
            usable_at(stage, from(places[link.site()], -way))
        });
        let coherent = first_in_pixels(places[site].map(i64::from), ahead);
        let of_place = |&place: &[i64; 2]| unlike(pixel_of(place));
        let nearest = coherent.iter();
        let nearest = nearest.min_by(|a, b| of_place(a).total_cmp(&of_place(b)));
        let aside = aside(stage, *nearest.unwrap());
        let alike = coherent.iter();
        let alike = alike.filter_map(|&place| stage.similar(pixel_of(place)));
        let alike = alike.map(|place| 3.0 * unlike(place));
        let all = coherent.iter().copied().chain(aside);
        let all = all.map(|place| of_place(&place)).chain(alike);
        let least = all.fold(f32::INFINITY, f32::min);
        let wanted = targets.of(0, site as u32);
        let Choice { distance_sq, .. } = choose(stage, &links, site, &places, wanted);
        // The terms are summed in a different order than in the code.
        assert!(
            (distance_sq - least).abs() <= 1e-4 * least,
            "{symmetry}, {site}: {distance_sq}, {least}"
        );
    }
    assert_eq!(
        n_turned > 1000,
        symmetry != Symmetry::One,
        "{n_turned} turned"
    );
}

#[test]
fn sites_whose_guides_are_off_search_all_of_the_exemplar() {
    let ball = ball();
    let is_right = Raster::from_fn([24, 20], |x, _| f32::from(x >= 12)).unwrap();
    let exemplar = noise(Edges::Wrap).with_guides(&[(&is_right, 3.0)]).unwrap();
    let wanted: Vec<f32> = (0..1500).map(|site| f32::from(site % 3 == 0)).collect();
    let targets = Targets::of_surface(&exemplar, &[&wanted], ball.hierarchy(), 2).unwrap();
    let appearance = Appearance::new(&ball, &exemplar, &targets, &[], &options()).unwrap();
    let stage = &appearance.stages[0];
    let links = Links::new(ball.hierarchy(), &appearance.frames, 0);
    let before: Vec<[u32; 2]> = (0..1500)
        .map(|site| middle([site % 12, site % 20]))
        .collect();
    let mut places = before.clone();
    let mut tell = |_| Ok(());
    appearance
        .apply_guides(0, &links, &mut places, &mut tell)
        .expect("nobody stops it");
    let mut n_exact = 0;
    for (site, place) in places.into_iter().enumerate() {
        if wanted[site] == 0.0 {
            assert_eq!(place, before[site], "{site} is where it should be");
            continue;
        }
        let around = around(stage, &links, site, &before);
        if around.iter().any(Option::is_none) {
            // Missing features are replaced by a mean, so the result is not exact.
            continue;
        }
        n_exact += 1;
        let off = |place: [i64; 2]| {
            distance_sq(stage, &around, place) + stage.guides_distance_sq(&[3_f32.sqrt()], place)
        };
        let all = (0..20).flat_map(|row| (0..24).map(move |column| off([column, row])));
        let least = all.fold(f32::INFINITY, f32::min);
        // The terms are summed in a different order than in the code.
        assert!(
            off(pixel(place)) <= least * 1.0001,
            "{site}: {} {least}",
            off(pixel(place))
        );
    }
    assert!(n_exact > 400, "{n_exact} of 500");
}

/// Returns the squared distance between the features on the diagonals of a site and those on the diagonals of a pixel.
fn unlike(stage: &AppearanceLevel, around: &[[f32; 8]], [x, y]: [i64; 2]) -> f32 {
    let corners = around.iter().zip(DIAGONALS);
    let squares = corners.flat_map(|(own, [i, j])| {
        let other = stage.features([x + i, y + j]);
        own.iter().zip(other).map(|(a, b)| (a - b) * (a - b))
    });
    squares.sum()
}

#[test]
fn features_of_what_looks_alike_when_turned_are_those_at_the_turned_place() {
    const SIDE: i64 = 15;
    let around = |at: [i64; 2]| at.map(|at| (at - 7).rem_euclid(SIDE));
    let value = |x: u32, y: u32| {
        let mut at = [x, y].map(|at| i64::from(at) - 7);
        let mut values = [0.0; 4];
        for value in &mut values {
            at = offset_before(at, 1);
            *value = unit_f32((hash2(Seed(3), at.map(|at| at.rem_euclid(SIDE)), 0) >> 32) as u32);
        }
        // Sort, so that the sum does not depend on the rotation.
        values.sort_unstable_by(f32::total_cmp);
        values.iter().sum()
    };
    let plane = Raster::from_fn([SIDE as u32; 2], value).unwrap();
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap).unwrap();
    for symmetry in [Symmetry::One, Symmetry::Two, Symmetry::Four] {
        let stage = &level::stages(
            &exemplar,
            &exemplar.guides,
            symmetry,
            1,
            &Wanted::new(&|| false),
        )
        .unwrap()[0];
        for place in (0..SIDE * SIDE).map(|pixel| [pixel % SIDE, pixel / SIDE]) {
            for &quarters in symmetry.quarters() {
                let turned = offset_before(around(place), quarters).map(|at| at + 7);
                assert_eq!(
                    stage.turned_features(place, quarters),
                    stage.features(turned),
                    "{symmetry}, {place:?}, {quarters}"
                );
            }
        }
    }
}

#[test]
fn exemplars_lie_turned_as_at_the_neighbors_but_along_seams() {
    for symmetry in [Symmetry::Two, Symmetry::Four] {
        let ball = ball_along(symmetry);
        let (graph, normals) = (
            ball.hierarchy().levels()[0].graph(),
            ball.hierarchy().sites().normals(),
        );
        let agrees = |quarters: &[u8], site: usize, near: SiteIdx| {
            let (near, of_near) = (near.index(), quarters[near.index()]);
            let toward = ball
                .orientation()
                .quarters_toward(normals, site, near, of_near);
            toward == quarters[site]
        };
        let texture = ball.synthesize(&noise(Edges::Wrap), &options()).unwrap();
        let (mut same, mut all) = (0, 0);
        for site in 0..graph.len() {
            let near = graph.neighbors(SiteIdx(site as u32)).iter();
            all += near.len();
            same += near
                .filter(|&&near| agrees(&texture.quarters, site, near))
                .count();
        }
        // Seams connect singularities, and there are only a few.
        assert!(same * 100 > 93 * all, "{symmetry}: {same} of {all}");

        // Every finer site takes its rotation from one of the coarser sites among its neighbors.
        let n_coarser = ball.hierarchy().levels()[1].n_sites();
        let turns = symmetry.quarters().iter().copied().cycle();
        let coarsest: Vec<u8> = turns.take(n_coarser).collect();
        let all = quarters(&ball, &coarsest, 2);
        assert_eq!(all.len(), graph.len(), "{symmetry}");
        assert_eq!(all[..n_coarser], coarsest, "{symmetry}");
        for site in n_coarser..graph.len() {
            let near = graph.neighbors(SiteIdx(site as u32)).iter();
            let mut coarser = near.filter(|near| near.index() < n_coarser);
            assert!(
                coarser.any(|&near| agrees(&all, site, near)),
                "{symmetry}, {site}"
            );
        }
    }
}

#[test]
fn textures_have_the_same_bits_on_any_number_of_threads() {
    for (edges, symmetry) in [
        (Edges::Cut, Symmetry::One),
        (Edges::Wrap, Symmetry::One),
        (Edges::Cut, Symmetry::Four),
    ] {
        let ball = ball_along(symmetry);
        let [one, two, seven] = on_threads(|| ball.synthesize(&noise(edges), &options()).unwrap());
        assert!(one == two && one == seven, "{edges}, {symmetry}");
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
fn links_reach_as_far_as_pixels_do() {
    for (scale, levels, n_most) in [(0.5, 0, 8), (1.4, 0, 14), (2.5, 1, 14), (7.0, 1, 40)] {
        let flat = synthesizer(square(), 3000, |_, _| DVec3::NEG_Y);
        let flat = flat.with_scales(vec![scale; 3000]).unwrap();
        let links = Links::new(flat.hierarchy(), &Frames::new(&flat, &[]), 0);
        let n_read = flat.hierarchy().levels()[levels].n_sites();
        // The distance between features is a pixel, or a spacing if that is larger. It is at most three spacings of the
        // coarsest level.
        let unit = scale.clamp(1.0, 6.0) / scale;
        for (site, &at) in flat.hierarchy().sites().positions().iter().enumerate() {
            let is_inner = (at - DVec3::new(0.5, 0.5, 0.0)).abs().max_element() < 0.2;
            for (corner, diagonal) in links.of(site).corners.iter().zip(DIAGONALS) {
                let middle = Vec2::from(diagonal.map(|at| 1.6 * at as f32)) * unit;
                let range = usize::from(is_inner)..=n_most;
                assert!(
                    range.contains(&corner.len()),
                    "{} sites on a diagonal with {scale}",
                    corner.len()
                );
                for link in *corner {
                    let off = link.way().distance(middle);
                    assert!(off < 1.1 * unit + 1e-5, "{link:?} is off by {off}"); // Rounding.
                    assert!(link.site() < n_read, "{link:?} with {scale}");
                }
            }
        }
    }
}

#[test]
fn strands_go_on_from_one_side_to_the_other() {
    // Swaying strands, one every 16 pixels.
    let is_strand = |x: u32, y: u32| {
        let sway = (x % 32).abs_diff(16) / 3;
        (y + sway) % 16 < 5
    };
    let plane = Raster::from_fn([32, 32], |x, y| f32::from(is_strand(x, y))).unwrap();
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Wrap).unwrap();
    let square = sheet([4; 2], [true; 2], |u, v| DVec3::new(u, v, 0.0));
    let strands = |flat: &Synthesizer| {
        let texture = flat.synthesize(&exemplar, &options()).unwrap();
        pieces(flat, &texture.transfer(&plane).unwrap())
    };
    let (n_pieces, n_torn) = strands(&synthesizer(square.clone(), 6000, |_, _| DVec3::NEG_Y));
    assert_eq!(n_torn, 0, "strands with an end within");
    assert!(n_pieces >= 4, "{n_pieces} strands");
    // From left to right, strands fan out to three times the width.
    let fan = synthesizer(square, 6000, |at, normal| {
        (at + DVec3::new(0.5, -0.5, 0.0)).cross(normal)
    });
    let (_, n_torn) = strands(&fan);
    assert!(n_torn > 0, "strands of one width begin on the way");
    let (n_pieces, n_torn) = strands(&fan.with_conformal_scales([0.5, 2.0]).unwrap());
    assert_eq!(n_torn, 0, "strands with an end within, though they widen");
    assert!(n_pieces >= 4, "{n_pieces} strands that widen");
}

/// Returns the number of connected components of more than 8 sites with values above 0.5, and how many of them do not
/// extend from x = 0 to 1 although they are away from the edges along y.
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
fn value_stability_appearance_along_four_directions() {
    let texture = ball_along(Symmetry::Four)
        .synthesize(&noise(Edges::Wrap), &options())
        .unwrap();
    let sources: Vec<[u32; 2]> = texture.sources(0).step_by(300).collect();
    assert_eq!(
        sources,
        [[22, 2], [9, 10], [18, 2], [17, 5], [5, 19]],
        "some sources"
    );
}

#[test]
fn value_stability_appearance() {
    let texture = ball().synthesize(&noise(Edges::Wrap), &options()).unwrap();
    let sources: Vec<[u32; 2]> = texture.sources(0).step_by(300).collect();
    assert_eq!(
        sources,
        [[23, 7], [19, 2], [14, 12], [13, 8], [12, 15]],
        "some sources"
    );
}
