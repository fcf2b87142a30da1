//! Voronoi cell of the origin in a plane, computed by clipping with the bisectors of points, one point at a time.
//!
//! The points whose bisectors remain are the neighbors of the origin in the Delaunay triangulation of all points. A
//! corner of the cell is stored as the pair of neighbors that defines it, so rounding errors do not accumulate. A
//! bisector cuts off a corner if its point lies in the circle through the origin and the two neighbors. The test uses
//! the original points. A fast floating-point test comes first, and an exact predicate decides where rounding could
//! change the answer.
//!
//! Reference: Jonathan Richard Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates", Discrete & Computational Geometry 18, 1997, doi 10.1007/PL00009321, for the exact predicates.
//!
//! Where several points lie on one empty circle through the origin, any diagonal between them would complete the
//! triangulation. None is used, so that the cell does not depend on the order of the points. Lengths have the unit of
//! the points.

use core::cmp::Ordering;
use glam::DVec2;
use robust::{Coord, incircle, orient2d};

/// Relative error bound of a sum of two products of two coordinates: 2^-50, which is eight rounding units of 2^-53.
///
/// The bounds below are generous. The cross product of a and b is off by at most 2 units times `|a| |b|`, and 8 are
/// allowed. The fast incircle test of c, which is farther away than both, is off by at most 20 units times
/// `|a| |b| |c|²`, and 32 are allowed.
const ROUNDING: f64 = 8.881_784_197_001_252e-16;

/// Voronoi cell of the origin.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell {
    /// Neighbors, counterclockwise, each with the corner after it.
    sides: Vec<Side>,
    /// Index in `sides` of the neighbor inserted last.
    newest: usize,
    /// Squared diameter of the largest circle through the origin and two consecutive neighbors; infinite while the cell
    /// is open.
    diameter_sq: f64,
}

/// A side of the cell: a neighbor, and the corner between its bisector and the next one counterclockwise.
#[derive(Clone, Copy, Debug)]
struct Side {
    at: DVec2,
    length_sq: f64,
    tag: u32,
    corner: Corner,
}

/// Intersection of the bisectors of two neighbors a and b: the center of the circle through a, b and the origin.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Whether the next neighbor is at least half a turn away. The bisectors then do not meet on this side.
    is_open: bool,
    /// The vector `|b|² a - |a|² b`. Rotated by a quarter turn and divided by `2 turn`, it is the center of the circle.
    lean: DVec2,
    /// Cross product `a × b`.
    turn: f64,
    /// Error bound of the fast incircle test, divided by the squared length of the tested point.
    slack: f64,
    /// Upper bound of the circle's squared diameter; infinite for an open corner.
    diameter_sq: f64,
}

/// A neighbor of the origin, as returned by [`Cell::neighbors`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Neighbor {
    /// Tag that the caller passed with the point.
    pub(crate) tag: u32,
    /// Whether the origin, this neighbor and the next one counterclockwise form a triangle.
    pub(crate) joined: bool,
}

impl Cell {
    /// Resets the cell to the whole plane, without neighbors.
    pub(crate) fn clear(&mut self) {
        self.sides.clear();
        self.newest = 0;
        self.diameter_sq = f64::INFINITY;
    }

    /// Returns an upper bound of the squared diameter of the largest circle through the origin and two consecutive
    /// neighbors; infinite while the cell is open. A point farther away than this diameter does not change the cell.
    #[inline]
    pub(crate) fn diameter_sq(&self) -> f64 {
        self.diameter_sq
    }

    /// Clips the cell by the bisector of the point `at`, which must not be the origin.
    ///
    /// Points must be passed nearest first, with a tolerance of a millionth of their distance. The error bounds assume
    /// this order.
    #[inline]
    pub(crate) fn clip(&mut self, at: DVec2, tag: u32) {
        let length_sq = at.length_squared();
        let new = Side {
            at,
            length_sq,
            tag,
            corner: Corner::OPEN,
        };
        if self.sides.is_empty() {
            self.sides.push(new);
        } else if let Some(first) = self.first_cut(&new) {
            self.insert(first, new);
        }
    }

