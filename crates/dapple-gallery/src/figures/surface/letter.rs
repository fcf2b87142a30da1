//! Draws a single letter F, dark on light, which shows which way is up and whether the image is mirrored.
//!
//! The image tiles, since its border has a single color.

use crate::draw::Canvas;
use dapple_color::LinearRgb;
use dapple_raster::{Raster, Window};
use glam::DVec2;

/// Draws the letter, `size` pixels wide and high.
pub(super) fn letter(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let [ink, paper] = [[150_u8, 30, 30], [240, 236, 220]].map(LinearRgb::from_srgb);
    let mut canvas = Canvas::new(&Window::unit([size; 2])?, paper)?;
    canvas.text(DVec2::new(0.33, 0.82), 0.64 * f64::from(size), "F", ink);
    Ok(canvas.into_raster())
}
