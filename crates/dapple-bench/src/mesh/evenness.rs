//! Evenness of repelled points compared with a hexagonal lattice, by the distances to nearest neighbors.
//!
//! The points are the default hierarchy on the procedural animal, 262,144 points. The row reports the worst level.

use crate::harness::Bench;
use crate::row::{Case, Goal, Unit};
use anyhow::{Result, ensure};
use dapple_mesh::Surface;
use dapple_models as models;
use dapple_synth::{Evenness, Hierarchy, HierarchyOptions, evenness};

const MEAN: Case = Case {
    group: "mesh",
    case: "repelled points, mean distance to the nearest",
    peer: "a hexagonal lattice",
    unit: Unit::Thousandths,
    must: Goal::AtLeast(0.88),
    note: "262,144 points on a procedural animal, 3 levels of which the worst counts",
};

const LEAST: Case = Case {
    case: "repelled points, least distance to the nearest",
    must: Goal::AtLeast(0.5),
    ..MEAN
};

const N_SITES: usize = 512 * 512;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants_any(&[MEAN, LEAST]) {
        return Ok(());
    }
    let surface = Surface::new(models::bunny(6000)?)?;
    let options = HierarchyOptions {
        n_sites: N_SITES,
        n_levels: 3,
        seed: crate::sets::SEED,
        ..HierarchyOptions::default()
    };
    let hierarchy = Hierarchy::new(&surface, &options)?;
    ensure!(hierarchy.sites().len() == N_SITES, "a site is missing");
    let of = |n_sites| evenness(&surface, hierarchy.sites(), n_sites);
    let levels: Vec<Evenness> = hierarchy
        .levels()
        .iter()
        .map(|level| of(level.n_sites()))
        .collect();
    let worst = |part: fn(&Evenness) -> f64| levels.iter().map(part).fold(f64::INFINITY, f64::min);
    for (case, found) in [
        (MEAN, worst(|level| level.mean)),
        (LEAST, worst(|level| level.min)),
    ] {
        if bench.wants(&case) {
            bench.measured(&case, found, 1.0);
        }
    }
    Ok(())
}
