//! The order of vectors around a point, exact and without angles.

use core::cmp::Ordering;
use glam::DVec2;
use robust::{Coord, orient2d};

/// Compares two vectors by their angle in `[0, 2π)` from the x axis, then by their length.
pub(crate) fn by_angle(a: DVec2, b: DVec2) -> Ordering {
    is_lower(a)
        .cmp(&is_lower(b))
        .then_with(|| turn(b, a).total_cmp(&0.0))
        .then_with(|| a.length_squared().total_cmp(&b.length_squared()))
}

/// Above zero if `b` lies counterclockwise of `a`, below zero if clockwise, zero if they are parallel; the sign is
/// exact.
pub(crate) fn turn(a: DVec2, b: DVec2) -> f64 {
    let coord = |v: DVec2| Coord { x: v.x, y: v.y };
    let cross = orient2d(Coord { x: 0.0, y: 0.0 }, coord(a), coord(b));
    // Negative zero would not compare equal to zero in a total order.
    cross + 0.0
}

/// Whether the angle is in `[π, 2π)`.
#[inline]
pub(crate) fn is_lower(v: DVec2) -> bool {
    // Without branches, which could not be predicted.
    (v.y < 0.0) | ((v.y == 0.0) & (v.x < 0.0))
}
