//! Rows that compare our own methods with each other and need no other crate.

use super::{confirm, confirm_maximal};
use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use crate::sets::{self, SEED, UNIT_TORUS};
use anyhow::{Context as _, Result};
use dapple_points::glam::DVec2;
use dapple_points::raster::{Ramp, Varying};
use dapple_points::{
    Domain, EndlessPoint, EndlessPoissonDisk, PointSet, VariablePoissonOptions, poisson_disk,
    variable_poisson_disk,
};
use std::time::Duration;

const VARIABLE: Case = Case {
    group: "points",
    case: "variable radius, 100 k points",
    peer: "ours, fixed radius",
    unit: Unit::NsPerPoint,
    must: Goal::CostAtMost(3.0),
    note: "average rule; from left to right, the radius becomes four times as large",
};

const TWO_THREADS: Case = Case {
    case: "maximal Poisson disk on two threads, 1 M points",
    peer: "ours, one thread",
    unit: Unit::Ms,
    must: Goal::Faster(1.75),
    note: "",
    ..VARIABLE
};

const ENDLESS: Case = Case {
    case: "endless Poisson disk, 100 k points",
    peer: "ours, maximal",
    must: Goal::CostAtMost(6.0),
    note: "a window of the endless plane, with 0.92 of the points of a maximal set",
    ..VARIABLE
};

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    variable(bench)?;
    endless(bench)?;
    two_threads(bench)
}

/// Returns a side that generates a point set on the unit torus and stores it.
pub(super) fn maximal(radius: f64) -> Side<'static, Option<PointSet>> {
    Side::new(None, move |points| {
        *points = poisson_disk(UNIT_TORUS, radius, SEED).ok();
    })
    .prepared(|points| *points = None)
}

fn variable(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&VARIABLE) {
        return Ok(());
    }
    let cylinder = Domain {
        wrap: [false, true],
        ..UNIT_TORUS
    };
    let radius = sets::radius_of(100_000);
    // The mean of 1 / r² over a geometric ramp from a to 4a is (1 − 1/16) / (2 ln 4) = 0.338 of 1 / a².
    let least = radius * 0.338_f64.sqrt();
    let ramp = Ramp {
        from: DVec2::ZERO,
        to: DVec2::X,
        start: least,
        end: 4.0 * least,
    };
    let (field, options) = (
        Varying::GeometricRamp(ramp),
        VariablePoissonOptions::default(),
    );
    let ours = Side::new(None, |points: &mut Option<PointSet>| {
        *points = variable_poisson_disk(cylinder, &field, &options, SEED).ok();
    })
    .prepared(|points| *points = None);
    bench.beside(&VARIABLE, 15, ours, maximal(radius), |ours, theirs| {
        let ours = ours.as_ref().context("no points")?;
        // The density equals the density for a fixed radius within the 3 % that the method promises. The minimum
        // distance is the minimum radius of the ramp.
        let n_ours = confirm(ours, radius, 1.0, 0.676..=0.718)?;
        confirm(ours, least, 1e-9, 0.0..=1.0)?;
        Ok(Done {
            ours: n_ours,
            theirs: confirm_maximal(theirs, radius)?,
        })
    })
}

fn endless(bench: &mut Bench) -> Result<()> {
    let radius = sets::radius_of(100_000);
    // The corner is far from the origin by a power of two, so that positions in the window are exact.
    let corner = 64.0;
    let endless = EndlessPoissonDisk::new(radius, SEED)?;
    let ours = Side::new(None, |points: &mut Option<Vec<EndlessPoint>>| {
        *points = endless.points([corner; 2], [corner + 1.0; 2]).ok();
    })
    .prepared(|points| *points = None);
    bench.beside(&ENDLESS, 15, ours, maximal(radius), |ours, theirs| {
        let ours = ours.as_ref().context("no points")?;
        let positions = ours.iter().map(|point| point.position - corner).collect();
        let domain = Domain::rectangle(DVec2::ZERO, DVec2::ONE);
        Ok(Done {
            ours: confirm(&PointSet::new(domain, positions)?, radius, 0.0, 0.63..=0.65)?,
            theirs: confirm_maximal(theirs, radius)?,
        })
    })
}

fn two_threads(bench: &mut Bench) -> Result<()> {
    let radius = sets::radius_of(1_000_000);
    let job = |points: &mut Option<PointSet>| *points = poisson_disk(UNIT_TORUS, radius, SEED).ok();
    // Two failed runs do not count as equal. Coordinates are never NaN or −0.
    let same = |one: &Option<PointSet>, two: &Option<PointSet>| one.is_some() && one == two;
    bench.two_threads(
        &TWO_THREADS,
        Duration::from_secs(30),
        [None, None],
        job,
        same,
    )
}
