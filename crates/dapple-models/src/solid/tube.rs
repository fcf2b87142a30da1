//! Tubes along curves.

use super::shape::Spindle;
use super::{RoundCone, Solid};
use glam::DVec3;

/// A tube around a smooth curve through given points, with a radius at each point.
///
/// The curve is a Catmull-Rom spline (Catmull and Rom, "A Class of Local Interpolating Splines", 1974), divided into
/// [`RoundCone`]s.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    links: Vec<Link>,
    bounds: [DVec3; 2],
}

/// A segment of a tube with its bounding sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Link {
    cone: Spindle,
    center: DVec3,
    reach: f64,
}

/// Number of links between two consecutive curve points. The angles between links are too small to see in figures.
const LINKS: u32 = 5;

impl Tube {
    /// Creates the tube through points `[x, y, z, radius]`. It is empty for fewer than two points.
    #[must_use]
    pub fn through(points: &[[f64; 4]]) -> Self {
        let mut cones = Vec::new();
        for index in 1..points.len() {
            let before = points[index.saturating_sub(2)];
            let after = points[(index + 1).min(points.len() - 1)];
            let spline = [before, points[index - 1], points[index], after];
            for step in 0..LINKS {
                let [from, to] = [step, step + 1]
                    .map(|step| on_spline(&spline, f64::from(step) / f64::from(LINKS)));
                cones.push(round_cone(from, to));
            }
        }
        let boxes = cones.iter().map(RoundCone::bounds);
        let bounds = boxes.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        Self {
            links: cones.iter().map(link).collect(),
            bounds: bounds.unwrap_or_default(),
        }
    }
}

impl Solid for Tube {
    fn distance(&self, at: DVec3) -> f64 {
        // Evaluate the link that is probably nearest first, so that most others can be skipped.
        let (mut first, mut least_sq) = (0, f64::INFINITY);
        for (index, link) in self.links.iter().enumerate() {
            let distance_sq = (at - link.center).length_squared();
            if distance_sq < least_sq {
                (first, least_sq) = (index, distance_sq);
            }
        }
        let likely = self.links.get(first);
        let mut nearest = likely.map_or(f64::INFINITY, |link| link.cone.distance(at));
        for link in &self.links {
            // Skip links whose bounding sphere is farther than the nearest link.
            let least = nearest + link.reach;
            if least > 0.0 && (at - link.center).length_squared() < least * least {
                nearest = nearest.min(link.cone.distance(at));
            }
        }
        nearest
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.bounds
    }
}

fn round_cone(from: [f64; 4], to: [f64; 4]) -> RoundCone {
    RoundCone {
        ends: [from, to].map(|[x, y, z, _]| DVec3::new(x, y, z)),
        radii: [from[3], to[3]],
    }
}

fn link(cone: &RoundCone) -> Link {
    let [from, to] = cone.ends;
    Link {
        cone: Spindle::new(cone),
        center: (from + to) * 0.5,
        reach: 0.5 * (to - from).length() + cone.radii[0].max(cone.radii[1]),
    }
}

/// Returns a point of the spline segment between the second and the third point, at `part` from 0 to 1.
fn on_spline(points: &[[f64; 4]; 4], part: f64) -> [f64; 4] {
    core::array::from_fn(|number| {
        let [before, from, to, after] = points.map(|point| point[number]);
        let [start, end] = [0.5 * (to - before), 0.5 * (after - from)];
        let rest = 1.0 - part;
        // Cubic Hermite form.
        (1.0 + 2.0 * part) * rest * rest * from
            + part * rest * rest * start
            + (3.0 - 2.0 * part) * part * part * to
            - part * part * rest * end
    })
}
