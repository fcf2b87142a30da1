//! The one rule for which triangles have an area.
//!
//! A triangle is *degenerate* if twice its area is at most 2^-50 times the square of its longest edge, or if that edge is
//! shorter than 1e-60. The first bound is where rounding drowns the normal: the cross product of two edges is off by up
//! to a quarter of it. The second keeps squares of areas above the smallest number. Every other triangle has a unit
//! normal, and edges and heights whose squares and reciprocals are finite.
//!
//! The rule gives the same answer for the three corners in any order, to the last bit.

use glam::DVec3;

/// Twice the area over the square of the longest edge, at or below which a triangle is degenerate: 2^-50.
const FLATNESS_MIN: f64 = 4.0 * f64::EPSILON;
/// The shortest longest edge that a triangle with an area has, in units of the mesh.
const LENGTH_MIN: f64 = 1e-60;
/// The largest height over the longest edge of a face that counts as thin: 2^-40.
pub(crate) const THIN_MAX: f64 = 4096.0 * f64::EPSILON;

/// The kinds of triangles by shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A triangle with an area.
    Fair,
    /// Degenerate, and the edge from this corner to the next is the shortest, and short beside the longest.
    Needle { shortest: usize },
    /// Degenerate, and the corner that is not on this longest edge lies on the edge, well within it.
    Cap { longest: usize },
}

/// The normal of a triangle as long as twice its area, or nothing if it is degenerate.
///
/// Exchanging two corners changes the sign and no bit more.
pub(crate) fn area_vector(corners: [DVec3; 3]) -> Option<DVec3> {
    let (corners, odd) = sorted(corners);
    let lengths_sq = edge_lengths_sq(corners);
    let edge = first_longest(lengths_sq);
    // The two shorter edges give the most precise product.
    let [a, b, tip] = [0, 1, 2].map(|step| corners[(edge + step) % 3]);
    let vector = (a - tip).cross(b - tip);
    let long_enough = lengths_sq[edge] >= LENGTH_MIN * LENGTH_MIN;
    let flat = FLATNESS_MIN * lengths_sq[edge];
    if !long_enough || vector.length_squared() <= flat * flat {
        return None;
    }
    Some(if odd { -vector } else { vector })
}

/// The shape of a triangle; in a needle the shortest edge is at most `thin` times the longest.
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

/// Whether twice the area of a triangle is at most 2^-40 times the square of its longest edge, or it is degenerate.
pub(crate) fn is_thin(corners: [DVec3; 3]) -> bool {
    let lengths_sq = edge_lengths_sq(corners);
    let longest_sq = lengths_sq[first_longest(lengths_sq)];
    area_vector(corners).is_none_or(|vector| vector.length() <= THIN_MAX * longest_sq)
}

/// The squared lengths of the edges from each corner to the next.
pub(crate) fn edge_lengths_sq([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [b - a, c - b, a - c].map(DVec3::length_squared)
}

/// The corners in the order of their coordinates, and whether that exchanged an odd number of pairs.
fn sorted(mut corners: [DVec3; 3]) -> ([DVec3; 3], bool) {
    let mut odd = false;
    for [i, j] in [[0, 1], [1, 2], [0, 1]] {
        // Arrays are compared part by part.
        if corners[j].to_array() < corners[i].to_array() {
            corners.swap(i, j);
            odd = !odd;
        }
    }
    (corners, odd)
}

/// The first of the largest numbers.
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
