//! Sorts vectors by their angle around a point, exactly and without computing angles.

use core::cmp::Ordering;
use glam::DVec2;
use robust::{Coord, orient2d};

/// Compares two vectors by their angle from the x axis in `[0, 2π)`, then by their length.
pub(crate) fn by_angle(a: DVec2, b: DVec2) -> Ordering {
    is_lower(a)
        .cmp(&is_lower(b))
        .then_with(|| turn(b, a).total_cmp(&0.0))
        .then_with(|| a.length_squared().total_cmp(&b.length_squared()))
}

/// Returns the cross product of `a` and `b`: positive if `b` is counterclockwise from `a`, negative if clockwise,
/// zero if parallel. The sign is exact.
pub(crate) fn turn(a: DVec2, b: DVec2) -> f64 {
    let coord = |v: DVec2| Coord { x: v.x, y: v.y };
    let cross = orient2d(Coord { x: 0.0, y: 0.0 }, coord(a), coord(b));
    // Adding 0 turns a negative zero, which a total order distinguishes, into zero.
    cross + 0.0
}

/// Returns whether the angle is in `[π, 2π)`.
#[inline]
pub(crate) fn is_lower(v: DVec2) -> bool {
    // Branch-free, since the branches would be unpredictable.
    (v.y < 0.0) | ((v.y == 0.0) & (v.x < 0.0))
}
