//! The plane in which heights lie: what all maps from heights ask of their options.
//!
//! Lengths are in units of the plane; a raster covers a stated extent of it.

use crate::{ColorError, ColorErrorKind};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Window, Wrap, parallel};

/// How many pixels a radius may reach over.
const MAX_RADIUS: u32 = 1 << 14;

/// The width and height of a window in the plane.
pub(crate) fn extent(window: &Window) -> DVec2 {
    let size = DVec2::new(window.size[0].into(), window.size[1].into());
    (window.pixel * window.scale * size).abs()
}

/// Refuses a strength that is not finite and an extent that is not above zero and finite.
pub(crate) fn check(what: &'static str, strength: f64, extent: DVec2) -> Result<(), ColorError> {
    if !strength.is_finite() {
        let value = strength;
        return Err(ColorError::new(ColorErrorKind::NotFinite { what, value }));
    }
    if !(extent.is_finite() && extent.x > 0.0 && extent.y > 0.0) {
        return Err(ColorError::new(ColorErrorKind::Extent { extent }));
    }
    Ok(())
}

/// The width and height of a pixel in the plane.
pub(crate) fn pixel(extent: DVec2, size: [u32; 2]) -> DVec2 {
    extent / DVec2::new(size[0].max(1).into(), size[1].max(1).into())
}

/// Refuses a radius that is not a number of pixels from 0 to [`MAX_RADIUS`].
pub(crate) fn check_radius(
    what: &'static str,
    radius: f64,
    pixel: DVec2,
) -> Result<(), ColorError> {
    if !radius.is_finite() {
        let value = radius;
        return Err(ColorError::new(ColorErrorKind::NotFinite { what, value }));
    }
    let pixels = radius / pixel.min_element();
    // Written so that a pixel of no size, whose quotient is not a number, is refused too.
    if !(pixels >= 0.0 && pixels <= f64::from(MAX_RADIUS)) {
        return Err(ColorError::new(ColorErrorKind::Radius {
            radius,
            pixels,
            limit: MAX_RADIUS,
        }));
    }
    Ok(())
}

/// The index within the line, as by [`Wrap::index`], and quick where nothing has to be brought back.
#[inline(always)]
pub(crate) fn index(wrap: Wrap, index: i64, length: u32) -> usize {
    if (0..i64::from(length)).contains(&index) {
        index as usize
    } else {
        wrap.index(index, length) as usize
    }
}

/// Has `fill` write every row, on all cores where the feature `rayon` is on.
pub(crate) fn fill_rows(raster: &mut Raster<f32>, fill: impl Fn(u32, &mut [f32]) + Sync) {
    let width = raster.width() as usize;
    parallel::for_each_chunk(raster.pixels_mut(), width, |row, values| {
        fill(row as u32, values);
    });
}
