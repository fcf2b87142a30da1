//! Tests repairs against an exhaustive search, and tiles.

use crate::{
    Candidates, CoarserCenter, Coherence, Edges, Exemplar, Options, Pass, PlaneTexture, Pyramid,
    Reads, Schedule, SideBySide, SynthErrorKind, Turned, distance_sq, repair_levels,
    synthesize_plane, tile_plane,
};
use core::ops::ControlFlow;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::{Raster, Wrap};

/// Returns smooth noise with a period of `period` pixels.
fn noise(size: [u32; 2], period: u32) -> Raster<f32> {
    let value = |x: u32, y: u32| {
        let cell = [x % period / 2, y % period / 3].map(i64::from);
        unit_f32((hash2(Seed(5), cell, 0) >> 32) as u32)
    };
    Raster::from_fn(size, value).unwrap()
}

/// Returns the exemplar of a plane with wrong values in its hole, which a mask excludes.
fn damaged(size: [u32; 2], edges: Edges, hole: &Raster<bool>) -> Exemplar {
    let plane = noise(size, 64);
    let plane = plane.zip_map(hole, |&value, &is_off| if is_off { 9.0 } else { value });
    let mask = hole.map(|&is_off| !is_off);
    let exemplar = Exemplar::from_planes(&[(&plane.unwrap(), 1.0)], edges).unwrap();
    exemplar.with_mask(&mask).unwrap()
}

/// Returns options with which the smallest distance always wins.
fn least(n_levels: usize) -> Options {
    Options {
        n_levels,
        coherence: Coherence::Factor(0.0),
        ..Options::default()
    }
}

fn repaired(exemplar: &Exemplar, hole: &Raster<bool>, options: &Options) -> PlaneTexture {
    let whole = PlaneTexture::identity(exemplar).unwrap();
    let keep_on = |_| ControlFlow::Continue(());
    whole.repair(exemplar, hole, options, keep_on).unwrap()
}

/// Sources of a level in the oracle, and which of them are synthesized.
struct NaiveLevel {
    size: [u32; 2],
    sources: Vec<[i64; 2]>,
    is_made: Vec<bool>,
}

/// An oracle that repairs an exemplar pixel by pixel.
struct Naive<'a> {
    pyramid: &'a Pyramid,
    wrap: Wrap,
    levels: Vec<NaiveLevel>,
}

