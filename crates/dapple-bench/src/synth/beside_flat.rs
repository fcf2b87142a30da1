//! Our synthesis compared with `texture-synthesis`, which generates one flat image of 512×512 pixels from the same
//! exemplar.
//!
//! Both run on one thread. Times are medians of processor times. The peer generates one image per turn, shared by all
//! rows.

use super::scene::{self, N_SITES, SIDE, endless, exact, leaves, model, synthesizer};
use super::whole;
use crate::harness::{Bench, median};
use crate::peers::flat;
use crate::row::{Case, Goal, Unit};
use anyhow::{Result, ensure};
use dapple_mesh::Surface;
use dapple_synth::{Edges, Exemplar, Options, PlaneTexture, sites_for_exemplar, synthesize_plane};

const EXACT: Case = Case {
    group: "synth",
    case: "synthesis, 262,144 sites, 3 levels, 64² exemplar, exact search",
    peer: "texture-synthesis, flat 512×512",
    unit: Unit::S,
    must: Goal::CostAtMost(0.4),
    note: "",
};

const DEFAULT: Case = Case {
    case: "synthesis, 262,144 sites, 3 levels, 64² exemplar, default options",
    ..EXACT
};

const WHOLE: Case = Case {
    case: "whole run, 262,144 sites, 3 levels, 64² exemplar, exact search, map 2048×2048",
    must: Goal::CostAtMost(0.9),
    ..EXACT
};

const PLANE: Case = Case {
    case: "plane 512×512, 3 levels, 64² exemplar, default options",
    must: Goal::CostAtMost(0.35),
    ..EXACT
};

const PLANE_EXACT: Case = Case {
    case: "plane 512×512, 3 levels, 64² exemplar, exact search",
    ..PLANE
};

const ENDLESS: Case = Case {
    case: "endless texture, 512×512, 64² exemplar",
    must: Goal::CostAtMost(0.1),
    ..EXACT
};

/// Row that compares our endless synthesis with our older method on the same exemplar.
const ENDLESS_BESIDE_SWEEP: Case = Case {
    peer: "plane 512×512, default options",
    must: Goal::CostAtMost(1.2),
    ..ENDLESS
};

const LARGE: Case = Case {
    case: "synthesis, 262,144 sites, 4 levels, 256² exemplar, default options",
    must: Goal::CostAtMost(1.0),
    ..EXACT
};

/// Row whose threshold is the result of a prototype with the same search.
const LARGE_EXACT: Case = Case {
    case: "synthesis, 262,144 sites, 4 levels, 256² exemplar, exact search",
    must: Goal::CostAtMost(1.3),
    ..EXACT
};

/// Row with the number of sites that `dapple synth --mesh` uses: enough for the exemplar to repeat five times, but at
/// most 400,000.
const DEFAULT_SITES: Case = Case {
    case: "synthesis, default number of sites, 256² exemplar, default options",
    must: Goal::CostAtMost(1.6),
    ..EXACT
};

/// The measured job of a row. Returns the number of elements of its output.
type Job<'a> = Box<dyn Fn() -> Result<usize> + Sync + 'a>;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if bench.wants(&ENDLESS_BESIDE_SWEEP) {
        beside_sweep(bench)?;
    }
    if bench.wants_any(&[EXACT, DEFAULT, WHOLE, PLANE, PLANE_EXACT, ENDLESS]) {
        small(bench)?;
    }
    if bench.wants_any(&[LARGE, LARGE_EXACT]) {
        large(bench)?;
    }
    if bench.wants(&DEFAULT_SITES) {
        default_sites(bench)?;
    }
    Ok(())
}

fn small(bench: &mut Bench) -> Result<()> {
    let (model, picture) = (model()?, leaves(64)?);
    let exemplar = picture.exemplar()?;
    let sites = synthesizer(&model, N_SITES, 3)?;
    let on_sites = |options: Options| -> Job<'_> {
        let (sites, exemplar) = (&sites, &exemplar);
        Box::new(move || scene::count(&sites.synthesize(exemplar, &options)?))
    };
    let in_plane = |options: Options| -> Job<'_> {
        let exemplar = &exemplar;
        Box::new(move || {
            count_plane(&synthesize_plane(
                exemplar,
                [SIDE; 2],
                [Edges::Cut; 2],
                &options,
            )?)
        })
    };
    let whole: Job<'_> = Box::new(|| {
        let written = whole::run(&model, &exemplar, &exact(3))?;
        ensure!(written.coverage > 0.9, "the map is empty");
        ensure!(written.glb.len() > 1_000_000, "the map is flat");
        Ok(N_SITES)
    });
    let rows = [
        (EXACT, on_sites(exact(3))),
        (DEFAULT, on_sites(Options::default())),
        (WHOLE, whole),
        (PLANE, in_plane(Options::default())),
        (PLANE_EXACT, in_plane(exact(3))),
        (ENDLESS, Box::new(|| count_plane(&endless(&exemplar)?))),
    ];
    let note = format!("{}; {}", model.note, picture.note());
    beside(bench, 3, &picture, rows.into(), &note)
}

