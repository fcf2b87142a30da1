//! The plane in which heights lie, shared by all maps from heights.
//!
//! Lengths are in units of the plane; a raster covers a stated extent of it.

use crate::{ColorError, ColorErrorKind};
use dapple_raster::glam::DVec2;
use dapple_raster::{Raster, Window, Wrap, parallel};

/// The largest radius in pixels.
const MAX_RADIUS: u32 = 1 << 14;

/// The position of a raster of heights in the plane, for normals, occlusion and curvature.
///
/// The options of each map can be made from it with [`From`], and contain it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct HeightPlane {
    /// The height in units of the plane of a value of 1; negative turns hills into dents. By default 1.
    pub strength: f64,
    /// The width and height of the raster in the plane, above zero. By default 1 × 1, as in [`Window::unit`]; a raster
    /// with square pixels that is not square needs its true proportions here.
    pub extent: DVec2,
    /// The wrapping past the edges of the height, along x and y. By default both repeat.
    pub wrap: [Wrap; 2],
}

impl Default for HeightPlane {
    fn default() -> Self {
        Self {
            strength: 1.0,
            extent: DVec2::ONE,
            wrap: [Wrap::Repeat; 2],
        }
    }
}

impl HeightPlane {
    /// The plane of heights that were rendered in a window.
    #[must_use]
    pub fn for_window(window: &Window) -> Self {
        let size = DVec2::new(window.size[0].into(), window.size[1].into());
        Self {
            extent: (window.pixel * window.scale * size).abs(),
            ..Self::default()
        }
    }

    /// Checks that the strength is finite and the extent is above zero and finite. `what` names the strength.
    pub(crate) fn check(&self, what: &'static str) -> Result<(), ColorError> {
        let Self {
            strength, extent, ..
        } = *self;
        if !strength.is_finite() {
            let value = strength;
            return Err(ColorError::new(ColorErrorKind::NotFinite { what, value }));
        }
        if !(extent.is_finite() && extent.x > 0.0 && extent.y > 0.0) {
            return Err(ColorError::new(ColorErrorKind::Extent { extent }));
        }
        Ok(())
    }

    /// The width and height of a pixel of a raster of `size` pixels.
    pub(crate) fn pixel(&self, size: [u32; 2]) -> DVec2 {
        self.extent / DVec2::new(size[0].max(1).into(), size[1].max(1).into())
    }
}

/// Checks that a radius is from 0 to [`MAX_RADIUS`] pixels.
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
    // Written so that a pixel without a size, whose quotient is NaN, is an error too.
    if !(pixels >= 0.0 && pixels <= f64::from(MAX_RADIUS)) {
        return Err(ColorError::new(ColorErrorKind::Radius {
            radius,
            pixels,
            limit: MAX_RADIUS,
        }));
    }
    Ok(())
}

/// The index within the line, like [`Wrap::index`], but fast for indices inside.
#[inline(always)]
pub(crate) fn index(wrap: Wrap, index: i64, length: u32) -> usize {
    if (0..i64::from(length)).contains(&index) {
        index as usize
    } else {
        wrap.index(index, length) as usize
    }
}

/// Calls `fill` for every row, on all cores where the feature `rayon` is on.
pub(crate) fn fill_rows(raster: &mut Raster<f32>, fill: impl Fn(u32, &mut [f32]) + Sync) {
    let width = raster.width() as usize;
    parallel::for_each_chunk(raster.pixels_mut(), width, |row, values| {
        fill(row as u32, values);
    });
}

#[cfg(test)]
pub(crate) mod checks;