impl Naive<'_> {
    fn index(&self, level: usize, place: [i64; 2]) -> usize {
        let size = self.levels[level].size;
        let [x, y] = [0, 1].map(|axis| self.wrap.index(place[axis], size[axis]));
        (y * size[0] + x) as usize
    }

    fn color(&self, level: usize, halves: [i64; 2]) -> f32 {
        let read = &self.pyramid.levels()[level];
        let at = |step: [i64; 2]| {
            let place = [0, 1].map(|axis| (halves[axis] + step[axis]).div_euclid(2));
            let [x, y] = self.levels[level].sources[self.index(level, place)];
            read.pixels()[(y * i64::from(read.size()[0]) + x) as usize]
        };
        0.25 * ((at([0, 0]) + at([1, 0])) + (at([0, 1]) + at([1, 1])))
    }

    /// Returns the source that all sites around a site predict for it; on its own level the site itself is included.
    fn piece(&self, pass: &Pass, site: [u32; 2]) -> Option<[i64; 2]> {
        let part = &pass.parts[0];
        let level = pass.level + usize::from(part.reads == Reads::Coarser);
        let [width, height] = self.levels[level].size.map(i64::from);
        let read = self.pyramid.levels()[level].size().map(i64::from);
        let middle = site.map(|at| i64::from(at) / if level == pass.level { 1 } else { 2 });
        let mut predicted = Vec::new();
        let half = i64::from(part.side / 2);
        for offset in (-half..=half).flat_map(|j| (-half..=half).map(move |i| [i, j])) {
            let place = [middle[0] + offset[0], middle[1] + offset[1]];
            let is_within = (0..width).contains(&place[0]) && (0..height).contains(&place[1]);
            if is_within || self.wrap == Wrap::Repeat {
                let source = self.levels[level].sources[self.index(level, place)];
                let from = [source[0] - offset[0], source[1] - offset[1]];
                predicted.push(match self.wrap {
                    Wrap::Repeat => [from[0].rem_euclid(read[0]), from[1].rem_euclid(read[1])],
                    _ => from,
                });
            }
        }
        let is_same = predicted.windows(2).all(|pair| pair[0] == pair[1]);
        let [x, y] = predicted[0];
        let is_pixel = (0..read[0]).contains(&x) && (0..read[1]).contains(&y);
        if !is_same || !is_pixel {
            return None;
        }
        Some(match part.reads {
            Reads::Same => [x, y],
            Reads::Coarser => [
                2 * x + i64::from(site[0] % 2),
                2 * y + i64::from(site[1] % 2),
            ],
        })
    }

    fn visit(&mut self, pass: &Pass) {
        let candidates = Candidates::of_repair(self.pyramid, pass, CoarserCenter::Exact).unwrap();
        let [width, height] = self.levels[pass.level].size;
        for turn in 0..16 {
            for site in (0..width * height).map(|site| [site % width, site / width]) {
                // The 4 × 4 matrix of ordered dithering, computed by its recursion.
                let [x, y] = site.map(|at| at % 4);
                let quad = |x: u32, y: u32| 2 * (x ^ y) + y;
                let index = (site[1] * width + site[0]) as usize;
                let is_turn = 4 * quad(x % 2, y % 2) + quad(x / 2, y / 2) == turn;
                if !is_turn || !self.levels[pass.level].is_made[index] {
                    continue;
                }
                if let Some(source) = self.piece(pass, site) {
                    self.levels[pass.level].sources[index] = source;
                    continue;
                }
                let mut query = Vec::new();
                for part in &pass.parts {
                    let (level, scale) = match part.reads {
                        Reads::Same => (pass.level, 2),
                        Reads::Coarser => (pass.level + 1, 1),
                    };
                    for offset in part.offsets() {
                        let at = [0, 1].map(|axis| {
                            scale * i64::from(site[axis]) + 2 * i64::from(offset[axis])
                        });
                        query.push(self.color(level, at));
                    }
                }
                let mut best = (f32::INFINITY, 0);
                for row in 0..candidates.len() {
                    let distance = distance_sq(&query, candidates.row(row));
                    if distance < best.0 {
                        best = (distance, row);
                    }
                }
                let source = candidates.pixel(best.1).map(i64::from);
                self.levels[pass.level].sources[index] = source;
            }
        }
    }

    /// Initializes the synthesized sites of a level by continuing the sources of the coarser level. With the holes of
    /// these tests, no continuation reaches into the hole or past an edge.
    fn go_on(&mut self, level: usize) {
        let [width, _] = self.levels[level].size;
        let wider = self.levels[level + 1].size[0];
        for site in 0..self.levels[level].sources.len() {
            if self.levels[level].is_made[site] {
                let [x, y] = [site as u32 % width, site as u32 / width];
                let [a, b] = self.levels[level + 1].sources[(y / 2 * wider + x / 2) as usize];
                self.levels[level].sources[site] =
                    [2 * a + i64::from(x % 2), 2 * b + i64::from(y % 2)];
            }
        }
    }
}

/// Returns the oracle's sources of a repair whose hole is a single rectangle on the coarsest level.
fn naive(exemplar: &Exemplar, hole: &Raster<bool>, n_levels: usize) -> Vec<[u32; 2]> {
    let pyramid = exemplar.pyramid(n_levels).unwrap();
    let wrap = match exemplar.edges() {
        Edges::Cut => Wrap::Mirror,
        Edges::Wrap => Wrap::Repeat,
    };
    let mut levels: Vec<NaiveLevel> = Vec::new();
    for level in pyramid.levels() {
        let size = level.size();
        let places = (0..size[0] * size[1]).map(|at| [at % size[0], at / size[0]]);
        let is_made = |place: [u32; 2]| match levels.last() {
            None => hole.row(place[1])[place[0] as usize],
            Some(finer) => (0..4).any(|child| {
                let x = wrap.index((2 * place[0] + child % 2).into(), finer.size[0]);
                let y = wrap.index((2 * place[1] + child / 2).into(), finer.size[1]);
                finer.is_made[(y * finer.size[0] + x) as usize]
            }),
        };
        levels.push(NaiveLevel {
            size,
            is_made: places.clone().map(is_made).collect(),
            sources: places.map(|place| place.map(i64::from)).collect(),
        });
    }
    fit(&mut levels[n_levels - 1], &pyramid.levels()[n_levels - 1]);
    let mut naive = Naive {
        pyramid: &pyramid,
        wrap,
        levels,
    };
    let mut level = n_levels - 1;
    for pass in &Schedule::repair(n_levels).passes {
        if pass.level < level {
            level = pass.level;
            naive.go_on(level);
        }
        naive.visit(pass);
    }
    let sources = naive.levels[0].sources.iter();
    sources.map(|source| source.map(|at| at as u32)).collect()
}