    /// Iterates counterclockwise over the neighbors that lie on an empty circle through the origin with a squared
    /// diameter of at most `limit_sq`.
    pub(crate) fn neighbors(&self, limit_sq: f64) -> impl Iterator<Item = Neighbor> + '_ {
        let all = self.diameter_sq <= limit_sq;
        let is_kept = move |index: usize| all || self.is_within(index, limit_sq);
        // Start with the neighbor before the one inserted last.
        let first = self
            .newest
            .wrapping_sub(1)
            .min(self.sides.len().saturating_sub(1));
        (first..self.sides.len())
            .chain(0..first)
            .filter(move |&index| is_kept(index))
            .map(move |index| {
                let side = &self.sides[index];
                let joined = !side.corner.is_open
                    && side.corner.diameter_sq <= limit_sq
                    && is_kept(self.after(index));
                Neighbor {
                    tag: side.tag,
                    joined,
                }
            })
    }

    /// Returns the index of the first corner that the bisector of `new` cuts off, if any.
    #[inline]
    fn first_cut(&self, new: &Side) -> Option<usize> {
        for (index, side) in self.sides.iter().enumerate() {
            let corner = &side.corner;
            let excess = corner.excess(new);
            // An open corner has an infinite slack and always takes the exact test.
            let slack = corner.slack * new.length_sq;
            if excess > slack || (excess >= -slack && self.cuts(index, new).is_gt()) {
                return Some(index);
            }
        }
        None
    }

    /// Returns whether the bisector of `new` cuts off the corner at `index` (greater), passes through it (equal), or
    /// misses it (less).
    fn cuts(&self, index: usize, new: &Side) -> Ordering {
        let a = &self.sides[index];
        let b = &self.sides[self.after(index)];
        // An open corner, at infinity, is cut off by any point in the angle between its two neighbors.
        if a.corner.is_open {
            let opposite =
                self.sides.len() == 1 && turns(a.at, new.at).is_eq() && a.at.dot(new.at) < 0.0;
            let between = turns(a.at, new.at).is_gt() || turns(new.at, b.at).is_gt() || opposite;
            return if between {
                Ordering::Greater
            } else {
                Ordering::Less
            };
        }
        // Fast incircle test.
        let excess = a.corner.excess(new);
        if excess.abs() > a.corner.slack * new.length_sq {
            return order(excess);
        }
        // Exact incircle test.
        order(incircle(
            coord(DVec2::ZERO),
            coord(a.at),
            coord(b.at),
            coord(new.at),
        ))
    }

    /// Inserts the neighbor `new`. It replaces the run of corners around `cut` that its bisector cuts off or passes
    /// through.
    fn insert(&mut self, cut: usize, new: Side) {
        let n = self.sides.len();
        // Extend the run of removed corners clockwise, then counterclockwise.
        let (mut first, mut last, mut count) = (cut, cut, 1);
        while count < n && self.hides(first, self.before(first), &new) {
            first = self.before(first);
            count += 1;
        }
        while count < n && self.hides(self.after(last), self.after(last), &new) {
            last = self.after(last);
            count += 1;
        }
        // Remove the neighbors between these corners.
        let at = self.replace(first, last, count - 1, new);
        let (before, after) = (self.before(at), self.after(at));
        // Compute the two new corners.
        self.sides[before].corner = Corner::new(&self.sides[before], &self.sides[at]);
        self.sides[at].corner = Corner::new(&self.sides[at], &self.sides[after]);
        self.newest = at;
        self.diameter_sq = 0.0;
        for side in &self.sides {
            if side.corner.diameter_sq > self.diameter_sq {
                self.diameter_sq = side.corner.diameter_sq;
            }
        }
    }

    /// Replaces the `count` neighbors after `first` up to `last` by `new`. Returns the index of `new`.
    #[inline]
    fn replace(&mut self, first: usize, last: usize, count: usize, new: Side) -> usize {
        if last < first {
            // The replaced neighbors wrap around the end of the list.
            self.sides.truncate(first + 1);
            self.sides.drain(..=last);
            self.sides.push(new);
            return self.sides.len() - 1;
        }
        let at = first + 1;
        if count == 0 {
            self.sides.insert(at, new);
        } else {
            self.sides[at] = new;
            if count > 1 {
                self.sides.drain(at + 1..=last);
            }
        }
        at
    }

    /// Returns whether the bisector of `new` removes the whole side of `neighbor`. The bisector is known to cut off or
    /// pass through one end of the side; `corner` is the other end.
    #[inline]
    fn hides(&self, neighbor: usize, corner: usize, new: &Side) -> bool {
        let other = &self.sides[corner].corner;
        if other.excess(new) < -other.slack * new.length_sq {
            return false;
        }
        let [before, after] = [self.before(neighbor), neighbor].map(|index| &self.sides[index]);
        // At an open corner the side is a ray, whose far end must be cut off.
        self.cuts(corner, new).is_ge()
            && (!before.corner.is_open || turns(new.at, after.at).is_gt())
            && (!after.corner.is_open || turns(after.at, new.at).is_gt())
    }

    /// Returns whether the neighbor at `index` is on an empty circle through the origin with a squared diameter of at
    /// most `limit_sq`.
    ///
    /// The centers of its empty circles form its side of the cell. The smallest circle is centered halfway between the
    /// neighbor and the origin if that point is on the side, and at the nearer corner otherwise.
    fn is_within(&self, index: usize, limit_sq: f64) -> bool {
        let side = &self.sides[index];
        let [before, after] = [&self.sides[self.before(index)].corner, &side.corner];
        // The center is `lean / (2 turn)`, rotated by a quarter turn.
        let is_left = after.is_open || after.lean.dot(side.at) >= 0.0;
        let is_right = before.is_open || before.lean.dot(side.at) <= 0.0;
        let at_corner = before.diameter_sq.min(after.diameter_sq);
        let least = if is_left && is_right {
            side.length_sq
        } else {
            at_corner
        };
        least <= limit_sq
    }

    /// Returns the index of the next side counterclockwise.
    #[inline]
    fn after(&self, index: usize) -> usize {
        if index + 1 == self.sides.len() {
            0
        } else {
            index + 1
        }
    }

    /// Returns the index of the next side clockwise.
    #[inline]
    fn before(&self, index: usize) -> usize {
        if index == 0 {
            self.sides.len() - 1
        } else {
            index - 1
        }
    }
}

