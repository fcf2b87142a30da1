//! Content of a PNG file. JPEG files are decoded to the same type.

use super::Transfer;
use crate::ColorSpace;
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
}
