//! Converts PNG codes to values and colors.

use super::{PngImage, PngPixels};
use crate::image::transparent;
use crate::{ImageError, ImageErrorKind};
use dapple_color::{Code, LinearRgb, LinearRgba};
use dapple_raster::Raster;

impl PngImage {
    /// Returns the values of a gray image, `code / max`, from 0 to 1. No transfer curve is applied, regardless of the
    /// declared color space.
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

    /// Returns the colors in linear light of ITU-R BT.709, converted from the declared color space or, without a
    /// declaration, from sRGB. Gray images become gray colors under the sRGB curve, regardless of the declaration.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is partly transparent, [`ImageErrorKind::ColorSpace`] if its color space
    /// cannot be converted.
    pub fn color(&self) -> Result<Raster<LinearRgb>, ImageError> {
        Ok(match &self.pixels {
            PngPixels::Gray8(raster) => raster.map(|&code| gray(code)),
            PngPixels::Gray16(raster) => raster.map(|&code| gray(code)),
            PngPixels::GrayAlpha8(raster) => opaque(raster, "RGB")?.map(|&[code, _]| gray(code)),
            PngPixels::GrayAlpha16(raster) => opaque(raster, "RGB")?.map(|&[code, _]| gray(code)),
            PngPixels::Rgb8(raster) => self.colors(raster, |&codes| codes)?,
            PngPixels::Rgb16(raster) => self.colors(raster, |&codes| codes)?,
            PngPixels::Rgba8(raster) => {
                self.colors(opaque(raster, "RGB")?, |&[r, g, b, _]| [r, g, b])?
            }
            PngPixels::Rgba16(raster) => {
                self.colors(opaque(raster, "RGB")?, |&[r, g, b, _]| [r, g, b])?
            }
        })
    }

    /// Returns the colors as in [`color`](Self::color), with alpha, which is 1 if the file has none.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::ColorSpace`] if the color space of the file cannot be converted.
    pub fn color_alpha(&self) -> Result<Raster<LinearRgba>, ImageError> {
        let all = LinearRgba::opaque;
        Ok(match &self.pixels {
            PngPixels::GrayAlpha8(raster) => raster.map(gray_alpha),
            PngPixels::GrayAlpha16(raster) => raster.map(gray_alpha),
            PngPixels::Rgba8(raster) => self.colors_alpha(raster)?,
            PngPixels::Rgba16(raster) => self.colors_alpha(raster)?,
            _ => self.color()?.map(|&color| all(color)),
        })
    }

    fn colors<P: Sync, C: Code + Into<u16>>(
        &self,
        raster: &Raster<P>,
        codes: impl Fn(&P) -> [C; 3] + Sync,
    ) -> Result<Raster<LinearRgb>, ImageError> {
        Ok(match self.space.converter(self.max())? {
            None => raster.map(|pixel| LinearRgb::from_srgb(codes(pixel))),
            Some(space) => raster.par_map(|pixel| space.color(codes(pixel).map(Into::into))),
        })
    }

    fn colors_alpha<C: Code + Into<u16> + Sync>(
        &self,
        raster: &Raster<[C; 4]>,
    ) -> Result<Raster<LinearRgba>, ImageError> {
        Ok(match self.space.converter(self.max())? {
            None => raster.map(|&codes| LinearRgba::from_srgb(codes)),
            Some(space) => raster.par_map(|&[r, g, b, alpha]| LinearRgba {
                color: space.color([r, g, b].map(Into::into)),
                alpha: alpha.to_unit(),
            }),
        })
    }

    /// Returns the maximum code for the bit depth.
    fn max(&self) -> u16 {
        match self.bits() {
            8 => u8::MAX.into(),
            _ => u16::MAX,
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

/// Returns the raster if its last channel, alpha, is at its maximum everywhere; otherwise an error.
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
