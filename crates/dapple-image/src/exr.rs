//! OpenEXR files: named planes of `f32`, writing and reading.
//!
//! The format is that of the Academy Software Foundation's "OpenEXR File Layout", <https://openexr.com>; the codec is
//! the crate `exr`. Colors are linear with the primaries of ITU-R BT.709, the default of OpenEXR, and alpha is
//! multiplied into them in the file, as the format requires.

#[cfg(feature = "exr")]
mod decode;
#[cfg(feature = "exr")]
mod encode;
#[cfg(feature = "exr")]
mod shortcut;
#[cfg(feature = "exr")]
mod tiles;

#[cfg(feature = "exr")]
pub use decode::decode_exr;
#[cfg(feature = "exr")]
pub use encode::{encode_exr, write_exr};
#[cfg(feature = "exr")]
pub use shortcut::{write_color_alpha_exr, write_color_exr, write_gray_exr};
#[cfg(feature = "exr")]
pub(crate) use tiles::TileStream;

use crate::content::Pixel;
use crate::{ImageError, ImageErrorKind};
use dapple_color::{LinearRgb, LinearRgba};
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
#[derive(Clone, Debug, PartialEq)]
pub struct ExrImage {
    /// The planes. Those of a named part are named `part.channel`, unless it is the only part of the file.
    pub planes: Vec<ExrPlane>,
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

    /// The only plane, or else the plane `Y`.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::Channels`] if there are several and none is `Y`, or if there are also color or alpha planes.
    pub fn gray(&self) -> Result<&Raster<f32>, ImageError> {
        match self.planes.as_slice() {
            [plane] => Ok(&plane.values),
            _ if ["R", "G", "B", "A"].iter().all(|name| !self.has(name)) && self.has("Y") => {
                self.plane("Y")
            }
            _ => Err(ImageError::new(ImageErrorKind::Channels {
                found: "of several planes",
                needed: "gray",
            })),
        }
    }

    /// The colors of the planes `R`, `G`, `B` with the alpha of `A` divided out, or 1 where there is no plane `A`.
    ///
    /// Without a plane `R`, the planes of the only layer that has one are used, such as `beauty.R`. A gray image
    /// becomes gray colors. Where alpha is 0, the color is as in the file.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingPlane`] if a plane is missing and the image is not gray,
    /// [`ImageErrorKind::SizeMismatch`] if their sizes differ.
    pub fn color_alpha(&self) -> Result<Raster<LinearRgba>, ImageError> {
        if let Ok(gray) = self.gray() {
            return Ok(gray.map(|&value| LinearRgba::opaque(LinearRgb::gray(value))));
        }
        let layer = self.color_layer();
        let part = |channel: &str| self.plane(&format!("{layer}{channel}"));
        let [red, green, blue] = [part("R")?, part("G")?, part("B")?];
        let alpha = part("A").ok();
        for plane in [Some(green), Some(blue), alpha].into_iter().flatten() {
            check_size(plane.size(), red.size())?;
        }
        let pixel = |at: usize| {
            let [r, g, b] = [red, green, blue].map(|plane| plane.pixels()[at]);
            straight([r, g, b], alpha.map_or(1.0, |plane| plane.pixels()[at]))
        };
        let pixels = (0..red.pixels().len()).map(pixel).collect();
        Raster::from_vec(red.size(), pixels).map_err(|error| ImageError::damaged("OpenEXR", error))
    }

    /// The prefix of the names of the color planes: empty, or the only layer of color with its dot.
    pub(crate) fn color_layer(&self) -> &str {
        let layers = self.planes.iter().filter_map(|plane| {
            let layer = plane.name.strip_suffix("R")?;
            (layer.is_empty() || layer.ends_with('.')).then_some(layer)
        });
        match layers.collect::<Vec<_>>().as_slice() {
            [layer] => layer,
            _ => "",
        }
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.planes.iter().any(|plane| plane.name == name)
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
