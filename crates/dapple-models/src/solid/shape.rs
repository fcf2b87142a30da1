//! Elementary solids.

use super::{Solid, box_distance};
use glam::DVec3;

/// A ball: the inside of a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The center.
    pub center: DVec3,
    /// The radius.
    pub radius: f64,
}

impl Solid for Ball {
    fn distance(&self, at: DVec3) -> f64 {
        (at - self.center).length() - self.radius
    }

    fn bounds(&self) -> [DVec3; 2] {
        [self.center - self.radius, self.center + self.radius]
    }
}

/// An ellipsoid with its axes along x, y and z.
///
/// The distance is exact outside, and a lower bound of the depth inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// The center.
    pub center: DVec3,
    /// The semi-axes along x, y and z, above 0.
    pub radii: DVec3,
}

impl Solid for Ellipsoid {
    fn distance(&self, at: DVec3) -> f64 {
        let at = at - self.center;
        let ratio = (at / self.radii).length();
        if ratio <= 1.0 {
            (ratio - 1.0) * self.radii.min_element()
        } else {
            outer_distance(self.radii, at)
        }
    }

    fn bounds(&self) -> [DVec3; 2] {
        [self.center - self.radii, self.center + self.radii]
    }
}

/// Returns the distance from a point outside an ellipsoid centered at the origin.
///
/// The nearest point is `r² p / (r² + t)` for the t above 0 at which it lies on the ellipsoid. The function whose
/// root is t is decreasing and convex, so Newton steps from 0 converge without overshooting.
fn outer_distance(radii: DVec3, at: DVec3) -> f64 {
    /// Maximum number of steps, more than needed: near the root, each step doubles the number of correct digits.
    const STEPS: u32 = 40;
    let squares = radii * radii;
    let mut t = 0.0;
    for _ in 0..STEPS {
        let inverse = (squares + t).recip();
        let terms = radii * at * inverse;
        let terms = terms * terms;
        let excess = terms.element_sum() - 1.0;
        let step = excess / (2.0 * (terms * inverse).element_sum());
        // The last bits do not matter. NaN ends the iteration.
        if excess.is_nan() || excess <= 1e-13 {
            break;
        }
        t += step;
    }
    (at * (squares + t).recip()).length() * t
}

/// The convex hull of two balls, a cone with rounded ends. It is a capsule if the radii are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundCone {
    /// The centers of the balls at the ends.
    pub ends: [DVec3; 2],
    /// The radii of the balls at the ends.
    pub radii: [f64; 2],
}

impl Solid for RoundCone {
    fn distance(&self, at: DVec3) -> f64 {
        Spindle::new(self).distance(at)
    }

    fn bounds(&self) -> [DVec3; 2] {
        let [[a, b], [first, last]] = [[self.ends[0], self.ends[1]], self.radii.map(DVec3::splat)];
        [(a - first).min(b - last), (a + first).max(b + last)]
    }
}

/// A round cone with precomputed values for its distance function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spindle {
    from: DVec3,
    /// Unit vector to the other end.
    axis: DVec3,
    length: f64,
    radius: f64,
    /// Decrease of the radius per unit length along the axis.
    taper: f64,
    /// Displacement along the axis per unit distance outward, along a normal of the lateral surface.
    lean: f64,
}

impl Spindle {
    pub(super) fn new(cone: &RoundCone) -> Self {
        let [from, to] = cone.ends;
        let [first, last] = cone.radii;
        let length = (to - from).length();
        let narrowing = first - last;
        // Neither ball contains the other.
        if narrowing.abs() < length {
            return Self {
                from,
                axis: (to - from) / length,
                length,
                radius: first,
                taper: narrowing / length,
                lean: narrowing / (length * length - narrowing * narrowing).sqrt(),
            };
        }
        // One ball contains the other.
        let bigger = if narrowing >= 0.0 { from } else { to };
        Self {
            from: bigger,
            axis: DVec3::Y,
            length: 0.0,
            radius: first.max(last),
            taper: 0.0,
            lean: 0.0,
        }
    }

    pub(super) fn distance(&self, at: DVec3) -> f64 {
        let reach = at - self.from;
        let height = reach.dot(self.axis);
        let aside = (reach - self.axis * height).length();
        // The point on the axis at which the lateral surface's normal through `at` starts.
        let foot = (height - aside * self.lean).clamp(0.0, self.length);
        let along = height - foot;
        (aside * aside + along * along).sqrt() - (self.radius - self.taper * foot)
    }
}

/// A torus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// The center of the torus.
    pub center: DVec3,
    /// Unit vector along the axis of rotation.
    pub axis: DVec3,
    /// Radius of the tube's center line.
    pub ring: f64,
    /// Radius of the tube.
    pub tube: f64,
}

impl Solid for Torus {
    fn distance(&self, at: DVec3) -> f64 {
        let at = at - self.center;
        let height = at.dot(self.axis);
        let aside = (at - self.axis * height).length() - self.ring;
        (aside * aside + height * height).sqrt() - self.tube
    }

    fn bounds(&self) -> [DVec3; 2] {
        // The circle extends less along directions closer to its axis.
        let flat = (DVec3::ONE - self.axis * self.axis).max(DVec3::ZERO);
        let reach = DVec3::new(flat.x.sqrt(), flat.y.sqrt(), flat.z.sqrt()) * self.ring + self.tube;
        [self.center - reach, self.center + reach]
    }
}

/// An axis-aligned box with rounded edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundBox {
    /// The center.
    pub center: DVec3,
    /// The distances from the center to the faces.
    pub half: DVec3,
    /// Radius of the rounded edges, at most the smallest component of `half`.
    pub rounding: f64,
}

impl Solid for RoundBox {
    fn distance(&self, at: DVec3) -> f64 {
        let core = self.half - self.rounding;
        box_distance([self.center - core, self.center + core], at) - self.rounding
    }

    fn bounds(&self) -> [DVec3; 2] {
        [self.center - self.half, self.center + self.half]
    }
}
