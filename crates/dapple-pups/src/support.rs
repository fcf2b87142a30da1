//! Computes the support of a control point, and the borders of its axes.
//!
//! The support of a point is the polygon of all offsets `d` from the point with `d·v < s |v|²`, for the vector `v` of
//! every axis and the axis scale `s`. With Delaunay axes it is the Voronoi cell of the point, scaled by `2 s`. At
//! `s = ½` the border of an axis is the dual of its edge: the side that two Voronoi cells share.

use glam::DVec2;

/// Returns whether two neighboring axes, in angular order, are 180° or more apart.
pub(crate) fn has_gap(axes: &[DVec2]) -> bool {
    let next = axes.iter().cycle().skip(1);
    // Two axes cannot enclose the point. Neighbors are less than 180° apart if their cross product is positive.
    axes.len() < 3
        || axes
            .iter()
            .zip(next)
            .any(|(axis, next)| axis.perp_dot(*next) <= 0.0)
}

/// Relative margin of the bounds of a support, so that rounding cannot produce a weight outside of them.
const SLACK: f64 = 1e-5;

/// Returns the bounds of a point's support, relative to the point, extended by a margin for rounding. A side is
/// infinite where the support may be unbounded.
pub(crate) fn padded_box(axes: &[DVec2], scale: f64) -> (DVec2, DVec2) {
    let (min, max) = support_box(axes, scale);
    let slack = (max - min) * SLACK;
    (min - slack, max + slack)
}

/// Returns the bounds of a point's support, relative to the point. The support is the polygon of all `d` with `d·v < s
/// |v|²` for every axis `v`. A side is infinite where the polygon is unbounded.
fn support_box(axes: &[DVec2], scale: f64) -> (DVec2, DVec2) {
    walk_support(axes, scale).unwrap_or_else(|| clip_support(axes, scale))
}

/// Returns the bounds of a support to which every axis contributes an edge, as Delaunay axes do. Corners are the
/// intersections of the borders of neighboring axes. Returns `None` if an axis contributes no edge or the polygon is
/// open.
fn walk_support(axes: &[DVec2], scale: f64) -> Option<(DVec2, DVec2)> {
    if has_gap(axes) {
        return None;
    }
    let vector = |index: usize| axes[index % axes.len()];
    let corner = |a: DVec2, b: DVec2| corner(a, b) * scale;
    // Start at the corner between the last and the first axis, and follow the polygon counterclockwise.
    let mut before = corner(vector(axes.len() - 1), vector(0));
    let (mut min, mut max) = (before, before);
    for index in 0..axes.len() {
        let after = corner(vector(index), vector(index + 1));
        // If the border runs backward between its corners, other axes cut it off completely.
        if vector(index).perp_dot(after - before) < 0.0 {
            return None;
        }
        (min, max) = (min.min(after), max.max(after));
        before = after;
    }
    Some((min, max))
}

/// Returns the bounds of any support, by clipping a very large square.
fn clip_support(axes: &[DVec2], scale: f64) -> (DVec2, DVec2) {
    // Start with a square that is far larger than any bounded support.
    let longest = axes.iter().map(|axis| axis.length()).fold(0.0, f64::max);
    let far = (longest * scale).max(f64::MIN_POSITIVE) * 1e12;
    let mut polygon = vec![
        DVec2::new(far, far),
        DVec2::new(-far, far),
        DVec2::new(-far, -far),
        DVec2::new(far, -far),
    ];
    // Clip the polygon by the half-plane d·v ≤ s |v|² of each axis (Sutherland-Hodgman).
    for axis in axes {
        let inside = |corner: DVec2| scale * axis.length_squared() - corner.dot(*axis);
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        for (index, &corner) in polygon.iter().enumerate() {
            let next = polygon[(index + 1) % polygon.len()];
            let [here, there] = [inside(corner), inside(next)];
            if here >= 0.0 {
                clipped.push(corner);
            }
            // Where the edge crosses the border, add the intersection.
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
    // A side far beyond every axis comes from the square, not from an axis; a long wedge is treated as unbounded.
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

/// Returns the intersection of the borders of two axes, relative to the point, at an axis scale of 1.
fn corner(a: DVec2, b: DVec2) -> DVec2 {
    // Solve d·a = |a|² and d·b = |b|² by Cramer's rule.
    (b.perp() * a.length_squared() - a.perp() * b.length_squared()) / -a.perp_dot(b)
}

/// Returns the exponents of the axes: below 1 where an axis's border is shorter than `fade` times its edge, else 1.
pub(crate) fn fading(axes: &[DVec2], fade: f64) -> Vec<f32> {
    let borders = walk_borders(axes).unwrap_or_else(|| clip_borders(axes));
    let exponent = |(axis, border): (&DVec2, f64)| {
        let exponent = border / (fade * axis.length());
        exponent.clamp(0.0, 1.0) as f32
    };
    axes.iter().zip(borders).map(exponent).collect()
}

/// Returns the border length of each axis if every axis has a border, as Delaunay axes do; otherwise `None`.
fn walk_borders(axes: &[DVec2]) -> Option<Vec<f64>> {
    if has_gap(axes) {
        return None;
    }
    let vector = |index: usize| axes[index % axes.len()];
    // Start at the corner between the last and the first axis.
    let mut before = corner(vector(axes.len() - 1), vector(0));
    let border = |index: usize| {
        let after = corner(vector(index), vector(index + 1));
        // Corners are for the axis scale 1; the Voronoi cell is half as large.
        let side = 0.5 * (after - before);
        before = after;
        // A border that runs backward between its corners is empty.
        (vector(index).perp_dot(side) >= 0.0).then(|| side.length())
    };
    (0..axes.len()).map(border).collect()
}

/// Returns, for each axis, the length of the Voronoi edge perpendicular to it, clipped by all other axes. A length is
/// infinite where the cell is open, and zero for an axis without a border.
fn clip_borders(axes: &[DVec2]) -> Vec<f64> {
    let border = |(index, &axis): (usize, &DVec2)| {
        // The border is part of the bisector ½ v + t v⊥ of the axis v. Clip the interval of t by all other bisectors.
        let along = axis.perp();
        let [mut first, mut last] = [f64::NEG_INFINITY, f64::INFINITY];
        for (other, &cut) in axes.iter().enumerate() {
            // The bisector of another axis c requires t (c·v⊥) ≤ ½ c·(c − v).
            let (rate, room) = (cut.dot(along), 0.5 * cut.dot(cut - axis));
            if rate > 0.0 {
                last = last.min(room / rate);
            } else if rate < 0.0 {
                first = first.max(room / rate);
            } else if room < 0.0 || (room == 0.0 && other < index) {
                // A nearer parallel bisector hides the whole border. Of two equal axes, the first has the border.
                return 0.0;
            }
        }
        (last - first).max(0.0) * along.length()
    };
    axes.iter().enumerate().map(border).collect()
}
