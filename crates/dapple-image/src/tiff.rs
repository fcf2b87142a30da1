//! TIFF decoder: gray and RGB images with 8 or 16 bits per channel or floating-point numbers, with or without alpha, in
//! strips or tiles, and `BigTIFF`.
//!
//! References: "TIFF Revision 6.0", Aldus Corporation, 1992; "Adobe Photoshop TIFF Technical Notes", 2002 (Deflate);
//! "Adobe Photoshop TIFF Technical Note 3", 2005 (floating point). The codec is the crate `tiff`, with the compressions
//! LZW, Deflate and `PackBits`.
//!
//! Codes become a [`PngImage`] with the color space of the ICC profile; the default is sRGB. Floating-point numbers
//! become an [`ExrImage`] in linear light of ITU-R BT.709, whatever a profile says. Associated alpha of codes is divided
//! out of the color, and straight alpha of floating-point numbers is multiplied in, since the two types hold straight and
//! associated colors. The orientation tag is applied.
//!
//! Palettes, CMYK, YCbCr and Lab, JPEG and fax compression, signed numbers, other depths and files of several pages give
//! errors that name the feature. Pages of reduced resolution and masks are skipped.

use crate::error::guarded;
use crate::orientation::{Orientation, Stored};
use crate::{
    ColorSpace, ExrImage, ExrPlane, Format, Image, ImageError, ImageErrorKind, Limits, PngImage,
    PngPixels, Transfer, icc,
};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult, DecodingSampleType};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

type Reader<'a> = Decoder<Cursor<&'a [u8]>>;

/// Maximum number of pages of reduced resolution that are skipped.
const REDUCED_PAGES_MAX: usize = 64;

/// How alpha relates to the colors of a file: the tag `ExtraSamples`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alpha {
    None,
    Associated,
    Straight,
}

/// Decodes a file with a TIFF signature.
pub(crate) fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, ImageError> {
    guarded(Format::Tiff, || decode_guarded(bytes, limits))
}

fn decode_guarded(bytes: &[u8], limits: &Limits) -> Result<Image, ImageError> {
    let refuse = |error| refusal(error, limits);
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(refuse)?;
    let size: [u32; 2] = decoder.dimensions().map_err(refuse)?.into();
    limits.check_pixels(size.map(u64::from))?;
    check_pages(bytes, limits)?;
    let (n_channels, alpha) = channels(&mut decoder, limits)?;
    let layout = decoder.image_buffer_layout().map_err(refuse)?;
    let sample_bytes = match (layout.sample_type, bits(&mut decoder)) {
        (Some(DecodingSampleType::U8), 8) => 1,
        (Some(DecodingSampleType::U16), 16) => 2,
        (Some(DecodingSampleType::F16 | DecodingSampleType::F32), _) => 4,
        (Some(DecodingSampleType::F64), _) => 8,
        _ => {
            return Err(unsupported(
                "TIFF without 8 or 16 bits or floating-point numbers",
            ));
        }
    };
    // Samples are in memory as decoded, in pixel order and upright.
    let n_samples = u64::from(size[0]) * u64::from(size[1]) * n_channels as u64;
    limits.check_bytes(3 * sample_bytes * n_samples)?;
    check_row_of_tile(&mut decoder, limits)?;
    let bytes_limit = usize::try_from(limits.bytes).unwrap_or(usize::MAX);
    let mut codec_limits = tiff::decoder::Limits::default();
    codec_limits.decoding_buffer_size = bytes_limit;
    codec_limits.intermediate_buffer_size = bytes_limit;
    let mut decoder = decoder.with_limits(codec_limits);
    let mut samples = DecodingResult::U8(Vec::new());
    decoder.read_image_to_buffer(&mut samples).map_err(refuse)?;
    let orientation = decoder.find_tag_unsigned(Tag::Orientation).ok().flatten();
    let profile = decoder.get_tag_u8_vec(Tag::IccProfile);
    Pixels {
        stored: Orientation::new(orientation.unwrap_or(1)).stored(size, Format::Tiff),
        n_channels,
        alpha,
        n_planes: layout.planes,
        space: profile.map_or_else(
            |_| ColorSpace::default(),
            |profile| icc::color_space(&profile),
        ),
    }
    .image(samples)
}

/// Returns the bits per sample.
fn bits(decoder: &mut Reader<'_>) -> u8 {
    decoder.colortype().map_or(0, |color| color.bit_depth())
}

/// Returns the number of channels and the kind of alpha.
fn channels(decoder: &mut Reader<'_>, limits: &Limits) -> Result<(usize, Alpha), ImageError> {
    let refuse = |error| refusal(error, limits);
    let extra: Option<Vec<u16>> = decoder
        .find_tag_unsigned_vec(Tag::ExtraSamples)
        .map_err(refuse)?;
    let alpha = match extra.unwrap_or_default().first() {
        Some(1) => Alpha::Associated,
        Some(2) => Alpha::Straight,
        _ => Alpha::None,
    };
    Ok(match decoder.colortype().map_err(refuse)? {
        ColorType::Gray(_) => (1, Alpha::None),
        ColorType::Multiband { num_samples: 2, .. } if alpha != Alpha::None => (2, alpha),
        ColorType::RGB(_) => (3, Alpha::None),
        // A fourth sample that the file does not explain counts as straight alpha.
        ColorType::RGBA(_) if alpha == Alpha::None => (4, Alpha::Straight),
        ColorType::RGBA(_) => (4, alpha),
        ColorType::CMYK(_) | ColorType::CMYKA(_) => return Err(unsupported("CMYK in TIFF")),
        _ => return Err(unsupported("a TIFF image that is neither gray nor RGB")),
    })
}

