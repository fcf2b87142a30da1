//! Represents positions as integers, so that differences and images are exact.
//!
//! The unit is one step, whose length is a power of two in the caller's units.

use crate::GraphError;
use dapple_points::{Domain, PointIdx, PointSet};
use glam::DVec2;

/// The lattice of a domain, whose larger side has between 2^49 and 2^50 steps.
///
/// A site is a position in steps relative to the origin of the domain: an integer in an `f64`. Images up to three
/// times the larger side away are below 2^52, so that sites, their images and their differences are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    origin: DVec2,
    /// Length of a step, in the caller's units.
    step: f64,
    per_step: f64,
    /// Width and height in steps.
    pub(crate) size: DVec2,
    /// Whether x and y wrap.
    pub(crate) wrap: [bool; 2],
}

impl Lattice {
    pub(crate) fn new(domain: &Domain) -> Self {
        let step = step_of(domain.size.max_element());
        Self {
            origin: domain.origin,
            step,
            per_step: 1.0 / step,
            // A side that is tiny relative to the other one must still have a length.
            size: round(domain.size / step).max(DVec2::ONE),
            wrap: domain.wrap,
        }
    }

    /// Creates the lattice from its serialized parts; `None` if no domain has such a lattice.
    #[cfg(feature = "serde")]
    pub(crate) fn from_parts(
        origin: DVec2,
        step: f64,
        size: [i64; 2],
        wrap: [bool; 2],
    ) -> Option<Self> {
        let is_power_of_two = step.is_normal() && step > 0.0 && step.to_bits() << 12 == 0;
        let [shorter, longer] = [size[0].min(size[1]), size[0].max(size[1])];
        // Steps are only longer than usual for tiny domains.
        let is_long = longer >= 1 << 49 || step == f64::MIN_POSITIVE;
        if !(is_power_of_two && shorter >= 1 && is_long && longer <= 1 << 50) {
            return None;
        }
        let lattice = Self {
            origin,
            step,
            per_step: 1.0 / step,
            size: size.map(|side| side as f64).into(),
            wrap,
        };
        let size = lattice.vector(lattice.size);
        let is_domain = Domain { origin, size, wrap }.checked().is_ok();
        is_domain.then_some(lattice)
    }

    /// Returns the domain's origin and the length of a step, both in the caller's units.
    #[cfg(feature = "serde")]
    pub(crate) fn origin_and_step(&self) -> (DVec2, f64) {
        (self.origin, self.step)
    }

    /// Returns the sites of all points, in order.
    pub(crate) fn sites(&self, points: &PointSet) -> Vec<DVec2> {
        points.positions().iter().map(|&p| self.site(p)).collect()
    }

    /// Converts a position to its site in steps, wrapped into the domain along the wrapped axes.
    pub(crate) fn site(&self, position: DVec2) -> DVec2 {
        self.snapped((position - self.origin) * self.per_step)
    }

    /// Returns the lattice position nearest to any position, in steps, wrapped into the domain along the wrapped
    /// axes. `None` if the position is not finite or outside along an axis that does not wrap.
    pub(crate) fn place(&self, position: DVec2) -> Option<DVec2> {
        let mut offset = position - self.origin;
        let size = self.vector(self.size);
        for axis in 0..2 {
            let size = size[axis];
            if self.wrap[axis] && !(offset[axis] >= 0.0 && offset[axis] < size) {
                offset[axis] -= (offset[axis] / size).floor() * size;
                // Far from the domain, rounding may leave the result outside.
                offset[axis] = offset[axis].clamp(0.0, size);
            }
        }
        let steps = offset * self.per_step;
        // A position up to half a step beyond the end snaps to the end.
        let is_inside = steps.cmpge(DVec2::ZERO) & steps.cmplt(self.size + 0.5);
        if !is_inside.all() {
            return None;
        }
        Some(self.snapped(steps))
    }

    /// Rounds a position to whole steps; the end of a wrapped axis is its start.
    fn snapped(&self, steps: DVec2) -> DVec2 {
        let mut site = round(steps);
        for axis in 0..2 {
            if self.wrap[axis] && site[axis] >= self.size[axis] {
                site[axis] -= self.size[axis];
            }
        }
        site
    }

    /// Converts a site to a position in the caller's units.
    pub(crate) fn position(&self, site: DVec2) -> DVec2 {
        self.origin + self.vector(site)
    }

    /// Converts a difference of sites to the caller's units; exact.
    #[inline]
    pub(crate) fn vector(&self, steps: DVec2) -> DVec2 {
        steps * self.step
    }

    /// Converts a vector in the caller's units to steps.
    #[inline]
    pub(crate) fn steps(&self, vector: DVec2) -> DVec2 {
        vector * self.per_step
    }

    /// Returns the shortest vector from one site to an image of the other. On a tie, returns the vector that does not
    /// wrap.
    pub(crate) fn delta(&self, from: DVec2, to: DVec2) -> DVec2 {
        let mut delta = to - from;
        for axis in 0..2 {
            if self.wrap[axis] && delta[axis].abs() * 2.0 > self.size[axis] {
                delta[axis] -= self.size[axis].copysign(delta[axis]);
            }
        }
        delta
    }

    /// Returns the numbers of the first and last image of the domain that an interval along an axis touches.
    pub(crate) fn images(&self, axis: usize, low: f64, high: f64) -> (f64, f64) {
        if self.wrap[axis] {
            let size = self.size[axis];
            ((low / size).floor(), (high / size).floor())
        } else {
            (0.0, 0.0)
        }
    }

    /// Returns whether either axis wraps.
    pub(crate) fn wraps(&self) -> bool {
        self.wrap[0] || self.wrap[1]
    }
}

/// Fails if two points share a site; the error names the first such pair.
pub(crate) fn check_distinct(sites: &[DVec2]) -> Result<(), GraphError> {
    let key = |&index: &u32| {
        let site = sites[index as usize];
        (site.x as i64, site.y as i64, index)
    };
    let mut order: Vec<u32> = (0..sites.len() as u32).collect();
    order.sort_unstable_by_key(key);
    let coincident = order
        .windows(2)
        .filter(|pair| sites[pair[0] as usize] == sites[pair[1] as usize])
        .map(|pair| (PointIdx(pair[0]), PointIdx(pair[1])))
        .min();
    coincident.map_or(Ok(()), |(a, b)| Err(GraphError::coincident(a, b)))
}

/// Returns the power of two that fits into `side` between 2^49 and 2^50 times, but at least the smallest positive
/// normal number.
fn step_of(side: f64) -> f64 {
    let exponent_only = f64::from_bits(side.to_bits() & f64::INFINITY.to_bits());
    (exponent_only / (1_u64 << 49) as f64).max(f64::MIN_POSITIVE)
}

/// Rounds to the nearest integer, for numbers from 0 to 2^51.
fn round(v: DVec2) -> DVec2 {
    // Avoid `floor`, which is slow on processors without an instruction for it.
    DVec2::new((v.x + 0.5) as i64 as f64, (v.y + 0.5) as i64 as f64)
}
