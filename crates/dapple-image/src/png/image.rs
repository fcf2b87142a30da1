//! Content of a PNG file. Other formats of 8 and 16 bits are decoded to the same type.

use super::Transfer;
use crate::orientation::Stored;
use crate::{ColorSpace, ImageError};
use dapple_color::Code;
use dapple_raster::Raster;

/// Content of a PNG file.
#[derive(Clone, Debug, PartialEq)]
pub struct PngImage {
    /// The pixels.
    pub pixels: PngPixels,
    /// [`Transfer::Srgb`] if the file declares it (with the chunk `sRGB`, or a `gAMA` of 0.45455), else
    /// [`Transfer::Data`]; a file without a declaration may still hold color.
    pub transfer: Transfer,
    /// Declared color space. It does not affect gray images and data, which use the codes of the file.
    pub space: ColorSpace,
}

/// Pixels in one of PNG's formats; alpha comes last.
#[derive(Clone, Debug, PartialEq)]
pub enum PngPixels {
    /// Gray, 8 bits.
    Gray8(Raster<u8>),
    /// Gray, 16 bits.
    Gray16(Raster<u16>),
    /// Gray and alpha, 8 bits.
    GrayAlpha8(Raster<[u8; 2]>),
    /// Gray and alpha, 16 bits.
    GrayAlpha16(Raster<[u16; 2]>),
    /// Red, green and blue, 8 bits.
    Rgb8(Raster<[u8; 3]>),
    /// Red, green and blue, 16 bits.
    Rgb16(Raster<[u16; 3]>),
    /// Red, green, blue and alpha, 8 bits.
    Rgba8(Raster<[u8; 4]>),
    /// Red, green, blue and alpha, 16 bits.
    Rgba16(Raster<[u16; 4]>),
}

impl PngPixels {
    /// Creates upright pixels from the 8-bit samples of a file, with 1 to 4 channels.
    pub(crate) fn from_codes8(
        stored: Stored,
        n_channels: usize,
        samples: &[u8],
    ) -> Result<Self, ImageError> {
        Ok(match n_channels {
            1 => Self::Gray8(stored.upright(samples)?),
            2 => Self::GrayAlpha8(stored.upright(samples.as_chunks().0)?),
            3 => Self::Rgb8(stored.upright(samples.as_chunks().0)?),
            _ => Self::Rgba8(stored.upright(samples.as_chunks().0)?),
        })
    }

    /// Creates upright pixels from the 16-bit samples of a file, with 1 to 4 channels.
    #[cfg(feature = "tiff")]
    pub(crate) fn from_codes16(
        stored: Stored,
        n_channels: usize,
        samples: &[u16],
    ) -> Result<Self, ImageError> {
        Ok(match n_channels {
            1 => Self::Gray16(stored.upright(samples)?),
            2 => Self::GrayAlpha16(stored.upright(samples.as_chunks().0)?),
            3 => Self::Rgb16(stored.upright(samples.as_chunks().0)?),
            _ => Self::Rgba16(stored.upright(samples.as_chunks().0)?),
        })
    }

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Gray8(raster) => raster.size(),
            Self::Gray16(raster) => raster.size(),
            Self::GrayAlpha8(raster) => raster.size(),
            Self::GrayAlpha16(raster) => raster.size(),
            Self::Rgb8(raster) => raster.size(),
            Self::Rgb16(raster) => raster.size(),
            Self::Rgba8(raster) => raster.size(),
            Self::Rgba16(raster) => raster.size(),
        }
    }

    /// Returns a raster for each channel, with the codes divided by the largest code. Alpha comes last.
    #[must_use]
    pub fn planes(&self) -> Vec<Raster<f32>> {
        fn split<C: Code, const N: usize>(raster: &Raster<[C; N]>) -> Vec<Raster<f32>> {
            let plane = |channel: usize| raster.map(|pixel| pixel[channel].to_unit());
            (0..N).map(plane).collect()
        }
        match self {
            Self::Gray8(raster) => vec![raster.map(|code| code.to_unit())],
            Self::Gray16(raster) => vec![raster.map(|code| code.to_unit())],
            Self::GrayAlpha8(raster) => split(raster),
            Self::GrayAlpha16(raster) => split(raster),
            Self::Rgb8(raster) => split(raster),
            Self::Rgb16(raster) => split(raster),
            Self::Rgba8(raster) => split(raster),
            Self::Rgba16(raster) => split(raster),
        }
    }
}
