//! Straight paths over a surface.
//!
//! A path goes straight through a face; at an edge the next face is unfolded into the plane of the last one, and the path
//! goes on in it. Reference: Greg Turk, "Generating Textures on Arbitrary Surfaces Using Reaction-Diffusion", SIGGRAPH
//! 1991, doi 10.1145/127719.122749, section 3.1, where points that repel each other are moved so; on a vertex a path has
//! no straight continuation, and goes on in one of the faces there.
//!
//! Every face on the way moves the end by at most a few roundings of the distance and of the size of the face, and turns
//! the direction by a few roundings: 16 faces or fewer by less than 2^-46 of both.

use crate::surface::EdgeTransition;
use crate::{Surface, SurfacePoint};
use glam::DVec2;

/// The most edges that one path crosses, which no path on a sensible mesh comes near to.
const CROSSINGS_MAX: u32 = 1 << 16;

/// The end of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walk {
    /// The end of the path.
    pub point: SurfacePoint,
    /// The unit direction at the end, in the plane of the last face: the first one, carried along.
    pub direction: DVec2,
    /// How much of the distance is left because the path met a border, with the sign of the distance: zero if it did not.
    pub left: f64,
}

impl Surface {
    /// Goes straight from a point in a face along a unit direction in the plane of the face, for a distance in units of
    /// the mesh.
    ///
    /// A path ends early at a border of the mesh, and after 65,536 edges. A vector that is to be carried along keeps its
    /// angle to `direction`. A negative distance goes backward; the direction at the end points forward all the same. If
    /// the point, the direction or the distance is not finite, the path ends where it begins, with all of the distance
    /// left.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_mesh::{FaceIdx, Mesh, Surface, glam::DVec3};
    ///
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
    /// let square = Surface::new(Mesh::new(corners, &[[0, 1, 2], [3, 2, 1]])?)?;
    /// let start = square.project(FaceIdx(0), DVec3::new(0.25, 0.25, 0.0));
    /// let right = square.flatten(FaceIdx(0), DVec3::X);
    /// let walk = square.walk(start, right, 1.0);
    /// assert_eq!(square.position(walk.point), DVec3::new(1.0, 0.25, 0.0));
    /// assert_eq!(walk.left, 0.25);
    /// # Ok::<(), dapple_mesh::MeshError>(())
    /// ```
    #[inline]
    #[must_use]
    pub fn walk(&self, from: SurfacePoint, direction: DVec2, distance: f64) -> Walk {
        let flat = from.flat + direction * distance;
        // A face is convex: what ends in it has not left it. This is so for most short paths.
        if self.flat(from.face).contains(flat) {
            return Walk {
                point: SurfacePoint { flat, ..from },
                direction,
                left: 0.0,
            };
        }
        self.walk_far(from, direction, distance)
    }

    /// Walks where the path may leave its face.
    fn walk_far(&self, from: SurfacePoint, direction: DVec2, distance: f64) -> Walk {
        let walk = Walk {
            point: from,
            direction,
            left: distance,
        };
        if !(from.flat.is_finite() && direction.is_finite() && distance.is_finite()) {
            return walk;
        }
        if distance >= 0.0 {
            return self.forward(walk);
        }
        let walk = self.forward(Walk {
            direction: -direction,
            left: -distance,
            ..walk
        });
        Walk {
            direction: -walk.direction,
            left: -walk.left,
            ..walk
        }
    }

    /// Goes the distance that is left.
    #[inline]
    fn forward(&self, mut walk: Walk) -> Walk {
        let mut entered = None;
        for _ in 0..CROSSINGS_MAX {
            let Some(fold) = self.leave_face(&mut walk, entered) else {
                break;
            };
            walk.point.face = fold.to.face;
            walk.point.flat = fold.turn.rotate(walk.point.flat) + fold.shift;
            walk.direction = fold.turn.rotate(walk.direction);
            entered = Some(fold.to.edge);
        }
        walk
    }

    /// Goes on to the end of the path, or to the edge through which it leaves its face, other than the one it came by.
    ///
    /// Gives what is across that edge, or nothing at the end and at a border.
    #[inline]
    fn leave_face(&self, walk: &mut Walk, entered: Option<u8>) -> Option<EdgeTransition> {
        let flat = self.flat(walk.point.face);
        let corners = flat.corners();
        let from = walk.point.flat;
        let mut nearest = walk.left;
        let mut exit = None;
        for edge in 0..3_u8 {
            let [a, b] = [edge, (edge + 1) % 3].map(|corner| corners[usize::from(corner)]);
            let along = b - a;
            // A point that rounding has put outside of the edge is on it.
            let side = along.perp_dot(from - a).max(0.0);
            let rate = -along.perp_dot(walk.direction);
            // The product keeps the division for edges that are near enough.
            if rate * nearest > side && Some(edge) != entered {
                nearest = side / rate;
                exit = Some(edge);
            }
        }
        walk.point.flat = from + walk.direction * nearest;
        walk.left -= nearest;
        flat.across[usize::from(exit?)]
    }
}

#[cfg(test)]
mod tests;
