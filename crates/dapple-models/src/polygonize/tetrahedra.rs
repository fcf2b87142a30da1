//! Marching tetrahedra on a body-centered cubic lattice.
//!
//! Lattice points have integer coordinates (i, j, k) along the three short diagonals [`BASIS`]. In these coordinates,
//! the lattice's tetrahedra are Kuhn's six tetrahedra of the unit cube (H. W. Kuhn, "Some Combinatorial Lemmas in
//! Topology", 1960). Each connects a corner of the cube to the opposite corner along three edges.

use super::Cut;
use crate::solid::box_distance;
use glam::DVec3;

/// The basis vectors of the lattice, in multiples of the cube's side.
const BASIS: [DVec3; 3] = [
    DVec3::new(-0.5, 0.5, 0.5),
    DVec3::new(0.5, -0.5, 0.5),
    DVec3::new(0.5, 0.5, -0.5),
];

/// The corners of Kuhn's tetrahedra as bit sets of basis vectors, ordered so that the volume is positive in the
/// lattice's frame.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 2, 6, 7],
    [0, 4, 5, 7],
    [0, 3, 2, 7],
    [0, 6, 4, 7],
    [0, 5, 1, 7],
];

/// Number of cells along each side of a leaf block. Leaf blocks are not subdivided further.
const LEAF: i64 = 4;
/// Distance from the center of a block to its farthest corners, in multiples of the block's side. It is half of the
/// longest diagonal, √11 / 2.
const REACH: f64 = 0.5 * 1.658_312_395_177_7;
/// Maximum change of a solid's distance, relative to the change of the position.
const STRETCH: f64 = 1.2;

/// A point of the lattice.
type Point = [i64; 3];

/// Finds the surface. Returns the positions of its vertices, and its triangles.
pub(super) fn march(cut: &Cut) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut march = March::new(cut);
    let size = march.size.unsigned_abs().next_power_of_two() as i64;
    march.block([0; 3], size.max(LEAF));
    // Number the vertices by the sorted keys of their edges.
    let mut edges: Vec<Crossing> = march.triangles.iter().flatten().copied().collect();
    edges.sort_unstable();
    edges.dedup();
    let number = |edge| edges.binary_search(&edge).unwrap_or_default() as u32;
    let faces = march.triangles.iter().map(|triangle| triangle.map(number));
    let positions = edges.iter().map(|&edge| march.crossing(edge)).collect();
    (positions, faces.collect())
}

/// Key of an edge of the lattice that the surface crosses. It contains the coordinates of the edge's lower point and,
/// in the lowest 3 bits, the basis vectors that lead to the other point.
type Crossing = u64;

/// Bits per coordinate in a key.
const BITS: u32 = 20;

struct March<'a> {
    cut: &'a Cut<'a>,
    /// Lattice coordinates of the lowest point.
    low: Point,
    /// Number of cells along each axis of the lattice.
    size: i64,
    triangles: Vec<[Crossing; 3]>,
}

impl<'a> March<'a> {
    fn new(cut: &'a Cut<'a>) -> Self {
        // Convert the bounds to lattice coordinates.
        let [low, high] = cut.bounds.map(|corner| {
            let at = corner / cut.side;
            [at.y + at.z, at.z + at.x, at.x + at.y]
        });
        // Add two cells on each side, so that all points at the border are outside.
        let first = low.map(|coordinate| coordinate.floor() as i64 - 2);
        let size = [0, 1, 2].map(|axis| high[axis].ceil() as i64 + 2 - first[axis]);
        Self {
            cut,
            low: first,
            size: size.into_iter().max().unwrap_or(LEAF),
            triangles: Vec::new(),
        }
    }

    fn position(&self, point: Point) -> DVec3 {
        let [i, j, k] = [0, 1, 2].map(|axis| (self.low[axis] + point[axis]) as f64);
        (BASIS[0] * i + BASIS[1] * j + BASIS[2] * k) * self.cut.side
    }

    /// Adds the triangles of a block. The block is subdivided recursively; parts that the surface cannot cross are
    /// skipped.
    fn block(&mut self, first: Point, size: i64) {
        let last = first.map(|coordinate| coordinate + size);
        let center = (self.position(first) + self.position(last)) * 0.5;
        let reach = REACH * size as f64 * self.cut.side;
        // Skip the block if its distance bound excludes the surface.
        if box_distance(self.cut.bounds, center) > reach
            || self.cut.distance(center).abs() > STRETCH * reach
        {
            return;
        }
        if size <= LEAF {
            self.leaf(first);
            return;
        }
        let half = size / 2;
        for child in 0..8 {
            let at = [0, 1, 2].map(|axis| first[axis] + half * (child >> axis & 1));
            self.block(at, half);
        }
    }

