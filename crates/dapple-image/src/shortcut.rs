//! From rasters of values to files in one call.

use crate::{ImageError, Transfer, write_png};
use dapple_color::{Code, LinearRgb, LinearRgba};
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

/// Writes data from 0 to 1 as a gray PNG file, linear, without a color chunk.
///
/// Values are quantized with `round(value · max)`; below 0 and above 1 they are clamped, and NaN becomes 0.
///
/// # Errors
///
/// [`ImageErrorKind::Io`](crate::ImageErrorKind::Io) if the file cannot be written.
pub fn write_gray_png(
    path: impl AsRef<Path>,
    values: &Raster<f32>,
    depth: Depth,
) -> Result<(), ImageError> {
    fn write<C: Code + crate::PngPixel>(
        path: &Path,
        values: &Raster<f32>,
    ) -> Result<(), ImageError> {
        let codes = values.map(|&value| C::from_unit(value));
        write_png(path, codes.view(), Transfer::Data)
    }
    match depth {
        Depth::Eight => write::<u8>(path.as_ref(), values),
        Depth::Sixteen => write::<u16>(path.as_ref(), values),
    }
}

/// Writes colors as an RGB PNG file under the sRGB curve, with the chunk that says so.
///
/// Parts below 0 and above 1 are clamped, and NaN becomes 0.
///
/// # Errors
///
/// [`ImageErrorKind::Io`](crate::ImageErrorKind::Io) if the file cannot be written.
pub fn write_color_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgb>,
    depth: Depth,
) -> Result<(), ImageError> {
    let (path, transfer) = (path.as_ref(), Transfer::Srgb);
    match depth {
        Depth::Eight => write_png(
            path,
            colors.map(|color| color.to_srgb::<u8>()).view(),
            transfer,
        ),
        Depth::Sixteen => write_png(
            path,
            colors.map(|color| color.to_srgb::<u16>()).view(),
            transfer,
        ),
    }
}

/// Writes colors with alpha as an RGBA PNG file: color under the sRGB curve, with the chunk that says so, alpha linear.
///
/// Parts below 0 and above 1 are clamped, and NaN becomes 0.
///
/// # Errors
///
/// [`ImageErrorKind::Io`](crate::ImageErrorKind::Io) if the file cannot be written.
pub fn write_color_alpha_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgba>,
    depth: Depth,
) -> Result<(), ImageError> {
    let (path, transfer) = (path.as_ref(), Transfer::Srgb);
    match depth {
        Depth::Eight => write_png(
            path,
            colors.map(|color| color.to_srgb::<u8>()).view(),
            transfer,
        ),
        Depth::Sixteen => write_png(
            path,
            colors.map(|color| color.to_srgb::<u16>()).view(),
            transfer,
        ),
    }
}
