//! Corner normals that are smooth across blunt edges and split at sharp ones.
//!
//! Original method; modeling programs call it auto smooth by angle.

use crate::adjacency::{Adjacency, FaceEdge};
use crate::{FaceIdx, Mesh};
use glam::DVec3;

/// Default crease angle in radians: 30 degrees. Edges with a larger angle between their faces are shaded as creases.
pub const CREASE: f64 = core::f64::consts::FRAC_PI_6;

impl Mesh {
    /// Returns the unit normals of the corners of all faces, split at creases. A crease is an edge whose faces have
    /// normals that differ by more than `crease`, in radians.
    ///
    /// Corners at a vertex whose faces are connected without a crease share one normal: the area-weighted sum of the
    /// normals of these faces, normalized, or zero if the sum is zero. Edges of one face, or of three or more faces,
    /// are also creases.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::{CREASE, Mesh, glam::DVec3};
    ///
    /// let roof = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], &[[0, 1, 2], [0, 2, 3]])?;
    /// assert_eq!(roof.corner_normals(CREASE), [[DVec3::Z; 3], [DVec3::X; 3]]);
    /// # Ok::<(), dapple_mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn corner_normals(&self, crease: f64) -> Vec<[DVec3; 3]> {
        let cos = libm::cos(crease);
        // Face normals, with lengths of twice the areas.
        let normals: Vec<DVec3> = (0..self.faces.len() as u32)
            .map(|face| {
                let [a, b, c] = self.corners(FaceIdx(face));
                (b - a).cross(c - a)
            })
            .collect();
        // Separate neighbors at creases.
        let mut adjacency = Adjacency::new(self);
        for face in (0..self.faces.len() as u32).map(FaceIdx) {
            for edge in 0..3 {
                let from = FaceEdge { face, edge };
                if let Some(to) = adjacency.across(from) {
                    let [here, there] = [face, to.face].map(|face| normals[face.index()]);
                    if here.dot(there) < cos * (here.length() * there.length()) {
                        adjacency.set(from, None);
                        adjacency.set(to, None);
                    }
                }
            }
        }
        // Sum the face normals of each fan.
        let fans = adjacency.fans(self);
        let mut sums = vec![DVec3::ZERO; fans.len()];
        for (corner, &fan) in fans.iter().enumerate() {
            sums[fan] += normals[corner / 3];
        }
        let normal = |&fan: &usize| sums[fan].normalize_or_zero();
        let corners = fans.chunks_exact(3);
        corners
            .map(|corners| [0, 1, 2].map(|corner| normal(&corners[corner])))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::{cube, plane, tetrahedron};

    #[test]
    fn corners_of_a_cube_have_the_normals_of_their_sides() {
        let cube = cube();
        let flat = cube.corner_normals(CREASE);
        for (face, corners) in (0..).map(FaceIdx).zip(&flat) {
            let [a, b, c] = cube.corners(face);
            let normal = (b - a).cross(c - a).normalize();
            assert!(corners.iter().all(|&corner| corner == normal), "{face:?}");
        }
    }

    #[test]
    fn corners_have_the_normals_of_vertices_where_no_edge_is_a_crease() {
        for mesh in [cube(), tetrahedron(), plane(3, 2)] {
            let normals = mesh.vertex_normals();
            let smooth = mesh.corner_normals(core::f64::consts::PI);
            for (face, corners) in mesh.faces().iter().zip(smooth) {
                for (vertex, corner) in face.iter().zip(corners) {
                    // Both are sums of the same vectors in the same order.
                    assert_eq!(corner, normals[vertex.index()]);
                }
            }
        }
    }
}
