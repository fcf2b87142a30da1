//! A mesh that can be walked on: every face laid out flat, and how its neighbors continue it.
//!
//! Every face has a plane with the first corner at the origin and the second on the positive x axis. Planes of neighbors
//! are joined by the rigid motion that lays the other face beside this one, unfolded about their edge.
//!
//! All is worked out from differences of positions, so that needles and flat triangles down to the limit that
//! [`MeshReport::degenerate_faces`](crate::MeshReport::degenerate_faces) states have unit axes at right angles and turns
//! that are right to a few roundings; their places are right to a few roundings of their longest edge.
//!
//! Reference: our own; unfolding over edges is what Greg Turk, SIGGRAPH 1991, doi 10.1145/127719.122749, walks by.

mod flat;

use crate::adjacency::{Adjacency, FaceEdge};
use crate::{FaceIdx, Mesh, MeshError, MeshErrorKind};
use flat::fold;
pub(crate) use flat::{EdgeTransition, FaceFrame};
use glam::{DVec2, DVec3};

/// A mesh whose faces are laid out flat, so that points on it have a place and paths can be followed.
///
/// Borders (see [`Adjacency`]) are where paths end; the mesh need not be closed or in one piece.
#[derive(Clone, Debug)]
pub struct Surface {
    mesh: Mesh,
    adjacency: Adjacency,
    flats: Vec<FaceFrame>,
    vertex_normals: Vec<DVec3>,
    area: f64,
}

/// A point on a surface: a face and a place in its plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePoint {
    /// The face.
    pub face: FaceIdx,
    /// The place in the plane of the face: the first corner is at the origin, the second on the positive x axis, and the
    /// third has a positive y. In units of the mesh.
    pub flat: DVec2,
}

impl Surface {
    /// Lays out a mesh.
    ///
    /// # Errors
    ///
    /// [`MeshErrorKind::Defects`] if there are faces without an area, duplicate faces, or edges whose two faces go around
    /// different sides: [`Mesh::repair`] mends them. [`MeshErrorKind::NoArea`] for a mesh without faces.
    pub fn new(mesh: Mesh) -> Result<Self, MeshError> {
        // Where no windings differ, the neighbors are those of `Adjacency::new`.
        let (report, adjacency) = mesh.report_and_adjacency();
        let (degenerate, duplicate, winding) = (
            report.degenerate_faces,
            report.duplicate_faces,
            report.winding_edges,
        );
        if degenerate + duplicate + winding > 0 {
            return Err(MeshError::new(MeshErrorKind::Defects {
                degenerate,
                duplicate,
                winding,
            }));
        }
        let faces = || (0..mesh.faces().len() as u32).map(FaceIdx);
        // The report has found that all faces have an area.
        let mut flats: Vec<FaceFrame> = faces()
            .filter_map(|face| FaceFrame::new(mesh.corners(face)))
            .collect();
        if flats.is_empty() {
            return Err(MeshError::new(MeshErrorKind::NoArea));
        }
        for face in faces() {
            let corners = mesh.corners(face);
            for edge in 0..3 {
                let start = usize::from(edge);
                let along = corners[(start + 1) % 3] - corners[start];
                let to = adjacency.across(FaceEdge { face, edge });
                flats[face.index()].across[start] = to.map(|to| {
                    fold(
                        &flats[face.index()],
                        edge,
                        &flats[to.face.index()],
                        to,
                        along,
                    )
                });
            }
        }
        Ok(Self {
            area: flats.iter().map(FaceFrame::area).sum(),
            vertex_normals: mesh.vertex_normals(),
            mesh,
            adjacency,
            flats,
        })
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Which faces share which edges.
    #[must_use]
    pub fn adjacency(&self) -> &Adjacency {
        &self.adjacency
    }

    /// The area of all faces, in squared units of the mesh.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The area of a face.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn face_area(&self, face: FaceIdx) -> f64 {
        self.flats[face.index()].area()
    }

    /// For each face the number of its component, the set of faces that can be walked to from it.
    ///
    /// Components are numbered from 0 in the order of their lowest faces.
    #[must_use]
    pub fn components(&self) -> Vec<u32> {
        self.adjacency.components()
    }

    /// The areas of the components, in squared units of the mesh.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::{Mesh, Surface, glam::DVec3};
    ///
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let surface = Surface::new(Mesh::new(corners, &[[0, 1, 2], [1, 0, 3]])?)?;
    /// assert_eq!((surface.components(), surface.component_areas()), (vec![0, 0], vec![1.0]));
    /// # Ok::<(), dapple_mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn component_areas(&self) -> Vec<f64> {
        let mut areas = Vec::new();
        for (component, flat) in self.components().into_iter().zip(&self.flats) {
            if component as usize == areas.len() {
                areas.push(0.0);
            }
            areas[component as usize] += flat.area();
        }
        areas
    }

    /// The unit normal of a face.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    #[must_use]
    pub fn face_normal(&self, face: FaceIdx) -> DVec3 {
        let flat = &self.flats[face.index()];
        flat.x.cross(flat.y)
    }

    /// Where a point is in space.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    #[must_use]
    pub fn position(&self, point: SurfacePoint) -> DVec3 {
        let flat = &self.flats[point.face.index()];
        flat.origin + flat.x * point.flat.x + flat.y * point.flat.y
    }

    /// The unit normal of the smooth surface at a point: those of the corners, mixed.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn normal(&self, point: SurfacePoint) -> DVec3 {
        let [a, b, c] = self.weights(point);
        let [na, nb, nc] =
            self.mesh.faces()[point.face.index()].map(|vertex| self.vertex_normals[vertex.index()]);
        (na * a + nb * b + nc * c).normalize_or(self.face_normal(point.face))
    }

    /// The weights of the three corners of the face that give the point; they sum to 1, and are at least 0 inside, but for
    /// roundings of the longest edge over the height of the face.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn weights(&self, point: SurfacePoint) -> [f64; 3] {
        let flat = &self.flats[point.face.index()];
        let c = point.flat.y / flat.apex.y;
        let b = (point.flat.x - flat.apex.x * c) / flat.width;
        [1.0 - b - c, b, c]
    }

    /// The point of a face with these weights of its corners.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn point(&self, face: FaceIdx, [_, b, c]: [f64; 3]) -> SurfacePoint {
        let flat = &self.flats[face.index()];
        SurfacePoint {
            face,
            flat: DVec2::new(flat.width, 0.0) * b + flat.apex * c,
        }
    }

    /// The point of the plane of a face that is nearest to a position.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    #[must_use]
    pub fn project(&self, face: FaceIdx, position: DVec3) -> SurfacePoint {
        let flat = &self.flats[face.index()];
        let from = position - flat.origin;
        SurfacePoint {
            face,
            flat: DVec2::new(from.dot(flat.x), from.dot(flat.y)),
        }
    }

    /// The part of a vector in the plane of a face, in the coordinates of that plane.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    #[must_use]
    pub fn flatten(&self, face: FaceIdx, vector: DVec3) -> DVec2 {
        let flat = &self.flats[face.index()];
        DVec2::new(vector.dot(flat.x), vector.dot(flat.y))
    }

    /// A vector in the plane of a face, in space.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    #[must_use]
    pub fn lift(&self, face: FaceIdx, vector: DVec2) -> DVec3 {
        let flat = &self.flats[face.index()];
        flat.x * vector.x + flat.y * vector.y
    }

    #[inline]
    pub(crate) fn flat(&self, face: FaceIdx) -> &FaceFrame {
        &self.flats[face.index()]
    }
}

#[cfg(test)]
mod tests;
