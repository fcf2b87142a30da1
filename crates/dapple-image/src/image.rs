//! Images whose format is recognized by their first bytes.

use crate::{
    ColorSpace, ExrImage, Format, ImageError, ImageErrorKind, Limits, PngImage, PngPixels, file,
};
use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_raster::Raster;
use std::path::Path;

/// An image of one of the supported formats.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Image {
    /// Codes of 8 or 16 bits: PNG, JPEG, WebP, TGA and most TIFF files.
    Codes(Format, PngImage),
    /// Floating-point planes: OpenEXR, Radiance HDR and floating-point TIFF files.
    Planes(Format, ExrImage),
}

/// Decodes an image file. The format is recognized by its first bytes.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the bytes are of no supported format, [`ImageErrorKind::Unsupported`] if the
/// format's crate feature is disabled or the file uses a feature that is not read, [`ImageErrorKind::Damaged`] if the
/// bytes violate the format's rules or end too soon, [`ImageErrorKind::TooManyPixels`] or
/// [`ImageErrorKind::TooManyBytes`] beyond a limit.
pub fn decode_image(bytes: &[u8], limits: &Limits) -> Result<Image, ImageError> {
    Format::of(bytes)?.decode(bytes, limits)
}

/// Reads an image file. The format is recognized by its first bytes; the file name does not matter.
///
/// # Errors
///
/// [`ImageErrorKind::Io`] if the file cannot be read, or any error from [`decode_image`].
pub fn read_image(path: impl AsRef<Path>, limits: &Limits) -> Result<Image, ImageError> {
    let path = path.as_ref();
    let bytes = file::read(path, limits.bytes)?;
    decode_image(&bytes, limits).map_err(|error| error.at(path))
}

impl Image {
    /// Returns the width and height in pixels (of the first plane, if there are several).
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Codes(_, image) => image.pixels.size(),
            Self::Planes(_, image) => image
                .planes
                .first()
                .map_or([0, 0], |plane| plane.values.size()),
        }
    }

    /// Returns the values of a gray image: from 0 to 1 for codes, of any magnitude for floating-point planes.
    ///
    /// Use this method for data such as heights and masks. No transfer curve is applied, regardless of the declared
    /// color space. Alpha is allowed if it is 1 everywhere.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is not gray, or partly transparent.
    pub fn gray(&self) -> Result<Raster<f32>, ImageError> {
        match self {
            Self::Codes(_, image) => image.gray(),
            Self::Planes(_, image) => image.gray().cloned(),
        }
    }

    /// Returns the colors in linear light. Gray images become gray colors; alpha is allowed if it is 1 everywhere.
    ///
    /// Codes are converted from the color space that the file declares; files without a declaration are sRGB, as on the
    /// web.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::ColorSpace`] if the declared color space cannot be converted, [`ImageErrorKind::Channels`]
    /// if the image is partly transparent, [`ImageErrorKind::MissingPlane`] or [`ImageErrorKind::SizeMismatch`] if
    /// floating-point planes are not three colors.
    pub fn color(&self) -> Result<Raster<LinearRgb>, ImageError> {
        match self {
            Self::Codes(_, image) => image.color(),
            Self::Planes(_, image) => {
                let pixels = image.color_alpha()?;
                if pixels.pixels().iter().any(|pixel| pixel.alpha != 1.0) {
                    return Err(transparent("RGB"));
                }
                Ok(pixels.map(|pixel| pixel.color))
            }
        }
    }

    /// Returns the colors in linear light with alpha, which is 1 if the file has none.
    ///
    /// Codes are converted from the color space that the file declares; files without a declaration are sRGB, as on the
    /// web.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingPlane`] or [`ImageErrorKind::SizeMismatch`] if floating-point planes are not
    /// three colors.
    pub fn color_alpha(&self) -> Result<Raster<LinearRgba>, ImageError> {
        match self {
            Self::Codes(_, image) => image.color_alpha(),
            Self::Planes(_, image) => image.color_alpha(),
        }
    }
}

impl Image {
    /// Returns the unit vectors of a normal map, regardless of the declared color space. The alpha channel of
    /// codes is ignored.
    ///
    /// Codes are `(part + 1) / 2`; [`ExrImage::normals`] describes the values of floating-point planes.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is gray, or any error from [`ExrImage::normals`].
    pub fn normals(&self) -> Result<Raster<Normal>, ImageError> {
        let png = match self {
            Self::Codes(_, png) => png,
            Self::Planes(_, exr) => return exr.normals(),
        };
        match &png.pixels {
            PngPixels::Rgb8(raster) => Ok(raster.map(|&codes| Normal::from_codes(codes))),
            PngPixels::Rgb16(raster) => Ok(raster.map(|&codes| Normal::from_codes(codes))),
            PngPixels::Rgba8(raster) => {
                Ok(raster.map(|&[x, y, z, _]| Normal::from_codes([x, y, z])))
            }
            PngPixels::Rgba16(raster) => {
                Ok(raster.map(|&[x, y, z, _]| Normal::from_codes([x, y, z])))
            }
            _ => Err(ImageError::new(ImageErrorKind::Channels {
                found: "gray",
                needed: "a normal map",
            })),
        }
    }

    /// Reinterprets the codes as sRGB and ignores the declared color space, as glTF 2.0, section 3.8.3, requires for
    /// textures.
    #[must_use]
    pub fn without_color_space(mut self) -> Self {
        if let Self::Codes(_, image) = &mut self {
            image.space = ColorSpace::default();
        }
        self
    }

    /// Returns the image of one layer of an OpenEXR file with several layers.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingLayer`] if there is no layer with this name, [`ImageErrorKind::NoLayers`] for an
    /// image of codes.
    pub fn layer(&self, name: &str) -> Result<Self, ImageError> {
        match self {
            Self::Planes(format, image) => Ok(Self::Planes(*format, image.layer(name)?)),
            Self::Codes(..) => Err(ImageError::new(ImageErrorKind::NoLayers {
                format: self.format(),
            })),
        }
    }
}

/// Creates the error for an image with alpha where alpha is not allowed.
pub(crate) fn transparent(needed: &'static str) -> ImageError {
    ImageError::new(ImageErrorKind::Channels {
        found: "partly transparent",
        needed,
    })
}
