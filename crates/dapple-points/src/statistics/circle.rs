//! Finds the largest empty circle of a point set.
//!
//! The position farthest from all points is a corner of a Voronoi cell, clipped at the sides of the domain. Each cell
//! is clipped by the bisectors to surrounding points, starting with the nearest ring of the grid, until no farther
//! point can affect it. Corners are relative to the point of the cell, so that a distant origin costs no precision.
//!
//! Reference: our own.

use super::grid::{Grid, Images};
use crate::PointSet;
use glam::DVec2;

/// A circle with no point inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmptyCircle {
    /// Center of the circle, inside the domain.
    pub center: DVec2,
    /// Distance from the center to the nearest points.
    pub radius: f64,
}

impl PointSet {
    /// Returns the largest empty circle whose center is in the domain; `None` for an empty set.
    ///
    /// Its radius is the maximum distance of any position in the domain to the nearest point. Along wrapped axes,
    /// every copy of every point counts, including copies of a single point. Along other axes, the circle may extend
    /// beyond the domain, but its center may not.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_points::{Domain, PointSet, glam::DVec2};
    ///
    /// let set = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::new(8.0, 6.0)), vec![DVec2::ONE])?;
    /// let circle = set.largest_empty_circle().expect("there is a point");
    /// assert_eq!(circle.radius, 5.0);
    /// # Ok::<(), dapple_points::PointsError>(())
    /// ```
    #[must_use]
    pub fn largest_empty_circle(&self) -> Option<EmptyCircle> {
        let grid = Grid::new(self);
        let mut cell = VoronoiCell::default();
        let (mut best, mut best_sq) = (None, -1.0);
        for (_, position) in self.iter() {
            cell.cut_out(self, &grid, position);
            for &corner in &cell.corners {
                if corner.length_squared() > best_sq {
                    best_sq = corner.length_squared();
                    best = Some(position + corner);
                }
            }
        }
        let domain = self.domain();
        best.map(|center| EmptyCircle {
            // Rounding may move a corner on the border slightly outside.
            center: domain.wrap(center).clamp(domain.origin, domain.end()),
            radius: best_sq.sqrt(),
        })
    }
}

/// A convex polygon around a point, with corners relative to the point.
#[derive(Debug, Default)]
struct VoronoiCell {
    corners: Vec<DVec2>,
    scratch: Vec<DVec2>,
    /// Maximum squared distance of a corner.
    reach_sq: f64,
}

impl VoronoiCell {
    /// Computes the Voronoi cell of the point at `position`.
    fn cut_out(&mut self, set: &PointSet, grid: &Grid, position: DVec2) {
        self.start(set, position);
        let center = grid.cell(position);
        for ring in 0..=grid.outermost_ring() {
            let distance = grid.distance_to_ring(ring);
            if distance > 0.0 && distance * distance > 4.0 * self.reach_sq {
                return;
            }
            grid.visit_ring(center, ring, Images::All, |other, shift| {
                self.clip(set.positions()[other] - position + shift);
            });
        }
    }

    /// Initializes the cell with the part of the domain nearer to the point than to its own copies.
    fn start(&mut self, set: &PointSet, position: DVec2) {
        let domain = set.domain();
        let half = domain.size * 0.5;
        let low = DVec2::from_array([0, 1].map(|axis| match domain.wrap[axis] {
            true => -half[axis],
            false => domain.origin[axis] - position[axis],
        }));
        let high = DVec2::from_array([0, 1].map(|axis| match domain.wrap[axis] {
            true => half[axis],
            false => domain.end()[axis] - position[axis],
        }));
        self.corners.clear();
        self.corners.extend([
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ]);
        self.measure();
    }

    /// Clips the cell to the half-plane nearer to its point than to another point, at `other` relative to it.
    fn clip(&mut self, other: DVec2) {
        let other_sq = other.length_squared();
        // A coinciding point clips nothing; a point that is too far away does not reach the cell.
        if other_sq == 0.0 || other_sq > 4.0 * self.reach_sq {
            return;
        }
        let excess = |corner: DVec2| corner.dot(other) - 0.5 * other_sq;
        self.scratch.clear();
        let Some(&last) = self.corners.last() else {
            return;
        };
        // Walk along the polygon, and insert a corner where it crosses the bisector.
        let (mut from, mut from_excess) = (last, excess(last));
        for &to in &self.corners {
            let to_excess = excess(to);
            if (from_excess > 0.0) != (to_excess > 0.0) {
                let share = from_excess / (from_excess - to_excess);
                self.scratch.push(from + (to - from) * share);
            }
            if to_excess <= 0.0 {
                self.scratch.push(to);
            }
            (from, from_excess) = (to, to_excess);
        }
        core::mem::swap(&mut self.corners, &mut self.scratch);
        self.measure();
    }

    fn measure(&mut self) {
        self.reach_sq = self
            .corners
            .iter()
            .map(|corner| corner.length_squared())
            .fold(0.0, f64::max);
    }
}

#[cfg(test)]
mod tests;
