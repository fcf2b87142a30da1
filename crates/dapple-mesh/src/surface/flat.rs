//! Planar coordinates of faces, and transitions across their edges.

use crate::adjacency::FaceEdge;
use crate::triangle::area_vector;
use glam::{DVec2, DVec3};

/// A face laid out in its own plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceFrame {
    /// Position of the first corner.
    pub(crate) origin: DVec3,
    /// Unit vector toward the second corner.
    pub(crate) x: DVec3,
    /// Unit vector in the plane, orthogonal to `x`, on the side of the third corner.
    pub(crate) y: DVec3,
    /// Length of the first edge: the second corner is at `[width, 0]`.
    pub(crate) width: f64,
    /// Position of the third corner in the plane.
    pub(crate) apex: DVec2,
    /// Transitions across the three edges; `None` at a border.
    pub(crate) across: [Option<EdgeTransition>; 3],
}

/// Rigid motion from the plane of a face to the plane of a neighbor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeTransition {
    pub(crate) to: FaceEdge,
    /// Rotation from this plane to the neighbor's, as cosine and sine. The rotation is followed by a shift, `shift`.
    pub(crate) turn: DVec2,
    pub(crate) shift: DVec2,
}

impl FaceFrame {
    /// Computes the plane of a face; `None` if it has no area.
    pub(super) fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let vector = area_vector(corners)?;
        let (along, up) = (b - a, c - a);
        let width = along.length();
        let x = along / width;
        Some(Self {
            origin: a,
            x,
            // The normal of a flat triangle is not exactly orthogonal to x, but this axis is.
            y: vector.cross(x).normalize(),
            width,
            apex: DVec2::new(up.dot(x), vector.length() / width),
            across: [None; 3],
        })
    }

    /// Returns the positions of the corners in the plane.
    #[inline]
    pub(crate) fn corners(&self) -> [DVec2; 3] {
        [DVec2::ZERO, DVec2::new(self.width, 0.0), self.apex]
    }

    /// Returns whether a point is in the face or on its edges, up to rounding; false if it is not finite.
    #[inline]
    pub(crate) fn contains(&self, at: DVec2) -> bool {
        let right = DVec2::new(self.width, 0.0);
        (at.y >= 0.0)
            & (self.apex.y * at.x >= self.apex.x * at.y)
            & ((self.apex - right).perp_dot(at - right) >= 0.0)
    }

    pub(super) fn area(&self) -> f64 {
        0.5 * self.width * self.apex.y
    }
}

/// Returns the transition across a shared edge: the rigid motion from the plane of one face to the plane of the other
/// that maps the edge to itself.
///
/// `along` is the edge as a vector in space; its directions in both planes determine the rotation. Differences of
/// planar corners would be less precise for the short edges of needles.
pub(super) fn fold(
    here: &FaceFrame,
    edge: u8,
    there: &FaceFrame,
    to: FaceEdge,
    along: DVec3,
) -> EdgeTransition {
    let direction = |flat: &FaceFrame| DVec2::new(along.dot(flat.x), along.dot(flat.y)).normalize();
    let (a, b) = (direction(here), direction(there));
    let turn = DVec2::new(a.dot(b), a.perp_dot(b)).normalize();
    let from = here.corners()[usize::from(edge)];
    // The other face traverses the edge in the opposite direction.
    let from_there = there.corners()[(usize::from(to.edge) + 1) % 3];
    EdgeTransition {
        to,
        turn,
        shift: from_there - turn.rotate(from),
    }
}
