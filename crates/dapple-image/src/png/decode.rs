//! PNG decoder.
//!
//! Palettes, 1, 2 and 4 bits, the transparent color (`tRNS`) and interlacing are resolved into the eight variants of
//! [`PngPixels`]. Of an animation, the first frame is read. The size is checked against the limits before memory for
//! the pixels is allocated.

use super::{PngImage, PngPixel, PngPixels, Transfer, space};
use crate::{Format, ImageError, ImageErrorKind, Limits};
use dapple_raster::Raster;
use png::{BitDepth, ColorType, DecodingError};
use std::io::Cursor;

/// Decodes the bytes of a PNG file.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the bytes lack the PNG signature, [`ImageErrorKind::Damaged`] if they violate
/// the format's rules or end too soon, [`ImageErrorKind::TooManyPixels`] or [`ImageErrorKind::TooManyBytes`] past a
/// limit.
pub fn decode_png(bytes: &[u8], limits: &Limits) -> Result<PngImage, ImageError> {
    Format::Png.check(bytes)?;
    let mut decoder = decoder(bytes, limits);
    let refuse = |error| refusal(error, limits);
    check_not_empty(bytes)?;
    let header = decoder.read_header_info().map_err(refuse)?;
    let size = [header.width, header.height];
    limits.check_pixels(size.map(u64::from))?;
    let mut reader = decoder.read_info().map_err(refuse)?;
    check_palette(reader.info())?;
    let length = reader.output_buffer_size().unwrap_or(usize::MAX);
    limits.check_bytes(length as u64)?;
    let mut samples = vec![0; length];
    reader.next_frame(&mut samples).map_err(refuse)?;
    // Read to the end of the file, because an error in a later chunk makes the whole file count as damaged.
    reader.finish().map_err(refuse)?;
    image_of(&reader, size, &samples)
}

/// Decodes a region of a PNG file: `size` pixels starting at column and row `first`. Only the region counts against
/// the limits. Rows below it are neither read nor checked for damage.
///
/// # Errors
///
/// Same as [`decode_png`], plus [`ImageErrorKind::Outside`] if the region extends beyond the image;
/// [`ImageErrorKind::Unsupported`] for an interlaced file, whose rows are not stored in order.
pub fn decode_png_region(
    bytes: &[u8],
    first: [u32; 2],
    size: [u32; 2],
    limits: &Limits,
) -> Result<PngImage, ImageError> {
    Format::Png.check(bytes)?;
    check_not_empty(bytes)?;
    let refuse = |error| refusal(error, limits);
    let mut reader = decoder(bytes, limits).read_info().map_err(refuse)?;
    check_palette(reader.info())?;
    let image = [reader.info().width, reader.info().height];
    let reaches_out =
        |axis: usize| u64::from(first[axis]) + u64::from(size[axis]) > u64::from(image[axis]);
    if reaches_out(0) || reaches_out(1) {
        return Err(ImageError::new(ImageErrorKind::Outside {
            first,
            size,
            image,
        }));
    }
    if reader.info().interlaced {
        let feature = "a part of an interlaced PNG image";
        return Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
    }
    limits.check_pixels(size.map(u64::from))?;
    let row_length = reader.output_line_size(image[0]).unwrap_or(usize::MAX);
    // Rows are whole numbers of bytes, since depths below 8 bits are expanded.
    let pixel_length = row_length / image[0] as usize;
    let [left, width] = [first[0], size[0]].map(|columns| columns as usize * pixel_length);
    limits.check_bytes((width as u64).saturating_mul(size[1].into()))?;
    let mut samples = Vec::with_capacity(width * size[1] as usize);
    for row in 0..first[1] + size[1] {
        let Some(data) = reader.next_row().map_err(refuse)? else {
            return Err(ImageError::damaged("PNG", "rows are missing"));
        };
        if row >= first[1] {
            samples.extend_from_slice(&data.data()[left..left + width]);
        }
    }
    image_of(&reader, size, &samples)
}

/// Creates an image from decoded samples, with the color space that the file declares.
fn image_of(
    reader: &png::Reader<Cursor<&[u8]>>,
    size: [u32; 2],
    samples: &[u8],
) -> Result<PngImage, ImageError> {
    let transfer = transfer_of(reader.info());
    let pixels = PngPixels::from_samples(size, reader.output_color_type(), samples)?;
    let space = space::of(reader.info());
    Ok(PngImage {
        pixels,
        transfer,
        space,
    })
}

