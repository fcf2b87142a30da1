//! The Voronoi cell of the origin of a plane, found by clipping it with the bisectors of points, one by one.
//!
//! The points whose bisectors remain are the neighbors of the origin in the Delaunay triangulation of them all. Only
//! its corners are kept, as the pairs of neighbors that make them, so nothing adds up: a bisector cuts off a corner if
//! its point lies in the circle through the origin and the two, and that is decided for the points as they were given.
//! Where the rounding of the quick answer could matter, the exact one is taken.
//!
//! Reference: Jonathan Richard Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates", Discrete & Computational Geometry 18, 1997, doi 10.1007/PL00009321, for the exact answers.
//!
//! Where several points lie on an empty circle through the origin, any diagonal between them would do; none is taken,
//! so the cell does not depend on the order of the points. Units: those of the points.

use core::cmp::Ordering;
use glam::DVec2;
use robust::{Coord, incircle, orient2d};

/// 2^-50: eight units of rounding, for a sum of two products of two coordinates.
///
/// It takes part in what follows with room to spare. The cross product of a and b is off by at most 2 units times
/// `|a| |b|`; the quick answer for c, which is farther away than both, by at most 20 units times `|a| |b| |c|²`, where 32
/// are taken.
const ROUNDING: f64 = 8.881_784_197_001_252e-16;

/// The Voronoi cell of the origin.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell {
    /// Counterclockwise.
    sides: Vec<Side>,
    /// The side that came last.
    newest: usize,
    /// The squared diameter of the largest circle through the origin and two neighbors in a row; infinite while the cell
    /// is open.
    diameter_sq: f64,
}

/// A neighbor, and the corner of the cell between it and the next one, counterclockwise.
#[derive(Clone, Copy, Debug)]
struct Side {
    at: DVec2,
    length_sq: f64,
    tag: u32,
    corner: Corner,
}

/// Where the bisectors of two neighbors a and b meet: the center of the circle through them and the origin.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Whether the next neighbor is at least half a turn away, so that the bisectors do not meet.
    is_open: bool,
    /// `|b|² a - |a|² b`.
    lean: DVec2,
    /// `a × b`.
    turn: f64,
    /// The largest error of the quick answer over the squared length of the point asked for.
    slack: f64,
    /// Not less than the true one; infinite for an open corner.
    diameter_sq: f64,
}

/// A neighbor of the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Neighbor {
    /// The tag that was given with the point.
    pub(crate) tag: u32,
    /// Whether it makes a triangle with the origin and the next neighbor, counterclockwise.
    pub(crate) joined: bool,
}

impl Cell {
    /// Makes the cell the whole plane again.
    pub(crate) fn clear(&mut self) {
        self.sides.clear();
        self.newest = 0;
        self.diameter_sq = f64::INFINITY;
    }

    /// Not less than the squared diameter of the largest circle through the origin and two neighbors in a row: a point
    /// farther away does not change the cell. Infinite while the cell is open.
    #[inline]
    pub(crate) fn diameter_sq(&self) -> f64 {
        self.diameter_sq
    }

    /// Clips the cell by the bisector of a point, which must not be the origin.
    ///
    /// Points must come nearest first, up to a millionth of their distance: the bounds of rounding are made for that.
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

    /// The neighbors, counterclockwise, that lie on an empty circle through the origin whose squared diameter is at
    /// most `limit_sq`.
    pub(crate) fn neighbors(&self, limit_sq: f64) -> impl Iterator<Item = Neighbor> + '_ {
        let all = self.diameter_sq <= limit_sq;
        let is_kept = move |index: usize| all || self.is_within(index, limit_sq);
        // The one before the newest is the first.
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

    /// A corner that the bisector of a point cuts off.
    #[inline]
    fn first_cut(&self, new: &Side) -> Option<usize> {
        for (index, side) in self.sides.iter().enumerate() {
            let corner = &side.corner;
            let excess = corner.excess(new);
            // An open corner has an infinite slack.
            let slack = corner.slack * new.length_sq;
            if excess > slack || (excess >= -slack && self.cuts(index, new).is_gt()) {
                return Some(index);
            }
        }
        None
    }

