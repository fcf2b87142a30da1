//! Triangle meshes, ready for rays.

mod build;
mod bvh;
mod triangle;

use crate::ray::Ray;
use crate::shape::Detail;
use crate::surface::{Chart, Part};
use crate::{PreviewError, PreviewErrorKind};
use build::Bounds;
use bvh::Bvh;
use core::fmt;
use glam::DVec3;
use triangle::{Corners, Probe};

/// Triangles that share vertices, with a hierarchy of boxes around them.
///
/// Triangles are seen from both sides. A triangle without an area is never met, and a mesh may be empty.
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
    /// The corners of the triangles in the order of the hierarchy.
    corners: Vec<Corners>,
    /// The unit normals of the vertices, or nothing for a mesh with flat triangles; zero where there is none.
    normals: Vec<DVec3>,
    /// The vertices of the triangles in the order of the caller.
    triangles: Vec<[u32; 3]>,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeshHit {
    pub(crate) distance: f64,
    /// Where the triangle is in the order of the hierarchy.
    slot: u32,
    /// The index of the triangle in the order of the caller.
    triangle: u32,
    /// The weights of the three corners, which sum to 1.
    weights: [f64; 3],
}

impl Mesh {
    /// A mesh with a normal at every vertex: the sum of those of its triangles, weighted by their areas.
    ///
    /// Triangles that go around their outside counterclockwise agree about it; each holds three indices of vertices.
    ///
    /// # Errors
    ///
    /// [`PreviewErrorKind::Range`] if a part of a position is not finite or above 1e30,
    /// [`PreviewErrorKind::Corner`] if an index is past the last vertex, [`PreviewErrorKind::Count`] past 2^31 triangles.
    pub fn smooth(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, PreviewError> {
        let mut mesh = Self::flat(positions, triangles)?;
        let mut normals = vec![DVec3::ZERO; positions.len()];
        for triangle in triangles {
            let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
            // As long as twice the area.
            let normal = (b - a).cross(c - a);
            for &vertex in triangle {
                normals[vertex as usize] += normal;
            }
        }
        mesh.normals = normals.into_iter().map(DVec3::normalize_or_zero).collect();
        Ok(mesh)
    }

    /// A mesh of flat triangles, with an edge wherever two meet.
    ///
    /// # Errors
    ///
    /// As [`smooth`](Self::smooth).
    pub fn flat(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, PreviewError> {
        let limit = 1 << 31;
        for (what, count) in [
            ("vertices", positions.len()),
            ("triangles", triangles.len()),
        ] {
            if count > limit {
                let kind = PreviewErrorKind::Count { what, count, limit };
                return Err(PreviewError::new(kind));
            }
        }
        for &position in positions {
            PreviewError::check_vector("position of a vertex", position)?;
        }
        let count = positions.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
                return Err(PreviewError::new(PreviewErrorKind::Corner {
                    triangle,
                    vertex,
                    count,
                }));
            }
        }
        let corners_of = |triangle: &[u32; 3]| triangle.map(|vertex| positions[vertex as usize]);
        let bounds = triangles
            .iter()
            .map(|triangle| Bounds::around(&corners_of(triangle)))
            .collect();
        let bvh = Bvh::new(bounds);
        let in_order = |&index: &u32| Corners::new(corners_of(&triangles[index as usize]));
        Ok(Self {
            corners: bvh.order().iter().map(in_order).collect(),
            bvh,
            normals: Vec::new(),
            triangles: triangles.to_vec(),
        })
    }

    /// The number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The nearest triangle at a distance above zero and at most `limit`; of several at one distance the one with the
    /// lowest index.
    pub(crate) fn nearest(&self, ray: &Ray, limit: f64) -> Option<MeshHit> {
        let (ray, shift) = self.near_ray(ray);
        let probe = Probe::new(&ray);
        let mut best: Option<MeshHit> = None;
        self.bvh.visit(&ray, -shift, limit - shift, |slots| {
            for slot in slots {
                if let Some(hit) = self.meet(&probe, shift, slot)
                    && hit.distance <= limit
                    && best.is_none_or(|best| hit.is_before(&best))
                {
                    best = Some(hit);
                }
            }
            best.map(|best| best.distance - shift)
        });
        best
    }

    /// Whether a triangle is at a distance above zero and below `limit`.
    pub(crate) fn blocks(&self, ray: &Ray, limit: f64) -> bool {
        let (ray, shift) = self.near_ray(ray);
        let probe = Probe::new(&ray);
        let mut blocked = false;
        self.bvh.visit(&ray, -shift, limit - shift, |mut slots| {
            blocked |= slots.any(|slot| {
                let hit = self.meet(&probe, shift, slot);
                hit.is_some_and(|hit| hit.distance < limit)
            });
            // No box is nearer than this, so that the search ends.
            blocked.then_some(f64::NEG_INFINITY)
        });
        blocked
    }

    /// The normals of the surface at a hit, and where its shadow rays start.
    pub(crate) fn detail(&self, position: DVec3, hit: &MeshHit) -> Detail {
        let corners = self.corners[hit.slot as usize].positions();
        let [a, b, c] = corners;
        let geometric_normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
        let mut detail = Detail {
            position,
            geometric_normal,
            normal: geometric_normal,
            part: Part::Skin,
            chart: Chart::None,
            lit_position: position,
        };
        if self.normals.is_empty() {
            return detail;
        }
        let vertices = self.triangles[hit.triangle as usize];
        let normals = vertices.map(|vertex| self.normals[vertex as usize]);
        let weighted = |values: [DVec3; 3]| {
            values[0] * hit.weights[0] + values[1] * hit.weights[1] + values[2] * hit.weights[2]
        };
        detail.normal = weighted(normals).normalize_or(geometric_normal);
        // Johannes Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4, 2021: shadow rays start from
        // the mean of the point's projections to the planes that the normals of the corners stand for, where those are
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

    /// The ray from its point nearest to the middle of the mesh, from which distances are about the size of the mesh, so
    /// that rounding is small beside the margin of the boxes; and how far that is along the ray.
    fn near_ray(&self, ray: &Ray) -> (Ray, f64) {
        let shift = (self.bvh.middle() - ray.origin).dot(ray.direction);
        let origin = ray.at(shift);
        let direction = ray.direction;
        (Ray { origin, direction }, shift)
    }

    /// The hit of one triangle, if it is at a distance above zero.
    fn meet(&self, probe: &Probe, shift: f64, slot: u32) -> Option<MeshHit> {
        let (distance, weights) = probe.meet(&self.corners[slot as usize])?;
        let distance = distance + shift;
        (distance > 0.0).then(|| MeshHit {
            distance,
            slot,
            triangle: self.bvh.order()[slot as usize],
            weights,
        })
    }
}

impl MeshHit {
    fn is_before(&self, other: &Self) -> bool {
        self.distance < other.distance
            || (self.distance == other.distance && self.triangle < other.triangle)
    }
}

impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.triangles.len();
        write!(f, "Mesh({count} triangles)")
    }
}

#[cfg(test)]
mod tests;
