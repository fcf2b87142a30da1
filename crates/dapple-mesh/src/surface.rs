//! Surfaces, whose faces are unfolded into planes with transitions to the planes of their neighbors.
//!
//! The plane of a face has the first corner at the origin and the second on the positive x axis. The transition to a
//! neighbor is the rigid motion that unfolds it about the shared edge.
//!
//! All quantities are computed from differences of positions. Needles and flat triangles down to the limit of
//! [`MeshReport::degenerate_faces`](crate::MeshReport::degenerate_faces) therefore have orthonormal axes, and
//! rotations that are accurate to a few roundings. Positions are accurate to a few rounding errors of their longest
//! edge.
//!
//! Reference: our own; Greg Turk, SIGGRAPH 1991, doi 10.1145/127719.122749, moves points by unfolding across edges.

mod flat;

use crate::adjacency::{Adjacency, FaceEdge};
use crate::{FaceIdx, Mesh, MeshError, MeshErrorKind};
use flat::fold;
pub(crate) use flat::{EdgeTransition, FaceFrame};
use glam::{DVec2, DVec3};

/// A mesh with planar coordinates in every face, for points on the surface and paths across it.
///
/// Paths end at borders (see [`Adjacency`]). The mesh may be open or have several pieces.
#[derive(Clone, Debug)]
pub struct Surface {
    mesh: Mesh,
    adjacency: Adjacency,
    flats: Vec<FaceFrame>,
    vertex_normals: Vec<DVec3>,
    area: f64,
}

/// A point on a surface: a face and coordinates in its plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePoint {
    /// Face that contains the point.
    pub face: FaceIdx,
    /// Coordinates in the plane of the face, in units of the mesh. The first corner is at the origin, the second is on
    /// the positive x axis, and the third has a positive y.
    pub flat: DVec2,
}

impl Surface {
    /// Computes the planes of all faces of a mesh.
    ///
    /// # Errors
    ///
    /// [`MeshErrorKind::Defects`] if there are faces with zero area, duplicate faces, or edges with inconsistent
    /// winding: [`Mesh::repair`] fixes them. [`MeshErrorKind::NoArea`] for a mesh without faces.
    pub fn new(mesh: Mesh) -> Result<Self, MeshError> {
        // With consistent winding, this adjacency equals `Adjacency::new`.
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
        // The report has verified that all faces have an area.
        let mut flats: Vec<FaceFrame> = faces()
            .filter_map(|face| FaceFrame::new(mesh.corners(face)))
            .collect();
        if flats.is_empty() {
            return Err(MeshError::new(MeshErrorKind::NoArea));
        }
        // Compute the transition across every edge.
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

    /// Returns the underlying mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Returns the adjacency of the faces.
    #[must_use]
    pub fn adjacency(&self) -> &Adjacency {
        &self.adjacency
    }

    /// Returns the total area of all faces, in squared units of the mesh.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns the area of a face, in squared units of the mesh.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[must_use]
    pub fn face_area(&self, face: FaceIdx) -> f64 {
        self.flats[face.index()].area()
    }

    /// Returns the connected component of each face; walks never leave a component.
    ///
    /// Components are numbered from 0 in the order of their lowest face index.
    #[must_use]
    pub fn components(&self) -> Vec<u32> {
        self.adjacency.components()
    }

    /// Returns the areas of the components, in squared units of the mesh.
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

    /// Returns the unit normal of a face.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[inline]
    #[must_use]
    pub fn face_normal(&self, face: FaceIdx) -> DVec3 {
        let flat = &self.flats[face.index()];
        flat.x.cross(flat.y)
    }

    /// Returns the position in space of a point on the surface.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[inline]
    #[must_use]
    pub fn position(&self, point: SurfacePoint) -> DVec3 {
        let flat = &self.flats[point.face.index()];
        flat.origin + flat.x * point.flat.x + flat.y * point.flat.y
    }

    /// Returns the smooth unit normal at a point, interpolated between the vertex normals.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[must_use]
    pub fn normal(&self, point: SurfacePoint) -> DVec3 {
        let [a, b, c] = self.weights(point);
        let [na, nb, nc] =
            self.mesh.faces()[point.face.index()].map(|vertex| self.vertex_normals[vertex.index()]);
        (na * a + nb * b + nc * c).normalize_or(self.face_normal(point.face))
    }

    /// Returns the barycentric weights of a point, which sum to 1. Inside the face, they are at least 0, up to the
    /// rounding error of the longest edge relative to the height of the face.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[must_use]
    pub fn weights(&self, point: SurfacePoint) -> [f64; 3] {
        let flat = &self.flats[point.face.index()];
        let c = point.flat.y / flat.apex.y;
        let b = (point.flat.x - flat.apex.x * c) / flat.width;
        [1.0 - b - c, b, c]
    }

    /// Returns the point on a face with the given barycentric weights.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[must_use]
    pub fn point(&self, face: FaceIdx, [_, b, c]: [f64; 3]) -> SurfacePoint {
        let flat = &self.flats[face.index()];
        SurfacePoint {
            face,
            flat: DVec2::new(flat.width, 0.0) * b + flat.apex * c,
        }
    }

    /// Projects a position orthogonally onto the plane of a face.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
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

    /// Projects a vector orthogonally onto the plane of a face, and returns it in the plane's coordinates.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
    #[inline]
    #[must_use]
    pub fn flatten(&self, face: FaceIdx, vector: DVec3) -> DVec2 {
        let flat = &self.flats[face.index()];
        DVec2::new(vector.dot(flat.x), vector.dot(flat.y))
    }

    /// Converts a vector from the plane of a face to space.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
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
