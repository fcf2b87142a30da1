//! Draws straight, even, vertical stripes, whose direction on a surface can be measured.
//!
//! The image tiles. Stripes run along `j`, so on a surface they follow the orientation field.

use crate::draw::sampled;
use dapple_color::LinearRgb;
use dapple_raster::Raster;

/// Number of dark stripes, with light stripes between them.
const N_STRIPES: f64 = 7.0;

/// Number of samples along each side of a pixel.
const N_SAMPLES: u32 = 8;

/// Draws stripes, `size` pixels wide and high.
pub(super) fn stripes(size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let [dark, light] = [[40_u8, 32, 28], [232, 226, 210]].map(LinearRgb::from_srgb);
    Ok(sampled([size; 2], N_SAMPLES, |at| {
        let part = (at.x * N_STRIPES).fract();
        if (0.25..0.75).contains(&part) {
            dark
        } else {
            light
        }
    })?)
}
