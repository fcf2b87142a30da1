//! Measures distances between points, and packing densities.

use super::grid::{Grid, Images};
use crate::PointSet;
use core::f64::consts::PI;

impl PointSet {
    /// Returns the minimum distance between two points; `None` for fewer than two points.
    ///
    /// Distances from a point to its own copies across wrapped axes do not count. Coinciding points have a distance
    /// of 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_points::{Domain, PointSet, glam::DVec2};
    ///
    /// let points = vec![DVec2::new(-0.75, 0.0), DVec2::new(0.75, 0.0)];
    /// let set = PointSet::new(Domain::paper_torus(), points)?;
    /// assert_eq!(set.minimum_distance(), Some(0.5));
    /// # Ok::<(), dapple_points::PointsError>(())
    /// ```
    #[must_use]
    pub fn minimum_distance(&self) -> Option<f64> {
        if self.len() < 2 {
            return None;
        }
        let grid = Grid::new(self);
        let mut best_sq = f64::INFINITY;
        for (point, position) in self.iter() {
            let center = grid.cell(position);
            for ring in 0..=grid.last_ring(f64::INFINITY) {
                let reach = grid.distance_to_ring(ring);
                if reach > 0.0 && reach * reach > best_sq {
                    break;
                }
                grid.visit_ring(center, ring, Images::Nearest, |other, _| {
                    if other != point.index() {
                        let delta = self.domain().delta(position, self.positions()[other]);
                        best_sq = best_sq.min(delta.length_squared());
                    }
                });
            }
        }
        Some(best_sq.sqrt())
    }

    /// Returns the mean number of other points within `distance` of a point; 0 for an empty set.
    ///
    /// Points at exactly `distance` are included. Each other point counts once, by its shortest distance, even if
    /// `distance` exceeds the period. Near sides that do not wrap, points have fewer neighbors.
    #[must_use]
    pub fn mean_neighbor_count(&self, distance: f64) -> f64 {
        let grid = Grid::new(self);
        let mut n_pairs = 0_u64;
        for (point, position) in self.iter() {
            let center = grid.cell(position);
            for ring in 0..=grid.last_ring(distance) {
                grid.visit_ring(center, ring, Images::Nearest, |other, _| {
                    let delta = self.domain().delta(position, self.positions()[other]);
                    let is_within = delta.length_squared() <= distance * distance;
                    n_pairs += u64::from(is_within && distance >= 0.0 && other != point.index());
                });
            }
        }
        n_pairs as f64 / self.len().max(1) as f64
    }

    /// Returns the normalized density N r² / area, that is, the number of points per square of side `radius`.
    ///
    /// Random sequential addition with the minimum distance `radius` reaches 0.697; the densest lattice reaches
    /// 1.155.
    #[must_use]
    pub fn normalized_density(&self, radius: f64) -> f64 {
        self.len() as f64 * (radius * radius) / self.domain().area()
    }

    /// Returns the fraction of the domain covered by discs of diameter `radius` around the points, which do not
    /// overlap if points are at least `radius` apart: 0.547 for random sequential addition, at most 0.907.
    #[must_use]
    pub fn packing_fraction(&self, radius: f64) -> f64 {
        self.normalized_density(radius) * (PI / 4.0)
    }

    /// Returns the mean number of discs of radius `radius` that cover a position: N π r² / area.
    ///
    /// Discs that extend beyond a side that does not wrap count in full.
    #[must_use]
    pub fn mean_coverage(&self, radius: f64) -> f64 {
        self.normalized_density(radius) * PI
    }
}

#[cfg(test)]
mod tests;
