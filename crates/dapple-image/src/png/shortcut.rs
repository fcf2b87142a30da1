//! Functions that write rasters as PNG files in one call. Values below 0 and above 1 are clamped, and NaN becomes 0.

use crate::content::Pixel;
use crate::{Depth, Encoding, ImageError, RowWriter, file};
use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_raster::Raster;
use std::io::Cursor;
use std::path::Path;

/// Writes data from 0 to 1 as a gray PNG file: `round(value · max)`, linear, without a color chunk.
///
/// # Errors
///
/// The errors of [`write_png`](crate::write_png).
pub fn write_gray_png(
    path: impl AsRef<Path>,
    values: &Raster<f32>,
    depth: Depth,
) -> Result<(), ImageError> {
    write(path.as_ref(), values, depth)
}

/// Writes colors as an RGB PNG file under the sRGB curve, with the chunk that says so.
///
/// # Errors
///
/// The errors of [`write_png`](crate::write_png).
pub fn write_color_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgb>,
    depth: Depth,
) -> Result<(), ImageError> {
    write(path.as_ref(), colors, depth)
}

/// Writes colors with alpha as an RGBA PNG file: color under the sRGB curve, with the chunk that says so, alpha linear.
///
/// # Errors
///
/// The errors of [`write_png`](crate::write_png).
pub fn write_color_alpha_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgba>,
    depth: Depth,
) -> Result<(), ImageError> {
    write(path.as_ref(), colors, depth)
}

/// Writes normals as an RGB PNG file: `round((part + 1) / 2 · max)`, linear, without a color chunk.
///
/// # Errors
///
/// The errors of [`write_png`](crate::write_png).
pub fn write_normal_png(
    path: impl AsRef<Path>,
    normals: &Raster<Normal>,
    depth: Depth,
) -> Result<(), ImageError> {
    write(path.as_ref(), normals, depth)
}

fn write<T: Pixel>(path: &Path, raster: &Raster<T>, depth: Depth) -> Result<(), ImageError> {
    let encode = || {
        let sink = Cursor::new(Vec::new());
        let encoding = Encoding::Png(depth);
        let mut writer = RowWriter::new(sink, raster.size(), T::CONTENT, encoding)?;
        writer.write(raster.view())?;
        writer.finish()
    };
    let bytes = encode().map_err(|error| error.at(path))?.into_inner();
    file::replace(path, &bytes)
}
