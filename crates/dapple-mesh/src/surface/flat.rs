//! Faces laid out flat, and what lies across their edges.

use crate::adjacency::FaceEdge;
use crate::triangle::area_vector;
use glam::{DVec2, DVec3};

/// A face in its own plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceFrame {
    /// The first corner.
    pub(crate) origin: DVec3,
    /// The unit vector toward the second corner.
    pub(crate) x: DVec3,
    /// The unit vector across it in the plane of the face, toward the third corner.
    pub(crate) y: DVec3,
    /// The second corner is at `[width, 0]`.
    pub(crate) width: f64,
    /// The third corner.
    pub(crate) apex: DVec2,
    /// The faces across the three edges.
    pub(crate) across: [Option<EdgeTransition>; 3],
}

/// The motion that takes the plane of a face to that of the face across an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeTransition {
    pub(crate) to: FaceEdge,
    /// Cosine and sine of the turn, and the shift after it, from this plane into the other one.
    pub(crate) turn: DVec2,
    pub(crate) shift: DVec2,
}

impl FaceFrame {
    /// The face in its plane, or nothing if it has no area.
    pub(super) fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let vector = area_vector(corners)?;
        let (along, up) = (b - a, c - a);
        let width = along.length();
        let x = along / width;
        Some(Self {
            origin: a,
            x,
            // In a flat triangle the normal is not quite at a right angle to x, but this axis is.
            y: vector.cross(x).normalize(),
            width,
            apex: DVec2::new(up.dot(x), vector.length() / width),
            across: [None; 3],
        })
    }

    /// The corners in the plane.
    #[inline]
    pub(crate) fn corners(&self) -> [DVec2; 3] {
        [DVec2::ZERO, DVec2::new(self.width, 0.0), self.apex]
    }

    /// Whether a place is in the face or on its edges, but for rounding; not so for one that is not finite.
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

/// The rigid motion of the plane that takes an edge of one face to where the other face has it.
///
/// `along` is the edge in space; its directions in both planes give the turn. Those between the corners as they are in
/// the planes would be less precise for short edges of needles.
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
    // The other face goes through the edge in the other direction.
    let from_there = there.corners()[(usize::from(to.edge) + 1) % 3];
    EdgeTransition {
        to,
        turn,
        shift: from_there - turn.rotate(from),
    }
}
