//! Functions that write rasters as PNG files in one call. Values below 0 and above 1 are clamped, and NaN becomes 0.

use crate::{Content, Depth, Encoding, ImageError, RowWriter, file};
use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_raster::Raster;
use std::io::Cursor;
use std::path::Path;

/// Writes data from 0 to 1 as a gray PNG file: `round(value · max)`, linear, without a color chunk.
///
/// # Errors
///
/// Same as [`write_png`](crate::write_png).
pub fn write_gray_png(
    path: impl AsRef<Path>,
    values: &Raster<f32>,
    depth: Depth,
) -> Result<(), ImageError> {
    let size = values.size();
    write(path.as_ref(), size, Content::Gray, depth, |rows| {
        rows.write_gray(values.view())
    })
}

/// Writes colors as an RGB PNG file, encoded with the sRGB curve, with an `sRGB` chunk.
///
/// # Errors
///
/// Same as [`write_png`](crate::write_png).
pub fn write_color_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgb>,
    depth: Depth,
) -> Result<(), ImageError> {
    let size = colors.size();
    write(path.as_ref(), size, Content::Color, depth, |rows| {
        rows.write_color(colors.view())
    })
}

/// Writes colors with alpha as an RGBA PNG file: colors encoded with the sRGB curve, with an `sRGB` chunk; alpha
/// linear.
///
/// # Errors
///
/// Same as [`write_png`](crate::write_png).
pub fn write_color_alpha_png(
    path: impl AsRef<Path>,
    colors: &Raster<LinearRgba>,
    depth: Depth,
) -> Result<(), ImageError> {
    let size = colors.size();
    write(path.as_ref(), size, Content::ColorAlpha, depth, |rows| {
        rows.write_color_alpha(colors.view())
    })
}

/// Writes normals as an RGB PNG file: `round((component + 1) / 2 · max)`, linear, without a color chunk.
///
/// # Errors
///
/// Same as [`write_png`](crate::write_png).
pub fn write_normal_png(
    path: impl AsRef<Path>,
    normals: &Raster<Normal>,
    depth: Depth,
) -> Result<(), ImageError> {
    let size = normals.size();
    write(path.as_ref(), size, Content::Normal, depth, |rows| {
        rows.write_normals(normals.view())
    })
}

fn write(
    path: &Path,
    size: [u32; 2],
    content: Content,
    depth: Depth,
    fill: impl FnOnce(&mut RowWriter<Cursor<Vec<u8>>>) -> Result<(), ImageError>,
) -> Result<(), ImageError> {
    let encode = || {
        let sink = Cursor::new(Vec::new());
        let mut writer = RowWriter::new(sink, size, content, Encoding::Png(depth))?;
        fill(&mut writer)?;
        writer.finish()
    };
    let bytes = encode().map_err(|error| error.at(path))?.into_inner();
    file::replace(path, &bytes)
}
