//! Triangle meshes with shared vertices.

use crate::{MeshError, MeshErrorKind, VertexIdx};
use glam::DVec3;

/// Maximum absolute value of a coordinate, 1e30: squares and their sums stay finite.
pub const POSITION_MAX: f64 = 1e30;
/// Maximum number of vertices and of faces: indices and twice their number fit 32 bits.
const COUNT_MAX: usize = 1 << 31;

/// A triangle mesh with vertex positions and three vertex indices per face.
///
/// Faces are counterclockwise seen from outside. There are no other guarantees: a mesh may be empty or open, have
/// several pieces, and have defects. [`report`](Self::report) counts the defects and [`repair`](Self::repair) fixes
/// them.
///
/// # Examples
///
/// ```
/// use dapple_mesh::{Mesh, glam::DVec3};
///
/// let roof = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], &[[0, 1, 2], [0, 2, 3]])?;
/// assert_eq!(roof.faces().len(), 2);
/// # Ok::<(), dapple_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) faces: Vec<[VertexIdx; 3]>,
}

impl Mesh {
    /// Creates a mesh from positions and, for each face, the indices of its three vertices.
    ///
    /// # Errors
    ///
    /// [`MeshErrorKind::Position`] if a coordinate is not finite or beyond 1e30, [`MeshErrorKind::Corner`] if a face
    /// refers to a missing vertex, [`MeshErrorKind::Count`] for more than 2^31 vertices or faces.
    pub fn new(positions: Vec<DVec3>, faces: &[[u32; 3]]) -> Result<Self, MeshError> {
        for (what, count) in [("vertices", positions.len()), ("faces", faces.len())] {
            if count > COUNT_MAX {
                let needed = "at most 2^31";
                return Err(MeshError::new(MeshErrorKind::Count {
                    what,
                    count,
                    needed,
                }));
            }
        }
        for (vertex, position) in positions.iter().enumerate() {
            // A comparison with NaN is `None`, which is rejected.
            let refused = |part: &f64| !matches!(part.abs().partial_cmp(&POSITION_MAX), Some(order) if order.is_le());
            if let Some(value) = position.to_array().into_iter().find(refused) {
                return Err(MeshError::new(MeshErrorKind::Position { vertex, value }));
            }
        }
        let count = positions.len();
        for (face, corners) in faces.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
                return Err(MeshError::new(MeshErrorKind::Corner {
                    face,
                    vertex,
                    count,
                }));
            }
        }
        let faces = faces.iter().map(|face| face.map(VertexIdx)).collect();
        Ok(Self { positions, faces })
    }

    /// Returns the positions of the vertices, in the order of [`VertexIdx`].
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Returns the vertices of the faces, in the order of [`FaceIdx`](crate::FaceIdx).
    #[must_use]
    pub fn faces(&self) -> &[[VertexIdx; 3]] {
        &self.faces
    }

    /// Returns the positions of the corners of a face.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[must_use]
    pub fn corners(&self, face: crate::FaceIdx) -> [DVec3; 3] {
        self.faces[face.index()].map(|vertex| self.positions[vertex.index()])
    }

    /// Returns the unit normals of the vertices: area-weighted sums of the normals of their faces, normalized; zero
    /// if the sum is zero.
    #[must_use]
    pub fn vertex_normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.positions.len()];
        for face in &self.faces {
            let [a, b, c] = face.map(|vertex| self.positions[vertex.index()]);
            // The length is twice the area.
            let normal = (b - a).cross(c - a);
            for vertex in face {
                normals[vertex.index()] += normal;
            }
        }
        normals.into_iter().map(DVec3::normalize_or_zero).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FaceIdx;
    use crate::test_meshes::{cube, mesh, plane};

    fn refused(positions: Vec<DVec3>, faces: &[[u32; 3]]) -> MeshErrorKind {
        Mesh::new(positions, faces)
            .expect_err("it is refused")
            .kind()
            .clone()
    }

    #[test]
    fn mesh_refuses_positions_that_are_not_finite_or_too_large() {
        for value in [f64::NAN, f64::INFINITY, -1.1e30] {
            for axis in 0..3 {
                let mut parts = [1.0, -1e30, 1e30];
                parts[axis] = value;
                let kind = refused(vec![DVec3::ONE, DVec3::from_array(parts)], &[]);
                let MeshErrorKind::Position {
                    vertex: 1,
                    value: got,
                } = kind
                else {
                    panic!("{kind:?}")
                };
                assert_eq!(got.to_bits(), value.to_bits(), "the part");
            }
        }
        assert!(
            Mesh::new(vec![DVec3::splat(-1e30)], &[]).is_ok(),
            "the limit"
        );
    }

    #[test]
    fn mesh_refuses_corners_that_name_no_vertex() {
        let kind = refused(vec![DVec3::ZERO; 3], &[[0, 1, 2], [2, 3, 0]]);
        let want = MeshErrorKind::Corner {
            face: 1,
            vertex: 3,
            count: 3,
        };
        assert_eq!(kind, want);
        assert!(
            matches!(
                refused(vec![], &[[0, 0, u32::MAX]]),
                MeshErrorKind::Corner { count: 0, .. }
            ),
            "empty"
        );
    }

    #[test]
    fn mesh_gives_back_what_it_was_made_of() {
        let mesh = mesh(&[[0.0; 3], [1.0, 2.0, 3.0], [0.5, 0.0, 0.0]], &[[2, 0, 1]]);
        let corners = [
            DVec3::new(0.5, 0.0, 0.0),
            DVec3::ZERO,
            DVec3::new(1.0, 2.0, 3.0),
        ];
        assert_eq!(mesh.corners(FaceIdx(0)), corners);
        assert_eq!(
            (mesh.positions().len(), mesh.faces()),
            (3, &[[2, 0, 1].map(VertexIdx)][..])
        );
    }

    #[test]
    fn vertex_normals_are_weighted_by_area_and_zero_where_nothing_is() {
        assert_eq!(plane(2, 2).vertex_normals(), vec![DVec3::Z; 9], "flat");
        // At the first corner, all three sides have one or two of their triangles.
        let normal = cube().vertex_normals()[0];
        assert!(normal.max_element() < 0.0, "outward");
        let alone = mesh(
            &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [5.0; 3]],
            &[[0, 1, 2], [1, 1, 2]],
        );
        assert_eq!(alone.vertex_normals(), vec![DVec3::ZERO; 4], "no area");
    }

    #[test]
    fn vertex_normals_are_unit_vectors_at_all_scales() {
        for scale in [1e-59, 1e-20, 1.0, 1e30] {
            let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
                .map(|corner| corner.map(|part| part * scale));
            assert_eq!(
                mesh(&corners, &[[0, 1, 2]]).vertex_normals(),
                vec![DVec3::Z; 3],
                "{scale}"
            );
        }
    }
}
