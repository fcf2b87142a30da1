//! WebP decoder: still images, lossy and lossless, with or without alpha.
//!
//! References: RFC 9649, "WebP Image Format", 2024; RFC 6386, "VP8 Data Format and Decoding Guide", 2011. The codec is
//! the crate `image-webp`, whose still images use whole numbers only, so that a file has the same pixels on every
//! machine. The color space is taken from the ICC profile, else from Exif; the default is sRGB. The Exif orientation is
//! applied, as in JPEG. Animations give an error.

use crate::error::guarded;
use crate::{Format, ImageError, ImageErrorKind, Limits, PngImage, PngPixels, Transfer, exif, icc};
use image_webp::{DecodingError, WebPDecoder};
use std::io::Cursor;

/// Maximum memory per pixel, in bytes: four for the codes, four for the upright image, and eight for the codec.
const PIXEL_BYTES: u64 = 16;

/// Decodes a file with a WebP signature.
pub(crate) fn decode(bytes: &[u8], limits: &Limits) -> Result<PngImage, ImageError> {
    guarded(Format::WebP, || decode_guarded(bytes, limits))
}

fn decode_guarded(bytes: &[u8], limits: &Limits) -> Result<PngImage, ImageError> {
    let length = bytes[4..]
        .first_chunk()
        .map_or(0, |n| u32::from_le_bytes(*n));
    if bytes.len() - 8 < length as usize {
        return Err(damaged("the end is missing"));
    }
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(refusal)?;
    if decoder.is_animated() {
        let feature = "an animated WebP image";
        return Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
    }
    let (width, height) = decoder.dimensions();
    let size = [width, height];
    limits.check_pixels(size.map(u64::from))?;
    limits.check_bytes(PIXEL_BYTES * u64::from(width) * u64::from(height))?;
    if frame_size(bytes).is_some_and(|frame| frame != size) {
        return Err(damaged("the frame is not of the size of the image"));
    }
    decoder.set_memory_limit(usize::try_from(limits.bytes).unwrap_or(usize::MAX));
    let profile = decoder.icc_profile().map_err(refusal)?;
    let exif = decoder
        .exif_metadata()
        .map_err(refusal)?
        .unwrap_or_default();
    let n_channels = if decoder.has_alpha() { 4 } else { 3 };
    let mut samples = vec![0; decoder.output_buffer_size().unwrap_or_default()];
    decoder.read_image(&mut samples).map_err(refusal)?;
    let stored = exif::orientation(&exif).stored(size, Format::WebP);
    Ok(PngImage {
        pixels: PngPixels::from_codes8(stored, n_channels, &samples)?,
        transfer: Transfer::Srgb,
        space: match profile {
            Some(profile) => icc::color_space(&profile),
            None => exif::color_space(&exif),
        },
    })
}

/// Returns the width and height in the header of a lossy frame. The codec allocates memory for the frame before it
/// compares this size with the size of the image.
fn frame_size(bytes: &[u8]) -> Option<[u32; 2]> {
    let mut chunk = bytes.get(12..)?;
    loop {
        let length = u32::from_le_bytes(*chunk.get(4..)?.first_chunk()?) as usize;
        let content = chunk.get(8..)?;
        if chunk.starts_with(b"VP8 ") {
            // The frame tag and the start code take six bytes. Two bits of each side select the scale.
            let side = |at: usize| content.get(at..)?.first_chunk().copied();
            let side = |at: usize| Some(u32::from(u16::from_le_bytes(side(at)?) & 0x3fff));
            return Some([side(6)?, side(8)?]);
        }
        // Chunks are padded to an even length.
        chunk = content.get(length.checked_next_multiple_of(2)?..)?;
    }
}

fn refusal(error: DecodingError) -> ImageError {
    match error {
        DecodingError::UnsupportedFeature(_) => {
            let feature = "this kind of WebP coding";
            ImageError::new(ImageErrorKind::Unsupported { feature }).because(error)
        }
        _ => ImageError::damaged(Format::WebP.name(), error),
    }
}

fn damaged(reason: &'static str) -> ImageError {
    ImageError::damaged(Format::WebP.name(), reason)
}
