//! Decides whether a triangle is degenerate, by one rule for the whole crate.
//!
//! A triangle is *degenerate* if twice its area is at most 2^-50 times the square of its longest edge, or if that edge
//! is shorter than 1e-60. Below the first bound, rounding dominates the normal: the error of the cross product of two
//! edges is up to a quarter of the bound. The second bound keeps squares of areas above the smallest `f64`. Every
//! other triangle has a unit normal, and edges and heights whose squares and reciprocals are finite.
//!
//! The result does not depend on the order of the corners, bit for bit.

use glam::DVec3;

/// Maximum ratio of twice the area to the square of the longest edge at which a triangle is degenerate: 2^-50.
const FLATNESS_MIN: f64 = 4.0 * f64::EPSILON;
/// Minimum length of a nondegenerate triangle's longest edge, in units of the mesh.
const LENGTH_MIN: f64 = 1e-60;
/// Maximum ratio of the height to the longest edge of a thin face: 2^-40.
pub(crate) const THIN_MAX: f64 = 4096.0 * f64::EPSILON;

/// Classification of triangles by shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A triangle with nonzero area.
    Fair,
    /// Degenerate. The edge that starts at this corner is the shortest, and much shorter than the longest.
    Needle { shortest: usize },
    /// Degenerate. The corner opposite the longest edge is on that edge, well between its ends.
    Cap { longest: usize },
}

/// Returns the normal of a triangle, whose length is twice the triangle's area; `None` if it is degenerate.
///
/// Exchanging two corners changes only the sign.
pub(crate) fn area_vector(corners: [DVec3; 3]) -> Option<DVec3> {
    let (corners, odd) = sorted(corners);
    let lengths_sq = edge_lengths_sq(corners);
    let edge = first_longest(lengths_sq);
    // The two shorter edges give the most accurate product.
    let [a, b, tip] = [0, 1, 2].map(|step| corners[(edge + step) % 3]);
    let vector = (a - tip).cross(b - tip);
    let long_enough = lengths_sq[edge] >= LENGTH_MIN * LENGTH_MIN;
    let flat = FLATNESS_MIN * lengths_sq[edge];
    if !long_enough || vector.length_squared() <= flat * flat {
        return None;
    }
    Some(if odd { -vector } else { vector })
}

/// Returns the shape of a triangle. The shortest edge of a needle is at most `thin` times the longest.
pub(crate) fn shape(corners: [DVec3; 3], thin: f64) -> Shape {
    if area_vector(corners).is_some() {
        return Shape::Fair;
    }
    let lengths_sq = edge_lengths_sq(corners);
    let longest = first_longest(lengths_sq);
    let shortest = first_longest(lengths_sq.map(|length_sq| -length_sq));
    let tiny = lengths_sq[longest] < LENGTH_MIN * LENGTH_MIN;
    if tiny || lengths_sq[shortest] <= thin * thin * lengths_sq[longest] {
        Shape::Needle { shortest }
    } else {
        Shape::Cap { longest }
    }
}

/// Returns whether a triangle is degenerate, or twice its area is at most 2^-40 times the square of its longest edge.
pub(crate) fn is_thin(corners: [DVec3; 3]) -> bool {
    let lengths_sq = edge_lengths_sq(corners);
    let longest_sq = lengths_sq[first_longest(lengths_sq)];
    area_vector(corners).is_none_or(|vector| vector.length() <= THIN_MAX * longest_sq)
}

/// Returns the squared lengths of the edges, each from a corner to the next.
pub(crate) fn edge_lengths_sq([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [b - a, c - b, a - c].map(DVec3::length_squared)
}

/// Returns the corners in lexicographic order, and whether the permutation is odd.
fn sorted(mut corners: [DVec3; 3]) -> ([DVec3; 3], bool) {
    let mut odd = false;
    for [i, j] in [[0, 1], [1, 2], [0, 1]] {
        // Arrays compare lexicographically.
        if corners[j].to_array() < corners[i].to_array() {
            corners.swap(i, j);
            odd = !odd;
        }
    }
    (corners, odd)
}

/// Returns the index of the longest edge; the first one on a tie.
fn first_longest(lengths_sq: [f64; 3]) -> usize {
    let mut longest = 0;
    for edge in 1..3 {
        if lengths_sq[edge] > lengths_sq[longest] {
            longest = edge;
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn triangle(apex: [f64; 3]) -> [DVec3; 3] {
        [DVec3::ZERO, DVec3::X, DVec3::from_array(apex)]
    }

    #[test]
    fn area_vector_is_twice_the_area() {
        let vector = area_vector(triangle([0.25, 3.0, 0.0]));
        assert_eq!(vector, Some(DVec3::new(0.0, 0.0, 3.0)), "base 1, height 3");
    }

    #[test]
    fn area_vector_is_none_at_the_limits_and_some_past_them() {
        let limit = FLATNESS_MIN;
        assert_eq!(area_vector(triangle([0.5, limit, 0.0])), None, "flat");
        assert!(
            area_vector(triangle([0.5, 1.01 * limit, 0.0])).is_some(),
            "a thin cap"
        );
        assert!(
            area_vector(triangle([1.0, 1e-12, 0.0])).is_some(),
            "a needle"
        );
        let small = |scale: f64| triangle([0.5, 0.5, 0.0]).map(|corner| corner * scale);
        assert!(area_vector(small(1e-59)).is_some(), "small");
        assert_eq!(area_vector(small(1e-61)), None, "too small");
        assert!(
            area_vector(small(1e30)).is_some_and(DVec3::is_finite),
            "large"
        );
    }

    #[test]
    fn shape_tells_needles_from_caps() {
        assert_eq!(
            shape(triangle([0.5, 0.1, 0.0]), THIN_MAX),
            Shape::Fair,
            "fair"
        );
        assert_eq!(
            shape(triangle([0.5, 0.0, 0.0]), THIN_MAX),
            Shape::Cap { longest: 0 },
            "cap"
        );
        assert_eq!(
            shape(triangle([1.0 + 1e-13, 0.0, 0.0]), THIN_MAX),
            Shape::Needle { shortest: 1 },
            "needle"
        );
        let same = [DVec3::ONE; 3];
        assert_eq!(
            shape(same, THIN_MAX),
            Shape::Needle { shortest: 0 },
            "one point"
        );
    }

    proptest! {
        #[test]
        fn area_vector_has_the_same_bits_for_corners_in_any_order(
            parts in prop::array::uniform9(prop_oneof![
                -1.0..1.0_f64, (-3_i8..3).prop_map(f64::from), (0_i8..9).prop_map(|part| 0.1 * f64::from(part)),
            ]),
        ) {
            let corner = |first: usize| DVec3::new(parts[first], parts[first + 1], parts[first + 2]);
            let [a, b, c] = [0, 3, 6].map(corner);
            let vector = area_vector([a, b, c]);
            for (turned, order) in [(1.0, [b, c, a]), (1.0, [c, a, b]), (-1.0, [a, c, b]), (-1.0, [c, b, a])] {
                prop_assert_eq!(area_vector(order), vector.map(|vector| vector * turned));
            }
        }
    }
}
