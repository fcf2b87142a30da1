//! The polygon in which a control point has a weight, and the borders that its axes leave on it.
//!
//! The support of a point is the set of all `d` (seen from the point) with `d·v < s |v|²` for the vector `v` of every axis and
//! the axis scale `s`. With Delaunay axes it is the Voronoi cell of the point, scaled by `2 s`: at `s = ½` the border that an axis
//! leaves is the dual of its edge, the side that two Voronoi cells share.

use glam::DVec2;

/// Whether two neighboring axes, in their order around the point, are half a turn or more apart.
pub(crate) fn has_gap(axes: &[DVec2]) -> bool {
    let next = axes.iter().cycle().skip(1);
    axes.len() < 3
        || axes
            .iter()
            .zip(next)
            .any(|(axis, next)| axis.perp_dot(*next) <= 0.0)
}

/// Supports are taken this much larger than they are, so that rounding cannot put a weight outside of its box.
const SLACK: f64 = 1e-5;

/// A box in which the support of a point lies, seen from the point, whatever rounding does. A side is infinite where the
/// support may not be bounded.
pub(crate) fn padded_box(axes: &[DVec2], scale: f64) -> (DVec2, DVec2) {
    let (min, max) = support_box(axes, scale);
    let slack = (max - min) * SLACK;
    (min - slack, max + slack)
}

/// The box around the support of a point, seen from the point: the polygon of all `d` with `d·v < s |v|²` for every
/// axis `v`. A side is infinite where the polygon is not bounded.
fn support_box(axes: &[DVec2], scale: f64) -> (DVec2, DVec2) {
    walk_support(axes, scale).unwrap_or_else(|| clip_support(axes, scale))
}

/// The box when every axis contributes an edge, as Delaunay axes do: its corners are where the borders of neighboring
/// axes meet. Nothing if an axis has no edge or the polygon is open.
fn walk_support(axes: &[DVec2], scale: f64) -> Option<(DVec2, DVec2)> {
    if has_gap(axes) {
        return None;
    }
    let vector = |index: usize| axes[index % axes.len()];
    let corner = |a: DVec2, b: DVec2| corner(a, b) * scale;
    let mut before = corner(vector(axes.len() - 1), vector(0));
    let (mut min, mut max) = (before, before);
    for index in 0..axes.len() {
        let after = corner(vector(index), vector(index + 1));
        if vector(index).perp_dot(after - before) < 0.0 {
            return None;
        }
        (min, max) = (min.min(after), max.max(after));
        before = after;
    }
    Some((min, max))
}

/// The box of any support, by clipping a very large square.
fn clip_support(axes: &[DVec2], scale: f64) -> (DVec2, DVec2) {
    let longest = axes.iter().map(|axis| axis.length()).fold(0.0, f64::max);
    let far = (longest * scale).max(f64::MIN_POSITIVE) * 1e12;
    let mut polygon = vec![
        DVec2::new(far, far),
        DVec2::new(-far, far),
        DVec2::new(-far, -far),
        DVec2::new(far, -far),
    ];
    for axis in axes {
        let inside = |corner: DVec2| scale * axis.length_squared() - corner.dot(*axis);
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        for (index, &corner) in polygon.iter().enumerate() {
            let next = polygon[(index + 1) % polygon.len()];
            let [here, there] = [inside(corner), inside(next)];
            if here >= 0.0 {
                clipped.push(corner);
            }
            if (here < 0.0) != (there < 0.0) {
                clipped.push(corner + (next - corner) * (here / (here - there)));
            }
        }
        polygon = clipped;
    }
    let min = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let max = polygon
        .iter()
        .copied()
        .fold(DVec2::NEG_INFINITY, DVec2::max);
    // What reaches far beyond every axis is cut by the square, not by an axis; a long wedge may as well be open.
    let open = |side: f64| {
        if side.abs() < far * 1e-3 {
            side
        } else {
            f64::INFINITY.copysign(side)
        }
    };
    (
        DVec2::new(open(min.x), open(min.y)),
        DVec2::new(open(max.x), open(max.y)),
    )
}

/// Where the borders of two axes meet at an axis scale of 1.
fn corner(a: DVec2, b: DVec2) -> DVec2 {
    (b.perp() * a.length_squared() - a.perp() * b.length_squared()) / -a.perp_dot(b)
}

/// The exponents of axes that fade where their borders are shorter than `fade` times their edges: 1 for those that do not.
pub(crate) fn fading(axes: &[DVec2], fade: f64) -> Vec<f32> {
    let borders = walk_borders(axes).unwrap_or_else(|| clip_borders(axes));
    let exponent = |(axis, border): (&DVec2, f64)| {
        let exponent = border / (fade * axis.length());
        exponent.clamp(0.0, 1.0) as f32
    };
    axes.iter().zip(borders).map(exponent).collect()
}

/// The lengths of the borders of a cell if every axis leaves one, as Delaunay axes do.
fn walk_borders(axes: &[DVec2]) -> Option<Vec<f64>> {
    if has_gap(axes) {
        return None;
    }
    let vector = |index: usize| axes[index % axes.len()];
    let mut before = corner(vector(axes.len() - 1), vector(0));
    let border = |index: usize| {
        let after = corner(vector(index), vector(index + 1));
        let side = 0.5 * (after - before);
        before = after;
        (vector(index).perp_dot(side) >= 0.0).then(|| side.length())
    };
    (0..axes.len()).map(border).collect()
}

/// The lengths of the borders of any cell, each cut by all other axes: infinite where the cell is open, and zero where an axis
/// leaves none.
fn clip_borders(axes: &[DVec2]) -> Vec<f64> {
    let border = |(index, &axis): (usize, &DVec2)| {
        let along = axis.perp();
        let [mut first, mut last] = [f64::NEG_INFINITY, f64::INFINITY];
        for (other, &cut) in axes.iter().enumerate() {
            let (rate, room) = (cut.dot(along), 0.5 * cut.dot(cut - axis));
            if rate > 0.0 {
                last = last.min(room / rate);
            } else if rate < 0.0 {
                first = first.max(room / rate);
            } else if room < 0.0 || (room == 0.0 && other < index) {
                return 0.0;
            }
        }
        (last - first).max(0.0) * along.length()
    };
    axes.iter().enumerate().map(border).collect()
}
