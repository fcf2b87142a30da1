//! PNG encoder.
//!
//! Color is marked with the chunk `sRGB` (perceptual intent) and also with `gAMA` for programs that do not support
//! `sRGB`, as the specification recommends. Data has no color chunk: viewers would brighten a height map with a `gAMA`
//! of 1, while programs that read data use the codes.

use super::stream::{PngStream, Samples};
use super::{PngPixel, Transfer};
use crate::{ImageError, file};
use dapple_raster::RasterView;
use std::path::Path;

/// Encodes pixels with 8 or 16 bits per channel as a PNG file in memory.
///
/// The bytes depend only on the pixels and `transfer`.
///
/// # Errors
///
/// [`Empty`](crate::ImageErrorKind::Empty) if the view has no pixel,
/// [`TooManyBytes`](crate::ImageErrorKind::TooManyBytes) if a row takes more than 2^30 bytes,
/// [`TooLarge`](crate::ImageErrorKind::TooLarge) if a side is longer than 2^31 - 1 pixels.
///
/// # Examples
///
/// ```
/// use dapple_image::{Limits, PngPixels, Transfer, decode_png, encode_png};
/// use dapple_raster::Raster;
///
/// let raster = Raster::from_fn([4, 2], |x, y| [x as u8, y as u8, 9])?;
/// let bytes = encode_png(raster.view(), Transfer::Srgb)?;
/// assert_eq!(decode_png(&bytes, &Limits::default())?.pixels, PngPixels::Rgb8(raster));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn encode_png<P: PngPixel>(
    pixels: RasterView<'_, P>,
    transfer: Transfer,
) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Vec::new();
    let mut stream = PngStream::new(&mut bytes, pixels.size(), Samples::of::<P>(), transfer)?;
    stream.write_rows(&mut bytes, pixels, |&pixel| pixel)?;
    stream.finish(&mut bytes)?;
    Ok(bytes)
}

/// Writes pixels with 8 or 16 bits per channel to a PNG file.
///
/// # Errors
///
/// Same as [`encode_png`], plus [`Io`](crate::ImageErrorKind::Io) if the file cannot be written; in that case, an
/// existing file is unchanged.
pub fn write_png<P: PngPixel>(
    path: impl AsRef<Path>,
    pixels: RasterView<'_, P>,
    transfer: Transfer,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    let bytes = encode_png(pixels, transfer).map_err(|error| error.at(path))?;
    file::replace(path, &bytes)
}
