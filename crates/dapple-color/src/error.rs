//! Why a color, a ramp or a map was refused.

use core::fmt;
use dapple_raster::RasterError;
use dapple_raster::glam::DVec2;

/// Why a color, a ramp or a map was refused.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorError {
    kind: ColorErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ColorErrorKind {
    /// A text is not a color in hexadecimal.
    Hex {
        /// The text.
        text: String,
    },
    /// A ramp has no stop.
    NoStops,
    /// A number that has to be finite is not.
    NotFinite {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A size that has to be above zero and finite is not.
    Extent {
        /// The size.
        extent: DVec2,
    },
    /// A radius is negative, or reaches over too many pixels.
    Radius {
        /// The radius.
        radius: f64,
        /// How many pixels it is along the axis on which they are smaller.
        pixels: f64,
        /// How many pixels it may be.
        limit: u32,
    },
    /// The part of a radius over which something fades is not from 0 to 1.
    Fade {
        /// The part.
        fade: f64,
    },
    /// The raster that was to result was refused.
    Raster(RasterError),
    /// The stops of a ramp are not in order.
    Unsorted {
        /// The first position that is smaller than the one before it.
        position: f32,
        /// The position before it.
        before: f32,
    },
}

impl ColorError {
    pub(crate) fn new(kind: ColorErrorKind) -> Self {
        Self { kind }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &ColorErrorKind {
        &self.kind
    }
}

impl fmt::Display for ColorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            ColorErrorKind::Hex { text } => write!(
                f,
                "{text:?} is not a color; it must be 3 or 6 hexadecimal digits, with or without #"
            ),
            ColorErrorKind::NoStops => f.write_str("a color ramp needs at least one stop"),
            ColorErrorKind::NotFinite { what, value } => {
                write!(f, "the {what} is {value}, but it must be finite")
            }
            ColorErrorKind::Extent { extent } => write!(
                f,
                "the extent is {} × {}, but both must be above zero and finite",
                extent.x, extent.y
            ),
            ColorErrorKind::Radius {
                radius,
                pixels,
                limit,
            } => write!(
                f,
                "the radius {radius} is {pixels} pixels, but it must be from 0 to {limit} pixels"
            ),
            ColorErrorKind::Fade { fade } => {
                write!(f, "the fade is {fade}, but it must be from 0 to 1")
            }
            ColorErrorKind::Raster(error) => error.fmt(f),
            ColorErrorKind::Unsorted { position, before } => write!(
                f,
                "the stop at {position} follows the stop at {before}, but stops must be in order"
            ),
        }
    }
}

impl core::error::Error for ColorError {}

impl From<RasterError> for ColorError {
    fn from(error: RasterError) -> Self {
        Self::new(ColorErrorKind::Raster(error))
    }
}
