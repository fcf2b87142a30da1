//! Bonds of rectangular bricks.

use super::{Bond, Brick, Bricks};
use crate::lattice::Split;
use crate::lattice::length;
use dapple_hash::{CellHash, unit_f64};

/// The cell of a rectangular brick, and a position in it.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Column and course, not wrapped by the period.
    id: [i64; 2],
    /// Position relative to the center, in units of the plane.
    at: [f64; 2],
    /// Half of the width and height, in units of the plane.
    half: [f64; 2],
    upright: bool,
}

impl Bricks {
    /// Returns the rectangular brick that contains a position.
    pub(super) fn rectangle(&self, place: [Split; 2]) -> Brick {
        let cell = self.cell(place);
        let (depth, mut uv) = self.depth(&cell);
        if cell.upright {
            uv.reverse();
        }
        Brick {
            id: self.wrapped(cell.id),
            upright: cell.upright,
            uv,
            height: self.rise(depth),
        }
    }

    /// Returns the signed distance to the nearest border of a rectangular brick: positive on faces, negative in
    /// joints.
    pub(super) fn rectangle_edge_distance(&self, place: [Split; 2]) -> f64 {
        let (own, _) = self.depth(&self.cell(place));
        if own >= 0.0 {
            return own;
        }
        // In a joint, a brick that is nearer than the position's own one has a cell that meets the square with a half
        // side of the own distance. This distance is less than the sides of all cells, so that the cell contains one of
        // the square's corners, the middles of its sides, or its center.
        let reach = -own;
        let mut nearest = own;
        for [x, y] in AROUND {
            let step = [x * reach, y * reach];
            let moved =
                [0, 1].map(|axis| place[axis].shifted(step[axis] * self.options.frequency[axis]));
            let mut cell = self.cell(moved);
            cell.at = [cell.at[0] - step[0], cell.at[1] - step[1]];
            nearest = nearest.max(self.depth(&cell).0);
        }
        nearest
    }

    /// Returns the signed distance to the border of a brick's face, positive inside, and the position on the face
    /// along x and y, from 0 to 1.
    fn depth(&self, cell: &Cell) -> (f64, [f64; 2]) {
        // Move the sides inward: left, right, top and bottom.
        let id = self.wrapped(cell.id);
        let inset = [0, 1, 2, 3].map(|side| self.inset(id, side));
        let mut uv = [0.0; 2];
        let mut half = [0.0; 2];
        let mut past = [0.0; 2];
        for axis in 0..2 {
            let [first, last] = [inset[2 * axis], inset[2 * axis + 1]];
            half[axis] = cell.half[axis] - 0.5 * (first + last);
            let at = cell.at[axis] - 0.5 * (first - last);
            uv[axis] = (0.5 + 0.5 * at / half[axis]).clamp(0.0, 1.0);
            past[axis] = at.abs() - half[axis];
        }
        let radius = (self.options.rounding * self.unit)
            .min(half[0])
            .min(half[1]);
        (rounded_corner(past, radius), uv)
    }

