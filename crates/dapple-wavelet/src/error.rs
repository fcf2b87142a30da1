//! Why a line, a raster or a tile was refused.

use core::fmt;
use dapple_raster::RasterError;

/// Why a filter refused its input.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveletError {
    kind: WaveletErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WaveletErrorKind {
    /// A periodic side that cannot be halved so often.
    NotDivisible {
        /// The length of the side.
        length: usize,
        /// How often it was to be halved.
        levels: u32,
    },
    /// A side is too short.
    TooShort {
        /// The length of the side.
        length: usize,
        /// The shortest that is allowed.
        least: usize,
    },
    /// The number of values is not the one needed.
    Length {
        /// How many values there are.
        length: usize,
        /// How many were needed.
        needed: usize,
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
    /// A value is NaN or infinite.
    NotFinite {
        /// Its index, counted along rows from the first.
        index: usize,
        /// The value.
        value: f64,
    },
    /// The raster was refused.
    Raster(RasterError),
}

impl WaveletError {
    pub(crate) fn new(kind: WaveletErrorKind) -> Self {
        Self { kind }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &WaveletErrorKind {
        &self.kind
    }
}

impl From<RasterError> for WaveletError {
    fn from(error: RasterError) -> Self {
        Self::new(WaveletErrorKind::Raster(error))
    }
}

impl fmt::Display for WaveletError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            WaveletErrorKind::NotDivisible { length, levels } => write!(
                f,
                "a periodic side of {length} cannot be halved {levels} times; its length must be a multiple of 2^{levels}"
            ),
            WaveletErrorKind::TooShort { length, least } => {
                write!(
                    f,
                    "a side of {length} is too short; it must have at least {least}"
                )
            }
            WaveletErrorKind::Length { length, needed } => {
                write!(f, "there are {length} values, but {needed} are needed")
            }
            WaveletErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            WaveletErrorKind::NotFinite { index, value } => {
                write!(f, "value {index} is {value}, but all must be finite")
            }
            WaveletErrorKind::Raster(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for WaveletError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            WaveletErrorKind::Raster(error) => Some(error),
            _ => None,
        }
    }
}
