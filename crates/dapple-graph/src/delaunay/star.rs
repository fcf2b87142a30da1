//! Reads the edges around a triangulation vertex, and selects those that are axes.
//!
//! Positions are integers: lattice steps relative to the vertex.

use super::patch::Vertex;
use crate::Axis;
use crate::angle::{by_angle, is_lower};
use crate::lattice::Lattice;
use dapple_points::PointIdx;
use glam::DVec2;
use robust::{Coord, incircle};

/// A neighbor of a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spoke {
    /// Position of the neighbor relative to the vertex, in steps.
    pub(super) at: DVec2,
    /// Index of the neighbor's point.
    to: u32,
    /// Whether there is no triangle between this neighbor and the next one.
    pub(super) gap_after: bool,
}

/// Neighbors of a vertex, counterclockwise.
#[derive(Debug, Default)]
pub(super) struct Star {
    spokes: Vec<Spoke>,
    has_gaps: bool,
    /// Mask of the neighbors with an angle in `[π, 2π)`.
    lower: u64,
    /// Whether two adjacent circumcircles may be equal.
    co_circular: bool,
    /// Whether a circumcircle may exceed the reach passed to [`read`](Self::read).
    far: bool,
}

impl Star {
    /// Reads the star of a vertex, with a quick test for equal circumcircles and for circumcircles beyond `reach`
    /// steps.
    #[inline]
    pub(super) fn read(&mut self, vertex: Vertex<'_>, reach: f64) {
        self.spokes.clear();
        self.has_gaps = false;
        self.lower = 0;
        let mut look = Look::new(reach);
        let center = vertex.position();
        for edge in vertex.out_edges() {
            let to = edge.to();
            let position = to.position();
            let spoke = Spoke {
                at: DVec2::new(position.x - center.x, position.y - center.y),
                to: to.data().point,
                gap_after: edge.is_outer_edge(),
            };
            self.has_gaps |= spoke.gap_after;
            // The mask is not used for more than 64 neighbors.
            self.lower |= u64::from(is_lower(spoke.at)).wrapping_shl(self.spokes.len() as u32);
            look.pass(spoke.at);
            self.spokes.push(spoke);
        }
        for spoke in self.spokes.iter().take(2) {
            look.pass(spoke.at);
        }
        (self.co_circular, self.far) = (look.co_circular, look.far);
    }

    /// Returns whether a triangle may exceed the reach, or is missing.
    pub(super) fn is_doubtful(&self) -> bool {
        self.far || self.has_gaps || self.spokes.len() < 3
    }

    /// Iterates over all pairs of a neighbor and the next one.
    pub(super) fn wedges(&self) -> impl Iterator<Item = (Spoke, Spoke)> + '_ {
        let next = self.spokes.iter().cycle().skip(1);
        self.spokes.iter().copied().zip(next.copied())
    }

    /// Appends the axes of the star, in order.
    #[inline]
    pub(super) fn push_axes(&self, lattice: &Lattice, axes: &mut Vec<Axis>) {
        let first = self.first();
        let axis = |spoke: &Spoke| Axis {
            to: PointIdx(spoke.to),
            vector: lattice.vector(spoke.at),
        };
        if self.co_circular {
            let kept = |&index: &usize| !self.is_diagonal(index);
            let indices = (first..self.spokes.len()).chain(0..first).filter(kept);
            axes.extend(indices.map(|index| axis(&self.spokes[index])));
        } else {
            axes.extend(self.spokes[first..].iter().map(axis));
            axes.extend(self.spokes[..first].iter().map(axis));
        }
    }

    /// Returns the index of the neighbor with the smallest angle.
    #[inline]
    fn first(&self) -> usize {
        let n = self.spokes.len();
        if n > 0 && n <= 64 {
            // Find an upper neighbor that follows a lower one.
            let previous = self.lower << 1 | self.lower >> (n - 1);
            let first = (previous & !self.lower).trailing_zeros() as usize;
            if first < n {
                return first;
            }
        }
        // All neighbors are on one side, or there are more than 64.
        let order = |&a: &usize, &b: &usize| by_angle(self.spokes[a].at, self.spokes[b].at);
        (0..n).min_by(order).unwrap_or(0)
    }

    /// Returns whether the triangles on both sides of an edge have the same circumcircle, which makes the edge one of
    /// several possible diagonals.
    #[cold]
    fn is_diagonal(&self, index: usize) -> bool {
        let n = self.spokes.len();
        let (before, after) = ((index + n - 1) % n, (index + 1) % n);
        let [a, b, c] = [before, index, after].map(|index| self.spokes[index]);
        if a.gap_after || b.gap_after {
            return false;
        }
        let coord = |at: DVec2| Coord { x: at.x, y: at.y };
        incircle(coord(a.at), coord(b.at), coord(c.at), coord(DVec2::ZERO)) == 0.0
    }
}

/// A quick test of the neighbors while they are read. It may give false positives, but no false negatives.
struct Look {
    reach_sq: f64,
    /// The last two neighbors, their squared lengths and their cross product; initially NaN.
    a: DVec2,
    b: DVec2,
    a_sq: f64,
    b_sq: f64,
    ab: f64,
    co_circular: bool,
    far: bool,
}

impl Look {
    fn new(reach: f64) -> Self {
        let reach = reach.max(0.0);
        Self {
            // Rounding changes the products by less than a millionth.
            reach_sq: reach * reach * 0.999_999,
            a: DVec2::NAN,
            b: DVec2::NAN,
            a_sq: f64::NAN,
            b_sq: f64::NAN,
            ab: f64::NAN,
            co_circular: false,
            far: false,
        }
    }

    /// Processes the next neighbor. Comparisons with values that are still NaN are false.
    #[inline]
    fn pass(&mut self, c: DVec2) {
        let Self {
            a,
            b,
            a_sq,
            b_sq,
            ab,
            ..
        } = *self;
        let c_sq = c.length_squared();
        let bc = b.perp_dot(c);
        let determinant = a_sq * bc - b_sq * a.perp_dot(c) + c_sq * ab;
        // Shewchuk's bound is 10 · 2^-53 times the permanent, which is at most this sum of products.
        let bound = 1.2e-15 * (a_sq * b_sq + (a_sq + b_sq) * c_sq);
        self.co_circular |= determinant.abs() < bound;
        // The diameter of the circumcircle is the product of the sides over the cross product.
        self.far |= b_sq * c_sq * (c - b).length_squared() > self.reach_sq * (bc * bc);
        (self.a, self.b, self.a_sq, self.b_sq, self.ab) = (b, c, b_sq, c_sq, bc);
    }
}