fn beside_sweep(bench: &mut Bench) -> Result<()> {
    let picture = leaves(64)?;
    let exemplar = picture.exemplar()?;
    let [mut ours, mut sweeps] = [Vec::new(), Vec::new()];
    for _ in 0..3 {
        let (time, made) = bench.on_one(|| count_plane(&endless(&exemplar)?));
        ensure!(made? == (SIDE * SIDE) as usize, "another number of pixels");
        ours.push(time);
        let (time, made) = bench.on_one(|| {
            let edges = [Edges::Cut; 2];
            count_plane(&synthesize_plane(
                &exemplar,
                [SIDE; 2],
                edges,
                &Options::default(),
            )?)
        });
        ensure!(made? == (SIDE * SIDE) as usize, "another number of pixels");
        sweeps.push(time);
    }
    let note = picture.note().to_owned();
    bench.measured_with(
        &ENDLESS_BESIDE_SWEEP,
        median(&mut ours),
        median(&mut sweeps),
        note,
    );
    Ok(())
}

fn large(bench: &mut Bench) -> Result<()> {
    let (model, picture) = (model()?, leaves(256)?);
    let exemplar = picture.exemplar()?;
    let sites = synthesizer(&model, N_SITES, 4)?;
    let job = |options: Options| -> Job<'_> {
        let (sites, exemplar) = (&sites, &exemplar);
        Box::new(move || scene::count(&sites.synthesize(exemplar, &options)?))
    };
    let default = Options {
        n_levels: 4,
        ..Options::default()
    };
    let rows = [(LARGE, job(default)), (LARGE_EXACT, job(exact(4)))];
    let note = format!("{}; {}", model.note, picture.note());
    beside(bench, 3, &picture, rows.into(), &note)
}

fn default_sites(bench: &mut Bench) -> Result<()> {
    let (model, picture) = (model()?, leaves(256)?);
    let exemplar = picture.exemplar()?;
    let surface = Surface::new(whole::read_obj(&model.obj)?)?;
    let n_sites = sites_for_exemplar(&surface, exemplar.size());
    let sites = synthesizer(&model, n_sites, Options::default().n_levels)?;
    let job: Job<'_> = Box::new(|| {
        let made = scene::count(&sites.synthesize(&exemplar, &Options::default())?)?;
        ensure!(made == n_sites, "{made} sites, not {n_sites}");
        Ok(N_SITES)
    });
    let note = format!("{n_sites} sites; {}; {}", model.note, picture.note());
    beside(bench, 3, &picture, vec![(DEFAULT_SITES, job)], &note)
}

/// Measures all selected rows of our synthesis against the peer's flat image.
fn beside(
    bench: &mut Bench,
    turns: u32,
    picture: &scene::Picture,
    mut rows: Vec<(Case, Job<'_>)>,
    note: &str,
) -> Result<()> {
    rows.retain(|(case, _)| bench.wants(case));
    let mut theirs = Vec::new();
    let mut ours = vec![Vec::new(); rows.len()];
    for _ in 0..turns {
        let (seconds, image) = flat::synthesize(&picture.image, SIDE)?;
        let made = Exemplar::new(&image, Edges::Cut)?;
        let range = made
            .pixels()
            .iter()
            .fold([1.0_f32, 0.0], |[low, high], &value| {
                [low.min(value), high.max(value)]
            });
        ensure!(
            range[1] - range[0] > 0.2,
            "the flat image is flat: {range:?}"
        );
        theirs.push(seconds);
        for ((_, job), seconds) in rows.iter().zip(&mut ours) {
            let (time, made) = bench.on_one(job);
            ensure!(made? == (SIDE * SIDE) as usize, "another number of pixels");
            seconds.push(time);
        }
    }
    let theirs = median(&mut theirs);
    for ((case, _), mut ours) in rows.iter().zip(ours) {
        bench.measured_with(case, median(&mut ours), theirs, note.to_owned());
    }
    Ok(())
}

/// Returns the number of pixels of a texture. Fails if the texture uses too few pixels of the exemplar.
fn count_plane(texture: &PlaneTexture) -> Result<usize> {
    let mut sources = texture.sources().pixels().to_vec();
    let n_pixels = sources.len();
    sources.sort_unstable();
    sources.dedup();
    ensure!(sources.len() > 500, "all is of {} pixels", sources.len());
    Ok(n_pixels)
}
