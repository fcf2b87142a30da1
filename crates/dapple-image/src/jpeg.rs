//! Decoder of JPEG: gray and color with 8 bits, baseline and progressive.
//!
//! Reference: ITU-T T.81, "Digital compression and coding of continuous-tone still images", 1992, with JFIF (ITU-T
//! T.871) and Exif. The codec is the crate `zune-jpeg`, without its SIMD, so that a file has the same pixels on every
//! machine. The color space is that of an ICC profile, else that of Exif, else sRGB. An image with an Exif orientation is turned upright, as in
//! browsers and editors. Other codings, other depths and CMYK are errors that name the feature.
//!
//! Where a program unwinds on panic (the default), a panic of the codec is caught here and becomes
//! [`ImageErrorKind::Damaged`].

mod exif;
mod orientation;

use crate::image::JPEG_SIGNATURE as SIGNATURE;
use crate::{ImageError, ImageErrorKind, Limits, PngImage, PngPixels, Transfer, icc};
use orientation::Orientation;
use std::panic::{AssertUnwindSafe, catch_unwind};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// The second byte of the marker at the beginning of a scan.
const START_OF_SCAN: u8 = 0xda;

/// The second byte of the marker at the end of an image.
const END_OF_IMAGE: u8 = 0xd9;

/// The longest side of the format, in pixels.
const SIDE_LIMIT: usize = 65_535;

/// Bytes of memory for each sample: its code, and its coefficient of 16 bits, of which a progressive file needs all.
const SAMPLE_BYTES: u64 = 3;

/// Decodes the bytes of a JPEG file to a PNG image of the same pixels: [`PngPixels::Gray8`] or [`PngPixels::Rgb8`],
/// with their color space, which is sRGB if the file says nothing else.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the bytes do not begin like JPEG, [`ImageErrorKind::Damaged`] if they break its
/// rules or end too soon, [`ImageErrorKind::Unsupported`] for CMYK, for arithmetic, lossless or hierarchical coding, and for other than 8 bits,
/// [`ImageErrorKind::TooManyPixels`] or [`ImageErrorKind::TooManyBytes`] past a limit, where each sample counts for three
/// bytes, since decoding may take as much.
pub fn decode_jpeg(bytes: &[u8], limits: &Limits) -> Result<PngImage, ImageError> {
    if !bytes.starts_with(&SIGNATURE) {
        return Err(ImageError::new(ImageErrorKind::UnknownFormat));
    }
    // No data that a panic could leave half done outlives the call.
    catch_unwind(AssertUnwindSafe(|| decode(bytes, limits)))
        .unwrap_or_else(|_| Err(ImageError::damaged("JPEG", "the codec gave up")))
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
    let orientation = Orientation::from_exif(exif);
    let space = match decoder.icc_profile() {
        Some(profile) => icc::color_space(&profile),
        None => exif::color_space(exif),
    };
    let pixels = match output {
        ColorSpace::Luma => PngPixels::Gray8(orientation.raster([width, height], &samples)?),
        _ => {
            let (pixels, _) = samples.as_chunks::<3>();
            PngPixels::Rgb8(orientation.raster([width, height], pixels)?)
        }
    };
    Ok(PngImage {
        pixels,
        transfer: Transfer::Srgb,
        space,
    })
}

/// Checks that the last scan of a file has an end; otherwise the codec makes up its last pixels.
///
/// Within a scan neither marker can occur, and a preview in the header ends before the first scan begins.
fn check_end(bytes: &[u8]) -> Result<(), ImageError> {
    let last = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xff, marker]);
    if last(END_OF_IMAGE) > last(START_OF_SCAN) {
        Ok(())
    } else {
        Err(ImageError::damaged("JPEG", "the end is missing"))
    }
}

/// The coding of a file: a marker, the bits of a sample, and the number of channels.
///
/// It stands in the header of the frame (T.81, B.2.2), before the first scan.
fn frame(bytes: &[u8]) -> Option<[u8; 3]> {
    let mut rest = bytes.get(2..)?;
    loop {
        match *rest {
            // A marker may be preceded by any number of these.
            [0xff, 0xff, ..] => rest = &rest[1..],
            // Tables of Huffman and arithmetic codes, and reserved markers, are no frames.
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

/// The name of the unsupported feature of a frame (T.81, table B.1; T.87 for JPEG-LS).
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
