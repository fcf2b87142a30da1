//! OpenEXR files: named planes of `f32`, writing and reading.
//!
//! The format is that of the Academy Software Foundation's "OpenEXR File Layout", <https://openexr.com>; the codec is
//! the crate `exr`. Colors are linear, with the chromaticities of the file or else the primaries of ITU-R BT.709, and alpha
//! is multiplied into them in the file, as the format requires.

#[cfg(feature = "exr")]
mod decode;
#[cfg(feature = "exr")]
mod encode;
mod layers;
#[cfg(feature = "exr")]
mod shortcut;
#[cfg(feature = "exr")]
mod tiles;

#[cfg(feature = "exr")]
pub use decode::{decode_exr, decode_exr_region};
#[cfg(feature = "exr")]
pub use encode::{encode_exr, write_exr};
#[cfg(feature = "exr")]
pub use shortcut::{write_color_alpha_exr, write_color_exr, write_gray_exr};
#[cfg(feature = "exr")]
pub(crate) use tiles::TileStream;

pub(crate) use layers::Picture;

use crate::color_space::{BT709, bt709_from, times};
use crate::content::Pixel;
use crate::image::transparent;
use crate::{ImageError, ImageErrorKind};
use dapple_color::{Code, LinearRgb, LinearRgba, Normal};
use dapple_raster::Raster;

/// A channel of an OpenEXR file: a name and numbers.
///
/// By convention `R`, `G`, `B` and `A` are color and alpha, `Y` is gray, and `layer.channel` belongs to a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrPlane {
    /// The name: 1 to 255 bytes of ASCII.
    pub name: String,
    /// The numbers; every `f32` is kept bit for bit, also NaN and infinity.
    pub values: Raster<f32>,
}

impl ExrPlane {
    /// A plane with a name.
    #[must_use]
    pub fn new(name: impl Into<String>, values: Raster<f32>) -> Self {
        Self {
            name: name.into(),
            values,
        }
    }

    /// The three planes `R`, `G` and `B` of a color image.
    #[must_use]
    pub fn from_colors(colors: &Raster<LinearRgb>) -> Vec<Self> {
        Self::from_pixels(colors)
    }

    /// The four planes `R`, `G`, `B` and `A` of a color image, with alpha multiplied into the color.
    #[must_use]
    pub fn from_colors_with_alpha(colors: &Raster<LinearRgba>) -> Vec<Self> {
        Self::from_pixels(colors)
    }

    fn from_pixels<T: Pixel>(raster: &Raster<T>) -> Vec<Self> {
        let names = T::CONTENT.planes().iter().enumerate().rev();
        names
            .map(|(plane, &name)| Self::new(name, raster.map(|value| value.part(plane))))
            .collect()
    }
}

/// The content of an OpenEXR file: its planes, in the order of the file (by name, within each part).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExrImage {
    /// The planes. Those of a named part are named `part.channel`, unless it is the only part of the file.
    pub planes: Vec<ExrPlane>,
    /// The names of the views, such as the eyes of a stereo image, in lower case: the default view first.
    pub views: Vec<String>,
    /// The chromaticities x and y of red, green, blue and white, if the file has them; else they are those of BT.709.
    pub chromaticities: Option<[[f32; 2]; 4]>,
}

impl ExrImage {
    /// The plane with a name.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingPlane`] if there is no such plane.
    pub fn plane(&self, name: &str) -> Result<&Raster<f32>, ImageError> {
        let plane = self.planes.iter().find(|plane| plane.name == name);
        plane.map(|plane| &plane.values).ok_or_else(|| {
            let name = name.to_owned();
            ImageError::new(ImageErrorKind::MissingPlane { name })
        })
    }

    /// The values of a gray picture; alpha is allowed if it is 1 everywhere.
    ///
    /// The picture is the only plane of the file, or a plane `Y`; of several layers it is chosen as
    /// [`to_picture`](Self::to_picture) says.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the picture is not gray, or partly transparent, else the errors of
    /// [`to_picture`](Self::to_picture).
    pub fn gray(&self) -> Result<&Raster<f32>, ImageError> {
        let needed = "gray";
        let found = match self.picture()? {
            Picture::Gray { values, alpha } => {
                let mut alphas = alpha.into_iter().flat_map(Raster::pixels);
                return match alphas.all(|&alpha| alpha == 1.0) {
                    true => Ok(values),
                    false => Err(transparent(needed)),
                };
            }
            Picture::Color { .. } => "of several planes",
            Picture::Vectors(_) => VECTORS,
        };
        Err(ImageError::new(ImageErrorKind::Channels { found, needed }))
    }

    /// The colors of the picture with the alpha divided out, or 1 where there is none. A gray picture becomes gray colors.
    ///
    /// Of several layers the picture is chosen as [`to_picture`](Self::to_picture) says. Where alpha is 0, the color is as
    /// in the file.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the picture is one of vectors, else the errors of
    /// [`to_picture`](Self::to_picture).
    pub fn color_alpha(&self) -> Result<Raster<LinearRgba>, ImageError> {
        let (colors, alpha) = self.associated()?;
        let Some(alpha) = alpha else {
            return Ok(colors.map(|&color| LinearRgba::opaque(color)));
        };
        let pixels = colors.zip_map(&alpha, |color, &alpha| straight(color.to_array(), alpha));
        pixels.map_err(|error| ImageError::damaged("OpenEXR", error))
    }

