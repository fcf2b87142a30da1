//! Moves control points on circles, for looping animations.
//!
//! The paper's outlook: "the motion of the texture can be governed by the motion of the underlying discrete structure.
//! The main difficulty here lies in smoothing out sudden changes in the texture arising from sudden changes in the
//! control net topology." Points retain their values and labels while they move. [`PupsOptions::fade`] smooths the
//! changes.
//!
//! A circle is centered at the position of its point in the texture without motion, so the distribution of point
//! distances is the same at all times.
//!
//! [`PupsOptions::fade`]: crate::PupsOptions::fade

use crate::{PupsError, Range, range};
use core::f64::consts::TAU;
use dapple_graph::Graph;
use dapple_hash::{CellHash, Seed, unit_f64};
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

/// Looping motion of control points on circles.
///
/// Each point goes once around its own circle in a loop, clockwise or counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Orbits {
    /// Radius of the largest circles, as a fraction of a point's mean edge length, above 0 and at most 1.
    ///
    /// The smallest circles are half as large. Up to a radius of 0.3, the points of a Poisson-disk set stay apart.
    #[cfg_attr(feature = "schema", schemars(transform = { RADIUS }))]
    pub radius: f64,
}

/// Range of [`Orbits::radius`].
const RADIUS: Range = range!(above 0 to 1);
/// Range of the time, in loops. Adding whole loops changes nothing.
const TIME: Range = range!(finite);

impl Orbits {
    /// Returns the positions of the points at `time`, as a fraction of the loop. Time 1 gives the same positions as 0.
    /// Along axes of the domain that do not wrap, circles are shrunk to fit within it.
    pub(crate) fn moved(
        self,
        points: &PointSet,
        graph: &Graph,
        time: f64,
        seed: Seed,
    ) -> Result<PointSet, PupsError> {
        PupsError::check_in(RADIUS, "radius of the orbits", self.radius)?;
        PupsError::check_in(TIME, "time", time)?;
        // Reduce the time to a fraction of the loop.
        let passed = time - time.floor();
        let moved = points.iter().map(|(point, center)| {
            let random = CellHash::new(seed, [i64::from(point.0)]);
            // Draw the phase, in turns, the size of the orbit, and the direction of rotation.
            let [phase, size, way] = [0, 1, 2].map(|lane| unit_f64(random.at(lane)));
            let turn = if way < 0.5 {
                phase + passed
            } else {
                phase - passed
            };
            // The radius is from half to all of the option, in multiples of the mean length of the point's edges.
            let radius = self.radius * (0.5 + 0.5 * size) * mean_distance(graph, point);
            let circle = DVec2::new(libm::cos(TAU * turn), libm::sin(TAU * turn));
            within(points, center, radius, circle)
        });
        Ok(PointSet::new(*points.domain(), moved.collect())?)
    }
}

/// Returns the mean length of a point's edges; zero without edges.
fn mean_distance(graph: &Graph, point: PointIdx) -> f64 {
    let axes = graph.axes(point);
    let sum: f64 = axes.iter().map(|axis| axis.vector.length()).sum();
    sum / axes.len().max(1) as f64
}

/// Returns the position `center + circle · radius`. The radius is reduced if the circle would cross a border that does
/// not wrap.
fn within(points: &PointSet, center: DVec2, mut radius: f64, circle: DVec2) -> DVec2 {
    let domain = points.domain();
    let (first, last) = (domain.origin, domain.end());
    // Reduce the radius so that the circle does not cross a border of the domain.
    for axis in (0..2).filter(|&axis| !domain.wrap[axis]) {
        let room = (center[axis] - first[axis]).min(last[axis] - center[axis]);
        radius = radius.min(room);
    }
    let mut at = center + circle * radius;
    for axis in (0..2).filter(|&axis| !domain.wrap[axis]) {
        // Rounding may exceed the border.
        at[axis] = at[axis].clamp(first[axis], last[axis]);
    }
    at
}
