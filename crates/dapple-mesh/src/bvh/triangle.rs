//! Ray-triangle intersection, and the nearest point of a triangle.
//!
//! Reference: Sven Woop, Carsten Benthin and Ingo Wald, "Watertight Ray/Triangle Intersection", Journal of Computer
//! Graphics Techniques 2(1), 2013. Space is sheared so that the ray becomes an axis. The signs of three areas in the
//! plane across it decide whether the ray hits the triangle. Two triangles compute the area of a shared edge from the
//! same numbers, so no ray passes between them. The distance is a weighted mean of the distances of the corners. It
//! is therefore outside the bounds of the triangle only by rounding.

use super::Ray;
use glam::DVec3;

/// The corners of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners([[f64; 3]; 3]);

impl Corners {
    pub(crate) fn new(positions: [DVec3; 3]) -> Self {
        Self(positions.map(|position| position.to_array()))
    }

    pub(crate) fn positions(&self) -> [DVec3; 3] {
        self.0.map(DVec3::from)
    }
}

/// A ray prepared for intersection tests: its origin, and the shear that maps it to a coordinate axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    origin: [f64; 3],
    /// Permutation of the coordinate axes: two across the ray, then the dominant axis of its direction.
    axes: [usize; 3],
    shear: [f64; 3],
}

impl Probe {
    pub(crate) fn new(ray: &Ray) -> Self {
        let size = ray.direction.abs();
        let along = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let direction = ray.direction.to_array();
        let [x, y] = [(along + 1) % 3, (along + 2) % 3];
        Self {
            origin: ray.origin.to_array(),
            axes: [x, y, along],
            shear: [
                direction[x] / direction[along],
                direction[y] / direction[along],
                1.0 / direction[along],
            ],
        }
    }

    /// Intersects the ray with a triangle, and returns the signed distance along the ray and the barycentric weights;
    /// `None` if the line of the ray misses the triangle, or sees it edge-on.
    #[inline]
    pub(crate) fn meet(&self, corners: &Corners) -> Option<(f64, [f64; 3])> {
        let [a, b, c] = corners.0.map(|corner| self.sheared(corner));
        // Signed areas opposite to the corners; mixed signs mean a miss.
        let areas = [
            c[0] * b[1] - c[1] * b[0],
            a[0] * c[1] - a[1] * c[0],
            b[0] * a[1] - b[1] * a[0],
        ];
        if areas.iter().any(|&area| area < 0.0) && areas.iter().any(|&area| area > 0.0) {
            return None;
        }
        // Interpolate the depth.
        let whole = areas[0] + areas[1] + areas[2];
        let weights = areas.map(|area| area / whole);
        let depth = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
        let distance = depth * self.shear[2];
        // Not finite for a triangle seen edge-on, whose weights are NaN.
        distance.is_finite().then_some((distance, weights))
    }

    /// Transforms a point so that the ray is the third axis; on the ray, the first two coordinates are zero.
    #[inline]
    fn sheared(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.axes.map(|axis| point[axis] - self.origin[axis]);
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }
}

/// Returns the barycentric weights of the point of a triangle nearest to a position.
///
/// Reference: Christer Ericson, "Real-Time Collision Detection", 2005, section 5.1.5: the nearest feature is the
/// corner, edge or interior whose Voronoi region contains the position. A triangle with zero area counts as its
/// longest edge or its corner.
pub(crate) fn nearest_weights([a, b, c]: [DVec3; 3], position: DVec3) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    // Voronoi region of corner a
    let from_a = position - a;
    let (d1, d2) = (ab.dot(from_a), ac.dot(from_a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    // Voronoi region of corner b
    let from_b = position - b;
    let (d3, d4) = (ab.dot(from_b), ac.dot(from_b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    // Voronoi region of edge ab
    let of_c = d1 * d4 - d3 * d2;
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let part = d1 / (d1 - d3);
        return [1.0 - part, part, 0.0];
    }
    // Voronoi region of corner c
    let from_c = position - c;
    let (d5, d6) = (ab.dot(from_c), ac.dot(from_c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    // Voronoi region of edge ac
    let of_b = d5 * d2 - d1 * d6;
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let part = d2 / (d2 - d6);
        return [1.0 - part, 0.0, part];
    }
    // Voronoi region of edge bc
    let of_a = d3 * d6 - d5 * d4;
    if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - part, part];
    }
    // Interior
    let whole = of_a + of_b + of_c;
    [of_a / whole, of_b / whole, of_c / whole]
}
