//! Straight paths over a surface.
//!
//! A path goes straight through a face; at an edge the next face is unfolded into the plane of the last one, and the path
//! goes on in it. Reference: Greg Turk, "Generating Textures on Arbitrary Surfaces Using Reaction-Diffusion", SIGGRAPH
//! 1991, doi 10.1145/127719.122749, section 3.1, where points that repel each other are moved so; on a vertex a path has
//! no straight continuation, and goes on in one of the faces there.

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
    /// How much of the distance is left because the path met a border: zero if it did not.
    pub left: f64,
}

impl Surface {
    /// Goes straight from a point along a unit direction in the plane of its face.
    ///
    /// A path ends early at a border of the mesh. A vector that is to be carried along keeps its angle to `direction`.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn walk(&self, from: SurfacePoint, direction: DVec2, distance: f64) -> Walk {
        let mut walk = Walk {
            point: from,
            direction,
            left: distance,
        };
        let mut entered = None;
        for _ in 0..CROSSINGS_MAX {
            match self.leave_face(&mut walk, entered) {
                Exit::Inside => return walk,
                Exit::Border => return walk,
                Exit::Across(fold) => {
                    walk.point.face = fold.to.face;
                    walk.point.flat = fold.turn.rotate(walk.point.flat) + fold.shift;
                    walk.direction = fold.turn.rotate(walk.direction);
                    entered = Some(fold.to.edge);
                }
            }
        }
        walk
    }

    /// Goes on to the end of the path or to the edge through which it leaves its face, other than the one it came by.
    #[inline]
    fn leave_face(&self, walk: &mut Walk, entered: Option<u8>) -> Exit {
        let flat = self.flat(walk.point.face);
        let corners = flat.corners();
        let from = walk.point.flat;
        let step = walk.direction * walk.left;
        let mut part = 1.0;
        let mut exit = None;
        for edge in 0..3_u8 {
            let (a, b) = (
                corners[usize::from(edge)],
                corners[(usize::from(edge) + 1) % 3],
            );
            let along = b - a;
            let side = along.perp_dot(from - a).max(0.0);
            let change = along.perp_dot(step);
            if side + change < 0.0 && Some(edge) != entered {
                let at = side / -change;
                if at < part {
                    part = at;
                    exit = Some(edge);
                }
            }
        }
        walk.point.flat = from + step * part;
        let Some(edge) = exit else {
            walk.left = 0.0;
            return Exit::Inside;
        };
        walk.left *= 1.0 - part;
        match &flat.across[usize::from(edge)] {
            Some(fold) => Exit::Across(*fold),
            None => Exit::Border,
        }
    }
}

/// How a path goes on from a face.
enum Exit {
    Inside,
    Across(Fold),
    Border,
}