/// Fills a hole within a level with the piece whose surroundings are most similar.
fn fit(level: &mut NaiveLevel, exemplar: &Exemplar) {
    let [width, height] = level.size.map(i64::from);
    let at = |x: i64, y: i64| (y * width + x) as usize;
    let sites = (0..width * height).map(|site| [site % width, site / width]);
    let made: Vec<_> = sites
        .clone()
        .filter(|&[x, y]| level.is_made[at(x, y)])
        .collect();
    let is_near = |&[x, y]: &[i64; 2]| {
        let near = |site: &[i64; 2]| (site[0] - x).abs().max((site[1] - y).abs()) <= 3;
        !level.is_made[at(x, y)] && made.iter().any(near)
    };
    let ring: Vec<_> = sites.filter(is_near).collect();
    let mut best = (f64::INFINITY, [0; 2]);
    for y in -height..height {
        for x in -width..width {
            let moved = made
                .iter()
                .chain(&ring)
                .map(|site| [site[0] + x, site[1] + y]);
            let mut moved = moved.map(|[x, y]| match exemplar.edges() {
                Edges::Cut => [x, y],
                Edges::Wrap => [x.rem_euclid(width), y.rem_euclid(height)],
            });
            let is_usable = |[x, y]: [i64; 2]| {
                let is_within = (0..width).contains(&x) && (0..height).contains(&y);
                is_within && !level.is_made[at(x, y)]
            };
            if !moved.clone().all(is_usable) {
                continue;
            }
            let mut sum = 0.0;
            for (to, [x, y]) in moved.by_ref().skip(made.len()).zip(&ring) {
                let step = exemplar.pixels()[at(to[0], to[1])] - exemplar.pixels()[at(*x, *y)];
                sum += f64::from(step) * f64::from(step);
            }
            if sum < best.0 {
                best = (sum, [x, y]);
            }
        }
    }
    assert!(best.0 < f64::INFINITY, "a piece fits");
    for [x, y] in made {
        let place = [x + best.1[0], y + best.1[1]];
        level.sources[at(x, y)] = match exemplar.edges() {
            Edges::Cut => place,
            Edges::Wrap => [place[0].rem_euclid(width), place[1].rem_euclid(height)],
        };
    }
}

#[test]
fn repairs_equal_passes_that_compare_everything() {
    for (size, n_levels, edges) in [
        ([30, 26], 1, Edges::Cut),
        ([48, 44], 2, Edges::Cut),
        ([48, 44], 2, Edges::Wrap),
    ] {
        let is_off = |x: u32, y: u32| (18..22).contains(&x) && (16..21).contains(&y);
        let hole = Raster::from_fn(size, is_off).unwrap();
        let exemplar = damaged(size, edges, &hole);
        let texture = repaired(&exemplar, &hole, &least(n_levels));
        let expected = naive(&exemplar, &hole, n_levels);
        assert!(texture.sources().pixels() == expected, "{size:?} {edges:?}");
    }
}

#[test]
fn only_the_hole_changes_and_nothing_is_from_it() {
    // Two holes, one of them at an edge.
    let is_off = |x: u32, y: u32| x.abs_diff(31) < 5 && y.abs_diff(40) < 4 || x < 3 && y > 60;
    let hole = Raster::from_fn([72, 80], is_off).unwrap();
    for edges in [Edges::Cut, Edges::Wrap] {
        let exemplar = damaged([72, 80], edges, &hole);
        let texture = repaired(&exemplar, &hole, &Options::default());
        for (at, &[x, y]) in texture.sources().pixels().iter().enumerate() {
            let place = [at as u32 % 72, at as u32 / 72];
            let is_off = hole.row(place[1])[place[0] as usize];
            assert!(is_off || place == [x, y], "{place:?} is kept");
            assert!(!hole.row(y)[x as usize], "{place:?} is not from the hole");
        }
    }
}

