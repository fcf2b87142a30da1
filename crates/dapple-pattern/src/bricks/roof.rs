//! Roof tiles: courses that overlap the course below them.
//!
//! A tile extends from far above its course to the lower border of the course, where its end may be round. A course
//! covers the tiles of the course below, which remain visible between round ends and in the joints.

use super::rectangles::rounded_corner;
use super::{Bond, Brick, Bricks};
use crate::lattice::Split;

/// A roof tile and a position relative to it.
struct Tile {
    /// Column and course, wrapped by the period.
    id: [i64; 2],
    /// Signed distance to the border of the tile, positive inside.
    depth: f64,
    /// Position across the face, from 0 to 1.
    across: f64,
    /// Position in the course from its upper border downward, in courses; negative above the border.
    down: f64,
}

impl Bricks {
    /// Returns the roof tile that is visible at a position.
    pub(super) fn roof_tile(&self, place: [Split; 2]) -> Brick {
        let tile = self.visible_tile(place);
        // Tiles lie on each other: a course rises by half a unit, which is the thickness of a tile.
        let surface = 0.5 * tile.down + 0.5 * self.rise(tile.depth);
        Brick {
            id: tile.id,
            upright: false,
            uv: [tile.across, tile.down.clamp(0.0, 1.0)],
            height: if tile.depth < 0.0 { 0.0 } else { surface },
        }
    }

    /// Returns the signed distance to the border of the visible area of a roof tile, positive inside.
    pub(super) fn roof_edge_distance(&self, place: [Split; 2]) -> f64 {
        let nearest = |below: i64| {
            let columns = [-1, 0, 1].map(|column| self.tile(place, column, below).depth);
            columns[0].max(columns[1]).max(columns[2])
        };
        let own = nearest(0);
        if own >= 0.0 {
            // The course above lies over this one.
            return own.min(-nearest(-1));
        }
        let lower = nearest(1);
        if lower >= 0.0 {
            lower.min(-own)
        } else {
            own.max(lower)
        }
    }

    /// Returns the tile that is visible at a position: the tile of its course, or the tile of the next course below if
    /// that tile is uncovered.
    fn visible_tile(&self, place: [Split; 2]) -> Tile {
        let own = self.tile(place, 0, 0);
        if own.depth >= 0.0 {
            return own;
        }
        let lower = self.tile(place, 0, 1);
        if lower.depth >= 0.0 { lower } else { own }
    }

    /// Returns the tile `columns` to the right of a position and `courses` below it.
    fn tile(&self, [x, y]: [Split; 2], columns: i64, courses: i64) -> Tile {
        let [width, height] = self.cell;
        let course = y.cell + courses;
        let x = x.shifted(-self.shift(course));
        let id = self.wrapped([x.cell + columns, course]);
        let [left, right, bottom] = [0, 1, 3].map(|side| self.inset(id, side));
        // The lower end is moved by jitter alone: courses overlap and have no joint.
        let bottom = bottom - 0.5 * self.options.joint * self.unit;
        let half = 0.5 * (width - left - right);
        let at = (x.offset - 0.5 - columns as f64) * width - 0.5 * (left - right);
        let down = y.offset - courses as f64;
        let radius = match self.options.bond {
            Bond::RoofTiles => half.min(0.75 * height),
            _ => (self.options.rounding * self.unit).min(half),
        };
        let past = [at.abs() - half, (down - 1.0) * height + bottom];
        Tile {
            id,
            depth: rounded_corner(past, radius),
            across: (0.5 + 0.5 * at / half).clamp(0.0, 1.0),
            down,
        }
    }
}
