//! Table 1 of Turk's paper: our times compared with its times in minutes, for models and exemplars of the same sizes.
//!
//! `cargo xtask bench "table 1"` measures it. Our time is the wall time of the synthesis on two threads with an exact
//! search, the smaller of two runs. The note states the setup time (points, graph, directions and sweep), since the
//! paper does not say whether its times include it. The models come from `dapple_models`, and the exemplars are
//! drawn.

use super::drawings::{self, Drawing, draw};
use super::scene::{count, exact};
use crate::harness::Bench;
use crate::report::three_digits;
use crate::row::{Case, Goal, Unit};
use anyhow::{Result, ensure};
use dapple_mesh::{Mesh, Surface};
use dapple_models::{self as models, ModelError};
use dapple_synth::{Direction, Edges, Exemplar, HierarchyOptions, Synthesizer};
use glam::DVec3;

/// A row of table 1.
pub(super) struct Row {
    case: Case,
    model: fn(usize) -> Result<Mesh, ModelError>,
    /// Texture directions on the model, as pairs of a position and a direction.
    directions: &'static [[DVec3; 2]],
    n_sites: usize,
    n_levels: usize,
    drawing: Drawing,
    side: u32,
    minutes: f64,
}

const CASE: Case = Case {
    group: "synth",
    case: "table 1: ray, 64,000 sites, 3 levels, 64² exemplar",
    peer: "the paper's 7 minutes",
    unit: Unit::S,
    must: Goal::Faster(300.0),
    note: "",
};

const RAY: Row = Row {
    case: CASE,
    model: models::ray,
    directions: &[
        [models::ray::SNOUT, DVec3::NEG_Z],
        [models::ray::LEFT_WING, DVec3::X],
        [models::ray::TAIL, DVec3::NEG_Z],
    ],
    n_sites: 64_000,
    n_levels: 3,
    drawing: drawings::checker,
    side: 64,
    minutes: 7.0,
};

const OCTOPUS: Row = Row {
    case: Case {
        case: "table 1: octopus, 256,000 sites, 3 levels, 64² exemplar",
        peer: "the paper's 34 minutes",
        ..CASE
    },
    model: models::octopus,
    directions: &[
        [DVec3::new(0.0, 0.5, 0.4), DVec3::NEG_Y],
        [DVec3::new(0.75, -0.2, 0.3), DVec3::new(0.9, 0.0, 0.4)],
        [DVec3::new(-0.75, -0.2, -0.3), DVec3::new(-0.9, 0.0, -0.4)],
    ],
    n_sites: 256_000,
    drawing: drawings::suckers,
    minutes: 34.0,
    ..RAY
};

const BUNNY: Row = Row {
    case: Case {
        case: "table 1: bunny, 256,000 sites, 3 levels, 128² exemplar",
        peer: "the paper's 80 minutes",
        ..CASE
    },
    model: models::bunny,
    directions: &[
        [models::bunny::LEFT_EAR, DVec3::NEG_Y],
        [models::bunny::NOSE, DVec3::NEG_Y],
        [models::bunny::TAIL, DVec3::NEG_Y],
    ],
    drawing: drawings::scales,
    side: 128,
    minutes: 80.0,
    ..OCTOPUS
};

/// Row for the tori. The rows for single steps use its model, too.
pub(super) const TORI: Row = Row {
    case: Case {
        case: "table 1: tori, 256,000 sites, 4 levels, 64² exemplar",
        peer: "the paper's 23 minutes",
        ..CASE
    },
    model: models::blended_tori,
    directions: &[
        [DVec3::new(0.55, 0.55, 0.2), DVec3::new(-1.0, 1.0, 0.0)],
        [DVec3::new(0.2, 0.55, 0.55), DVec3::new(0.0, -1.0, 1.0)],
        [DVec3::new(0.55, 0.2, 0.55), DVec3::new(1.0, 0.0, -1.0)],
    ],
    n_levels: 4,
    drawing: drawings::weave,
    side: 64,
    minutes: 23.0,
    ..OCTOPUS
};

const ZEBRA: Row = Row {
    case: Case {
        case: "table 1: zebra, 256,000 sites, 4 levels, 256² exemplar",
        peer: "the paper's 108 minutes",
        ..CASE
    },
    model: models::zebra,
    directions: &[
        [models::zebra::BACK, DVec3::X],
        [models::zebra::MUZZLE, DVec3::X],
    ],
    drawing: drawings::text,
    side: 256,
    minutes: 108.0,
    ..TORI
};

const ELEPHANT: Row = Row {
    case: Case {
        case: "table 1: elephant, 256,000 sites, 4 levels, 64² exemplar",
        peer: "the paper's 29 minutes",
        ..CASE
    },
    model: models::elephant,
    directions: &[
        [models::elephant::BACK, DVec3::NEG_Z],
        [models::elephant::FOREHEAD, DVec3::NEG_Y],
        [models::elephant::TRUNK, DVec3::NEG_Y],
    ],
    drawing: drawings::puzzle,
    minutes: 29.0,
    ..TORI
};

/// Number of triangles of each model. The paper's models have 10,000 to 20,000.
const N_TRIANGLES: usize = 14_000;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    for row in [RAY, OCTOPUS, BUNNY, TORI, ZEBRA, ELEPHANT] {
        if bench.wants(&row.case) {
            row.measure(bench)?;
        }
    }
    Ok(())
}

impl Row {
    /// Returns the surface of the model.
    pub(super) fn surface(&self) -> Result<Surface> {
        Ok(Surface::new((self.model)(N_TRIANGLES)?)?)
    }

    /// Returns the options for placing the sites.
    pub(super) fn sites(&self) -> HierarchyOptions {
        HierarchyOptions {
            n_sites: self.n_sites,
            n_levels: self.n_levels,
            ..HierarchyOptions::default()
        }
    }

    /// Returns the directions that the texture follows.
    pub(super) fn directions(&self) -> Vec<Direction> {
        let directions = self.directions.iter();
        directions
            .map(|&[at, vector]| Direction { at, vector })
            .collect()
    }

    fn measure(&self, bench: &mut Bench) -> Result<()> {
        let surface = self.surface()?;
        let exemplar = Exemplar::new(&draw(self.drawing, self.side)?, Edges::Cut)?;
        let (setup, sites) =
            bench.on_two(|| Synthesizer::new(surface, &self.directions(), &self.sites()));
        let sites = sites?;
        let mut least = f64::INFINITY;
        for _ in 0..2 {
            let (seconds, texture) =
                bench.on_two(|| sites.synthesize(&exemplar, &exact(self.n_levels)));
            ensure!(count(&texture?)? == self.n_sites, "a site is missing");
            least = least.min(seconds);
        }
        let note = format!(
            "wall time on two threads; points, graph, directions and sweep took {} s more",
            three_digits(setup)
        );
        bench.measured_with(&self.case, least, 60.0 * self.minutes, note);
        Ok(())
    }
}
