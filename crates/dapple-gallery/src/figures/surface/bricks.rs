//! Draws a wall of bricks in running bond, with mortar, an individual shade for each brick, and slight roughness.
//!
//! The image tiles.

use super::super::fractal::FractalNoise;
use crate::draw::{sampled, smooth_step};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_points::hash::{CellHash, Seed, unit_f64};
use dapple_raster::Raster;
use glam::DVec2;

/// Number of bricks per row, and number of rows. The number of rows is even, since every other row is shifted by half
/// a brick.
const N_BRICKS: [i64; 2] = [4, 8];

/// Length of a brick including its mortar, in multiples of the height of a brick including its mortar.
const LENGTH: f64 = 2.0;

/// Half the width of the mortar, in multiples of the brick height.
const MORTAR: f64 = 0.09;

/// Radius of a brick's corners, in multiples of the brick height.
const CORNER: f64 = 0.12;

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 4;

/// Draws bricks, `size` pixels wide and high.
pub(super) fn bricks(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let clay = ColorRamp::from_hex(&[
        "#6e2a20", "#a5452e", "#8a3a34", "#c0694a", "#b5503a", "#d59468", "#7c4038",
    ])?;
    let mortar = LinearRgb::from_srgb([186_u8, 178, 164]);
    let noise = FractalNoise::new(0.09, Seed(6))?;
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        let (brick, place) = brick(at);
        let roll = |index: u32| unit_f64(CellHash::new(Seed(2), brick).at(index));
        let rough = f64::from(noise.at(at)) - 0.5;
        let inside = depth(place) + 0.05 * rough;
        // The upper edge of a brick is lit, and the lower edge is dark.
        let edge = 1.0 - smooth_step(0.0, 0.14, inside);
        let light = 1.0 + 0.7 * rough - 0.5 * edge * place.y;
        let color = clay.at(roll(0) as f32) * (light * (0.8 + 0.4 * roll(1))) as f32;
        let ground = mortar * (0.75 + 0.8 * rough) as f32;
        ground.lerp(color, smooth_step(-0.02, 0.03, inside) as f32)
    })?)
}

/// Returns the column and row of the brick at a position, and the offset of the position from the brick's center, in
/// multiples of the brick height.
fn brick(at: DVec2) -> ([i64; 2], DVec2) {
    let row = (at.y * N_BRICKS[1] as f64).floor();
    let shift = 0.5 * (row as i64).rem_euclid(2) as f64;
    let across = at.x * N_BRICKS[0] as f64 - shift;
    let column = across.floor();
    let place = DVec2::new(
        (across - column - 0.5) * LENGTH,
        at.y * N_BRICKS[1] as f64 - row - 0.5,
    );
    let index = [column as i64, row as i64];
    (
        [0, 1].map(|axis| index[axis].rem_euclid(N_BRICKS[axis])),
        place,
    )
}

/// Returns how deep a position is inside a brick with round corners, in multiples of the brick height; negative in
/// the mortar.
fn depth(place: DVec2) -> f64 {
    let half = DVec2::new(0.5 * LENGTH, 0.5) - DVec2::splat(MORTAR + CORNER);
    let past = place.abs() - half;
    CORNER - past.max(DVec2::ZERO).length() - past.max_element().min(0.0)
}
