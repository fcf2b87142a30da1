//! What is wrong with a mesh, as data.

use crate::Mesh;

/// Counts of everything about a mesh that may be in the way.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshReport {
    /// Vertices.
    pub vertices: usize,
    /// Faces.
    pub faces: usize,
    /// Pieces: sets of faces that share edges with two faces, as [`Adjacency`](crate::Adjacency) has it.
    pub components: usize,
    /// Edges of exactly one face.
    pub boundary_edges: usize,
    /// Edges of three or more faces.
    pub non_manifold_edges: usize,
    /// Vertices whose faces do not follow each other around them in one fan.
    pub non_manifold_vertices: usize,
    /// Edges whose two faces go through them in the same direction.
    pub winding_edges: usize,
    /// Faces that name a vertex twice, or have an area that is zero.
    pub degenerate_faces: usize,
    /// Faces with the same three vertices as an earlier one.
    pub duplicate_faces: usize,
    /// Vertices at the same position as an earlier one.
    pub duplicate_vertices: usize,
    /// Vertices that no face names.
    pub unused_vertices: usize,
}

impl Mesh {
    /// Counts what may be in the way of an algorithm.
    #[must_use]
    pub fn report(&self) -> MeshReport {
        // SKELETON: all counts are to be filled in.
        let degenerate = |face: &&[crate::VertexIdx; 3]| {
            let [a, b, c] = face.map(|vertex| self.positions()[vertex.index()]);
            (b - a).cross(c - a).length_squared() == 0.0
        };
        MeshReport {
            vertices: self.positions().len(),
            faces: self.faces().len(),
            degenerate_faces: self.faces().iter().filter(degenerate).count(),
            ..MeshReport::default()
        }
    }
}
