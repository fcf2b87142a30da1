//! Functions that write rasters as OpenEXR files in one call. Values are preserved exactly.

use super::{ExrPlane, write_exr};
use crate::ImageError;
use dapple_color::{LinearRgb, LinearRgba};
use dapple_raster::Raster;
use std::path::Path;

/// Writes data as an OpenEXR file with the single plane `Y`.
///
/// # Errors
///
/// Same as [`write_exr`].
pub fn write_gray_exr(path: impl AsRef<Path>, values: &Raster<f32>) -> Result<(), ImageError> {
    write_exr(path, &[ExrPlane::new("Y", values.clone())])
}

/// Writes colors as an OpenEXR file with the planes `R`, `G` and `B`, linear.
///
/// # Errors
///
/// Same as [`write_exr`].
pub fn write_color_exr(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgb>,
) -> Result<(), ImageError> {
    write_exr(path, &ExrPlane::from_colors(colors))
}

/// Writes colors with alpha as an OpenEXR file with the planes `R`, `G`, `B` and `A`, linear, alpha multiplied in.
///
/// # Errors
///
/// Same as [`write_exr`].
pub fn write_color_alpha_exr(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgba>,
) -> Result<(), ImageError> {
    write_exr(path, &ExrPlane::from_colors_with_alpha(colors))
}
