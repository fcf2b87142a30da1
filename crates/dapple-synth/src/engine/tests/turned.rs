//! Tests passes with an orientation field of two or four directions against code that rotates every square and compares
//! with every candidate.

use super::*;
use crate::engine::run_turned;
use crate::orientation::turned;
use crate::{Hierarchy, Orientation, Symmetry};
use core::sync::atomic::{AtomicU32, Ordering};

fn sphere_along(symmetry: Symmetry, n_sites: usize) -> Synthesizer {
    let options = HierarchyOptions {
        n_sites,
        n_levels: 2,
        seed: Seed(1),
        ..HierarchyOptions::default()
    };
    let surface = Surface::new(crate::shapes::sphere()).unwrap();
    let hierarchy = Hierarchy::new(&surface, &options).unwrap();
    let axis = Orientation::AXIS;
    let orientation = Orientation::symmetric(&hierarchy, &[], axis, symmetry).unwrap();
    Synthesizer::from_parts(surface, hierarchy, orientation, None).unwrap()
}

/// Pixel and rotation (in quarter turns) of each site, on two levels.
type Levels = [Vec<(u32, u8)>; 2];

/// Returns the samples of a part of a neighborhood, and their nearest sites.
fn read(
    domain: &MeshDomain<'_>,
    pass: &Pass,
    part: &Part,
    site: u32,
    pyramid: &Pyramid,
    levels: &Levels,
) -> Samples {
    let half = part.side as i32 / 2;
    let reads = pass.level + part.reads.step();
    let square = Square {
        site,
        level: pass.level,
        reads,
        half,
        rows: Rows::All,
    };
    let prepared = match part.reads {
        Reads::Same => domain.prepare(pass.level, Some(half), None),
        Reads::Coarser => domain.prepare(pass.level, None, Some(half)),
    };
    let mut samples = Samples::default();
    samples.make_room(square.side(), 3);
    let pixels = &pyramid.levels()[reads].pixels;
    let of = |&(pixel, _): &(u32, u8)| &pixels[3 * pixel as usize..][..3];
    let values: Vec<f32> = levels[reads].iter().flat_map(of).copied().collect();
    let colors = Plain {
        values: &values,
        n_channels: 3,
    };
    domain.read(
        square,
        &prepared,
        colors,
        &mut samples,
        &mut Default::default(),
    );
    samples
}

/// Returns the index of the sample at an offset in a square that is rotated by quarter turns.
fn sample_at([mut i, mut j]: [i32; 2], half: i32, quarters: u8) -> usize {
    for _ in 0..quarters {
        // The rotated square's right is up, and its down is right.
        (i, j) = (j, -i);
    }
    ((j + half) * (2 * half + 1) + i + half) as usize
}

/// Returns the rotation of the exemplar at `site` nearest to that of another site, in quarter turns.
fn lies(case: &Synthesizer, site: u32, other: u32, quarters: u8) -> u8 {
    let direction = |site: u32, quarters| {
        let at = site as usize;
        let normal = case.hierarchy().sites().normals()[at];
        turned(case.orientation().vectors()[at], normal, quarters)
    };
    let there = direction(other, quarters);
    let all = case.orientation().symmetry().quarters().iter().copied();
    let near = |&quarters: &u8| direction(site, quarters).dot(there);
    all.max_by(|a, b| near(a).total_cmp(&near(b))).unwrap()
}

/// Returns the rotations that a site may take: those of its neighbors.
fn wanted(
    case: &Synthesizer,
    pass: &Pass,
    site: u32,
    samples: &[Samples],
    levels: &Levels,
) -> Vec<u8> {
    let mut wanted = Vec::new();
    for (part, samples) in pass.parts.iter().zip(samples) {
        let reads = pass.level + part.reads.step();
        let half = part.side as i32 / 2;
        for [i, j] in part.offsets() {
            let is_beside = match part.reads {
                Reads::Same => i.abs() <= 1 && j.abs() <= 1,
                Reads::Coarser => [i, j] == [0, 0],
            };
            let nearest = samples.nearest[sample_at([i, j], half, 0)];
            if is_beside && nearest != site {
                wanted.push(lies(case, site, nearest, levels[reads][nearest as usize].1));
            }
        }
    }
    if wanted.is_empty() {
        wanted.push(levels[pass.level][site as usize].1);
    }
    wanted.sort_unstable();
    wanted.dedup();
    wanted
}