/// Refuses files of several pages. Masks and images of reduced resolution do not count.
fn check_pages(bytes: &[u8], limits: &Limits) -> Result<(), ImageError> {
    let refuse = |error| refusal(error, limits);
    let mut pages = Decoder::new(Cursor::new(bytes)).map_err(refuse)?;
    for _ in 0..REDUCED_PAGES_MAX {
        if !pages.more_images() {
            return Ok(());
        }
        pages.next_image().map_err(refuse)?;
        // Bit 0 marks a reduced resolution, bit 2 a mask.
        let kind: Option<u32> = pages
            .find_tag_unsigned(Tag::NewSubfileType)
            .map_err(refuse)?;
        if kind.unwrap_or(0) & 5 == 0 {
            return Err(unsupported("a TIFF file of several pages"));
        }
    }
    Ok(())
}

/// Checks the memory for a row of a tile, which the codec allocates even if the image is smaller.
fn check_row_of_tile(decoder: &mut Reader<'_>, limits: &Limits) -> Result<(), ImageError> {
    let samples = decoder
        .find_tag_unsigned(Tag::SamplesPerPixel)
        .ok()
        .flatten();
    let n_samples: u64 = samples.unwrap_or(1);
    let (width, _) = decoder.chunk_dimensions();
    let n_bits = u64::from(width).saturating_mul(n_samples * u64::from(bits(decoder)));
    limits.check_bytes(n_bits / 8)
}

/// Interpretation of decoded samples.
struct Pixels {
    stored: Stored,
    n_channels: usize,
    alpha: Alpha,
    /// Number of planes that follow each other; 1 if the channels of a pixel do.
    n_planes: usize,
    /// Color space of codes.
    space: ColorSpace,
}

impl Pixels {
    /// Returns the image that the samples of a file represent.
    fn image(self, samples: DecodingResult) -> Result<Image, ImageError> {
        let pixels = match samples {
            DecodingResult::U8(samples) => {
                PngPixels::from_codes8(self.stored, self.n_channels, &self.straight(&samples))?
            }
            DecodingResult::U16(samples) => {
                PngPixels::from_codes16(self.stored, self.n_channels, &self.straight(&samples))?
            }
            DecodingResult::F16(samples) => {
                return self.planes(samples.into_iter().map(|sample| sample.to_f32()).collect());
            }
            DecodingResult::F32(samples) => return self.planes(samples),
            DecodingResult::F64(samples) => {
                return self.planes(samples.into_iter().map(|sample| sample as f32).collect());
            }
            _ => return Err(unsupported("TIFF with signed numbers")),
        };
        let image = PngImage {
            pixels,
            transfer: Transfer::Data,
            space: self.space,
        };
        Ok(Image::Codes(Format::Tiff, image))
    }

    /// Returns the samples pixel by pixel.
    fn by_pixel<T: Copy>(&self, samples: &[T]) -> Vec<T> {
        if self.n_planes <= 1 {
            return samples.to_vec();
        }
        let plane = samples.len() / self.n_planes;
        let pixels = (0..plane).flat_map(|at| samples[at..].iter().step_by(plane));
        pixels.copied().collect()
    }

    /// Returns codes pixel by pixel, with the color divided by alpha and rounded to nearest.
    fn straight<C: Copy + Into<u64> + TryFrom<u64>>(&self, samples: &[C]) -> Vec<C> {
        let mut samples = self.by_pixel(samples);
        if self.alpha == Alpha::Associated {
            let max = (1_u64 << (8 * size_of::<C>())) - 1;
            for pixel in samples.chunks_exact_mut(self.n_channels) {
                let Some((alpha, colors)) = pixel.split_last_mut() else {
                    continue;
                };
                let alpha: u64 = (*alpha).into();
                for color in colors.iter_mut().filter(|_| alpha > 0) {
                    let code: u64 = (*color).into();
                    let straight = (code * max + alpha / 2) / alpha;
                    *color = C::try_from(straight.min(max)).unwrap_or(*color);
                }
            }
        }
        samples
    }

    /// Returns floating-point planes, with alpha multiplied into the color.
    fn planes(self, samples: Vec<f32>) -> Result<Image, ImageError> {
        let mut samples = self.by_pixel(&samples);
        if self.alpha == Alpha::Straight {
            for pixel in samples.chunks_exact_mut(self.n_channels) {
                if let Some((&mut alpha, colors)) = pixel.split_last_mut() {
                    colors.iter_mut().for_each(|color| *color *= alpha);
                }
            }
        }
        let image = ExrImage {
            planes: ExrPlane::from_samples(self.stored, self.n_channels, &samples)?,
            ..ExrImage::default()
        };
        Ok(Image::Planes(Format::Tiff, image))
    }
}

fn unsupported(feature: &'static str) -> ImageError {
    ImageError::new(ImageErrorKind::Unsupported { feature })
}

fn refusal(error: TiffError, limits: &Limits) -> ImageError {
    match error {
        TiffError::UnsupportedError(_) => unsupported("this kind of TIFF image").because(error),
        TiffError::LimitsExceeded => {
            let limit = limits.bytes;
            ImageError::new(ImageErrorKind::TooManyBytes {
                bytes: limit.saturating_add(1),
                limit,
            })
        }
        other => ImageError::damaged(Format::Tiff.name(), other),
    }
}