#[test]
fn repairs_do_not_depend_on_threads() {
    let hole = Raster::from_fn([60, 60], |x, y| x.abs_diff(30) + y.abs_diff(30) < 14).unwrap();
    let exemplar = damaged([60, 60], Edges::Wrap, &hole);
    let with = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new();
        let pool = pool.num_threads(n_threads).build().unwrap();
        pool.install(|| repaired(&exemplar, &hole, &Options::default()))
    };
    let one = with(1);
    assert!(with(2) == one && with(7) == one, "1, 2 and 7 threads");
}

#[test]
fn what_is_larger_than_all_else_begins_with_random_pixels() {
    // The hole is larger than the rest of the image, so no piece is as large.
    let hole = Raster::from_fn([64, 64], |x, _| x >= 24).unwrap();
    let exemplar = damaged([64, 64], Edges::Cut, &hole);
    let options = least(1);
    let first = repaired(&exemplar, &hole, &options);
    assert_eq!(first, repaired(&exemplar, &hole, &options), "again");
    let seed = Seed(1);
    let other = repaired(&exemplar, &hole, &Options { seed, ..options });
    assert!(first != other, "another seed");
    let sources = first.sources().pixels();
    assert!(sources.iter().all(|&[x, _]| x < 24), "from what is left");
}

#[test]
fn a_texture_made_before_shows_other_maps() {
    let plane = noise([40, 32], 64);
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Cut).unwrap();
    let edges = [Edges::Wrap, Edges::Cut];
    let made = synthesize_plane(&exemplar, [24, 20], edges, &Options::default()).unwrap();
    let sources = made.sources().clone();
    let again = PlaneTexture::from_sources(sources, edges, [40, 32], Edges::Cut).unwrap();
    assert!(again == made, "the same texture");
    let places = Raster::from_fn([40, 32], |x, y| [x, y]).unwrap();
    assert!(
        again.transfer(&places).unwrap() == *made.sources(),
        "places"
    );
    let outside = Raster::filled([2, 2], [3, 32]).unwrap();
    let refused = PlaneTexture::from_sources(outside, edges, [40, 32], Edges::Cut);
    let expected = SynthErrorKind::Source {
        source: [3, 32],
        exemplar: [40, 32],
    };
    assert_eq!(refused.unwrap_err().kind(), &expected);
}

#[test]
fn masks_and_exemplars_of_other_sizes_are_refused() {
    let hole = Raster::from_fn([40, 40], |x, y| x == 20 && y == 20).unwrap();
    let exemplar = damaged([40, 40], Edges::Cut, &hole);
    let whole = PlaneTexture::identity(&exemplar).unwrap();
    let refused = |exemplar: &Exemplar, hole: &Raster<bool>| {
        let keep_on = |_| ControlFlow::Continue(());
        let result = whole.repair(exemplar, hole, &Options::default(), keep_on);
        result.unwrap_err().kind().clone()
    };
    let small = Raster::filled([40, 39], true).unwrap();
    let other = damaged([40, 39], Edges::Cut, &small);
    assert!(
        matches!(refused(&exemplar, &small), SynthErrorKind::Raster(_)),
        "mask"
    );
    assert!(
        matches!(refused(&other, &hole), SynthErrorKind::Raster(_)),
        "exemplar"
    );
    assert!(
        exemplar.clone().with_mask(&small).is_err(),
        "mask of an exemplar"
    );
    let nothing = Raster::filled([40, 40], false).unwrap();
    let without = exemplar.clone().with_mask(&nothing).unwrap();
    let expected = SynthErrorKind::Masked { level: 2 };
    assert_eq!(refused(&without, &hole), expected, "all is left out");
    let stop = |_| ControlFlow::Break(());
    let stopped = whole.repair(&exemplar, &hole, &Options::default(), stop);
    assert_eq!(
        stopped.unwrap_err().kind(),
        &SynthErrorKind::Cancelled,
        "stopped"
    );
}