    /// Whether the bisector of a point cuts off a corner (greater), goes through it (equal), or passes by.
    fn cuts(&self, index: usize, new: &Side) -> Ordering {
        let a = &self.sides[index];
        let b = &self.sides[self.after(index)];
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
        let excess = a.corner.excess(new);
        if excess.abs() > a.corner.slack * new.length_sq {
            return order(excess);
        }
        order(incircle(
            coord(DVec2::ZERO),
            coord(a.at),
            coord(b.at),
            coord(new.at),
        ))
    }

    /// Puts a neighbor in the place of the corners that its bisector cuts off or goes through, all in a row with `cut`.
    fn insert(&mut self, cut: usize, new: Side) {
        let n = self.sides.len();
        let (mut first, mut last, mut count) = (cut, cut, 1);
        while count < n && self.hides(first, self.before(first), &new) {
            first = self.before(first);
            count += 1;
        }
        while count < n && self.hides(self.after(last), self.after(last), &new) {
            last = self.after(last);
            count += 1;
        }
        // The neighbors between these corners go.
        let at = self.replace(first, last, count - 1, new);
        let (before, after) = (self.before(at), self.after(at));
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

    /// Puts a neighbor in the place of `count` others, those after `first` up to `last`; gives where it is then.
    #[inline]
    fn replace(&mut self, first: usize, last: usize, count: usize, new: Side) -> usize {
        if last < first {
            // They go on at the beginning.
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

    /// Whether the bisector of a point leaves nothing of a neighbor's side of the cell, of which it is known to cut off
    /// or go through the one corner, and `corner` is the other one.
    #[inline]
    fn hides(&self, neighbor: usize, corner: usize, new: &Side) -> bool {
        let other = &self.sides[corner].corner;
        if other.excess(new) < -other.slack * new.length_sq {
            return false;
        }
        let [before, after] = [self.before(neighbor), neighbor].map(|index| &self.sides[index]);
        // Where the corner is open the side is a ray, whose far end has to be cut off.
        self.cuts(corner, new).is_ge()
            && (!before.corner.is_open || turns(new.at, after.at).is_gt())
            && (!after.corner.is_open || turns(after.at, new.at).is_gt())
    }

    /// Whether a neighbor lies on an empty circle through the origin with at most this squared diameter.
    ///
    /// The centers of its empty circles are its side of the cell. The smallest circle is in the middle between it and
    /// the origin if that is on the side, and otherwise at the nearer corner.
    fn is_within(&self, index: usize, limit_sq: f64) -> bool {
        let side = &self.sides[index];
        let [before, after] = [&self.sides[self.before(index)].corner, &side.corner];
        // A center is half of `lean`, turned by a quarter, over `turn`.
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

    #[inline]
    fn after(&self, index: usize) -> usize {
        if index + 1 == self.sides.len() {
            0
        } else {
            index + 1
        }
    }

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
    /// A corner at infinity; the infinite slack sends every question to the exact answer.
    const OPEN: Self = Self {
        is_open: true,
        lean: DVec2::ZERO,
        turn: 0.0,
        slack: f64::INFINITY,
        diameter_sq: f64::INFINITY,
    };

    /// Above zero if a point lies in the circle through the neighbors and the origin, up to rounding; zero for an open
    /// corner.
    #[inline]
    fn excess(&self, new: &Side) -> f64 {
        self.lean.perp_dot(new.at) - new.length_sq * self.turn
    }

    #[inline]
    fn new(a: &Side, b: &Side) -> Self {
        if turns(a.at, b.at).is_le() {
            return Self::OPEN;
        }
        let turn = a.at.perp_dot(b.at);
        let product = (a.length_sq * b.length_sq).sqrt();
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

/// Whether it is less than half a turn, counterclockwise, from a to b (greater), or more (less); exact.
#[inline]
fn turns(a: DVec2, b: DVec2) -> Ordering {
    let (left, right) = (a.x * b.y, a.y * b.x);
    let turn = left - right;
    if turn.abs() > ROUNDING * (left.abs() + right.abs()) {
        return order(turn);
    }
    order(orient2d(coord(DVec2::ZERO), coord(a), coord(b)))
}

#[inline]
fn order(value: f64) -> Ordering {
    value.partial_cmp(&0.0).unwrap_or(Ordering::Less)
}

fn coord(at: DVec2) -> Coord<f64> {
    Coord { x: at.x, y: at.y }
}

#[cfg(test)]
mod tests;
