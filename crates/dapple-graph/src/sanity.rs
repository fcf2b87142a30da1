//! Checks a graph's invariants.

use crate::{Axis, Graph, GraphError, GraphErrorKind};
use core::cmp::Ordering;
use dapple_points::PointIdx;
use glam::DVec2;

impl Graph {
    /// Checks all invariants of the graph. Useful in tests, and for graphs that passed through other code.
    ///
    /// Every axis leads to a point of the graph, with a nonzero vector that leads exactly to an image of that point.
    /// The axes of each point are in order, without duplicates. If the graph [is symmetric](Self::is_symmetric), every
    /// axis has an opposite.
    ///
    /// # Errors
    ///
    /// If an invariant is violated, an error for the first violation: [`GraphErrorKind::NoSuchPoint`],
    /// [`GraphErrorKind::Vector`], [`GraphErrorKind::Order`] or [`GraphErrorKind::OneWay`].
    pub fn sanity_check(&self) -> Result<(), GraphError> {
        let n_points = self.n_points();
        for point in self.points() {
            let in_order = |pair: &[Axis]| pair[0].order(&pair[1]) == Ordering::Less;
            if !self.axes(point).windows(2).all(in_order) {
                return Err(GraphError::new(GraphErrorKind::Order { point }));
            }
        }
        for from in self.points() {
            for axis in self.axes(from) {
                let &Axis { to, vector } = axis;
                let kind = if to.index() >= n_points {
                    GraphErrorKind::NoSuchPoint { from, to, n_points }
                } else if !self.leads_to_an_image(from, axis) {
                    GraphErrorKind::Vector { from, to, vector }
                } else if self.is_symmetric() && !self.has_opposite(from, axis) {
                    GraphErrorKind::OneWay { from, to }
                } else {
                    continue;
                };
                return Err(GraphError::new(kind));
            }
        }
        Ok(())
    }

    fn points(&self) -> impl Iterator<Item = PointIdx> {
        (0..self.n_points() as u32).map(PointIdx)
    }

    /// Returns whether the vector differs by whole periods from the difference of the positions of the two points.
    fn leads_to_an_image(&self, from: PointIdx, axis: &Axis) -> bool {
        let steps = self.lattice.steps(axis.vector);
        let direct = self.sites[axis.to.index()] - self.sites[from.index()];
        let around = (steps - direct) / self.lattice.size;
        let is_whole = |k: f64, wraps: bool| k == 0.0 || (wraps && k.floor() == k);
        let whole =
            is_whole(around.x, self.lattice.wrap[0]) && is_whole(around.y, self.lattice.wrap[1]);
        // Compare the vector itself: the square of a tiny vector may be rounded to zero.
        whole && axis.vector.is_finite() && axis.vector != DVec2::ZERO
    }

    /// Returns whether the axis has an opposite, provided that the axes of its other end are in order.
    fn has_opposite(&self, from: PointIdx, axis: &Axis) -> bool {
        let opposite = Axis {
            to: from,
            vector: -axis.vector,
        };
        let row = self.axes(axis.to);
        let at = row.binary_search_by(|other| other.order(&opposite));
        at.is_ok_and(|at| row[at] == opposite)
    }

    pub(crate) fn every_axis_has_its_opposite(&self) -> bool {
        let both_ways = |from| {
            self.axes(from)
                .iter()
                .all(|axis| self.has_opposite(from, axis))
        };
        self.points().all(both_ways)
    }
}
