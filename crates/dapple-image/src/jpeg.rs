//! JPEG decoder for 8-bit gray and color images, baseline and progressive.
//!
//! Reference: ITU-T T.81, "Digital compression and coding of continuous-tone still images", 1992, with JFIF (ITU-T
//! T.871) and Exif. The codec is the crate `zune-jpeg`, without its SIMD, so that a file has the same pixels on every
//! machine. The color space is taken from the ICC profile, else from Exif; the default is sRGB. The Exif orientation
//! is applied, as in browsers and editors. Other codings, other depths and CMYK give errors that name the feature.
//!
//! In programs that unwind on panic (the default), a panic in the codec is caught here and becomes
//! [`ImageErrorKind::Damaged`].

use crate::error::guarded;
use crate::{Format, ImageError, ImageErrorKind, Limits, PngImage, PngPixels, Transfer, exif, icc};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Second byte of the start-of-scan marker.
const START_OF_SCAN: u8 = 0xda;

/// Second byte of the end-of-image marker.
const END_OF_IMAGE: u8 = 0xd9;

/// Maximum side of an image in the format, in pixels.
const SIDE_LIMIT: usize = 65_535;

/// Memory per sample, in bytes: one for the code and two for the 16-bit coefficient, since decoding a progressive
/// file needs all coefficients.
const SAMPLE_BYTES: u64 = 3;

/// Decodes a JPEG file to [`PngPixels::Gray8`] or [`PngPixels::Rgb8`] with its color space; the default is sRGB.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the bytes lack the JPEG signature, [`ImageErrorKind::Damaged`] if they
/// violate the format's rules or end too soon, [`ImageErrorKind::Unsupported`] for CMYK, for arithmetic, lossless or
/// hierarchical coding, and for depths other than 8 bits. [`ImageErrorKind::TooManyPixels`] or
/// [`ImageErrorKind::TooManyBytes`] beyond a limit; each sample counts as three bytes, the most that decoding can
/// take.
pub fn decode_jpeg(bytes: &[u8], limits: &Limits) -> Result<PngImage, ImageError> {
    Format::Jpeg.check(bytes)?;
    guarded(Format::Jpeg, || decode(bytes, limits))
}

fn decode(bytes: &[u8], limits: &Limits) -> Result<PngImage, ImageError> {
    check_end(bytes)?;
    if let Some(feature) = frame(bytes).and_then(unread_feature) {
        return Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
    }
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(SIDE_LIMIT)
        .set_max_height(SIDE_LIMIT);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(refusal)?;
    let [width, height] = decoder
        .dimensions()
        .map_or([0, 0], |(width, height)| [width as u32, height as u32]);
    limits.check_pixels([width, height].map(u64::from))?;
    let output = match decoder.input_colorspace() {
        Some(ColorSpace::Luma) => ColorSpace::Luma,
        Some(ColorSpace::YCbCr | ColorSpace::RGB) => ColorSpace::RGB,
        _ => {
            let feature = "a JPEG image that is neither gray nor RGB";
            return Err(ImageError::new(ImageErrorKind::Unsupported { feature }));
        }
    };
    decoder.set_options(options.jpeg_set_out_colorspace(output));
    let n_samples = decoder.output_buffer_size().unwrap_or(usize::MAX);
    limits.check_bytes(SAMPLE_BYTES.saturating_mul(n_samples as u64))?;
    let mut samples = vec![0; n_samples];
    decoder.decode_into(&mut samples).map_err(refusal)?;
    let exif = decoder.exif().map(Vec::as_slice).unwrap_or_default();
    let space = match decoder.icc_profile() {
        Some(profile) => icc::color_space(&profile),
        None => exif::color_space(exif),
    };
    let n_channels = output.num_components();
    let stored = exif::orientation(exif).stored([width, height], Format::Jpeg);
    Ok(PngImage {
        pixels: PngPixels::from_codes8(stored, n_channels, &samples)?,
        transfer: Transfer::Srgb,
        space,
    })
}

/// Checks that the last scan of a file is complete; otherwise the codec would invent its last pixels.
///
/// Neither the start-of-scan nor the end-of-image marker can occur within a scan. An embedded preview ends before the
/// first scan begins.
fn check_end(bytes: &[u8]) -> Result<(), ImageError> {
    let last = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xff, marker]);
    if last(END_OF_IMAGE) > last(START_OF_SCAN) {
        Ok(())
    } else {
        Err(ImageError::damaged("JPEG", "the end is missing"))
    }
}

/// Returns the frame header of a file: marker, bits per sample, and number of channels (T.81, B.2.2). It precedes the
/// first scan.
fn frame(bytes: &[u8]) -> Option<[u8; 3]> {
    let mut rest = bytes.get(2..)?;
    loop {
        match *rest {
            // Fill bytes may precede a marker.
            [0xff, 0xff, ..] => rest = &rest[1..],
            // Huffman tables, arithmetic tables and reserved markers are not frames.
            [
                0xff,
                marker @ (0xc0..=0xcf | 0xf7),
                _,
                _,
                bits,
                _,
                _,
                _,
                _,
                channels,
                ..,
            ] if !matches!(marker, 0xc4 | 0xc8 | 0xcc) => {
                return Some([marker, bits, channels]);
            }
            [0xff, marker, high, low, ..] if marker != START_OF_SCAN => {
                rest = rest.get(2 + usize::from(u16::from_be_bytes([high, low]))..)?;
            }
            _ => return None,
        }
    }
}

/// Returns the name of the unsupported feature that a frame uses (T.81, table B.1; T.87 for JPEG-LS).
fn unread_feature([marker, bits, channels]: [u8; 3]) -> Option<&'static str> {
    Some(match marker {
        0xc3 | 0xc7 | 0xcb | 0xcf => "lossless JPEG",
        0xf7 => "JPEG-LS",
        0xc5 | 0xc6 | 0xcd | 0xce => "hierarchical JPEG",
        0xc9 | 0xca => "JPEG with arithmetic coding",
        _ if bits != 8 => "JPEG with other than 8 bits per channel",
        _ if channels == 4 => "CMYK in JPEG",
        _ => return None,
    })
}

fn refusal(error: DecodeErrors) -> ImageError {
    match error {
        DecodeErrors::Unsupported(_) => {
            let feature = "this kind of JPEG coding";
            ImageError::new(ImageErrorKind::Unsupported { feature }).because(error.to_string())
        }
        _ => ImageError::damaged("JPEG", error.to_string()),
    }
}
