//! From rasters of values to files in one call.
//!
//! Codes are made on all cores where the feature `rayon` is on. Values below 0 and above 1 are clamped in PNG, and NaN
//! becomes 0; OpenEXR keeps every number as it is.

use crate::{ExrPlane, ImageError, PngPixel, Transfer, write_exr, write_png};
use dapple_color::{Code, LinearRgb, LinearRgba, Normal};
use dapple_raster::Raster;
use std::path::Path;

/// How many bits a channel has in a PNG file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Depth {
    /// 8 bits: 256 steps.
    #[default]
    Eight,
    /// 16 bits: 65536 steps, for heights and whatever is computed with later.
    Sixteen,
}

/// Writes data from 0 to 1 as a gray PNG file: `round(value · max)`, linear, without a color chunk.
///
/// # Errors
///
/// [`ImageErrorKind::Io`](crate::ImageErrorKind::Io) if the file cannot be written.
pub fn write_gray_png(
    path: impl AsRef<Path>,
    values: &Raster<f32>,
    depth: Depth,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    match depth {
        Depth::Eight => write(path, values, Transfer::Data, |&value| u8::from_unit(value)),
        Depth::Sixteen => write(path, values, Transfer::Data, |&value| u16::from_unit(value)),
    }
}

/// Writes colors as an RGB PNG file under the sRGB curve, with the chunk that says so.
///
/// # Errors
///
/// [`ImageErrorKind::Io`](crate::ImageErrorKind::Io) if the file cannot be written.
pub fn write_color_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgb>,
    depth: Depth,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    match depth {
        Depth::Eight => write(path, colors, Transfer::Srgb, |color| color.to_srgb::<u8>()),
        Depth::Sixteen => write(path, colors, Transfer::Srgb, |color| color.to_srgb::<u16>()),
    }
}

/// Writes colors with alpha as an RGBA PNG file: color under the sRGB curve, with the chunk that says so, alpha linear.
///
/// # Errors
///
/// [`ImageErrorKind::Io`](crate::ImageErrorKind::Io) if the file cannot be written.
pub fn write_color_alpha_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgba>,
    depth: Depth,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    match depth {
        Depth::Eight => write(path, colors, Transfer::Srgb, |color| color.to_srgb::<u8>()),
        Depth::Sixteen => write(path, colors, Transfer::Srgb, |color| color.to_srgb::<u16>()),
    }
}

/// Writes normals as an RGB PNG file: `round((part + 1) / 2 · max)`, linear, without a color chunk.
///
/// # Errors
///
/// [`ImageErrorKind::Io`](crate::ImageErrorKind::Io) if the file cannot be written.
pub fn write_normal_png(
    path: impl AsRef<Path>,
    normals: &Raster<Normal>,
    depth: Depth,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    match depth {
        Depth::Eight => write(path, normals, Transfer::Data, |normal| {
            normal.to_codes::<u8>()
        }),
        Depth::Sixteen => write(path, normals, Transfer::Data, |normal| {
            normal.to_codes::<u16>()
        }),
    }
}

/// Writes data as an OpenEXR file with the one plane `Y`.
///
/// # Errors
///
/// Those of [`write_exr`].
pub fn write_gray_exr(path: impl AsRef<Path>, values: &Raster<f32>) -> Result<(), ImageError> {
    write_exr(path, &[ExrPlane::new("Y", values.clone())])
}

/// Writes colors as an OpenEXR file with the planes `R`, `G` and `B`, linear.
///
/// # Errors
///
/// Those of [`write_exr`].
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
/// Those of [`write_exr`].
pub fn write_color_alpha_exr(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgba>,
) -> Result<(), ImageError> {
    write_exr(path, &ExrPlane::from_colors_with_alpha(colors))
}

fn write<T: Sync, P: PngPixel + Send>(
    path: &Path,
    raster: &Raster<T>,
    transfer: Transfer,
    code: impl Fn(&T) -> P + Sync,
) -> Result<(), ImageError> {
    write_png(path, raster.par_map(code).view(), transfer)
}
