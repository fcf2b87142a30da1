//! Draws pieces of a jigsaw puzzle in several colors, with knobs that reach into their neighbors and dark outlines.
//!
//! The image tiles.

use super::wobble::{Wave, wobble};
use crate::draw::sampled;
use dapple_color::LinearRgb;
use dapple_points::hash::{CellHash, Seed, unit_f64};
use dapple_raster::Raster;
use glam::DVec2;

/// Number of pieces along each side of the image.
const N_PIECES: i64 = 4;

/// Color indices of the pieces, by row. Adjacent pieces differ, also across the border of the image.
const COLORS: [[usize; 4]; 4] = [[0, 1, 2, 3], [2, 3, 4, 0], [4, 0, 1, 2], [1, 2, 3, 4]];

/// Colors of the pieces, in sRGB.
const PAINTS: [[u8; 3]; 5] = [
    [214, 60, 48],
    [246, 196, 60],
    [52, 122, 190],
    [78, 164, 86],
    [236, 232, 220],
];

/// Radius of a knob. All lengths are in multiples of a piece's side.
const KNOB: f64 = 0.15;

/// Distance from the edge to the center of a knob.
const OUT: f64 = 0.17;

/// Half the width of a knob's neck.
const NECK: f64 = 0.08;

/// Half the width of an outline.
const OUTLINE: f64 = 0.045;

/// Waves that bend the edges, with heights in multiples of the image width.
const SWAY: [Wave; 2] = [
    Wave {
        periods: [3, 2],
        height: 0.008,
        phase: 0.2,
    },
    Wave {
        periods: [-2, 5],
        height: 0.006,
        phase: 0.7,
    },
];

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 6;

/// Draws puzzle pieces, `size` pixels wide and high.
pub(super) fn puzzle(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let ink = LinearRgb::from_srgb([26_u8, 20, 22]);
    let paints = PAINTS.map(LinearRgb::from_srgb);
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        let turned = DVec2::new(at.y, at.x);
        let sway = DVec2::new(wobble(&SWAY, at), wobble(&SWAY, turned));
        let place = (at + sway) * N_PIECES as f64;
        let piece = piece(place);
        if on_outline(place, piece) {
            return ink;
        }
        let [column, row] = piece.map(|index| index.rem_euclid(N_PIECES) as usize);
        paints[COLORS[row][column]]
    })?)
}

/// Returns whether a position on piece `own` is within half an outline width of another piece.
fn on_outline(place: DVec2, own: [i64; 2]) -> bool {
    let s = core::f64::consts::FRAC_1_SQRT_2;
    let ways = [[1.0, 0.0], [s, s], [0.0, 1.0], [-s, s]].map(|way| OUTLINE * DVec2::from(way));
    ways.iter()
        .any(|&way| piece(place + way) != own || piece(place - way) != own)
}

/// Returns the piece at a position: the piece that owns the square, or an adjacent piece whose knob reaches into it.
fn piece(place: DVec2) -> [i64; 2] {
    let square = place.floor();
    let [column, row] = [square.x as i64, square.y as i64];
    let [x, y] = (place - square).to_array();
    let sides = [
        // Index of the edge, the piece and its neighbor, and the position along the edge and away from it.
        (0, [column, row], [column - 1, row], true, y, x),
        (0, [column + 1, row], [column + 1, row], false, y, 1.0 - x),
        (1, [column, row], [column, row - 1], true, x, y),
        (1, [column, row + 1], [column, row + 1], false, x, 1.0 - y),
    ];
    for (axis, edge, neighbor, forward, along, away) in sides {
        let edge = Edge::new(axis, edge);
        if edge.forward == forward && edge.has_knob_at(along, away) {
            return neighbor;
        }
    }
    [column, row]
}

/// The edge between a square and its predecessor along an axis.
struct Edge {
    /// Whether the knob belongs to the piece in the preceding square.
    forward: bool,
    /// Position of the knob along the edge, as a fraction from 0 to 1.
    middle: f64,
}

impl Edge {
    fn new(axis: i64, [column, row]: [i64; 2]) -> Self {
        let wrapped = [axis, column.rem_euclid(N_PIECES), row.rem_euclid(N_PIECES)];
        let hash = CellHash::new(Seed(3), wrapped);
        Self {
            forward: hash.at(0) & 1 == 0,
            middle: 0.5 + 0.16 * (unit_f64(hash.at(1)) - 0.5),
        }
    }

    /// Returns whether a position is on the knob.
    fn has_knob_at(&self, along: f64, away: f64) -> bool {
        let aside = (along - self.middle).abs();
        let head = DVec2::new(aside, away - OUT).length_squared() < KNOB * KNOB;
        head || (away < OUT && aside < NECK)
    }
}
