//! Conversion of the codes of a PNG file to values and colors.

use super::{PngImage, PngPixels};
use crate::image::transparent;
use crate::{ImageError, ImageErrorKind};
use dapple_color::{Code, LinearRgb, LinearRgba};
use dapple_raster::Raster;

impl PngImage {
    /// The numbers of a gray image, `code / max`, from 0 to 1; no transfer curve is applied, whatever the file says.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is not gray, or partly transparent.
    pub fn gray(&self) -> Result<Raster<f32>, ImageError> {
        match &self.pixels {
            PngPixels::Gray8(raster) => Ok(raster.map(|code| code.to_unit())),
            PngPixels::Gray16(raster) => Ok(raster.map(|code| code.to_unit())),
            PngPixels::GrayAlpha8(raster) => {
                opaque(raster, "gray").map(|raster| raster.map(|[code, _]| code.to_unit()))
            }
            PngPixels::GrayAlpha16(raster) => {
                opaque(raster, "gray").map(|raster| raster.map(|[code, _]| code.to_unit()))
            }
            _ => Err(ImageError::new(ImageErrorKind::Channels {
                found: "RGB",
                needed: "gray",
            })),
        }
    }

    /// The colors in linear light, with the codes read as sRGB whatever the file says; gray images become gray colors.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is partly transparent.
    pub fn color(&self) -> Result<Raster<LinearRgb>, ImageError> {
        Ok(match &self.pixels {
            PngPixels::Gray8(raster) => raster.map(|&code| gray(code)),
            PngPixels::Gray16(raster) => raster.map(|&code| gray(code)),
            PngPixels::GrayAlpha8(raster) => opaque(raster, "RGB")?.map(|&[code, _]| gray(code)),
            PngPixels::GrayAlpha16(raster) => opaque(raster, "RGB")?.map(|&[code, _]| gray(code)),
            PngPixels::Rgb8(raster) => raster.map(|&codes| LinearRgb::from_srgb(codes)),
            PngPixels::Rgb16(raster) => raster.map(|&codes| LinearRgb::from_srgb(codes)),
            PngPixels::Rgba8(raster) => {
                opaque(raster, "RGB")?.map(|&[r, g, b, _]| LinearRgb::from_srgb([r, g, b]))
            }
            PngPixels::Rgba16(raster) => {
                opaque(raster, "RGB")?.map(|&[r, g, b, _]| LinearRgb::from_srgb([r, g, b]))
            }
        })
    }

    /// The colors in linear light with their alpha, which is 1 where the file has none; the codes of color are read as sRGB
    /// whatever the file says.
    #[must_use]
    pub fn color_alpha(&self) -> Raster<LinearRgba> {
        let all = LinearRgba::opaque;
        match &self.pixels {
            PngPixels::Gray8(raster) => raster.map(|&code| all(gray(code))),
            PngPixels::Gray16(raster) => raster.map(|&code| all(gray(code))),
            PngPixels::GrayAlpha8(raster) => raster.map(gray_alpha),
            PngPixels::GrayAlpha16(raster) => raster.map(gray_alpha),
            PngPixels::Rgb8(raster) => raster.map(|&codes| all(LinearRgb::from_srgb(codes))),
            PngPixels::Rgb16(raster) => raster.map(|&codes| all(LinearRgb::from_srgb(codes))),
            PngPixels::Rgba8(raster) => raster.map(|&codes| LinearRgba::from_srgb(codes)),
            PngPixels::Rgba16(raster) => raster.map(|&codes| LinearRgba::from_srgb(codes)),
        }
    }
}

fn gray<C: Code>(code: C) -> LinearRgb {
    LinearRgb::gray(code.linear_from_srgb())
}

fn gray_alpha<C: Code>(&[code, alpha]: &[C; 2]) -> LinearRgba {
    LinearRgba {
        color: gray(code),
        alpha: alpha.to_unit(),
    }
}

/// Checks that the last channel of a raster, alpha, is at its maximum everywhere.
fn opaque<'a, C: Code, const CHANNELS: usize>(
    raster: &'a Raster<[C; CHANNELS]>,
    needed: &'static str,
) -> Result<&'a Raster<[C; CHANNELS]>, ImageError> {
    let covers = |pixel: &[C; CHANNELS]| pixel.last().is_none_or(|alpha| alpha.to_unit() == 1.0);
    if raster.pixels().iter().all(covers) {
        Ok(raster)
    } else {
        Err(transparent(needed))
    }
}
