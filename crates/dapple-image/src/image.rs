//! Images whose format is recognized by their first bytes.

use crate::{ColorSpace, ExrImage, ImageError, ImageErrorKind, Limits, PngImage, PngPixels, file};
use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_raster::Raster;
use std::path::Path;

/// Signature of PNG files.
pub(crate) const PNG_SIGNATURE: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];

/// Signature of JPEG files.
pub(crate) const JPEG_SIGNATURE: [u8; 3] = [0xff, 0xd8, 0xff];

/// Signature of OpenEXR files.
pub(crate) const EXR_SIGNATURE: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// An image of one of the supported formats.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Image {
    /// A PNG file.
    Png(PngImage),
    /// A JPEG file, decoded to the same type as a PNG image.
    Jpeg(PngImage),
    /// An OpenEXR file.
    Exr(ExrImage),
}

/// Decodes an image file. The format is recognized by its signature.
///
/// # Errors
///
/// [`ImageErrorKind::UnknownFormat`] if the signature is unknown, [`ImageErrorKind::Unsupported`] if the format's
/// crate feature is disabled, or any error from `decode_png`, `decode_jpeg` and `decode_exr`.
pub fn decode_image(bytes: &[u8], limits: &Limits) -> Result<Image, ImageError> {
    #[cfg(feature = "png")]
    if bytes.starts_with(&PNG_SIGNATURE) {
        return crate::decode_png(bytes, limits).map(Image::Png);
    }
    #[cfg(feature = "jpeg")]
    if bytes.starts_with(&JPEG_SIGNATURE) {
        return crate::decode_jpeg(bytes, limits).map(Image::Jpeg);
    }
    #[cfg(feature = "exr")]
    if bytes.starts_with(&EXR_SIGNATURE) {
        return crate::decode_exr(bytes, limits).map(Image::Exr);
    }
    let _ = limits;
    let left_out = LEFT_OUT
        .iter()
        .find(|(signature, _)| bytes.starts_with(signature));
    Err(ImageError::new(match left_out {
        Some(&(_, feature)) => ImageErrorKind::Unsupported { feature },
        None => ImageErrorKind::UnknownFormat,
    }))
}

/// Signatures of formats whose codec may be compiled out, each with the text of the error for it.
const LEFT_OUT: [(&[u8], &str); 3] = [
    (&PNG_SIGNATURE, "PNG without the feature `png`"),
    (&JPEG_SIGNATURE, "JPEG without the feature `jpeg`"),
    (&EXR_SIGNATURE, "OpenEXR without the feature `exr`"),
];

/// Reads an image file. The format is recognized by its signature; the file name does not matter.
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
            Self::Png(image) | Self::Jpeg(image) => image.pixels.size(),
            Self::Exr(image) => image
                .planes
                .first()
                .map_or([0, 0], |plane| plane.values.size()),
        }
    }

    /// Returns the values of a gray image: from 0 to 1 in PNG and JPEG, of any magnitude in OpenEXR.
    ///
    /// Use this method for data such as heights and masks. No transfer curve is applied, regardless of the declared
    /// color space. Alpha is allowed if it is 1 everywhere.
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

    /// Returns the colors in linear light. Gray images become gray colors; alpha is allowed if it is 1 everywhere.
    ///
    /// PNG and JPEG are converted from the color space that they declare; files without a declaration are sRGB, as on
    /// the web.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::ColorSpace`] if the declared color space cannot be converted, [`ImageErrorKind::Channels`]
    /// if the image is partly transparent, [`ImageErrorKind::MissingPlane`] or [`ImageErrorKind::SizeMismatch`] if an
    /// OpenEXR file does not have three color planes.
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

    /// Returns the colors in linear light with alpha, which is 1 if the file has none.
    ///
    /// PNG and JPEG are converted from the color space that they declare; files without a declaration are sRGB, as on
    /// the web.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingPlane`] or [`ImageErrorKind::SizeMismatch`] if an OpenEXR file does not have three
    /// color planes.
    pub fn color_alpha(&self) -> Result<Raster<LinearRgba>, ImageError> {
        match self {
            Self::Png(image) | Self::Jpeg(image) => image.color_alpha(),
            Self::Exr(image) => image.color_alpha(),
        }
    }
}

impl Image {
    /// Returns the unit vectors of a normal map, regardless of the declared color space. The alpha channel of a PNG
    /// file is ignored.
    ///
    /// The codes of PNG and JPEG are `(part + 1) / 2`; [`ExrImage::normals`] describes the values of OpenEXR.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is gray, or any error from [`ExrImage::normals`].
    pub fn normals(&self) -> Result<Raster<Normal>, ImageError> {
        let png = match self {
            Self::Png(png) | Self::Jpeg(png) => png,
            Self::Exr(exr) => return exr.normals(),
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
        if let Self::Png(image) | Self::Jpeg(image) = &mut self {
            image.space = ColorSpace::default();
        }
        self
    }

    /// Returns the image of one layer of an OpenEXR file with several layers.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingLayer`] if there is no layer with this name, [`ImageErrorKind::NoLayers`] for a PNG
    /// or JPEG file.
    pub fn layer(&self, name: &str) -> Result<Self, ImageError> {
        match self {
            Self::Exr(image) => image.layer(name).map(Self::Exr),
            Self::Png(_) | Self::Jpeg(_) => Err(ImageError::new(ImageErrorKind::NoLayers {
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
