//! Computes the fraction of each pixel that a drawing covers.
//!
//! Coverage is computed for an edge one pixel wide, from the distance to the shape. Where shapes overlap the larger
//! coverage is used, so that lines can cross or join without a blot.

use dapple_raster::{Raster, Texel, glam::DVec2};

/// The coverage of every pixel, from 0 to 1. Positions and lengths are in pixels from the top left corner.
#[derive(Clone, Debug)]
pub(super) struct Stencil {
    size: [u32; 2],
    coverage: Vec<f32>,
}

impl Stencil {
    /// Returns a stencil that covers nothing.
    pub(super) fn new(size: [u32; 2]) -> Self {
        let n_pixels = size[0] as usize * size[1] as usize;
        Self {
            size,
            coverage: vec![0.0; n_pixels],
        }
    }

    /// Covers all positions within `reach` of the line segment between two positions, which may be equal.
    ///
    /// A line thinner than a pixel is drawn paler to keep its weight.
    pub(super) fn segment(&mut self, [from, to]: [DVec2; 2], reach: f64) {
        let (half, weight) = (reach.max(0.5), (2.0 * reach).min(1.0));
        let low = from.min(to) - DVec2::splat(half + 1.0);
        let high = from.max(to) + DVec2::splat(half + 1.0);
        let [width, height] = self.size;
        for row in clamped(low.y, height)..clamped(high.y, height) {
            for column in clamped(low.x, width)..clamped(high.x, width) {
                let at = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let inside = half + 0.5 - distance_to_segment(at, from, to);
                self.cover(column, row, (inside.clamp(0.0, 1.0) * weight) as f32);
            }
        }
    }

    /// Sets a pixel's coverage, unless its coverage is already larger.
    pub(super) fn cover(&mut self, column: u32, row: u32, coverage: f32) {
        let pixel = &mut self.coverage[row as usize * self.size[0] as usize + column as usize];
        *pixel = pixel.max(coverage);
    }

    /// Blends `ink` into a raster wherever the stencil covers it.
    pub(super) fn ink<T: Texel>(&self, raster: &mut Raster<T>, ink: T) {
        for (pixel, &coverage) in raster.pixels_mut().iter_mut().zip(&self.coverage) {
            if coverage > 0.0 {
                *pixel = *pixel + (ink - *pixel) * coverage;
            }
        }
    }
}

/// Converts a coordinate to a pixel index: clamps it to the range of a side with `n` pixels, and rounds it down.
fn clamped(coordinate: f64, n: u32) -> u32 {
    coordinate.clamp(0.0, f64::from(n)) as u32
}

fn distance_to_segment(at: DVec2, from: DVec2, to: DVec2) -> f64 {
    let (along, reach) = (to - from, at - from);
    let length_sq = along.length_squared();
    let t = if length_sq > 0.0 {
        (reach.dot(along) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (reach - along * t).length()
}
