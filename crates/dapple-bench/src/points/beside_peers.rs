//! Our sets compared with other crates that generate Poisson-disk points.

use super::alone::maximal;
use super::{confirm, confirm_maximal};
use crate::harness::{Bench, Done, Side};
use crate::peers;
use crate::row::{Case, Goal, Unit};
use crate::sets::{self, SEED, UNIT_TORUS};
use anyhow::{Context as _, Result};
use dapple_points::glam::DVec2;
use dapple_points::{Domain, PointSet};
use std::ops::RangeInclusive;

const BLUENOISE_100K: Case = Case {
    group: "points",
    case: "maximal Poisson disk, 100 k points",
    peer: "bluenoise, wrapping, k = 10",
    unit: Unit::NsPerPoint,
    must: Goal::Faster(4.0),
    note: "",
};

const BLUENOISE_1M: Case = Case {
    case: "maximal Poisson disk, 1 M points",
    ..BLUENOISE_100K
};

const DISKUS_100K: Case = Case {
    peer: "poisson-diskus, periodic",
    must: Goal::Faster(15.0),
    ..BLUENOISE_100K
};

const DISKUS_1M: Case = Case {
    case: BLUENOISE_1M.case,
    ..DISKUS_100K
};

const FAST_POISSON_100K: Case = Case {
    peer: "fast_poisson, not periodic",
    must: Goal::Faster(30.0),
    ..BLUENOISE_100K
};

const FAST_POISSON_1M: Case = Case {
    case: BLUENOISE_1M.case,
    must: Goal::Faster(100.0),
    note: "one run of the peer, which takes more than a minute",
    ..FAST_POISSON_100K
};

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    row(bench, &BLUENOISE_100K, 15, &bluenoise(100_000))?;
    row(bench, &BLUENOISE_1M, 5, &bluenoise(1_000_000))?;
    row(bench, &DISKUS_100K, 7, &diskus(100_000))?;
    row(bench, &DISKUS_1M, 2, &diskus(1_000_000))?;
    row(bench, &FAST_POISSON_100K, 5, &fast_poisson(100_000))?;
    row(bench, &FAST_POISSON_1M, 1, &fast_poisson(1_000_000))
}

/// A peer that generates positions of type `P`, with its known properties.
struct Peer<P> {
    /// Radius on the unit torus, the same as our side's.
    radius: f64,
    /// Generates the points of the peer.
    make: Box<dyn Fn() -> Vec<P> + Sync>,
    /// Converts a point of the peer to a position.
    position: fn(&P) -> DVec2,
    /// Domain of the peer's points.
    domain: Domain,
    /// Radius in units of the peer's domain.
    own_radius: f64,
    /// Tolerance of the minimum distance between two points, relative to the radius.
    slack: f64,
    /// Expected density: the number of points times the squared radius, divided by the area.
    density: RangeInclusive<f64>,
}

impl<P> Peer<P> {
    /// Checks the peer's points and returns their number.
    fn confirm(&self, made: &[P]) -> Result<usize> {
        let points = PointSet::new(self.domain, made.iter().map(self.position).collect())?;
        confirm(&points, self.own_radius, self.slack, self.density.clone())
            .context("the peer's points")
    }
}

fn row<P: Send>(bench: &mut Bench, case: &Case, turns: u32, peer: &Peer<P>) -> Result<()> {
    let make = &peer.make;
    let theirs = Side::new(Vec::new(), |points: &mut Vec<P>| *points = make())
        .prepared(|points| *points = Vec::new());
    bench.beside(case, turns, maximal(peer.radius), theirs, |ours, theirs| {
        Ok(Done {
            ours: confirm_maximal(ours, peer.radius)?,
            theirs: peer.confirm(theirs)?,
        })
    })
}

/// Returns the crate `bluenoise` as a peer. It works on a torus of any side in single precision; its radius is 1 here.
fn bluenoise(n_points: u32) -> Peer<[f32; 2]> {
    let radius = sets::radius_of(n_points);
    let side = (1.0 / radius) as f32;
    Peer {
        radius,
        make: Box::new(move || peers::bluenoise(side, SEED.0)),
        position: |at| DVec2::new(f64::from(at[0]), f64::from(at[1])),
        domain: Domain::torus(DVec2::ZERO, DVec2::splat(f64::from(side))),
        own_radius: 1.0,
        // Coordinates go up to 1200, where adjacent `f32` values are 1.2e-4 apart.
        slack: 3e-4,
        density: 0.78..=0.82,
    }
}

fn diskus(n_points: u32) -> Peer<[f64; 2]> {
    let radius = sets::radius_of(n_points);
    Peer {
        radius,
        make: Box::new(move || peers::poisson_diskus(radius, SEED.0)),
        position: |at| DVec2::from_array(*at),
        domain: UNIT_TORUS,
        own_radius: radius,
        // Rounding error of positions up to 1, relative to radii down to 8e-4.
        slack: 1e-9,
        density: BRIDSON,
    }
}

/// Returns the crate `fast_poisson` as a peer. It does not wrap, and the border admits a few more points.
fn fast_poisson(n_points: u32) -> Peer<[f64; 2]> {
    let radius = sets::radius_of(n_points);
    Peer {
        make: Box::new(move || peers::fast_poisson(radius, SEED.0)),
        domain: Domain::rectangle(DVec2::ZERO, DVec2::ONE),
        ..diskus(n_points)
    }
}

/// Range of the number of points times the squared radius, for Bridson's algorithm with 30 attempts per point.
const BRIDSON: RangeInclusive<f64> = 0.610..=0.640;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peers_keep_the_radius_and_make_as_many_points_as_is_known() {
        let bluenoise = bluenoise(10_000);
        bluenoise
            .confirm(&(bluenoise.make)())
            .expect("points of bluenoise");
        for peer in [diskus(10_000), fast_poisson(10_000)] {
            peer.confirm(&(peer.make)())
                .expect("points of poisson-diskus or fast_poisson");
        }
    }
}
