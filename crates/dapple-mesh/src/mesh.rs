//! Triangles that share vertices.

use crate::{MeshError, MeshErrorKind, VertexIdx};
use glam::DVec3;

/// The largest part of a position, so that squares and their sums stay finite.
const POSITION_MAX: f64 = 1e30;
/// The most vertices and the most faces: indices and twice their number fit 32 bits.
const COUNT_MAX: usize = 1 << 31;

/// A triangle mesh: positions of vertices, and three vertices for each face.
///
/// A face goes around its outside counterclockwise. Nothing else is promised: a mesh may be empty or open, in several
/// pieces, and have defects, which [`report`](Self::report) counts and [`repair`](Self::repair) mends.
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
    positions: Vec<DVec3>,
    faces: Vec<[VertexIdx; 3]>,
}

impl Mesh {
    /// The mesh with these positions and, for each face, the numbers of its three vertices.
    ///
    /// # Errors
    ///
    /// [`MeshErrorKind::Position`] if a part of a position is not finite or beyond 1e30, [`MeshErrorKind::Corner`] if a
    /// face names no vertex, [`MeshErrorKind::Count`] past 2^31 vertices or faces.
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
            // NaN is not at most anything.
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

    /// The positions of the vertices, in the order of [`VertexIdx`].
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The vertices of the faces, in the order of [`FaceIdx`](crate::FaceIdx).
    #[must_use]
    pub fn faces(&self) -> &[[VertexIdx; 3]] {
        &self.faces
    }

    /// The corners of a face.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn corners(&self, face: crate::FaceIdx) -> [DVec3; 3] {
        self.faces[face.index()].map(|vertex| self.positions[vertex.index()])
    }

    /// The unit normals of the vertices: the sum of those of their faces, weighted by area; zero where there is none.
    #[must_use]
    pub fn vertex_normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.positions.len()];
        for face in &self.faces {
            let [a, b, c] = face.map(|vertex| self.positions[vertex.index()]);
            // As long as twice the area.
            let normal = (b - a).cross(c - a);
            for vertex in face {
                normals[vertex.index()] += normal;
            }
        }
        normals.into_iter().map(DVec3::normalize_or_zero).collect()
    }
}
