//! Draws the wiggly checkerboard found in many papers on texture synthesis, whose lines are not quite straight.
//!
//! The image tiles.

use super::wobble::{Wave, wobble};
use crate::draw::sampled;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use glam::DVec2;

/// Number of squares along each side, even so that the board tiles.
const N_SQUARES: f64 = 6.0;

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 8;

/// Waves that bend the vertical lines.
const ACROSS: [Wave; 3] = [
    Wave {
        periods: [1, 5],
        height: 0.009,
        phase: 0.1,
    },
    Wave {
        periods: [-2, 8],
        height: 0.006,
        phase: 0.45,
    },
    Wave {
        periods: [3, 2],
        height: 0.006,
        phase: 0.8,
    },
];

/// Waves that bend the horizontal lines.
const DOWN: [Wave; 3] = [
    Wave {
        periods: [5, -1],
        height: 0.009,
        phase: 0.3,
    },
    Wave {
        periods: [7, 2],
        height: 0.006,
        phase: 0.9,
    },
    Wave {
        periods: [-2, 3],
        height: 0.006,
        phase: 0.6,
    },
];

/// Draws the wiggly checker, `size` pixels wide and high.
pub(super) fn checker(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let [dark, light] = [LinearRgb::gray(0.004), LinearRgb::gray(0.92)];
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        let sway = DVec2::new(wobble(&ACROSS, at), wobble(&DOWN, at));
        let square = ((at + sway) * N_SQUARES).floor();
        let odd = (square.x as i64 + square.y as i64) % 2 != 0;
        if odd { light } else { dark }
    })?)
}