    /// The colors of the picture as they are in the file, with alpha multiplied into them, and the alpha.
    ///
    /// Light may cover nothing: a color with an alpha of 0 is added to what lies below, and has no color that could be
    /// divided out.
    ///
    /// # Errors
    ///
    /// The errors of [`color_alpha`](Self::color_alpha).
    pub fn associated(&self) -> Result<(Raster<LinearRgb>, Option<Raster<f32>>), ImageError> {
        let ([red, green, blue], alpha, is_color) = match self.picture()? {
            Picture::Gray { values, alpha } => ([values; 3], alpha, false),
            Picture::Color { parts, alpha } => (parts, alpha, true),
            Picture::Vectors(_) => {
                let (found, needed) = (VECTORS, "RGB");
                return Err(ImageError::new(ImageErrorKind::Channels { found, needed }));
            }
        };
        let matrix = self.matrix()?.filter(|_| is_color);
        let of = |at: usize| {
            let parts = [red, green, blue].map(|plane| plane.pixels()[at]);
            match &matrix {
                None => parts.into(),
                Some(matrix) => times(matrix, parts.map(f64::from)),
            }
        };
        let pixels = (0..red.pixels().len()).map(of).collect();
        let colors = Raster::from_vec(red.size(), pixels)
            .map_err(|error| ImageError::damaged("OpenEXR", error))?;
        Ok((colors, alpha.cloned()))
    }

    /// The unit vectors of the picture.
    ///
    /// Planes `X`, `Y` and `Z` are vectors. Planes of color are vectors, too, if one of their numbers is below 0, and else
    /// codes from 0 to 1, `(part + 1) / 2`.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the picture is gray or partly transparent, else the errors of
    /// [`to_picture`](Self::to_picture).
    pub fn normals(&self) -> Result<Raster<Normal>, ImageError> {
        let needed = "a normal map";
        let (parts, is_signed) = match self.picture()? {
            Picture::Vectors(parts) => (parts, true),
            Picture::Color { parts, alpha } => {
                let mut alphas = alpha.into_iter().flat_map(Raster::pixels);
                if alphas.any(|&alpha| alpha != 1.0) {
                    return Err(transparent(needed));
                }
                let mut numbers = parts.iter().flat_map(|part| part.pixels());
                let is_signed = numbers.any(|&number| number < 0.0);
                (parts, is_signed)
            }
            Picture::Gray { .. } => {
                let found = "gray";
                return Err(ImageError::new(ImageErrorKind::Channels { found, needed }));
            }
        };
        let vector = |at: usize| {
            let parts = parts.map(|part| part.pixels()[at]);
            if is_signed {
                normalized(parts)
            } else {
                // With the precision of 16-bit codes, and normalized by the same rule.
                Normal::from_codes(parts.map(u16::from_unit))
            }
        };
        let vectors = (0..parts[0].pixels().len()).map(vector).collect();
        Raster::from_vec(parts[0].size(), vectors)
            .map_err(|error| ImageError::damaged("OpenEXR", error))
    }

    /// The matrix from the colors of the file to those of BT.709, if they differ.
    fn matrix(&self) -> Result<Option<[[f64; 3]; 3]>, ImageError> {
        let Some(primaries) = self.chromaticities else {
            return Ok(None);
        };
        let primaries = primaries.map(|point| point.map(f64::from));
        let numbers = primaries.iter().flatten().zip(BT709.iter().flatten());
        if numbers
            .into_iter()
            .all(|(found, number)| (found - number).abs() < SAME_CHROMATICITY)
        {
            return Ok(None);
        }
        // Chromaticities have four digits as numbers of 32 bits, but the computation is in 64.
        let rounded = primaries.map(|point| point.map(|number| (number * 1e6).round() / 1e6));
        bt709_from(&rounded).map(Some).ok_or_else(|| {
            let found = "chromaticities that span no colors";
            ImageError::new(ImageErrorKind::ColorSpace { found })
        })
    }

    /// An image without planes that has all else of this one.
    fn without_planes(&self) -> Self {
        Self {
            planes: Vec::new(),
            views: self.views.clone(),
            chromaticities: self.chromaticities,
        }
    }
}

/// The largest difference of chromaticities that are meant to be the same: they are rounded to four digits.
const SAME_CHROMATICITY: f64 = 0.000_2;

/// The name of a picture of vectors in errors.
const VECTORS: &str = "of the vectors X, Y and Z";

/// The unit vector in a direction; that of a flat surface if there is none.
fn normalized(parts: [f32; 3]) -> Normal {
    // In f64, squares of f32 neither overflow nor vanish.
    let [x, y, z] = parts.map(f64::from);
    let length = (x * x + y * y + z * z).sqrt();
    if length > 0.0 && length.is_finite() {
        let [x, y, z] = [x, y, z].map(|part| (part / length) as f32);
        Normal { x, y, z }
    } else {
        Normal::FLAT
    }
}

/// Checks that a plane has the size of those before it.
fn check_size(size: [u32; 2], needed: [u32; 2]) -> Result<(), ImageError> {
    if size == needed {
        Ok(())
    } else {
        Err(ImageError::new(ImageErrorKind::SizeMismatch {
            size,
            needed,
        }))
    }
}

/// A color with its alpha divided out of it.
fn straight(multiplied: [f32; 3], alpha: f32) -> LinearRgba {
    let color = if alpha == 0.0 {
        multiplied
    } else {
        multiplied.map(|part| part / alpha)
    };
    LinearRgba {
        color: color.into(),
        alpha,
    }
}
