//! Counts mesh defects.

use crate::adjacency::{Adjacency, names_twice, sorted_edges};
use crate::triangle::area_vector;
use crate::{FaceIdx, Mesh, VertexIdx};

/// Counts of a mesh's elements and defects.
///
/// An edge is a pair of consecutive vertices of a face. Faces that contain a vertex twice contribute no edges and no
/// fans. All other faces count, including duplicates and faces with zero area.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshReport {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of faces.
    pub faces: usize,
    /// Number of connected components. Faces are connected across edges of exactly two faces, regardless of winding. A
    /// face that contains a vertex twice is a separate component. Sharing only a vertex, or an edge with a third face,
    /// does not connect faces.
    pub components: usize,
    /// Number of edges with exactly one face.
    pub boundary_edges: usize,
    /// Number of edges with three or more faces.
    pub non_manifold_edges: usize,
    /// Number of vertices whose faces do not form a single open or closed fan across edges of exactly two faces. The
    /// ends of a non-manifold edge always count; unused vertices do not.
    pub non_manifold_vertices: usize,
    /// Number of edges whose two faces traverse them in the same direction.
    pub winding_edges: usize,
    /// Number of faces that contain a vertex twice or have no area. A face has no area if twice its area is at most
    /// 2^-50 times the square of its longest edge, where rounding dominates the normal, or if that edge is shorter
    /// than 1e-60.
    pub degenerate_faces: usize,
    /// Number of faces with the same three vertices as an earlier face, in any order.
    pub duplicate_faces: usize,
    /// Number of faces at the same three positions as an earlier face with opposite winding: the two sides of a sheet.
    /// Faces at the same positions with equal winding do not count.
    pub back_to_back_faces: usize,
    /// Number of vertices at the position of an earlier vertex.
    pub duplicate_vertices: usize,
    /// Number of vertices without a face.
    pub unused_vertices: usize,
}

impl Mesh {
    /// Counts the mesh's elements and the defects that algorithms may not handle.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::{Mesh, glam::DVec3};
    ///
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let report = Mesh::new(corners, &[[0, 1, 2], [0, 1, 3]])?.report();
    /// assert_eq!((report.boundary_edges, report.winding_edges), (4, 1));
    /// # Ok::<(), dapple_mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn report(&self) -> MeshReport {
        self.report_and_adjacency().0
    }

    /// Returns the report, and the adjacency regardless of winding.
    pub(crate) fn report_and_adjacency(&self) -> (MeshReport, Adjacency) {
        let first_at_position = self.first_at_position();
        let mut report = MeshReport {
            vertices: self.positions().len(),
            faces: self.faces().len(),
            degenerate_faces: (0..self.faces().len())
                .filter(|&face| self.is_degenerate(FaceIdx(face as u32)))
                .count(),
            duplicate_faces: self
                .faces_by_vertices()
                .windows(2)
                .filter(|pair| pair[0].0 == pair[1].0)
                .count(),
            back_to_back_faces: self.back_to_back_faces(&first_at_position),
            duplicate_vertices: (0..)
                .zip(&first_at_position)
                .filter(|(vertex, first)| vertex != *first)
                .count(),
            ..MeshReport::default()
        };
        let adjacency = self.count_edges(&mut report);
        (report, adjacency)
    }

    /// Returns whether a face contains a vertex twice or has no area.
    pub(crate) fn is_degenerate(&self, face: FaceIdx) -> bool {
        names_twice(self.faces()[face.index()]) || area_vector(self.corners(face)).is_none()
    }

    /// Returns all faces with their vertices in ascending order, sorted so that faces with equal vertices are
    /// adjacent.
    pub(crate) fn faces_by_vertices(&self) -> Vec<([VertexIdx; 3], FaceIdx)> {
        let set = |mut corners: [VertexIdx; 3]| {
            corners.sort_unstable();
            corners
        };
        let corners = self.faces().iter().map(|&corners| set(corners));
        let mut faces: Vec<_> = corners.zip((0..).map(FaceIdx)).collect();
        faces.sort_unstable();
        faces
    }

    /// Returns the number of faces whose winding is opposite to that of the first face at the same positions.
    fn back_to_back_faces(&self, first_at_position: &[u32]) -> usize {
        let mut faces = Vec::with_capacity(self.faces().len());
        for (face, &corners) in (0..).map(FaceIdx).zip(self.faces()) {
            let mut corners = corners.map(|vertex| VertexIdx(first_at_position[vertex.index()]));
            if names_twice(corners) {
                continue;
            }
            // Starting at the lowest vertex, the order of the other two determines the winding.
            while corners[0] > corners[1].min(corners[2]) {
                corners.rotate_left(1);
            }
            let turned = corners[1] > corners[2];
            corners.sort_unstable();
            faces.push((corners, face, turned));
        }
        faces.sort_unstable();
        let others = |same: &[([VertexIdx; 3], FaceIdx, bool)]| {
            let first = same[0].2;
            same.iter().filter(|face| face.2 != first).count()
        };
        faces.chunk_by(|a, b| a.0 == b.0).map(others).sum()
    }

    /// Returns, for each vertex, the first vertex at the same position.
    pub(crate) fn first_at_position(&self) -> Vec<u32> {
        let positions = self.positions();
        let order = |&a: &u32, &b: &u32| {
            let [p, q] = [a, b].map(|vertex| positions[vertex as usize].to_array());
            // Positions are never NaN, so incomparable positions do not occur; zeros of both signs are equal.
            p.partial_cmp(&q)
                .unwrap_or(core::cmp::Ordering::Equal)
                .then(a.cmp(&b))
        };
        let mut vertices: Vec<u32> = (0..positions.len() as u32).collect();
        vertices.sort_unstable_by(order);
        let mut first = vec![0; positions.len()];
        for same in vertices.chunk_by(|&a, &b| positions[a as usize] == positions[b as usize]) {
            for &vertex in same {
                first[vertex as usize] = same[0];
            }
        }
        first
    }

    /// Counts the defects at edges and vertices, and returns the adjacency.
    fn count_edges(&self, report: &mut MeshReport) -> Adjacency {
        let edges = sorted_edges(self);
        for group in edges.chunk_by(|a, b| a.ends == b.ends) {
            match group {
                [_] => report.boundary_edges += 1,
                [a, b] => report.winding_edges += usize::from(a.forward == b.forward),
                _ => report.non_manifold_edges += 1,
            }
        }
        let adjacency = Adjacency::of_any_winding(self.faces().len(), &edges);
        let last = adjacency.components().into_iter().max();
        report.components = last.map_or(0, |last| last as usize + 1);
        // Count the fans of each vertex by their lowest corners.
        let mut used = vec![false; self.positions().len()];
        let mut n_fans = vec![0_u32; self.positions().len()];
        let fans = adjacency.fans(self);
        for (corners, fans) in self
            .faces()
            .iter()
            .zip((0..).step_by(3).zip(fans.chunks_exact(3)))
        {
            let (first, fans) = fans;
            for (corner, vertex) in corners.iter().enumerate() {
                used[vertex.index()] = true;
                let is_new = fans[corner] == first + corner && !names_twice(*corners);
                n_fans[vertex.index()] += u32::from(is_new);
            }
        }
        report.unused_vertices = used.iter().filter(|&&used| !used).count();
        report.non_manifold_vertices = n_fans.iter().filter(|&&count| count > 1).count();
        adjacency
    }
}

#[cfg(test)]
mod tests;
