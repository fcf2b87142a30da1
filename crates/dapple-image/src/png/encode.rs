//! Writing PNG.
//!
//! Color is marked with the chunk `sRGB` (perceptual intent) and, for programs that do not know that one, with `gAMA`, as
//! the specification recommends. Data carries no color chunk at all: a `gAMA` of 1 would make viewers brighten a height
//! map, while programs that read data take the numbers as they are.

use super::{GAMMA_OF_SRGB, PngPixel, Transfer};
use crate::{ImageError, ImageErrorKind, file};
use dapple_raster::RasterView;
use std::path::Path;

/// A PNG file in memory from pixels of 8 or 16 bits.
///
/// The bytes depend on the pixels and `transfer` alone.
///
/// # Errors
///
/// [`ImageErrorKind::Empty`] if the view has no pixel.
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
    let size = pixels.size();
    if size.contains(&0) {
        let size = size.map(u64::from);
        return Err(ImageError::new(ImageErrorKind::Empty { size }));
    }
    let mut samples = Vec::with_capacity(size[0] as usize * size[1] as usize * size_of::<P>());
    for pixel in pixels.rows().flatten() {
        pixel.push_bytes(&mut samples);
    }
    let mut bytes = Vec::new();
    write(&mut bytes, size, P::FORMAT, transfer, &samples)
        .map_err(|error| ImageError::new(ImageErrorKind::Io).because(error))?;
    Ok(bytes)
}

/// Writes a PNG file from pixels of 8 or 16 bits.
///
/// # Errors
///
/// [`ImageErrorKind::Io`] if the file cannot be written; what was there before is then untouched.
/// [`ImageErrorKind::Empty`] if the view has no pixel.
pub fn write_png<P: PngPixel>(
    path: impl AsRef<Path>,
    pixels: RasterView<'_, P>,
    transfer: Transfer,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    let bytes = encode_png(pixels, transfer).map_err(|error| error.at(path))?;
    file::replace(path, &bytes)
}

fn write(
    bytes: &mut Vec<u8>,
    [width, height]: [u32; 2],
    (color, depth): (png::ColorType, png::BitDepth),
    transfer: Transfer,
    samples: &[u8],
) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if transfer == Transfer::Srgb {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_source_gamma(png::ScaledFloat::from_scaled(GAMMA_OF_SRGB));
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(samples)?;
    writer.finish()
}
