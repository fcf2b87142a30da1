//! The reference image of figures 13 and 14: a white flower with soft edges, on black.

use dapple_raster::{Raster, RasterError, Window};
use glam::DVec2;

/// Width of the gray edges, in units of the plane.
const EDGE: f64 = 0.1;

/// Draws the flower, with intensities from 0 to 1.
pub(crate) fn flower(window: &Window) -> Result<Raster<f32>, RasterError> {
    Raster::from_window(window, |position| {
        let radius = position.length();
        let petals = soft(0.62 + 0.26 * five_waves(position) - radius);
        petals.min(soft(radius - 0.19)) as f32
    })
}

/// Returns the intensity of a soft edge, from 0 outside to 1 inside, for a position that is `inside` units within the
/// edge.
fn soft(inside: f64) -> f64 {
    (inside / EDGE + 0.5).clamp(0.0, 1.0)
}

/// Returns the cosine of five times the angle from straight up, as a polynomial in the cosine of the angle.
fn five_waves(position: DVec2) -> f64 {
    let cos = -position.normalize_or_zero().y;
    ((16.0 * cos * cos - 20.0) * cos * cos + 5.0) * cos
}