fn tile(plane: &Raster<f32>, axes: [bool; 2], width: u32) -> PlaneTexture {
    let exemplar = Exemplar::from_planes(&[(plane, 1.0)], Edges::Cut).unwrap();
    let keep_on = |_| ControlFlow::Continue(());
    tile_plane(&exemplar, axes, width, &Options::default(), keep_on).unwrap()
}

#[test]
fn tiles_of_what_repeats_repeat_it() {
    // The period is 24. Two and three periods are between half of the side and the side minus half of the strip.
    let plane = noise([90, 60], 24);
    let both = tile(&plane, [true; 2], 12);
    assert_eq!(both.sources().size(), [72, 48], "the largest that repeats");
    let across = tile(&plane, [true, false], 12);
    assert_eq!(across.sources().size(), [72, 60], "one axis");
    // If an axis does not repeat, neighborhoods near its edges include mirrored rows: 3 on the coarsest level, times
    // the number of finest rows per row of that level.
    for (texture, edge) in [(both, 0), (across, 16)] {
        let made = texture.transfer(&plane).unwrap();
        for row in edge..made.height() - edge {
            let expected = &plane.row(row)[..made.width() as usize];
            assert!(
                made.row(row) == expected,
                "the seam is not seen in row {row}"
            );
        }
    }
}

#[test]
fn tiles_change_only_a_strip_along_the_seam() {
    let plane = noise([64, 56], 64);
    let texture = tile(&plane, [true; 2], 10);
    let [width, height] = texture.sources().size();
    assert_eq!([width % 4, height % 4], [0; 2], "halves of halves");
    assert!(
        (32..=59).contains(&width) && (28..=51).contains(&height),
        "sides"
    );
    let seams = [(64 - width) / 2, (56 - height) / 2];
    let mut n_made = 0;
    for y in 0..height {
        for x in 0..width {
            let around = |at: u32, seam: u32, side: u32| {
                let past = (at + side - seam) % side;
                past.min(side - 1 - past)
            };
            let near = around(x, seams[0], width).min(around(y, seams[1], height));
            let source = texture.sources().row(y)[x as usize];
            let shown = [
                if x < seams[0] { x + width } else { x },
                if y < seams[1] { y + height } else { y },
            ];
            assert!(near < 5 || source == shown, "{x} {y}: {source:?}");
            n_made += u32::from(source != shown);
        }
    }
    assert!(n_made > 0, "the seam is closed");
}

#[test]
fn strips_that_are_too_wide_or_too_narrow_are_refused() {
    let plane = noise([40, 40], 64);
    let exemplar = Exemplar::from_planes(&[(&plane, 1.0)], Edges::Cut).unwrap();
    for width in [0, 1, 21, u32::MAX] {
        let keep_on = |_| ControlFlow::Continue(());
        let made = tile_plane(&exemplar, [true; 2], width, &Options::default(), keep_on);
        let kind = made.unwrap_err().kind().clone();
        let what = "width of a strip";
        assert!(
            matches!(kind, SynthErrorKind::Range { what: name, .. } if name == what),
            "{width}"
        );
    }
    let small = Exemplar::from_planes(&[(&noise([40, 15], 64), 1.0)], Edges::Cut).unwrap();
    let keep_on = |_| ControlFlow::Continue(());
    let made = tile_plane(&small, [false, true], 4, &Options::default(), keep_on);
    let kind = made.unwrap_err().kind().clone();
    let what = "side of the exemplar";
    assert!(
        matches!(kind, SynthErrorKind::Range { what: name, .. } if name == what),
        "15 rows"
    );
}

