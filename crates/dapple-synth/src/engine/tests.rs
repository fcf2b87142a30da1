//! Tests the engine against the paper's pseudocode, which compares every neighborhood with every candidate.

mod turned;

use super::{Progress, random_pixels, run};
use crate::domain::{Plain, Rows, Samples, Square, SynthesisDomain};
use crate::mesh_domain::MeshDomain;
use crate::neighborhood::{Part, Pass, Reads};
use crate::{
    Axes, Candidates, Coherence, Edges, Exemplar, HierarchyOptions, Options, Pyramid, Schedule,
    Shape, SynthErrorKind, Synthesizer, distance_sq,
};
use core::ops::ControlFlow;
use dapple_color::LinearRgb;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_mesh::Surface;
use dapple_raster::Raster;

/// Returns stripes and noise, 16 pixels square.
fn pyramid(edges: Edges, n_levels: usize) -> Pyramid {
    let image = Raster::from_fn([16, 16], |x, y| {
        let noise = unit_f32(hash2(Seed(2), [x.into(), y.into()], 0) as u32);
        LinearRgb::new(noise, if (x + y) % 8 < 4 { 0.9 } else { 0.1 }, 0.5 * noise)
    });
    let exemplar = Exemplar::new(&image.unwrap(), edges).unwrap();
    exemplar.pyramid(n_levels).unwrap()
}

/// Returns a sphere with sites on two levels.
fn sphere(n_sites: usize) -> Synthesizer {
    let options = HierarchyOptions {
        n_sites,
        n_levels: 2,
        seed: Seed(1),
        ..HierarchyOptions::default()
    };
    let surface = Surface::new(crate::shapes::sphere()).unwrap();
    Synthesizer::new(surface, &[], &options).unwrap()
}

/// Returns the neighborhood colors N(v) of the paper.
fn neighborhood(
    domain: &MeshDomain<'_>,
    pass: &Pass,
    site: u32,
    pyramid: &Pyramid,
    levels: &[Vec<u32>],
) -> Vec<f32> {
    let mut query = Vec::new();
    for part in &pass.parts {
        let half = part.side as i32 / 2;
        let reads = pass.level + usize::from(part.reads == Reads::Coarser);
        let square = Square {
            site,
            level: pass.level,
            reads,
            half,
            rows: Rows::All,
        };
        let prepared = domain.prepare(pass.level, Some(half), None);
        let coarser = (reads > pass.level).then(|| domain.prepare(pass.level, None, Some(half)));
        let mut samples = Samples::default();
        samples.make_room(square.side(), 3);
        let pixels = &pyramid.levels()[reads].pixels;
        let of = |&pixel: &u32| &pixels[3 * pixel as usize..][..3];
        let values: Vec<f32> = levels[reads].iter().flat_map(of).copied().collect();
        let colors = Plain {
            values: &values,
            n_channels: 3,
        };
        let prepared = coarser.as_ref().unwrap_or(&prepared);
        domain.read(
            square,
            prepared,
            colors,
            &mut samples,
            &mut Default::default(),
        );
        for [i, j] in part.offsets() {
            let sample = ((j + half) * (2 * half + 1) + i + half) as usize;
            let values = &samples.values[3 * sample..3 * sample + 3];
            query.extend(values.iter().map(|value| value * part.weight.sqrt()));
        }
    }
    query
}

/// Runs the passes as in the paper's pseudocode. The initial pixels are `started`.
fn pseudo_code(
    domain: &MeshDomain<'_>,
    pyramid: &Pyramid,
    passes: &[Pass],
    options: &Options,
    started: &[Vec<u32>],
) -> Vec<Vec<u32>> {
    let mut levels = started.to_vec();
    for pass in passes {
        let candidates = Candidates::new(pyramid, pass, options.center).unwrap();
        levels[pass.level].resize(domain.n_sites(pass.level), 0);
        for site in domain.order(pass.level) {
            let query = neighborhood(domain, pass, site, pyramid, &levels);
            let (mut smallest, mut best) = (f32::INFINITY, 0);
            for row in 0..candidates.len() {
                let new = distance_sq(&query, candidates.row(row));
                if new < smallest {
                    (smallest, best) = (new, row);
                }
            }
            levels[pass.level][site as usize] = candidates.pixels[best];
        }
    }
    levels
}

fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn passes_are_those_of_the_pseudo_code() {
    let case = sphere(300);
    let domain = case.domain(Axes::Carried, false);
    let paper = Schedule::paper(2);
    let part = |shape, side, reads| Part::new(shape, side, reads);
    let other = Schedule {
        passes: vec![
            Pass {
                level: 1,
                parts: vec![part(Shape::Causal, 5, Reads::Same)],
            },
            Pass {
                level: 0,
                parts: vec![part(Shape::Full, 3, Reads::Coarser)],
            },
            Pass {
                level: 0,
                parts: vec![
                    Part {
                        weight: 4.0,
                        ..part(Shape::Full, 3, Reads::Coarser)
                    },
                    part(Shape::HalfWithRow, 5, Reads::Same),
                ],
            },
        ],
    };
    for (schedule, edges) in [(paper, Edges::Wrap), (other, Edges::Cut)] {
        let pyramid = pyramid(edges, 2);
        let options = Options {
            n_levels: 2,
            schedule: Some(schedule.clone()),
            coherence: Coherence::Factor(0.0),
            evenness: 0.0,
            ..Options::default()
        };
        let candidates = Candidates::new(&pyramid, &schedule.passes[0], options.center).unwrap();
        let n_sites = domain.n_sites(1);
        let started = random_pixels(n_sites, &pyramid, &candidates, 1, options.seed);
        let started = [Vec::new(), started];
        let expected = pseudo_code(&domain, &pyramid, &schedule.passes, &options, &started);
        let found = run(&domain, &pyramid, &options, &mut go_on).unwrap();
        assert!(
            found == expected,
            "{edges:?}: other pixels than the pseudo-code's"
        );
    }
}

