//! Draws rows of overlapping fish scales, whose free ends point down.
//!
//! The image does **not** tile: scales become narrower to the right and taller to the bottom, the rows bend, and the
//! hue changes from the upper left to the lower right.

use crate::draw::{sampled, smooth_step};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_points::hash::{CellHash, Seed, unit_f64};
use dapple_raster::Raster;
use glam::DVec2;

/// Length of a scale, in multiples of the row spacing.
const REACH: f64 = 1.6;

/// Distance from the root of a scale to the start of its round end, in multiples of the row spacing.
const SHOULDER: f64 = 0.5;

/// Half the width of a scale, in multiples of the spacing of scales within a row. Adjacent scales overlap slightly.
const HALF: f64 = 0.53;

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 5;

/// A position on a scale, with its shading.
struct OnScale {
    /// Row of the scale and its index in the row.
    scale: [i64; 2],
    /// Position on the scale: across from the center line, −1 to 1, and down from the root, 0 to 1.
    at: DVec2,
    /// Closeness to the rim: 0 in the middle, 1 on the rim.
    rim: f64,
    /// Strength of the shadow cast by the scales above, from 0 to 1.
    shadow: f64,
}

/// Draws scales, `size` pixels wide and high.
pub(super) fn scales(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let hues = ColorRamp::from_hex(&["#17525c", "#2f8a78", "#9fb15a", "#d9a441", "#c06a35"])?;
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        let scale = on_scale(rows(at));
        let roll = |index: u32| unit_f64(CellHash::new(Seed(4), scale.scale).at(index));
        let along = 0.5 * (at.x + at.y) + 0.2 * (roll(0) - 0.5);
        let tone = 0.85 + 0.3 * roll(1);
        hues.at(along as f32) * (tone * light(&scale)) as f32
    })?)
}

/// Converts an image position to a scale coordinate across and a row coordinate down.
fn rows(at: DVec2) -> DVec2 {
    let across = 6.3 * at.x * (1.0 + 0.22 * at.x) + 0.3 * at.y;
    let bend = 0.5 * at.x * (1.0 - at.x);
    DVec2::new(across + 0.37, at.y * (10.3 - 1.9 * at.y) + bend + 0.21)
}

/// Returns the visible scale at a position, from the highest row that reaches it.
fn on_scale(at: DVec2) -> OnScale {
    let mut shadow = 0.0_f64;
    let lowest = at.y.floor();
    let mut row = lowest - 1.0;
    loop {
        // Every other row is offset by half a scale.
        let shift = 0.5 * (row as i64).rem_euclid(2) as f64;
        let place = (at.x - shift).round();
        let aside = (at.x - shift - place) / HALF;
        let below = at.y - row;
        let round = (below - SHOULDER).max(0.0) / (REACH - SHOULDER);
        let rim = (aside * aside + round * round).sqrt();
        if rim <= 1.0 || row >= lowest {
            return OnScale {
                scale: [row as i64, place as i64],
                at: DVec2::new(aside, below / REACH),
                rim,
                shadow,
            };
        }
        shadow = shadow.max(1.0 - smooth_step(1.0, 1.4, rim));
        row += 1.0;
    }
}

/// Returns the brightness of a scale, which is curved across, shines near its end and has a thin dark rim.
fn light(scale: &OnScale) -> f64 {
    let OnScale { at, rim, .. } = *scale;
    let bulge = 0.75 + 0.45 * smooth_step(0.1, 0.9, at.y) - 0.22 * at.x;
    let shine = 0.55 * smooth_step(0.55, 0.8, rim) * smooth_step(0.3, 0.6, at.y);
    let edge = 1.0 - 0.75 * smooth_step(0.86, 0.97, rim);
    (bulge + shine) * edge * (1.0 - 0.7 * scale.shadow)
}