/// Repairs holes across the border of an image that is 1 inside and 0 outside. The border is `margin` pixels from the
/// right side; the test rotates the image to each side. Holes extend `half` pixels in each direction, and end at least
/// `gap` pixels before the side. Returns the number of wrong pixels for each side.
fn wrong_at_borders(
    side: u32,
    margin: u32,
    half: [u32; 2],
    gap: u32,
    is_inside: fn(side: u32, margin: u32, at: [u32; 2]) -> bool,
) -> [usize; 4] {
    let border = side - margin;
    let across = border - half[0]..(border + half[0]).min(side - gap);
    let along = side / 2 - half[1]..side / 2 + half[1];
    [0, 1, 2, 3].map(|turn| {
        let turned = |x: u32, y: u32| match turn {
            0 => [x, y],
            1 => [y, x],
            2 => [side - 1 - x, y],
            _ => [side - 1 - y, x],
        };
        let value = |x, y| f32::from(is_inside(side, margin, turned(x, y)));
        let whole = Raster::from_fn([side; 2], value).unwrap();
        let in_hole = |x: u32, y: u32| {
            let [x, y] = turned(x, y);
            across.contains(&x) && along.contains(&y)
        };
        let hole = Raster::from_fn([side; 2], in_hole).unwrap();
        let damaged = whole.zip_map(&hole, |&v, &off| if off { 0.5 } else { v });
        let mask = hole.map(|&is_off| !is_off);
        let exemplar = Exemplar::from_planes(&[(&damaged.unwrap(), 1.0)], Edges::Cut).unwrap();
        let exemplar = exemplar.with_mask(&mask).unwrap();
        let texture = repaired(&exemplar, &hole, &Options::default());
        let shown = texture.transfer(&whole).unwrap();
        let shown = shown.pixels().iter().zip(whole.pixels());
        shown.filter(|(a, b)| a != b).count()
    })
}

#[test]
fn border_along_a_side_goes_on() {
    for margin in [4, 6, 8, 10, 12, 16, 20, 24] {
        // A shape on an empty background, `margin` pixels from all sides.
        let wrong = wrong_at_borders(128, margin, [6, 4], 2, |side, margin, at| {
            at.iter().all(|at| (margin..side - margin).contains(at))
        });
        assert_eq!(wrong, [0; 4], "margin {margin}");
    }
}

#[test]
fn border_along_a_side_of_a_small_image_goes_on() {
    for side in [64, 65, 66, 67, 68, 72, 90, 100, 101] {
        for (margin, half) in [
            (6, [4, 4]),
            (8, [2, 2]),
            (8, [6, 4]),
            (12, [6, 4]),
            (16, [4, 4]),
            (20, [6, 6]),
        ] {
            let is_inside = |side, margin, [x, _]: [u32; 2]| x < side - margin;
            let wrong = wrong_at_borders(side, margin, half, 2, is_inside);
            assert_eq!(wrong, [0; 4], "{side} pixels, margin {margin}, {half:?}");
        }
    }
}

#[test]
fn leaves_and_borders_at_a_side_go_on() {
    // Rows of leaves with sharp tips, each row shifted by half of a leaf.
    let in_leaf = |_: u32, _: u32, at: [u32; 2]| {
        let [x, y] = at.map(|at| f64::from(at) + 0.5);
        let x = (x + 11.0 * (y / 14.0).floor()).rem_euclid(22.0) / 9.5 - 11.0 / 9.5;
        let y = y.rem_euclid(14.0) / 6.0 - 7.0 / 6.0;
        y.abs() < 1.0 - x * x
    };
    for side in [64, 66, 100] {
        for half in [3, 6] {
            // Holes of 6 and 12 pixels that touch the side.
            let leaves = wrong_at_borders(side, half, [half; 2], 0, in_leaf);
            assert_eq!(leaves, [0; 4], "leaves, {side} pixels, {half}");
            let is_inside = |side, margin, [x, _]: [u32; 2]| x < side - margin;
            let border = wrong_at_borders(side, half, [half; 2], 0, is_inside);
            assert_eq!(border, [0; 4], "border, {side} pixels, {half}");
        }
    }
}