/// Runs all passes sequentially.
fn naive(
    case: &Synthesizer,
    pyramid: &Pyramid,
    passes: &[Pass],
    options: &Options,
    started: &[u32],
) -> Levels {
    let domain = case.domain(Axes::Carried, false);
    let mut levels = [
        Vec::new(),
        started.iter().map(|&pixel| (pixel, 0)).collect(),
    ];
    for pass in passes {
        let candidates = Candidates::new(pyramid, pass, options.center).unwrap();
        levels[pass.level].resize(domain.n_sites(pass.level), (0, 0));
        for site in domain.order(pass.level) {
            let parts = pass.parts.iter();
            let samples: Vec<_> = parts
                .map(|part| read(&domain, pass, part, site, pyramid, &levels))
                .collect();
            let is_whole = pass.parts.iter().all(|part| part.shape == Shape::Full);
            let wanted = match is_whole {
                true => wanted(case, pass, site, &samples, &levels),
                false => vec![0],
            };
            let (mut smallest, mut best) = (f32::INFINITY, (0, 0));
            for quarters in wanted {
                let mut query = Vec::new();
                for (part, samples) in pass.parts.iter().zip(&samples) {
                    for offset in part.offsets() {
                        let at = 3 * sample_at(offset, part.side as i32 / 2, quarters);
                        query.extend_from_slice(&samples.values[at..at + 3]);
                    }
                }
                for row in 0..candidates.len() {
                    let new = distance_sq(&query, candidates.row(row));
                    if new < smallest {
                        (smallest, best) = (new, (candidates.pixels[row], quarters));
                    }
                }
            }
            levels[pass.level][site as usize] = best;
        }
    }
    levels
}

#[test]
fn passes_of_a_symmetric_field_are_those_of_turned_squares() {
    for symmetry in [Symmetry::Two, Symmetry::Four] {
        let case = sphere_along(symmetry, 300);
        let domain = case.domain(Axes::Carried, false);
        let passes = Schedule::paper(2).passes;
        let pyramid = pyramid(Edges::Wrap, 2);
        let options = Options {
            n_levels: 2,
            coherence: Coherence::Factor(0.0),
            evenness: 0.0,
            ..Options::default()
        };
        let candidates = Candidates::new(&pyramid, &passes[0], options.center).unwrap();
        let started = random_pixels(domain.n_sites(1), &pyramid, &candidates, 1, options.seed);
        let expected = naive(&case, &pyramid, &passes, &options, &started);
        let found = run_turned(&domain, &pyramid, &options, &mut go_on).unwrap();
        let mut n_turned = 0;
        for (level, (found, expected)) in found.into_iter().zip(&expected).enumerate() {
            let quarters = found
                .quarters
                .iter()
                .map(|quarters| quarters.load(Ordering::Relaxed));
            let quarters: Vec<u8> = quarters.collect();
            n_turned += quarters.iter().filter(|&&quarters| quarters > 0).count();
            let found: Vec<_> = found
                .pixels
                .into_iter()
                .map(AtomicU32::into_inner)
                .zip(quarters)
                .collect();
            assert!(found == *expected, "{symmetry}, level {level}");
        }
        assert!(n_turned > 0, "{symmetry}: nothing goes on across a cut");
    }
}

#[cfg(feature = "rayon")]
#[test]
fn texture_along_a_symmetric_field_has_the_same_bits_on_any_number_of_threads() {
    let case = sphere_along(Symmetry::Four, 3000);
    let exemplar = pyramid(Edges::Wrap, 1).levels()[0].clone();
    let options = Options {
        n_levels: 2,
        ..Options::default()
    };
    let [one, two, seven] =
        crate::shapes::on_threads(|| case.synthesize(&exemplar, &options).unwrap());
    assert!(one == two && one == seven);
}

#[test]
fn square_that_is_laid_turned_has_the_samples_of_a_turned_square() {
    let hierarchy = crate::shapes::sites_on(crate::shapes::square(), 900, 1);
    let along = |vector| Orientation::from_fn(&hierarchy, |_, _| vector);
    let [down, right] = [glam::DVec3::NEG_Y, glam::DVec3::X].map(|vector| {
        let surface = Surface::new(crate::shapes::square()).unwrap();
        Synthesizer::from_parts(surface, hierarchy.clone(), along(vector), None).unwrap()
    });
    let pyramid = pyramid(Edges::Wrap, 1);
    let pass = Pass {
        level: 0,
        parts: vec![Part::new(Shape::Full, 5, Reads::Same)],
    };
    let levels: Levels = [
        (0..900).map(|site| (site * 77 % 256, 0)).collect(),
        Vec::new(),
    ];
    for site in hierarchy.sites().iter().map(|site| site.0) {
        let at = hierarchy.sites().positions()[site as usize];
        if (at - glam::DVec3::new(0.5, 0.5, 0.0)).abs().max_element() > 0.3 {
            continue; // The square may end at an edge of the surface.
        }
        let [before, after] = [&down, &right].map(|case| {
            let domain = case.domain(Axes::Carried, false);
            read(&domain, &pass, &pass.parts[0], site, &pyramid, &levels)
        });
        for offset in pass.parts[0].offsets() {
            let [there, here] = [sample_at(offset, 2, 1), sample_at(offset, 2, 0)];
            for channel in 0..3 {
                let off = before.values[3 * there + channel] - after.values[3 * here + channel];
                assert!(off.abs() < 1e-3, "{site} {offset:?}: off by {off}");
            }
        }
    }
}