impl Corner {
    /// A corner at infinity. Its slack is infinite, so every test takes the exact branch.
    const OPEN: Self = Self {
        is_open: true,
        lean: DVec2::ZERO,
        turn: 0.0,
        slack: f64::INFINITY,
        diameter_sq: f64::INFINITY,
    };

    /// Runs the fast incircle test: positive, up to rounding, if `new` is in the circle through the two neighbors and
    /// the origin; zero for an open corner.
    #[inline]
    fn excess(&self, new: &Side) -> f64 {
        self.lean.perp_dot(new.at) - new.length_sq * self.turn
    }

    /// Returns the corner between a neighbor `a` and the next one `b`, counterclockwise.
    #[inline]
    fn new(a: &Side, b: &Side) -> Self {
        if turns(a.at, b.at).is_le() {
            return Self::OPEN;
        }
        let turn = a.at.perp_dot(b.at);
        let product = (a.length_sq * b.length_sq).sqrt();
        // Divide by a lower bound of the cross product, so that the diameter is an upper bound.
        let least = turn - ROUNDING * product;
        let diameter_sq = if least > 0.0 {
            a.length_sq * b.length_sq * a.at.distance_squared(b.at) / (least * least)
        } else {
            f64::INFINITY
        };
        Self {
            is_open: false,
            lean: a.at * b.length_sq - b.at * a.length_sq,
            turn,
            slack: 4.0 * ROUNDING * product,
            diameter_sq,
        }
    }
}

/// Returns the exact sign of the cross product of a and b: greater if b is less than half a turn counterclockwise from
/// a, less if it is more than half a turn.
#[inline]
fn turns(a: DVec2, b: DVec2) -> Ordering {
    let (left, right) = (a.x * b.y, a.y * b.x);
    let turn = left - right;
    if turn.abs() > ROUNDING * (left.abs() + right.abs()) {
        return order(turn);
    }
    order(orient2d(coord(DVec2::ZERO), coord(a), coord(b)))
}

/// Returns the sign of `value` as an ordering; NaN counts as less.
#[inline]
fn order(value: f64) -> Ordering {
    value.partial_cmp(&0.0).unwrap_or(Ordering::Less)
}

fn coord(at: DVec2) -> Coord<f64> {
    Coord { x: at.x, y: at.y }
}

#[cfg(test)]
mod tests;