/// Creates the decoder, configured to expand palettes and depths below 8 bits.
fn decoder<'a>(bytes: &'a [u8], limits: &Limits) -> png::Decoder<Cursor<&'a [u8]>> {
    let mut decoder = png::Decoder::new_with_options(Cursor::new(bytes), options());
    decoder.set_limits(png::Limits {
        bytes: usize::try_from(limits.bytes).unwrap_or(usize::MAX),
    });
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder
}

/// Checks that the size is not 0, which the codec would report as damage.
fn check_not_empty(bytes: &[u8]) -> Result<(), ImageError> {
    // The signature is followed by the length of the first chunk, its name, and width and height in four bytes each.
    let Some(header) = bytes
        .get(12..24)
        .and_then(|header| header.strip_prefix(b"IHDR"))
    else {
        return Ok(());
    };
    let number = |digits: &[u8]| {
        digits
            .iter()
            .fold(0, |number, &digit| number << 8 | u64::from(digit))
    };
    let size = [number(&header[..4]), number(&header[4..])];
    if size.contains(&0) {
        return Err(ImageError::new(ImageErrorKind::Empty { size }));
    }
    Ok(())
}

/// Checks that a palette does not end within a color. Version 0.18.1 of the codec reads the missing bytes
/// from beyond its end (image-rs/image-png, issue 694).
fn check_palette(info: &png::Info<'_>) -> Result<(), ImageError> {
    match &info.palette {
        Some(palette) if palette.len() % 3 != 0 => {
            let message = format!(
                "a palette has three bytes for each color, not {} in all",
                palette.len()
            );
            Err(ImageError::damaged("PNG", message))
        }
        _ => Ok(()),
    }
}

/// Returns codec options that enable all checks and skip unused chunks.
fn options() -> png::DecodeOptions {
    let mut options = png::DecodeOptions::default();
    options.set_ignore_checksums(false);
    options.set_ignore_text_chunk(true);
    options
}

fn refusal(error: DecodingError, limits: &Limits) -> ImageError {
    match error {
        DecodingError::LimitsExceeded => {
            let limit = limits.bytes;
            ImageError::new(ImageErrorKind::TooManyBytes {
                bytes: limit.saturating_add(1),
                limit,
            })
        }
        other => ImageError::damaged("PNG", other),
    }
}

fn transfer_of(info: &png::Info<'_>) -> Transfer {
    let gamma = info.gama_chunk.map(png::ScaledFloat::into_scaled);
    if info.srgb.is_some() || gamma == Some(super::GAMMA_OF_SRGB) {
        Transfer::Srgb
    } else {
        Transfer::Data
    }
}

impl PngPixels {
    fn from_samples(
        size: [u32; 2],
        format: (ColorType, BitDepth),
        samples: &[u8],
    ) -> Result<Self, ImageError> {
        use BitDepth::{Eight, Sixteen};
        use ColorType::{Grayscale, GrayscaleAlpha, Rgb, Rgba};
        Ok(match format {
            (Grayscale, Eight) => Self::Gray8(raster(size, samples)?),
            (Grayscale, Sixteen) => Self::Gray16(raster(size, samples)?),
            (GrayscaleAlpha, Eight) => Self::GrayAlpha8(raster(size, samples)?),
            (GrayscaleAlpha, Sixteen) => Self::GrayAlpha16(raster(size, samples)?),
            (Rgb, Eight) => Self::Rgb8(raster(size, samples)?),
            (Rgb, Sixteen) => Self::Rgb16(raster(size, samples)?),
            (Rgba, Eight) => Self::Rgba8(raster(size, samples)?),
            (Rgba, Sixteen) => Self::Rgba16(raster(size, samples)?),
            // Other combinations are expanded by the codec.
            _ => {
                let feature = "this kind of PNG pixel";
                return Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
            }
        })
    }
}

fn raster<P: PngPixel>(size: [u32; 2], samples: &[u8]) -> Result<Raster<P>, ImageError> {
    let pixels = samples
        .chunks_exact(size_of::<P>())
        .map(P::from_bytes)
        .collect();
    Raster::from_vec(size, pixels).map_err(|error| ImageError::damaged("PNG", error))
}
