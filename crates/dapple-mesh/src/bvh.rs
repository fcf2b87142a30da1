//! Which face a ray meets first, and which point of a mesh is nearest.

mod build;
mod tree;
mod triangle;

use crate::{FaceIdx, Mesh};
use build::Bounds;
use core::fmt;
use glam::DVec3;
use tree::Tree;
use triangle::{Corners, Probe, nearest_weights};

/// A half line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The position where the ray begins.
    pub origin: DVec3,
    /// The direction of the ray, of length 1, so that a parameter along it is a distance.
    pub direction: DVec3,
}

/// Where a ray meets a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// How far along the ray, above zero.
    pub distance: f64,
    /// The face.
    pub face: FaceIdx,
    /// The weights of its corners, which sum to 1.
    pub weights: [f64; 3],
}

/// The point of a mesh nearest to a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// The point.
    pub position: DVec3,
    /// Its distance from the position, squared.
    pub distance_sq: f64,
    /// Its face.
    pub face: FaceIdx,
    /// The weights of the corners of the face, which sum to 1.
    pub weights: [f64; 3],
}

/// A hierarchy of boxes around the faces of a mesh (a bounding volume hierarchy), for rays and nearest points.
///
/// Answers are those of a search through all faces, to the last bit; of several faces at one distance it is the one with
/// the lowest index. Faces are seen from both sides, and those without an area are never met by a ray.
///
/// # Examples
///
/// ```
/// use dapple_mesh::{Bvh, Mesh, Ray, glam::DVec3};
///
/// let mesh = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let bvh = Bvh::new(&mesh);
/// let ray = Ray { origin: DVec3::new(0.25, 0.25, 2.0), direction: DVec3::NEG_Z };
/// assert_eq!(bvh.first_hit(&ray, f64::INFINITY).map(|hit| hit.distance), Some(2.0));
/// # Ok::<(), dapple_mesh::MeshError>(())
/// ```
#[derive(Clone)]
pub struct Bvh {
    tree: Tree,
    /// The corners of the faces in the order of the tree.
    corners: Vec<Corners>,
}

impl Ray {
    /// The point at a distance from the origin.
    #[inline]
    #[must_use]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }
}

impl Bvh {
    /// Builds the hierarchy; the mesh may be empty.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let faces = (0..mesh.faces().len() as u32).map(FaceIdx);
        let bounds = faces.map(|face| Bounds::around(&mesh.corners(face)));
        let tree = Tree::new(bounds.collect());
        let in_order = |&face: &u32| Corners::new(mesh.corners(FaceIdx(face)));
        Self {
            corners: tree.order().iter().map(in_order).collect(),
            tree,
        }
    }

    /// The nearest face on a ray, at a distance above zero and at most `limit`.
    #[must_use]
    pub fn first_hit(&self, ray: &Ray, limit: f64) -> Option<RayHit> {
        let (ray, shift) = self.near_ray(ray);
        let probe = Probe::new(&ray);
        let mut best: Option<RayHit> = None;
        self.tree.visit(&ray, -shift, limit - shift, |slots| {
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

    /// Whether a face is on a ray at a distance above zero and below `limit`.
    #[must_use]
    pub fn is_blocked(&self, ray: &Ray, limit: f64) -> bool {
        let (ray, shift) = self.near_ray(ray);
        let probe = Probe::new(&ray);
        let mut blocked = false;
        self.tree.visit(&ray, -shift, limit - shift, |mut slots| {
            blocked |= slots.any(|slot| {
                let hit = self.meet(&probe, shift, slot);
                hit.is_some_and(|hit| hit.distance < limit)
            });
            // No box is nearer than this, so that the search ends.
            blocked.then_some(f64::NEG_INFINITY)
        });
        blocked
    }

    /// The point of the mesh nearest to a position; nothing for an empty mesh and for a position that is not finite.
    #[must_use]
    pub fn nearest_point(&self, position: DVec3) -> Option<NearestPoint> {
        if !position.is_finite() {
            return None;
        }
        let mut best: Option<NearestPoint> = None;
        self.tree.visit_near(position, f64::INFINITY, |slots| {
            for slot in slots {
                let point = self.nearest_of(slot, position);
                if best.is_none_or(|best| point.is_before(&best)) {
                    best = Some(point);
                }
            }
            best.map_or(f64::INFINITY, |best| best.distance_sq)
        });
        best
    }

    /// The nearest point of one face.
    fn nearest_of(&self, slot: u32, position: DVec3) -> NearestPoint {
        let corners = self.corners[slot as usize].positions();
        let weights = nearest_weights(corners, position);
        let point = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
        NearestPoint {
            position: point,
            distance_sq: point.distance_squared(position),
            face: FaceIdx(self.tree.order()[slot as usize]),
            weights,
        }
    }

    /// The ray from its point nearest to the middle of the mesh, from which distances are about the size of the mesh, so
    /// that rounding is small beside the margin of the boxes; and how far that is along the ray.
    fn near_ray(&self, ray: &Ray) -> (Ray, f64) {
        let shift = (self.tree.middle() - ray.origin).dot(ray.direction);
        let origin = ray.at(shift);
        let direction = ray.direction;
        (Ray { origin, direction }, shift)
    }

    /// The hit of one face, if it is at a distance above zero.
    fn meet(&self, probe: &Probe, shift: f64, slot: u32) -> Option<RayHit> {
        let (distance, weights) = probe.meet(&self.corners[slot as usize])?;
        let distance = distance + shift;
        (distance > 0.0).then(|| RayHit {
            distance,
            face: FaceIdx(self.tree.order()[slot as usize]),
            weights,
        })
    }
}

impl RayHit {
    fn is_before(&self, other: &Self) -> bool {
        self.distance < other.distance
            || (self.distance == other.distance && self.face < other.face)
    }
}

impl NearestPoint {
    fn is_before(&self, other: &Self) -> bool {
        self.distance_sq < other.distance_sq
            || (self.distance_sq == other.distance_sq && self.face < other.face)
    }
}

impl fmt::Debug for Bvh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Bvh({} faces)", self.corners.len())
    }
}

#[cfg(test)]
mod tests;
