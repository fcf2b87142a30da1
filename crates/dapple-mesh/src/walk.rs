//! Straight paths (geodesics) on a surface.
//!
//! A path is straight within a face. At an edge, the next face is unfolded into the plane of the last one, and the
//! path continues in it. Reference: Greg Turk, "Generating Textures on Arbitrary Surfaces Using Reaction-Diffusion",
//! SIGGRAPH 1991, doi 10.1145/127719.122749, section 3.1, which moves mutually repelling points in this way. At a
//! vertex there is no straight continuation, and the path continues in one of the faces there.
//!
//! Every face on the path moves the end by at most a few rounding errors of the distance and the face's size, and
//! rotates the direction by a few rounding errors. For up to 16 faces, the sum is below 2^-46 of both.

use crate::surface::EdgeTransition;
use crate::{Surface, SurfacePoint};
use glam::DVec2;

/// Maximum number of edges that a path crosses, far more than on any sensible mesh.
const CROSSINGS_MAX: u32 = 1 << 16;

/// The result of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walk {
    /// End of the path.
    pub point: SurfacePoint,
    /// Unit direction at the end, in the plane of the last face: the initial direction, transported along the path.
    pub direction: DVec2,
    /// Distance not walked because the path reached a border, with the sign of the requested distance; zero
    /// otherwise.
    pub left: f64,
}

impl Surface {
    /// Walks straight from a point along a unit direction in the plane of its face, for a distance in units of the
    /// mesh.
    ///
    /// The path ends early at a border of the mesh, and after 65,536 edges. A vector transported along the path keeps
    /// its angle to `direction`. A negative distance walks backward; the direction at the end still points forward.
    /// If the point, the direction or the distance is not finite, the path ends at its start and `left` is the whole
    /// distance.
    ///
    /// # Panics
    ///
    /// If the face does not exist.
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
        // A face is convex, so a path that ends in it has not left it. This is the case for most short paths.
        if self.flat(from.face).contains(flat) {
            return Walk {
                point: SurfacePoint { flat, ..from },
                direction,
                left: 0.0,
            };
        }
        self.walk_far(from, direction, distance)
    }

    /// Walks a path that may leave its face.
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

    /// Walks until the remaining distance is zero, or the path reaches a border.
    #[inline]
    fn forward(&self, mut walk: Walk) -> Walk {
        let mut entered = None;
        for _ in 0..CROSSINGS_MAX {
            let Some(fold) = self.leave_face(&mut walk, entered) else {
                break;
            };
            // Continue in the plane of the next face.
            walk.point.face = fold.to.face;
            walk.point.flat = fold.turn.rotate(walk.point.flat) + fold.shift;
            walk.direction = fold.turn.rotate(walk.direction);
            entered = Some(fold.to.edge);
        }
        walk
    }

    /// Moves the end of the walk along its direction, up to the total distance or to the edge where the path leaves the
    /// face. `entered` is the edge by which it entered the face, which is ignored.
    ///
    /// Returns the transition across the exit edge; `None` at the end of the path and at a border.
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
            // Clamp a start point that rounding moved outside the edge.
            let side = along.perp_dot(from - a).max(0.0);
            let rate = -along.perp_dot(walk.direction);
            // Compare products first; divide only for edges that are near enough.
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
