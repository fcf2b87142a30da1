//! Ray casting and nearest-point queries on a mesh.

mod build;
mod tree;
mod triangle;

use crate::{FaceIdx, Mesh};
use build::Bounds;
use core::fmt;
use glam::DVec3;
use tree::Tree;
use triangle::{Corners, Probe, nearest_weights};

/// A half-line that starts at an origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start point of the ray.
    pub origin: DVec3,
    /// Unit direction, so that ray parameters are distances.
    pub direction: DVec3,
}

/// Intersection of a ray with a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Distance along the ray, greater than zero.
    pub distance: f64,
    /// Face that was hit.
    pub face: FaceIdx,
    /// Barycentric weights of the corners, which sum to 1.
    pub weights: [f64; 3],
}

/// The point on a mesh nearest to a queried position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Position of the point.
    pub position: DVec3,
    /// Squared distance from the queried position.
    pub distance_sq: f64,
    /// Face that contains the point.
    pub face: FaceIdx,
    /// Barycentric weights of the corners, which sum to 1.
    pub weights: [f64; 3],
}

/// A bounding volume hierarchy over the faces of a mesh, for ray casting and nearest-point queries.
///
/// Results equal those of a search through all faces, bit for bit. Among faces at the same distance, the one with the
/// lowest index is returned. Faces are two-sided; rays never hit a face with zero area.
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
    /// Corners of the faces, ordered as in the tree's leaves.
    corners: Vec<Corners>,
}

impl Ray {
    /// Returns the point on the ray at `distance` from its origin.
    #[inline]
    #[must_use]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }
}

impl Bvh {
    /// Builds the hierarchy. The mesh may be empty.
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

    /// Returns the nearest face hit by a ray, at a distance above zero and at most `limit`.
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

    /// Returns whether a ray hits any face at a distance above zero and below `limit`.
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
            // No box is nearer than minus infinity, so the search ends.
            blocked.then_some(f64::NEG_INFINITY)
        });
        blocked
    }

    /// Returns the point on the mesh nearest to `position`; `None` for an empty mesh or a position that is not
    /// finite.
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

    /// Returns the point nearest to `position` on one face.
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

    /// Moves the origin of a ray along it to the point nearest to the center of the mesh. Returns the new ray and the
    /// distance moved. Hit distances from the new origin are about as large as the mesh, so that their rounding errors
    /// stay well below the margin of the boxes.
    fn near_ray(&self, ray: &Ray) -> (Ray, f64) {
        let shift = (self.tree.middle() - ray.origin).dot(ray.direction);
        let origin = ray.at(shift);
        let direction = ray.direction;
        (Ray { origin, direction }, shift)
    }

    /// Intersects the ray with one face. Returns `None` unless the distance from the ray's original origin, `shift`
    /// plus the distance along the moved ray, is above zero.
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
