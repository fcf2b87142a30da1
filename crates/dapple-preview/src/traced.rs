//! Triangle meshes prepared for ray tracing.

use crate::PreviewError;
use crate::shape::Detail;
use crate::surface::{Chart, Part, Triangle};
use core::fmt;
use dapple_mesh::{Bvh, Ray, RayHit};
use glam::DVec3;

/// An indexed triangle mesh with a bounding volume hierarchy.
///
/// Triangles are visible from both sides. Triangles of zero area are never hit. A mesh may be empty.
///
/// # Examples
///
/// ```
/// use dapple_preview::{Mesh, glam::DVec3};
///
/// let roof = Mesh::smooth(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], &[[0, 1, 2], [0, 2, 3]])?;
/// assert_eq!(roof.triangle_count(), 2);
/// # Ok::<(), dapple_preview::PreviewError>(())
/// ```
#[derive(Clone)]
pub struct Mesh {
    bvh: Bvh,
    mesh: dapple_mesh::Mesh,
    /// The unit normals of the vertices, zero for a vertex without a normal. Empty for a mesh of flat triangles.
    normals: Vec<DVec3>,
}

impl Mesh {
    /// Creates a mesh with smooth normals. Each vertex normal is the normalized, area-weighted sum of the adjacent
    /// triangles' normals.
    ///
    /// Triangles are counterclockwise seen from outside. Each consists of three vertex indices.
    ///
    /// # Errors
    ///
    /// [`PreviewErrorKind::Mesh`](crate::PreviewErrorKind::Mesh) if a component of a position is not finite or above
    /// 1e30, if an index is past the last vertex, or past 2^31 triangles.
    pub fn smooth(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, PreviewError> {
        let mesh = dapple_mesh::Mesh::new(positions.to_vec(), triangles)?;
        Ok(Self::from_mesh(mesh))
    }

    /// Creates a mesh of flat triangles, with visible edges.
    ///
    /// # Errors
    ///
    /// Same as [`smooth`](Self::smooth).
    pub fn flat(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, PreviewError> {
        let mesh = dapple_mesh::Mesh::new(positions.to_vec(), triangles)?;
        Ok(Self {
            bvh: Bvh::new(&mesh),
            mesh,
            normals: Vec::new(),
        })
    }

    /// Converts a mesh of `dapple_mesh`, with a normal at every vertex.
    #[must_use]
    pub fn from_mesh(mesh: dapple_mesh::Mesh) -> Self {
        Self {
            bvh: Bvh::new(&mesh),
            normals: mesh.vertex_normals(),
            mesh,
        }
    }

    /// Returns the number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.mesh.faces().len()
    }

    /// Returns the nearest triangle at a distance above zero and at most `limit`. If several are equally near, returns
    /// the one with the lowest index.
    pub(crate) fn first_hit(&self, ray: &Ray, limit: f64) -> Option<RayHit> {
        self.bvh.first_hit(ray, limit)
    }

    /// Returns whether a ray hits a triangle at a distance above zero and below `limit`.
    pub(crate) fn is_blocked(&self, ray: &Ray, limit: f64) -> bool {
        self.bvh.is_blocked(ray, limit)
    }

    /// Returns the surface normals at a hit, and the origin of its shadow rays.
    pub(crate) fn detail(&self, position: DVec3, hit: &RayHit) -> Detail {
        let corners = self.mesh.corners(hit.face);
        let [a, b, c] = corners;
        let geometric_normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
        let mut detail = Detail {
            position,
            geometric_normal,
            normal: geometric_normal,
            part: Part::Skin,
            chart: Chart::Triangle(Triangle {
                index: hit.face.0,
                weights: hit.weights,
            }),
            lit_position: position,
        };
        if self.normals.is_empty() {
            return detail;
        }
        let vertices = self.mesh.faces()[hit.face.index()];
        let normals = vertices.map(|vertex| self.normals[vertex.index()]);
        let weighted = |values: [DVec3; 3]| {
            values[0] * hit.weights[0] + values[1] * hit.weights[1] + values[2] * hit.weights[2]
        };
        detail.normal = weighted(normals).normalize_or(geometric_normal);
        // Johannes Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4, 2021: shadow rays start
        // from the mean of the point's projections to the tangent planes of the normals at the corners, where those are
        // above the triangle.
        let side = if detail.normal.dot(geometric_normal) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let lift = |corner: usize| {
            let below = (position - corners[corner]).dot(normals[corner]) * side;
            normals[corner] * (side * -below.min(0.0))
        };
        detail.lit_position += weighted([lift(0), lift(1), lift(2)]);
        detail
    }
}

impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.triangle_count();
        write!(f, "Mesh({count} triangles)")
    }
}

#[cfg(test)]
mod tests;
