//! Straight paths over a surface.
//!
//! A path goes straight through a face; at an edge the next face is unfolded into the plane of the last one, and the path
//! goes on in it. Reference: Greg Turk, "Generating Textures on Arbitrary Surfaces Using Reaction-Diffusion", SIGGRAPH
//! 1991, doi 10.1145/127719.122749, section 3.1, where points that repel each other are moved so; on a vertex a path has
//! no straight continuation, and goes on in one of the faces there.
//!
//! Every face on the way moves the end by at most a few roundings of the distance and of the size of the face, and turns
//! the direction by a few roundings: 16 faces or fewer by less than 2^-46 of both.

use crate::surface::Fold;
use crate::{Surface, SurfacePoint};
use glam::DVec2;

/// The most edges that one path crosses, which no path on a sensible mesh comes near to.
const CROSSINGS_MAX: u32 = 1 << 16;

/// Where a path came to.
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
    /// the point, the direction or the distance is not finite, the path ends where it begins, with all of the distance left.
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
    #[must_use]
    pub fn walk(&self, from: SurfacePoint, direction: DVec2, distance: f64) -> Walk {
        let walk = Walk {
            point: from,
            direction,
            left: distance,
        };
        if !(from.flat.is_finite() && direction.is_finite() && distance.is_finite()) {
            return walk;
        }
        if distance >= 0.0 {
            return self.forward(walk, |_, _| ());
        }
        let back = Walk {
            direction: -direction,
            left: -distance,
            ..walk
        };
        let walk = self.forward(back, |_, _| ());
        Walk {
            direction: -walk.direction,
            left: -walk.left,
            ..walk
        }
    }

    /// Goes straight as [`walk`](Self::walk) does, and tells of every stop on the way: the first one, `step` away, has the
    /// number 1, the last one `n_steps`.
    ///
    /// Stops past a border are where the path met it. A step below 0, and one that leads nowhere finite, is one of 0.
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
    /// let mut stops = Vec::new();
    /// square.walk_in_steps(start, right, 0.5, 2, |_, stop| stops.push(square.position(stop.point).x));
    /// assert_eq!(stops, [0.75, 1.0]);
    /// # Ok::<(), dapple_mesh::MeshError>(())
    /// ```
    #[inline]
    pub fn walk_in_steps(
        &self,
        from: SurfacePoint,
        direction: DVec2,
        step: f64,
        n_steps: u32,
        mut stop: impl FnMut(u32, Walk),
    ) {
        let is_path = from.flat.is_finite() && direction.is_finite();
        let is_path = is_path && (step * f64::from(n_steps)).is_finite();
        let step = if is_path { step.max(0.0) } else { 0.0 };
        let total = step * f64::from(n_steps);
        let walk = Walk {
            point: from,
            direction,
            left: total,
        };
        let (mut next, mut gone) = (1, 0.0);
        let end = self.forward(walk, |start, walk| {
            let until = total - walk.left;
            while next <= n_steps && step * f64::from(next) <= until {
                let distance = step * f64::from(next) - gone;
                let point = SurfacePoint {
                    flat: start.flat + walk.direction * distance,
                    ..start
                };
                let (direction, left) = (walk.direction, 0.0);
                stop(
                    next,
                    Walk {
                        point,
                        direction,
                        left,
                    },
                );
                next += 1;
            }
            gone = until;
        });
        for next in next..=n_steps {
            let left = step * f64::from(next) - gone;
            stop(next, Walk { left, ..end });
        }
    }

    /// Goes the distance that is left; `piece` hears of each face where the path enters it, and how it stands at the end of
    /// its piece there.
    #[inline]
    fn forward(&self, mut walk: Walk, mut piece: impl FnMut(SurfacePoint, &Walk)) -> Walk {
        let mut entered = None;
        for _ in 0..CROSSINGS_MAX {
            let start = walk.point;
            let fold = self.leave_face(&mut walk, entered);
            piece(start, &walk);
            let Some(fold) = fold else {
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
    fn leave_face(&self, walk: &mut Walk, entered: Option<u8>) -> Option<Fold> {
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
