//! Reading and writing OpenEXR files as named planes of `f32`.
//!
//! The format is defined in the Academy Software Foundation's "OpenEXR File Layout", <https://openexr.com>; the codec
//! is the crate `exr`. Colors are linear. Their primaries are the chromaticities of the file, or ITU-R BT.709 if it
//! has none. As the format requires, the file stores colors with alpha multiplied in.

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
use crate::orientation::Stored;
use crate::{ImageError, ImageErrorKind};
use dapple_color::{Code, LinearRgb, LinearRgba, Normal};
use dapple_raster::Raster;

/// A channel of an OpenEXR file: a name and its values.
///
/// By convention `R`, `G`, `B` and `A` are color and alpha, `Y` is gray, and `layer.channel` belongs to a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrPlane {
    /// Name of 1 to 255 bytes of ASCII.
    pub name: String,
    /// Values; every `f32` is preserved bit for bit, including NaN and infinity.
    pub values: Raster<f32>,
}

impl ExrPlane {
    /// Creates a plane called `name`.
    #[must_use]
    pub fn new(name: impl Into<String>, values: Raster<f32>) -> Self {
        Self {
            name: name.into(),
            values,
        }
    }

    /// Returns the three planes `R`, `G` and `B` of a color image.
    #[must_use]
    pub fn from_colors(colors: &Raster<LinearRgb>) -> Vec<Self> {
        Self::from_pixels(colors)
    }

    /// Returns the four planes `R`, `G`, `B` and `A` of a color image, with alpha multiplied into the color.
    #[must_use]
    pub fn from_colors_with_alpha(colors: &Raster<LinearRgba>) -> Vec<Self> {
        Self::from_pixels(colors)
    }

    /// Creates planes from samples, pixel by pixel: `Y`, or `R`, `G` and `B`, and `A` last if there is alpha.
    pub(crate) fn from_samples(
        stored: Stored,
        n_channels: usize,
        samples: &[f32],
    ) -> Result<Vec<Self>, ImageError> {
        let names: &[&str] = match n_channels {
            1 | 2 => &["Y", "A"],
            _ => &["R", "G", "B", "A"],
        };
        let planes = names.iter().take(n_channels).enumerate();
        planes
            .map(|(channel, name)| {
                let samples = samples.iter().skip(channel).step_by(n_channels);
                let values: Vec<f32> = samples.copied().collect();
                Ok(Self::new(*name, stored.upright(&values)?))
            })
            .collect()
    }

    fn from_pixels<T: Pixel>(raster: &Raster<T>) -> Vec<Self> {
        let names = T::CONTENT.planes().iter().enumerate().rev();
        names
            .map(|(plane, &name)| Self::new(name, raster.map(|value| value.part(plane))))
            .collect()
    }
}

/// The content of an OpenEXR file. Planes are in file order: part by part, and by name within each part.
///
/// Radiance HDR and floating-point TIFF files are decoded to the same type.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExrImage {
    /// The planes. A plane of a named part is named `part.channel`, unless the file has only one part.
    pub planes: Vec<ExrPlane>,
    /// Names of the views in lower case, such as the eyes of a stereo image; the default view comes first.
    pub views: Vec<String>,
    /// Chromaticities x and y of red, green, blue and white; `None` means BT.709.
    pub chromaticities: Option<[[f32; 2]; 4]>,
}

impl ExrImage {
    /// Returns the plane called `name`.
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

    /// Returns the values of a gray image; alpha is allowed if it is 1 everywhere.
    ///
    /// The image is the only plane of the file, or a plane `Y`. [`to_picture`](Self::to_picture) describes how the
    /// main image is chosen among several layers.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is not gray, or partly transparent, or any error from
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

    /// Returns the colors of the main image unpremultiplied (divided by alpha). Alpha is 1 if the file has none. A
    /// gray image becomes gray colors.
    ///
    /// [`to_picture`](Self::to_picture) describes how the main image is chosen among several layers. Where alpha is 0,
    /// the color is returned as stored.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image contains vectors, or any error from
    /// [`to_picture`](Self::to_picture).
    pub fn color_alpha(&self) -> Result<Raster<LinearRgba>, ImageError> {
        let (colors, alpha) = self.associated()?;
        let Some(alpha) = alpha else {
            return Ok(colors.map(|&color| LinearRgba::opaque(color)));
        };
        let pixels = colors.zip_map(&alpha, |color, &alpha| straight(color.to_array(), alpha));
        pixels.map_err(|error| ImageError::damaged("OpenEXR", error))
    }

    /// Returns the colors of the main image as stored, with alpha multiplied in, and the alpha.
    ///
    /// A stored color with an alpha of 0 represents light without coverage: it is added to the background, and there
    /// is no alpha to divide by.
    ///
    /// # Errors
    ///
    /// Same as [`color_alpha`](Self::color_alpha).
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

    /// Returns the unit vectors of the main image.
    ///
    /// Planes `X`, `Y` and `Z` hold vectors. Planes `R`, `G` and `B` hold vectors if any of their values is negative;
    /// otherwise they hold codes from 0 to 1, `(part + 1) / 2`.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if the image is gray or partly transparent, or any error from
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
                // Quantize to 16-bit codes, so that the same normalization applies.
                Normal::from_codes(parts.map(u16::from_unit))
            }
        };
        let vectors = (0..parts[0].pixels().len()).map(vector).collect();
        Raster::from_vec(parts[0].size(), vectors)
            .map_err(|error| ImageError::damaged("OpenEXR", error))
    }

    /// Returns the matrix from the colors of the file to BT.709; `None` if the primaries are equal.
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
        // Chromaticities are `f32` with about four significant digits; round before computing in `f64`.
        let rounded = primaries.map(|point| point.map(|number| (number * 1e6).round() / 1e6));
        bt709_from(&rounded).map(Some).ok_or_else(|| {
            let found = "chromaticities that span no colors";
            ImageError::new(ImageErrorKind::ColorSpace { found })
        })
    }

    /// Returns a copy of the image without its planes.
    fn without_planes(&self) -> Self {
        Self {
            planes: Vec::new(),
            views: self.views.clone(),
            chromaticities: self.chromaticities,
        }
    }
}

/// Maximum difference between chromaticities that count as equal. Files round them to four digits.
const SAME_CHROMATICITY: f64 = 0.000_2;

/// Description of vector images in error messages.
const VECTORS: &str = "of the vectors X, Y and Z";

/// Returns a vector with length 1. If its length is zero or not finite, returns the normal of a flat surface.
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

/// Checks that a plane has the size of the preceding planes.
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

/// Divides a color by its alpha. Where alpha is 0, the color is returned unchanged.
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
