//! Triangulates the surface of a solid given by its distance function.
//!
//! Reference: Sarah F. F. Gibson, "Constrained Elastic Surface Nets: Generating Smooth Surfaces from Binary Segmented
//! Data", MICCAI 1998, doi 10.1007/BFb0056277. Every cell of a regular grid that the surface passes through gets one
//! vertex, first at the mean of the crossings on its edges and then moved onto the surface. Every edge that the
//! surface crosses gets a quadrilateral between the four cells around it. Blocks of cells far from the surface are
//! skipped.
//!
//! The mesh is only rendered, so it need not be manifold or evenly meshed like those of `dapple_models::polygonize`,
//! whose other vertices would change the pixels of the figure.

use dapple_models::solid::Solid;
use dapple_preview::{Mesh, PreviewError};
use glam::DVec3;
use std::collections::BTreeMap;

/// Triangulates the surface of a solid on a grid of cells with the given side.
pub(super) fn polygonize(solid: &dyn Solid, side: f64) -> Result<Mesh, PreviewError> {
    let mut net = Net::new(solid, side);
    net.add_vertices();
    let triangles = net.triangles();
    Mesh::smooth(&net.positions, &triangles)
}

/// Number of cells in a block, along each axis.
const BLOCK: u32 = 8;

type Cell = [u32; 3];

struct Net<'a> {
    solid: &'a dyn Solid,
    side: f64,
    low: DVec3,
    blocks: Cell,
    /// Vertex index of each cell that the surface passes through.
    vertices: BTreeMap<Cell, u32>,
    positions: Vec<DVec3>,
    /// Edges that the surface crosses: the lower end, the axis, and whether the lower end is inside.
    crossings: Vec<(Cell, usize, bool)>,
}

impl<'a> Net<'a> {
    fn new(solid: &'a dyn Solid, side: f64) -> Self {
        let [low, high] = solid.bounds();
        let blocks = ((high - low) / (side * f64::from(BLOCK)))
            .ceil()
            .max(DVec3::ONE);
        Self {
            solid,
            side,
            low,
            blocks: blocks.to_array().map(|count| count as u32),
            vertices: BTreeMap::new(),
            positions: Vec::new(),
            crossings: Vec::new(),
        }
    }

    /// Returns a position in a cell: the corner `corner` plus `offset`, which is in multiples of the cell side.
    fn position(&self, corner: Cell, offset: DVec3) -> DVec3 {
        self.low + (DVec3::from_array(corner.map(f64::from)) + offset) * self.side
    }

    fn add_vertices(&mut self) {
        for block in cells([0; 3], self.blocks) {
            let first = block.map(|index| index * BLOCK);
            let middle = self.position(first, DVec3::splat(0.5 * f64::from(BLOCK)));
            // Half a diagonal of the block, a cell of margin, and a fifth for approximate distances.
            let reach = 1.2 * 3_f64.sqrt() * (0.5 * f64::from(BLOCK) + 1.0) * self.side;
            if self.solid.distance(middle).abs() <= reach {
                self.add_block(first);
            }
        }
    }

    fn add_block(&mut self, first: Cell) {
        const CORNERS: u32 = BLOCK + 1;
        let distances: Vec<f64> = cells([0; 3], [CORNERS; 3])
            .map(|corner| {
                let at = self.position(
                    [0, 1, 2].map(|axis| first[axis] + corner[axis]),
                    DVec3::ZERO,
                );
                self.solid.distance(at)
            })
            .collect();
        let distance = |[x, y, z]: Cell| distances[((z * CORNERS + y) * CORNERS + x) as usize];
        for cell in cells([0; 3], [BLOCK; 3]) {
            let corners: [f64; 8] = core::array::from_fn(|corner| {
                distance([0, 1, 2].map(|axis| cell[axis] + (corner as u32 >> axis & 1)))
            });
            let inside = corners.iter().filter(|&&distance| distance < 0.0).count();
            if inside == 0 || inside == 8 {
                continue;
            }
            let place = [0, 1, 2].map(|axis| first[axis] + cell[axis]);
            for axis in 0..3 {
                if (corners[0] < 0.0) != (corners[1 << axis] < 0.0) {
                    self.crossings.push((place, axis, corners[0] < 0.0));
                }
            }
            let vertex = self.on_surface(self.position(place, middle_of_crossings(&corners)));
            self.vertices.insert(place, self.positions.len() as u32);
            self.positions.push(vertex);
        }
    }

    /// Moves a point near the surface onto it, by a step along the gradient.
    fn on_surface(&self, at: DVec3) -> DVec3 {
        let h = 0.1 * self.side;
        let slope = DVec3::AXES
            .map(|axis| self.solid.distance(at + axis * h) - self.solid.distance(at - axis * h));
        let gradient = DVec3::from_array(slope) / (2.0 * h);
        let step = gradient * (self.solid.distance(at) / gradient.length_squared().max(0.25));
        at - step.clamp_length_max(0.5 * self.side)
    }

    /// Returns two triangles for each crossing, counterclockwise from outside.
    fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for &(cell, axis, inside) in &self.crossings {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let around = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[back_u, back_v]| {
                let mut other = cell;
                other[u] = other[u].checked_sub(back_u)?;
                other[v] = other[v].checked_sub(back_v)?;
                self.vertices.get(&other).copied()
            });
            if let [Some(a), Some(b), Some(c), Some(d)] = around {
                let quad = if inside { [a, b, c, d] } else { [a, d, c, b] };
                triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
            }
        }
        triangles
    }
}

/// Returns the mean of the points where the surface crosses the edges of a unit cell, given the distances at its
/// corners.
fn middle_of_crossings(corners: &[f64; 8]) -> DVec3 {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for from in 0..8_usize {
        for axis in 0..3 {
            let to = from | 1 << axis;
            if to != from && (corners[from] < 0.0) != (corners[to] < 0.0) {
                let part = corners[from] / (corners[from] - corners[to]);
                let start = DVec3::from_array([0, 1, 2].map(|axis| (from >> axis & 1) as f64));
                sum += start + DVec3::AXES[axis] * part;
                count += 1.0;
            }
        }
    }
    sum / f64::max(count, 1.0)
}

/// Iterates over all cells of a box, with x varying fastest.
fn cells(low: Cell, size: Cell) -> impl Iterator<Item = Cell> {
    let range = move |axis: usize| low[axis]..low[axis] + size[axis];
    range(2).flat_map(move |z| range(1).flat_map(move |y| range(0).map(move |x| [x, y, z])))
}

#[cfg(test)]
mod tests {
    use super::Net;
    use dapple_models::solid::Ball;
    use glam::DVec3;

    #[test]
    fn a_ball_is_closed_faces_outward_and_has_its_volume() {
        let ball = Ball {
            center: DVec3::ZERO,
            radius: 1.0,
        };
        let mut net = Net::new(&ball, 0.07);
        net.add_vertices();
        let triangles = net.triangles();
        let mut volume = 0.0;
        for triangle in &triangles {
            let [a, b, c] = triangle.map(|vertex| net.positions[vertex as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        // The corners lie on the sphere, so the volume is slightly smaller than the volume of the ball.
        let ball = 4.0 / 3.0 * core::f64::consts::PI;
        assert!((0.99..1.0).contains(&(volume / ball)), "{volume}");
        // Euler: V - E + F = 2 with three half edges per triangle.
        assert_eq!(net.positions.len() * 2, triangles.len() + 4, "not a sphere");
        for position in &net.positions {
            // The error is of second order in a step of at most a cell.
            assert!((position.length() - 1.0).abs() < 1e-3, "{position}");
        }
    }
}