    /// Returns the cell of the brick at a position.
    fn cell(&self, [x, y]: [Split; 2]) -> Cell {
        let [width, height] = self.cell;
        let length = i64::from(self.options.length);
        match self.options.bond {
            Bond::Flemish => {
                // A pair of a stretcher and a header takes two columns. Every other course is shifted by half a pair.
                let x = x.shifted(f64::from(y.cell.rem_euclid(2) as u8));
                let pair = x.cell.div_euclid(2);
                let along = x.offset + x.cell.rem_euclid(2) as f64;
                let (column, center, half) = match along < 4.0 / 3.0 {
                    true => (2 * pair, 2.0 / 3.0, 2.0 / 3.0),
                    false => (2 * pair + 1, 5.0 / 3.0, 1.0 / 3.0),
                };
                Cell {
                    id: [column, y.cell],
                    at: [(along - center) * width, (y.offset - 0.5) * height],
                    half: [half * width, 0.5 * height],
                    upright: false,
                }
            }
            Bond::Herringbone => {
                // Diagonals of squares are numbered from 0 to twice the length. The first half of the numbers are
                // squares of horizontal bricks, from left to right, the second half of vertical ones, from the bottom.
                let diagonal = x.cell.wrapping_sub(y.cell).rem_euclid(2 * length);
                let (upright, along) = match diagonal < length {
                    true => (false, diagonal),
                    false => (true, 2 * length - 1 - diagonal),
                };
                self.squares([x, y], upright, along)
            }
            Bond::Basket => {
                let block = [x, y].map(|split| split.cell.div_euclid(length));
                let along = [x, y].map(|split| split.cell.rem_euclid(length));
                let upright = block[0].wrapping_add(block[1]).rem_euclid(2) == 1;
                self.squares([x, y], upright, along[usize::from(upright)])
            }
            Bond::Planks => self.plank([x, y]),
            _ => {
                let shift = match self.options.bond {
                    Bond::Running => self.shift(y.cell),
                    _ => 0.0,
                };
                let x = x.shifted(-shift);
                Cell {
                    id: [x.cell, y.cell],
                    at: [(x.offset - 0.5) * width, (y.offset - 0.5) * height],
                    half: [0.5 * width, 0.5 * height],
                    upright: false,
                }
            }
        }
    }

    /// Returns the cell of a brick of several squares. The position is in square number `along` of the brick, counted
    /// from its start.
    fn squares(&self, place: [Split; 2], upright: bool, along: i64) -> Cell {
        let (long, short) = (usize::from(upright), usize::from(!upright));
        let length = f64::from(self.options.length);
        let mut id = place.map(|split| split.cell);
        id[long] -= along;
        let (mut at, mut half) = ([0.0; 2], [0.0; 2]);
        at[long] = (place[long].offset + along as f64 - 0.5 * length) * self.cell[long];
        at[short] = (place[short].offset - 0.5) * self.cell[short];
        half[long] = 0.5 * length * self.cell[long];
        half[short] = 0.5 * self.cell[short];
        Cell {
            id,
            at,
            half,
            upright,
        }
    }

    /// Returns the cell of the plank at a position.
    fn plank(&self, [x, y]: [Split; 2]) -> Cell {
        let course = self.wrapped([0, y.cell])[1];
        let offset = CellHash::new(self.seed.child("course", 0), [course]).at(0);
        let x = x.shifted(unit_f64(offset));
        // The border to the left of a column is displaced by a quarter of a plank at most.
        let ends = self.seed.child("end", 0);
        let border = |column: i64| {
            let [column, _] = self.wrapped([column, 0]);
            let random = unit_f64(CellHash::new(ends, [column, course]).at(0));
            0.5 * self.options.variation * (random - 0.5)
        };
        let [left, right] = [border(x.cell), 1.0 + border(x.cell + 1)];
        let (column, left, right) = if x.offset < left {
            (x.cell - 1, border(x.cell - 1) - 1.0, left)
        } else if x.offset >= right {
            (x.cell + 1, right, 2.0 + border(x.cell + 2))
        } else {
            (x.cell, left, right)
        };
        let [width, height] = self.cell;
        Cell {
            id: [column, y.cell],
            at: [
                (x.offset - 0.5 * (left + right)) * width,
                (y.offset - 0.5) * height,
            ],
            half: [0.5 * (right - left) * width, 0.5 * height],
            upright: false,
        }
    }
}

/// Directions to the corners and the middles of the sides of a square.
const AROUND: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [0.0, -1.0],
    [1.0, -1.0],
    [-1.0, 0.0],
    [1.0, 0.0],
    [-1.0, 1.0],
    [0.0, 1.0],
    [1.0, 1.0],
];

/// Returns the signed distance to the border of a rounded box, positive inside. `past` is the distance of the position
/// beyond the sides of the box along each axis, negative inside.
pub(super) fn rounded_corner(past: [f64; 2], radius: f64) -> f64 {
    let past = past.map(|past| past + radius);
    let outside = length(past.map(|past| past.max(0.0)));
    radius - outside - past[0].max(past[1]).min(0.0)
}
