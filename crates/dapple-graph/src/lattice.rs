//! Positions as whole numbers, so that differences and images are exact.

use dapple_points::{Domain, PointSet};
use glam::DVec2;

/// The lattice of a domain: its larger side has between 2^49 and 2^50 steps.
///
/// A site is a position in steps from the domain's origin: a whole number in an `f64`. Images up to three larger
/// sides away are below 2^52, so that sites, their images and their differences are all exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    origin: DVec2,
    /// One step in the caller's unit, a power of two.
    step: f64,
    /// Width and height in steps.
    pub(crate) size: DVec2,
    /// Whether x and y wrap around.
    pub(crate) wrap: [bool; 2],
}

impl Lattice {
    pub(crate) fn new(domain: &Domain) -> Self {
        let step = power_of_two_below(domain.size.max_element());
        Self {
            origin: domain.origin,
            step,
            // A side that is tiny beside the other one still has a length.
            size: (domain.size / step + 0.5).floor().max(DVec2::ONE),
            wrap: domain.wrap,
        }
    }

    /// The sites of all points, in the order of the points.
    pub(crate) fn sites(&self, points: &PointSet) -> Vec<DVec2> {
        points.positions().iter().map(|&p| self.site(p)).collect()
    }

    fn site(&self, position: DVec2) -> DVec2 {
        let mut site = ((position - self.origin) / self.step + 0.5).floor();
        for axis in 0..2 {
            if self.wrap[axis] && site[axis] >= self.size[axis] {
                site[axis] -= self.size[axis];
            }
        }
        site
    }

    /// A difference of sites, in the caller's unit; exact.
    #[inline]
    pub(crate) fn vector(&self, steps: DVec2) -> DVec2 {
        steps * self.step
    }

    /// The shortest way from one site to an image of the other; of two equally long ones the one without wrapping.
    pub(crate) fn delta(&self, from: DVec2, to: DVec2) -> DVec2 {
        let mut delta = to - from;
        for axis in 0..2 {
            if self.wrap[axis] && delta[axis].abs() * 2.0 > self.size[axis] {
                delta[axis] -= self.size[axis].copysign(delta[axis]);
            }
        }
        delta
    }
}

/// The power of two that goes into `side` between 2^49 and 2^50 times.
fn power_of_two_below(side: f64) -> f64 {
    let power = f64::from_bits(side.to_bits() & f64::INFINITY.to_bits());
    (power / (1_u64 << 49) as f64).max(f64::MIN_POSITIVE)
}
