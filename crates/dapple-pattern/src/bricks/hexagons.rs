//! Hexagons: the Voronoi cells of a lattice with every other course shifted by half.
//!
//! The cells are regular hexagons if courses are `√3 / 2` of the width apart. For other ratios they are longer along
//! one axis, and joints have the same width on all sides. The face of a hexagon is a convex polygon; rounding its
//! corners insets the polygon and dilates it again.

use super::{Brick, Bricks};
use crate::lattice::{Split, length, shader_words};

/// Maximum number of corners of a clipped polygon: four of the initial square, and one more for each of the eight
/// half-planes.
const CORNERS: usize = 12;

/// A half-plane: positions whose dot product with the unit vector `normal` is at most `distance`.
#[derive(Clone, Copy)]
struct HalfPlane {
    normal: [f64; 2],
    distance: f64,
}

/// The cell of a hexagon, and a position in it.
#[derive(Clone, Copy)]
struct Cell {
    /// Column and course, not wrapped by the period.
    id: [i64; 2],
    /// Position relative to the center, in units of the plane.
    at: [f64; 2],
}

impl Bricks {
    /// Returns the hexagon that contains a position.
    pub(super) fn hexagon(&self, place: [Split; 2]) -> Brick {
        let cell = self.nearest_center(place);
        let depth = self.hexagon_depth(cell);
        let half = self.hexagon_half();
        Brick {
            id: self.wrapped(cell.id),
            upright: false,
            uv: [0, 1].map(|axis| (0.5 + 0.5 * cell.at[axis] / half[axis]).clamp(0.0, 1.0)),
            height: self.rise(depth),
        }
    }

    /// Returns the signed distance to the nearest border of a hexagon: positive on faces, negative in joints.
    pub(super) fn hexagon_edge_distance(&self, place: [Split; 2]) -> f64 {
        let cell = self.nearest_center(place);
        let own = self.hexagon_depth(cell);
        if own >= 0.0 {
            return own;
        }
        let odd = cell.id[1].rem_euclid(2);
        let depths = self.neighbors().map(|([columns, courses], vector)| {
            // Columns of odd courses are half a column further to the right.
            let shift = if courses % 2 == 0 { 0 } else { odd };
            self.hexagon_depth(Cell {
                id: [cell.id[0] + columns + shift, cell.id[1] + courses],
                at: [cell.at[0] - vector[0], cell.at[1] - vector[1]],
            })
        });
        depths.into_iter().fold(own, f64::max)
    }

    /// Returns the eight surrounding hexagons of a hexagon in an even course: offsets in columns and courses, and
    /// vectors in the plane. Six of them share a side with it.
    fn neighbors(&self) -> [([i64; 2], [f64; 2]); 8] {
        let [width, height] = self.cell;
        [
            ([-1, 0], [-width, 0.0]),
            ([1, 0], [width, 0.0]),
            ([-1, -1], [-0.5 * width, -height]),
            ([0, -1], [0.5 * width, -height]),
            ([-1, 1], [-0.5 * width, height]),
            ([0, 1], [0.5 * width, height]),
            ([0, -2], [0.0, -2.0 * height]),
            ([0, 2], [0.0, 2.0 * height]),
        ]
    }

    /// Returns the hexagon whose center is nearest to a position.
    fn nearest_center(&self, [x, y]: [Split; 2]) -> Cell {
        let [width, height] = self.cell;
        let mut nearest = (
            f64::INFINITY,
            Cell {
                id: [0; 2],
                at: [0.0; 2],
            },
        );
        for courses in -2..=2_i64 {
            let course = y.cell + courses;
            let shift = 0.5 * course.rem_euclid(2) as f64;
            for columns in -1..=1_i64 {
                let center = [columns as f64 + 0.5 + shift, courses as f64 + 0.5];
                let at = [
                    (x.offset - center[0]) * width,
                    (y.offset - center[1]) * height,
                ];
                let distance_sq = at[0] * at[0] + at[1] * at[1];
                if distance_sq < nearest.0 {
                    let id = [x.cell + columns, course];
                    nearest = (distance_sq, Cell { id, at });
                }
            }
        }
        nearest.1
    }

