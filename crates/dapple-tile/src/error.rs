//! Why an image, a method or a blend was refused.

use core::fmt;
use dapple_color::ColorError;
use dapple_raster::RasterError;
use dapple_wavelet::WaveletError;

/// Why a tile could not be made.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct TileError {
    kind: TileErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TileErrorKind {
    /// A side is too short for what was asked.
    TooSmall {
        /// The length of the side, in pixels.
        length: u32,
        /// The shortest that is allowed.
        least: u32,
    },
    /// A margin, or the width of what changes along the borders, leaves too little of the image.
    Margin {
        /// The margin or the width that was asked for, in pixels.
        margin: u32,
        /// The length of the side, in pixels.
        length: u32,
        /// The largest margin that is allowed.
        most: u32,
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
    /// There is nothing to work on, or there are more or fewer things than needed.
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many were needed, as text.
        needed: &'static str,
    },
    /// Maps that belong together are of different kinds.
    KindMismatch {
        /// The index of the map.
        map: usize,
    },
    /// A pixel is NaN or infinite.
    NotFinite {
        /// Its column.
        column: u32,
        /// Its row.
        row: u32,
        /// Its value.
        value: f32,
    },
    /// The wavelet filter refused the size: odd, or not divisible by 2^levels.
    Wavelet(WaveletError),
    /// The raster was refused, or two sizes differ.
    Raster(RasterError),
    /// The color crate refused its input.
    Color(ColorError),
}

impl TileError {
    pub(crate) fn new(kind: TileErrorKind) -> Self {
        Self { kind }
    }

    /// Refuses a value outside of its range.
    pub(crate) fn check(
        holds: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        if holds {
            Ok(())
        } else {
            Err(Self::new(TileErrorKind::Range { what, value, range }))
        }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &TileErrorKind {
        &self.kind
    }
}

impl From<WaveletError> for TileError {
    fn from(error: WaveletError) -> Self {
        Self::new(TileErrorKind::Wavelet(error))
    }
}

impl From<RasterError> for TileError {
    fn from(error: RasterError) -> Self {
        Self::new(TileErrorKind::Raster(error))
    }
}

impl From<ColorError> for TileError {
    fn from(error: ColorError) -> Self {
        Self::new(TileErrorKind::Color(error))
    }
}

impl fmt::Display for TileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            TileErrorKind::TooSmall { length, least } => write!(
                f,
                "a side of {length} pixels is too short; it must have at least {least}"
            ),
            TileErrorKind::Margin {
                margin,
                length,
                most,
            } => write!(
                f,
                "a margin of {margin} pixels is too wide for a side of {length}; at most {most} are possible"
            ),
            TileErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            TileErrorKind::Count {
                what,
                count,
                needed,
            } => write!(f, "there are {count} {what}, but {needed} are needed"),
            TileErrorKind::KindMismatch { map } => {
                write!(f, "map {map} is of another kind than the one it belongs to")
            }
            TileErrorKind::NotFinite { column, row, value } => write!(
                f,
                "the pixel in column {column} and row {row} is {value}, but all must be finite"
            ),
            TileErrorKind::Wavelet(error) => error.fmt(f),
            TileErrorKind::Raster(error) => error.fmt(f),
            TileErrorKind::Color(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for TileError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            TileErrorKind::Wavelet(error) => Some(error),
            TileErrorKind::Raster(error) => Some(error),
            TileErrorKind::Color(error) => Some(error),
            _ => None,
        }
    }
}
