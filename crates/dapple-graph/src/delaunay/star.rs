//! The edges around one vertex of a triangulation, and which of them are axes.
//!
//! Unit: steps of the lattice, relative to the vertex; whole numbers.

use super::patch::Vertex;
use crate::Axis;
use crate::angle::{by_angle, is_lower};
use crate::lattice::Lattice;
use dapple_points::PointIdx;
use glam::DVec2;
use robust::{Coord, incircle};

/// The neighbors of a vertex, counterclockwise. The first two come again at the end, so that each one has a next one.
#[derive(Debug, Default)]
pub(super) struct Star {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Squared distances.
    lift: Vec<f64>,
    /// The numbers of the points.
    to: Vec<u32>,
    /// Whether no triangle lies between a neighbor and the next one.
    gap_after: Vec<bool>,
    n_gaps: usize,
}

/// What a quick look at a star finds; both may be said of a star that is fine, but are never left out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Findings {
    /// Two neighboring circumcircles may be equal.
    pub(super) co_circular: bool,
    /// A circumcircle may reach beyond the given distance.
    pub(super) far: bool,
}

impl Star {
    /// Reads the star of a vertex.
    pub(super) fn read(&mut self, vertex: Vertex<'_>) {
        self.clear();
        let center = vertex.position();
        for edge in vertex.out_edges() {
            let to = edge.to();
            let position = to.position();
            let (x, y) = (position.x - center.x, position.y - center.y);
            self.x.push(x);
            self.y.push(y);
            self.lift.push(x * x + y * y);
            self.to.push(to.data().point);
            let gap = edge.is_outer_edge();
            self.gap_after.push(gap);
            self.n_gaps += usize::from(gap);
        }
        let n = self.len();
        for index in 0..n.min(2) {
            self.x.push(self.x[index]);
            self.y.push(self.y[index]);
            self.lift.push(self.lift[index]);
        }
    }

    fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.lift.clear();
        self.to.clear();
        self.gap_after.clear();
        self.n_gaps = 0;
    }

    /// The number of neighbors.
    pub(super) fn len(&self) -> usize {
        self.to.len()
    }

    /// Whether triangles lie all around.
    pub(super) fn is_closed(&self) -> bool {
        self.n_gaps == 0 && self.len() >= 3
    }

    /// Looks for pairs of equal circumcircles, and for circumcircles that reach farther than `reach` steps.
    pub(super) fn look(&self, reach: f64) -> Findings {
        let n = self.len();
        if self.x.len() < n + 2 {
            return Findings {
                co_circular: true,
                far: true,
            };
        }
        // Rounding takes less than a millionth of the products.
        let reach_sq = reach.max(0.0) * reach.max(0.0) * 0.999_999;
        let (x, y, lift) = (&self.x[..n + 2], &self.y[..n + 2], &self.lift[..n + 2]);
        let (mut co_circular, mut far) = (false, false);
        for i in 0..n {
            let (ax, ay, al) = (x[i], y[i], lift[i]);
            let (bx, by, bl) = (x[i + 1], y[i + 1], lift[i + 1]);
            let (cx, cy, cl) = (x[i + 2], y[i + 2], lift[i + 2]);
            let ab = ax * by - ay * bx;
            let bc = bx * cy - by * cx;
            let ac = ax * cy - ay * cx;
            let determinant = al * bc - bl * ac + cl * ab;
            // Shewchuk's bound, 10 · 2^-53 times the permanent, which in turn is at most this sum of products.
            let bound = 1.2e-15 * (al * bl + bl * cl + al * cl);
            co_circular |= determinant.abs() <= bound;
            // The diameter is the product of the sides over the cross product.
            let (dx, dy) = (bx - ax, by - ay);
            let within = al * bl * (dx * dx + dy * dy) <= reach_sq * (ab * ab);
            far |= !within;
        }
        Findings { co_circular, far }
    }

    /// Appends the axes of the star in their order.
    pub(super) fn push_axes(&self, lattice: &Lattice, co_circular: bool, axes: &mut Vec<Axis>) {
        let n = self.len();
        let first = self.first();
        for index in (first..n).chain(0..first) {
            if co_circular && self.is_diagonal(index) {
                continue;
            }
            axes.push(Axis {
                to: PointIdx(self.to[index]),
                vector: lattice.vector(self.at(index)),
            });
        }
    }

    /// The neighbor with the smallest angle.
    fn first(&self) -> usize {
        let n = self.len();
        let mut previous = n.checked_sub(1).is_some_and(|last| is_lower(self.at(last)));
        for index in 0..n {
            let lower = is_lower(self.at(index));
            if previous && !lower {
                return index;
            }
            previous = lower;
        }
        // All lie on one side.
        let smallest = (0..n).min_by(|&a, &b| by_angle(self.at(a), self.at(b)));
        smallest.unwrap_or(0)
    }

    /// Whether the triangles on both sides of an edge have the same circumcircle, so that the edge is one of several
    /// diagonals that could be.
    fn is_diagonal(&self, index: usize) -> bool {
        let n = self.len();
        let (before, after) = ((index + n - 1) % n, (index + 1) % n);
        if self.gap_after[before] || self.gap_after[index] {
            return false;
        }
        let coord = |at: DVec2| Coord { x: at.x, y: at.y };
        let [a, b, c] = [before, index, after].map(|index| coord(self.at(index)));
        incircle(a, b, c, Coord { x: 0.0, y: 0.0 }) == 0.0
    }

    /// Where a neighbor lies.
    pub(super) fn at(&self, index: usize) -> DVec2 {
        DVec2::new(self.x[index], self.y[index])
    }

    /// The neighbors on both sides of the triangle or gap after each edge, and whether it is a gap.
    pub(super) fn wedges(&self) -> impl Iterator<Item = (DVec2, DVec2, bool)> + '_ {
        let n = self.len();
        (0..n).map(move |i| (self.at(i), self.at((i + 1) % n), self.gap_after[i]))
    }
}