#[cfg(feature = "rayon")]
#[test]
fn texture_has_the_same_bits_on_any_number_of_threads() {
    let case = sphere(3000);
    let domain = case.domain(Axes::Carried, false);
    let pyramid = pyramid(Edges::Wrap, 2);
    for (coherence, evenness) in [(0.0, 0.0), (1.0, 0.0), (0.0, 2.0), (1.5, 0.5)] {
        let options = Options {
            n_levels: 2,
            coherence: Coherence::Factor(coherence),
            evenness,
            ..Options::default()
        };
        let textures = [1, 2, 7].map(|n_threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads);
            let pool = pool.build().unwrap();
            pool.install(|| run(&domain, &pyramid, &options, &mut go_on).unwrap())
        });
        assert!(
            textures[0] == textures[1],
            "2 threads, coherence {coherence}, evenness {evenness}"
        );
        assert!(
            textures[0] == textures[2],
            "7 threads, coherence {coherence}, evenness {evenness}"
        );
    }
}

#[test]
fn coherent_texture_has_more_neighbors_that_continue_each_other() {
    let case = sphere(2000);
    let domain = case.domain(Axes::Carried, false);
    let pyramid = pyramid(Edges::Wrap, 2);
    let continued = |coherence: f32| {
        let options = Options {
            n_levels: 2,
            coherence: Coherence::Factor(coherence),
            evenness: 0.0,
            ..Options::default()
        };
        let levels = run(&domain, &pyramid, &options, &mut go_on).unwrap();
        let sources = &levels[0];
        let graph = case.hierarchy().levels()[0].graph();
        let near = |a: u32, b: u32| {
            let step = |a: u32, b: u32| {
                let steps = (a + 16 - b) % 16;
                steps.min(16 - steps)
            };
            step(a % 16, b % 16) <= 1 && step(a / 16, b / 16) <= 1
        };
        case.hierarchy()
            .sites()
            .iter()
            .flat_map(|site| {
                graph
                    .neighbors(site)
                    .iter()
                    .map(move |&other| [site, other])
            })
            .filter(|[a, b]| near(sources[a.index()], sources[b.index()]))
            .count()
    };
    let [plain, coherent] = [0.0, 2.0].map(continued);
    assert!(coherent > plain, "{coherent} beside {plain} edges");
}

/// Returns, for each pixel of the coarser level, the number of sites that use it in a texture with the given evenness.
fn uses(evenness: f32) -> Vec<usize> {
    let case = sphere(4000);
    let options = Options {
        n_levels: 2,
        evenness,
        ..Options::default()
    };
    let pyramid = pyramid(Edges::Wrap, 2);
    let levels = run(
        &case.domain(Axes::Carried, false),
        &pyramid,
        &options,
        &mut go_on,
    )
    .unwrap();
    let mut uses = vec![0; 64];
    for &source in &levels[1] {
        uses[source as usize] += 1;
    }
    uses
}

#[test]
fn evenness_spreads_the_uses() {
    let [plain, even] = [0.0, 1.0].map(uses);
    let most = |uses: &[usize]| uses.iter().copied().max();
    assert!(most(&plain) > most(&even), "{plain:?} {even:?}");
    let squares = |uses: &[usize]| uses.iter().map(|count| count * count).sum::<usize>();
    assert!(squares(&plain) > squares(&even), "{plain:?} {even:?}");
}

#[test]
fn callback_hears_of_every_pass_and_can_stop_any() {
    let case = sphere(500);
    let domain = case.domain(Axes::Carried, false);
    let pyramid = pyramid(Edges::Wrap, 2);
    let options = Options {
        n_levels: 2,
        ..Options::default()
    };
    let mut heard = Vec::new();
    let mut listen = |progress: Progress| {
        heard.push(progress);
        ControlFlow::Continue(())
    };
    run(&domain, &pyramid, &options, &mut listen).unwrap();
    let ends: Vec<_> = heard
        .iter()
        .filter(|progress| progress.done == progress.n_sites)
        .collect();
    assert_eq!(
        ends.iter()
            .map(|progress| progress.pass)
            .collect::<Vec<_>>(),
        [0, 1, 2]
    );
    assert!(
        heard.iter().all(|progress| progress.n_passes == 3),
        "three passes"
    );
    for last in 0..3 {
        let mut stop = |progress: Progress| {
            if progress.pass == last {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let error = run(&domain, &pyramid, &options, &mut stop).unwrap_err();
        assert_eq!(error.kind(), &SynthErrorKind::Cancelled, "pass {last}");
    }
}

#[test]
fn value_stability_of_a_texture() {
    let case = sphere(400);
    let domain = case.domain(Axes::Carried, false);
    let pyramid = pyramid(Edges::Wrap, 2);
    let options = Options {
        n_levels: 2,
        coherence: Coherence::Factor(0.5),
        evenness: 0.0,
        ..Options::default()
    };
    let levels = run(&domain, &pyramid, &options, &mut go_on).unwrap();
    assert_eq!(
        levels[0][..8],
        [6, 4, 165, 133, 230, 228, 160, 198],
        "sources of the first sites"
    );
}