    /// Adds the triangles of a leaf block.
    fn leaf(&mut self, first: Point) {
        const POINTS: usize = LEAF as usize + 1;
        let mut inside = [false; POINTS * POINTS * POINTS];
        for (point, inside) in points(LEAF + 1).zip(&mut inside) {
            *inside = self.cut.distance(self.position(sum(first, point))) < 0.0;
        }
        if inside.iter().all(|&point| point == inside[0]) {
            return;
        }
        // March the cells whose corners are not all on the same side.
        for cell in points(LEAF) {
            // Look up the corners in the samples of the block.
            let corners: [bool; 8] = core::array::from_fn(|steps| {
                let [i, j, k] = sum(cell, corner(steps)).map(|coordinate| coordinate as usize);
                inside[(k * POINTS + j) * POINTS + i]
            });
            if corners.iter().any(|&corner| corner != corners[0]) {
                for tetrahedron in TETRAHEDRA {
                    self.tetrahedron(sum(first, cell), tetrahedron, &corners);
                }
            }
        }
    }

    /// Adds the triangles within a tetrahedron, which separate its inside corners from its outside corners.
    fn tetrahedron(&mut self, cell: Point, corners: [usize; 4], inside: &[bool; 8]) {
        let n_inside = corners.iter().filter(|&&corner| inside[corner]).count();
        // Sort the inside corners first. An odd number of swaps mirrors the tetrahedron; one more swap restores its
        // orientation.
        let (mut order, mut odd) = (corners, false);
        for left in [0, 1, 2, 0, 1, 0] {
            if !inside[order[left]] && inside[order[left + 1]] {
                order.swap(left, left + 1);
                odd = !odd;
            }
        }
        if odd && n_inside >= 2 {
            order.swap(0, 1);
        } else if odd {
            order.swap(2, 3);
        }
        let [a, b, c, d] = order;
        let edge = |from, to| crossing(cell, from, to);
        match n_inside {
            1 => self.triangles.push([edge(a, b), edge(a, c), edge(a, d)]),
            2 => {
                let quad = [edge(a, c), edge(a, d), edge(b, d), edge(b, c)];
                self.triangles.push([quad[0], quad[1], quad[2]]);
                self.triangles.push([quad[0], quad[2], quad[3]]);
            }
            3 => self.triangles.push([edge(a, d), edge(b, d), edge(c, d)]),
            _ => {}
        }
    }

    /// Returns the point where the surface crosses an edge.
    fn crossing(&self, edge: Crossing) -> DVec3 {
        // Unpack the ends of the edge.
        let coordinate = |axis: u32| (edge >> (3 + BITS * axis) & ((1 << BITS) - 1)) as i64;
        let point = [0, 1, 2].map(coordinate);
        let ends = [point, sum(point, corner(edge as usize & 7))].map(|end| self.position(end));
        let at = |part: f64| ends[0] + (ends[1] - ends[0]) * part;
        let distances = ends.map(|end| self.cut.distance(end));
        let part = root(distances, self.cut.tolerance(), |part| {
            self.cut.distance(at(part))
        });
        at(part)
    }
}

/// Finds a root of a function between 0 and 1, within a tolerance, or a jump across zero. `ends` are the values at 0
/// and 1, which have opposite signs. Alternates regula falsi with bisection.
fn root(ends: [f64; 2], tolerance: f64, value: impl Fn(f64) -> f64) -> f64 {
    /// Maximum number of steps. A third of them are bisections, which is enough to reach the last bits.
    const STEPS: u32 = 150;
    let [mut low, mut high] = [0.0, 1.0];
    let [mut at_low, mut at_high] = ends;
    let mut middle = 0.5;
    for step in 1..=STEPS {
        middle = if step % 3 == 0 {
            0.5 * (low + high)
        } else {
            low + (high - low) * (at_low / (at_low - at_high))
        };
        let at_middle = value(middle);
        if at_middle.abs() <= tolerance {
            break;
        }
        if (at_middle < 0.0) == (at_low < 0.0) {
            (low, at_low) = (middle, at_middle);
        } else {
            (high, at_high) = (middle, at_middle);
        }
    }
    middle
}

/// Returns the key of the edge between two corners of a cell. One corner's set of basis vectors must be a subset of
/// the other's.
fn crossing(cell: Point, from: usize, to: usize) -> Crossing {
    let point = sum(cell, corner(from & to));
    let steps = (from ^ to) as u64;
    let packed = (0..).zip(point).map(|(axis, coordinate)| {
        let shift: u32 = 3 + BITS * axis;
        (coordinate as u64) << shift
    });
    packed.fold(steps, |packed, part| packed | part)
}

/// Converts a bit set of basis vectors to a corner of the unit cube.
fn corner(steps: usize) -> Point {
    [0, 1, 2].map(|axis| (steps >> axis & 1) as i64)
}

fn sum(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Iterates over the points of a cube, with the first coordinate varying fastest.
fn points(size: i64) -> impl Iterator<Item = Point> {
    (0..size).flat_map(move |k| (0..size).flat_map(move |j| (0..size).map(move |i| [i, j, k])))
}