    /// Returns the signed distance to the border of a hexagon's face, positive inside.
    fn hexagon_depth(&self, cell: Cell) -> f64 {
        // Move the sides inward.
        let id = self.wrapped(cell.id);
        let mut sides = self.sides();
        for (index, side) in (0..).zip(&mut sides) {
            side.distance -= self.inset(id, index);
        }
        // Inset the polygon by the radius of the corners.
        let least = sides.iter().map(|side| side.distance);
        let least = least.fold(f64::INFINITY, f64::min);
        let radius = (self.options.rounding * self.unit).min(0.9 * least);
        for side in &mut sides {
            side.distance -= radius;
        }
        // Inside of the inset polygon, the nearest border is a side.
        let inside = sides.iter().map(|side| side.depth(cell.at));
        let inside = inside.fold(f64::INFINITY, f64::min);
        if inside >= 0.0 {
            return radius + inside;
        }
        let (corners, count) = polygon(&sides, self.half_side());
        radius - distance(&corners[..count], cell.at)
    }

    /// Returns the hexagons as a structure for shaders: the words of `HexagonSides` in the WGSL of `dapple-wgsl`, as
    /// pairs of high and low words.
    #[doc(hidden)]
    #[must_use]
    pub fn hexagon_words(&self) -> Vec<[u32; 2]> {
        let [x, y] = self.hexagon_half();
        let mut numbers = vec![x, y, self.half_side()];
        for ((_, vector), side) in self.neighbors().into_iter().zip(self.sides()) {
            let ([x, y], [normal_x, normal_y]) = (vector, side.normal);
            numbers.extend([x, y, normal_x, normal_y, side.distance]);
        }
        numbers.into_iter().map(shader_words).collect()
    }

    /// Returns half of the side of a square that contains a hexagon's cell, in units of the plane.
    fn half_side(&self) -> f64 {
        2.0 * (self.cell[0] + self.cell[1])
    }

    /// Returns the half-planes whose intersection is a hexagon's cell.
    fn sides(&self) -> [HalfPlane; 8] {
        self.neighbors().map(|(_, vector)| {
            let length = length(vector);
            HalfPlane {
                normal: vector.map(|part| part / length),
                distance: 0.5 * length,
            }
        })
    }

    /// Returns half of the width and height of a hexagon's cell, in units of the plane.
    fn hexagon_half(&self) -> [f64; 2] {
        let [width, height] = self.cell;
        // The corners are the circumcenters of the triangles of the lattice.
        if width < 2.0 * height {
            [0.5 * width, 0.5 * height + width * width / (8.0 * height)]
        } else {
            [0.25 * width + height * height / width, height]
        }
    }
}

impl HalfPlane {
    /// Returns the signed distance to the border line of the half-plane, positive inside.
    fn depth(&self, [x, y]: [f64; 2]) -> f64 {
        self.distance - (self.normal[0] * x + self.normal[1] * y)
    }
}

/// Returns the corners of the intersection of half-planes, in order, and their number. The intersection must be inside
/// a square with the given half side.
fn polygon(sides: &[HalfPlane; 8], half_side: f64) -> ([[f64; 2]; CORNERS], usize) {
    let mut corners = [[0.0; 2]; CORNERS];
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    for (corner, [x, y]) in corners.iter_mut().zip(square) {
        *corner = [x * half_side, y * half_side];
    }
    let mut count = 4;
    for side in sides {
        // Clip the polygon by the side (Sutherland and Hodgman).
        let (mut clipped, mut kept) = ([[0.0; 2]; CORNERS], 0);
        for index in 0..count {
            let [from, to] = [corners[index], corners[(index + 1) % count]];
            let [start, end] = [from, to].map(|corner| side.depth(corner));
            if start >= 0.0 {
                clipped[kept] = from;
                kept += 1;
            }
            if (start >= 0.0) != (end >= 0.0) {
                let t = start / (start - end);
                clipped[kept] = [0, 1].map(|axis| from[axis] + t * (to[axis] - from[axis]));
                kept += 1;
            }
        }
        (corners, count) = (clipped, kept);
    }
    (corners, count)
}

/// Returns the distance from a position to the border of a polygon.
fn distance(corners: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let mut least = f64::INFINITY;
    for (index, from) in corners.iter().enumerate() {
        let to = corners[(index + 1) % corners.len()];
        let side = [to[0] - from[0], to[1] - from[1]];
        let offset = [at[0] - from[0], at[1] - from[1]];
        let length_sq = side[0] * side[0] + side[1] * side[1];
        // A side of length 0 is a corner.
        let t = match length_sq {
            0.0 => 0.0,
            _ => ((offset[0] * side[0] + offset[1] * side[1]) / length_sq).clamp(0.0, 1.0),
        };
        least = least.min(length([offset[0] - t * side[0], offset[1] - t * side[1]]));
    }
    least
}