#[test]
fn small_example_is_repaired_turned_and_beside_another() {
    for side in [16, 48, 64, 65, 66, 67, 68, 70, 100] {
        let stripes = Raster::from_fn([side; 2], |x, _| f32::from(x / 4 % 2 == 0)).unwrap();
        let unlike = Raster::from_fn([96, 80], |x, y| 5.0 + f32::from((x ^ y) % 3 == 0)).unwrap();
        let middle = side / 2 - side / 16..side / 2 + side / 16;
        let is_off = |x: u32, y: u32| middle.contains(&x) && middle.contains(&y);
        let clean = Raster::from_fn([side; 2], |x, y| !is_off(x, y)).unwrap();
        let damaged = stripes.zip_map(&clean, |&v, &is_clean| if is_clean { v } else { 9.0 });
        let damaged = damaged.unwrap();
        for n_examples in [1, 2] {
            for turned in [Turned::None, Turned::Mirror, Turned::Quarters, Turned::All] {
                let case = format!("{side} pixels, {n_examples} examples, {turned:?}");
                let sizes = [stripes.size(), unlike.size()];
                let layout = SideBySide::new(&sizes[..n_examples]).unwrap();
                let layout = layout.with_turned(turned).unwrap();
                let joined = layout
                    .join(&[&damaged, &unlike][..n_examples], 0.0)
                    .unwrap();
                let is_whole = Raster::filled(unlike.size(), true).unwrap();
                let mask = layout
                    .join(&[&clean, &is_whole][..n_examples], false)
                    .unwrap();
                let exemplar = Exemplar::from_planes(&[(&joined, 1.0)], Edges::Cut).unwrap();
                let exemplar = exemplar.with_mask(&mask).unwrap();
                let exemplar = exemplar.with_layout(&layout).unwrap();
                let sources = Raster::from_fn([side; 2], |x, y| [x, y]).unwrap();
                let size = layout.size();
                let whole =
                    PlaneTexture::from_sources(sources, [Edges::Cut; 2], size, Edges::Cut).unwrap();
                let hole = clean.map(|&is_clean| !is_clean);
                let options = Options {
                    n_levels: if side < 32 { 1 } else { 3 },
                    ..Options::default()
                };
                let keep_on = |_| ControlFlow::Continue(());
                let texture = whole.repair(&exemplar, &hole, &options, keep_on).unwrap();
                let shown = texture.transfer(&joined).unwrap();
                let is_own = |&source: &[u32; 2]| layout.image_at(source) == Some(0);
                assert!(texture.sources().pixels().iter().all(is_own), "{case}");
                let wrong = shown.pixels().iter().zip(stripes.pixels());
                let wrong = wrong.filter(|(a, b)| a != b).count();
                assert_eq!(wrong, 0, "{case}");
            }
        }
    }
}

/// The number of levels, from the distance of each pixel of the hole to each other pixel.
fn naive_levels(hole: &Raster<bool>) -> usize {
    let [width, height] = hole.size();
    let places = || (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let is_made = |[x, y]: [u32; 2]| hole.row(y)[x as usize];
    let distance = |[x, y]: [u32; 2]| {
        let kept = places().filter(|&place| !is_made(place));
        let distances = kept.map(|place| x.abs_diff(place[0]).max(y.abs_diff(place[1])));
        distances.min().unwrap_or(width.max(height))
    };
    let made = places().filter(|&place| is_made(place));
    let radius = made.map(distance).max().unwrap_or(0);
    let fits = |n_levels: &usize| {
        let coarse = 1_u32 << (n_levels - 1);
        radius.div_ceil(coarse) <= 6 || width.min(height) / (2 * coarse) < 16
    };
    (3..).find(fits).unwrap()
}

#[test]
fn repair_levels_follow_the_inscribed_radius_of_the_hole() {
    let disk = |size: [u32; 2], [x0, y0]: [u32; 2], radius: u32| {
        Raster::from_fn(size, |x, y| {
            let [x, y] = [x.abs_diff(x0), y.abs_diff(y0)];
            x * x + y * y < radius * radius
        })
        .unwrap()
    };
    let holes = [
        disk([150, 140], [70, 70], 20),
        disk([150, 140], [70, 70], 40),
        disk([150, 140], [20, 130], 60),
        disk([150, 140], [75, 70], 200),
        disk([40, 140], [20, 70], 19),
        // A scratch is narrow, and a hole of no pixels has no radius.
        Raster::from_fn([150, 140], |x, _| (70..80).contains(&x)).unwrap(),
        Raster::filled([150, 140], false).unwrap(),
    ];
    let levels = holes.each_ref().map(repair_levels);
    assert_eq!(levels, holes.each_ref().map(naive_levels));
    assert_eq!(levels, [3, 4, 4, 4, 3, 3, 3]);
}
