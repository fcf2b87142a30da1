//! Describes an image's channels, format and bit depth.

use crate::exr::Picture;
use crate::{ExrImage, Image, PngImage, PngPixels};
use core::fmt;

/// Channel layout of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Channels {
    /// One value per pixel: read with [`Image::gray`].
    Gray,
    /// One value per pixel, and alpha.
    GrayAlpha,
    /// Red, green and blue: read with [`Image::color`].
    Rgb,
    /// Red, green, blue and alpha: read with [`Image::color_alpha`].
    Rgba,
    /// The components X, Y and Z of vectors: read with [`Image::normals`].
    Vectors,
    /// OpenEXR planes with other names: read with [`ExrImage::plane`].
    Planes,
}

impl Channels {
    /// Returns whether there is an alpha channel.
    #[must_use]
    pub const fn has_alpha(self) -> bool {
        matches!(self, Self::GrayAlpha | Self::Rgba)
    }
}

impl fmt::Display for Channels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gray => "gray",
            Self::GrayAlpha => "gray with alpha",
            Self::Rgb => "RGB",
            Self::Rgba => "RGB with alpha",
            Self::Vectors => "vectors",
            Self::Planes => "named planes",
        })
    }
}

impl Image {
    /// Returns the name of the format, such as `PNG` or `OpenEXR`.
    #[must_use]
    pub const fn format(&self) -> &'static str {
        match self {
            Self::Codes(format, _) | Self::Planes(format, _) => format.name(),
        }
    }

    /// Returns the file's channel layout.
    #[must_use]
    pub fn channels(&self) -> Channels {
        match self {
            Self::Codes(_, image) => image.channels(),
            Self::Planes(_, image) => image.channels(),
        }
    }

    /// Returns the bits per channel: 8 or 16, and 32 for floating-point planes, whose samples are all read as `f32`.
    #[must_use]
    pub const fn bits(&self) -> u32 {
        match self {
            Self::Codes(_, image) => image.bits(),
            Self::Planes(..) => 32,
        }
    }
}

impl PngImage {
    fn channels(&self) -> Channels {
        match self.pixels {
            PngPixels::Gray8(_) | PngPixels::Gray16(_) => Channels::Gray,
            PngPixels::GrayAlpha8(_) | PngPixels::GrayAlpha16(_) => Channels::GrayAlpha,
            PngPixels::Rgb8(_) | PngPixels::Rgb16(_) => Channels::Rgb,
            PngPixels::Rgba8(_) | PngPixels::Rgba16(_) => Channels::Rgba,
        }
    }

    pub(crate) const fn bits(&self) -> u32 {
        match self.pixels {
            PngPixels::Gray8(_)
            | PngPixels::GrayAlpha8(_)
            | PngPixels::Rgb8(_)
            | PngPixels::Rgba8(_) => u8::BITS,
            PngPixels::Gray16(_)
            | PngPixels::GrayAlpha16(_)
            | PngPixels::Rgb16(_)
            | PngPixels::Rgba16(_) => u16::BITS,
        }
    }
}

impl ExrImage {
    fn channels(&self) -> Channels {
        match self.picture() {
            Ok(Picture::Gray { alpha: None, .. }) => Channels::Gray,
            Ok(Picture::Gray { .. }) => Channels::GrayAlpha,
            Ok(Picture::Color { alpha: None, .. }) => Channels::Rgb,
            Ok(Picture::Color { .. }) => Channels::Rgba,
            Ok(Picture::Vectors(_)) => Channels::Vectors,
            Err(_) => Channels::Planes,
        }
    }
}
