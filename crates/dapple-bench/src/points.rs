//! The points group: maximal Poisson-disk sets on the unit torus compared with other crates that generate
//! Poisson-disk points.
//!
//! All sides get the same radius. They are compared by the time per point, since their densities differ: no peer is
//! maximal, `bluenoise` packs more densely than random darts, the others more loosely, and `fast_poisson` does not
//! wrap. Confirmed: the density is the known density of the method, and no two points are closer than the radius. Our
//! set also leaves no empty circle larger than the radius.

mod alone;
#[cfg(feature = "peers")]
mod beside_peers;

use crate::harness::Bench;
use anyhow::{Context as _, Result, ensure};
use dapple_points::PointSet;
use std::ops::RangeInclusive;

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    beside_peers::run(bench)?;
    alone::run(bench)
}

/// Checks that our set has the known density, that no two points are too close, and that there is no room for another
/// point. Returns the number of points.
fn confirm_maximal(points: &Option<PointSet>, radius: f64) -> Result<usize> {
    let points = points.as_ref().context("no points")?;
    // The density is 0.697, with less than 1 % deviation for 100,000 points or more.
    let n_points = confirm(points, radius, 1e-9, 0.690..=0.704)?;
    let largest = points
        .largest_empty_circle()
        .context("no empty circle")?
        .radius;
    // The guarantee of `poisson_disk`.
    ensure!(
        largest <= radius * (1.0 + 1e-6),
        "an empty circle of {largest} has room for a point, with a radius of {radius}"
    );
    Ok(n_points)
}

/// Checks the density of a set, and that no two points are closer than `radius` minus `slack`. Returns the number of
/// points.
fn confirm(
    points: &PointSet,
    radius: f64,
    slack: f64,
    density: RangeInclusive<f64>,
) -> Result<usize> {
    let found = points.normalized_density(radius);
    ensure!(
        density.contains(&found),
        "points times squared radius is {found}, not in {density:?}"
    );
    let least = points.minimum_distance().context("no two points")?;
    ensure!(
        least >= radius * (1.0 - slack),
        "two points are {least} apart, with a radius of {radius}"
    );
    Ok(points.len())
}
