//! Why a raster or a window was refused.

use core::fmt;

/// Why an operation on rasters was refused.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterError {
    kind: RasterErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RasterErrorKind {
    /// A width or a height is zero.
    Empty {
        /// The size that was asked for, in pixels.
        size: [u32; 2],
    },
    /// The pixels are more than the address space, or the limit of 2^31, allows.
    TooLarge {
        /// The size that was asked for, in pixels.
        size: [u32; 2],
    },
    /// The number of values is not that of the pixels.
    Length {
        /// How many values there are.
        length: usize,
        /// How many were needed.
        needed: usize,
    },
    /// Two sizes that must be equal are not.
    SizeMismatch {
        /// The size of what was passed, in pixels.
        size: [u32; 2],
        /// The size that was needed.
        needed: [u32; 2],
    },
    /// A rectangle reaches past the raster.
    OutOfBounds {
        /// The first column and row of the rectangle.
        first: [u32; 2],
        /// Its size in pixels.
        size: [u32; 2],
        /// The size of the raster.
        bounds: [u32; 2],
    },
    /// A number is outside of its range.
    Range {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range it must lie in, as text.
        range: &'static str,
    },
    /// One period was asked for of a field that does not repeat along both axes.
    NoPeriod,
    /// A number that has to be finite (and, for the size of a pixel, not zero) is not.
    NotFinite {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
    },
}

impl RasterError {
    pub(crate) fn new(kind: RasterErrorKind) -> Self {
        Self { kind }
    }

    /// Refuses memory for another number of values than are needed; for those who write a [`Field`](crate::Field).
    ///
    /// # Errors
    ///
    /// [`Length`](RasterErrorKind::Length) if the numbers differ.
    pub fn check_length(length: usize, needed: usize) -> Result<(), Self> {
        if length == needed {
            return Ok(());
        }
        Err(Self::new(RasterErrorKind::Length { length, needed }))
    }

    /// Refuses a number out of its range; for those who write a [`Field`](crate::Field).
    ///
    /// # Errors
    ///
    /// [`Range`](RasterErrorKind::Range) unless it `holds`.
    pub fn check_range(
        holds: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        if holds {
            return Ok(());
        }
        Err(Self::new(RasterErrorKind::Range { what, value, range }))
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &RasterErrorKind {
        &self.kind
    }
}

impl fmt::Display for RasterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            RasterErrorKind::Empty { size: [w, h] } => {
                write!(f, "a raster of {w} × {h} pixels is empty")
            }
            RasterErrorKind::TooLarge { size: [w, h] } => {
                write!(
                    f,
                    "a raster of {w} × {h} pixels is larger than the limit of 2^31 pixels"
                )
            }
            RasterErrorKind::Length { length, needed } => {
                write!(f, "there are {length} values, but {needed} are needed")
            }
            RasterErrorKind::SizeMismatch {
                size: [w, h],
                needed: [nw, nh],
            } => {
                write!(
                    f,
                    "the raster has {w} × {h} pixels, but {nw} × {nh} are needed"
                )
            }
            RasterErrorKind::OutOfBounds {
                first: [x, y],
                size: [w, h],
                bounds: [bw, bh],
            } => {
                write!(
                    f,
                    "the rectangle of {w} × {h} pixels at ({x}, {y}) leaves the raster of {bw} × {bh}"
                )
            }
            RasterErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            RasterErrorKind::NoPeriod => f.write_str(
                "the field does not repeat along both axes, so that there is no tile of it",
            ),
            RasterErrorKind::NotFinite { what, value } => {
                write!(
                    f,
                    "the {what} is {value}, but it must be finite and a pixel's size must not be zero"
                )
            }
        }
    }
}

impl core::error::Error for RasterError {}
