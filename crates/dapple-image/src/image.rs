//! Images whose format is found out by their first bytes.

use crate::{
    ExrImage, ImageError, ImageErrorKind, Limits, PngImage, decode_exr, decode_jpeg, decode_png,
    exr, file, jpeg, png,
};
use dapple_color::{LinearRgb, LinearRgba};
use dapple_raster::Raster;
use std::path::Path;

/// An image of one of the formats that are read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Image {
    /// A PNG file.
    Png(PngImage),
    /// A JPEG file, as the PNG image of the same pixels.
    Jpeg(PngImage),
    /// An OpenEXR file.
    Exr(ExrImage),
}

/// The image in the bytes of a file, whose format is found out by the first of them.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if it is none that is known, else those of [`decode_png`], [`decode_jpeg`] and
/// [`decode_exr`].
pub fn decode_image(bytes: &[u8], limits: &Limits) -> Result<Image, ImageError> {
    if bytes.starts_with(&png::SIGNATURE) {
        decode_png(bytes, limits).map(Image::Png)
    } else if bytes.starts_with(&jpeg::SIGNATURE) {
        decode_jpeg(bytes, limits).map(Image::Jpeg)
    } else if bytes.starts_with(&exr::SIGNATURE) {
        decode_exr(bytes, limits).map(Image::Exr)
    } else {
        Err(ImageError::new(ImageErrorKind::UnknownFormat))
    }
}

/// Reads an image file, whose format is found out by its first bytes (the name does not matter).
///
/// # Errors
///
/// [`ImageErrorKind::Io`] if the file cannot be read, else those of [`decode_image`].
pub fn read_image(path: impl AsRef<Path>, limits: &Limits) -> Result<Image, ImageError> {
    let path = path.as_ref();
    let bytes = file::read(path, limits.bytes)?;
    decode_image(&bytes, limits).map_err(|error| error.at(path))
}

impl Image {
    /// Columns and rows (of the first plane, where there are several).
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Png(image) | Self::Jpeg(image) => image.pixels.size(),
            Self::Exr(image) => image
                .planes
                .first()
                .map_or([0, 0], |plane| plane.values.size()),
        }
    }

    /// The numbers of a gray image as they are: from 0 to 1 in PNG and JPEG, of any size in OpenEXR.
    ///
    /// This is for data (heights, masks). No transfer curve is undone, whatever the file says. Alpha is allowed where it is
    /// 1 everywhere.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is not gray, or partly transparent.
    pub fn gray(&self) -> Result<Raster<f32>, ImageError> {
        match self {
            Self::Png(image) | Self::Jpeg(image) => image.gray(),
            Self::Exr(image) => image.gray().cloned(),
        }
    }

    /// The colors of the image in linear light. Gray images give grays; alpha is allowed where it is 1 everywhere.
    ///
    /// PNG and JPEG are read as sRGB, also where the file does not say so, as the web does.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is partly transparent, [`ImageErrorKind::MissingPlane`] or
    /// [`ImageErrorKind::SizeMismatch`] if an OpenEXR file does not have three planes of color.
    pub fn color(&self) -> Result<Raster<LinearRgb>, ImageError> {
        match self {
            Self::Png(image) | Self::Jpeg(image) => image.color(),
            Self::Exr(image) => {
                let pixels = image.color_alpha()?;
                if pixels.pixels().iter().any(|pixel| pixel.alpha != 1.0) {
                    return Err(transparent("RGB"));
                }
                Ok(pixels.map(|pixel| pixel.color))
            }
        }
    }

    /// The colors of the image in linear light with their alpha, which is 1 where the file has none.
    ///
    /// PNG and JPEG are read as sRGB, also where the file does not say so, as the web does.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingPlane`] or [`ImageErrorKind::SizeMismatch`] if an OpenEXR file does not have three planes
    /// of color.
    pub fn color_alpha(&self) -> Result<Raster<LinearRgba>, ImageError> {
        match self {
            Self::Png(image) | Self::Jpeg(image) => Ok(image.color_alpha()),
            Self::Exr(image) => image.color_alpha(),
        }
    }
}

/// The refusal of an image with alpha where none is wanted.
pub(crate) fn transparent(needed: &'static str) -> ImageError {
    ImageError::new(ImageErrorKind::Channels {
        found: "partly transparent",
        needed,
    })
}
