//! Why a basis was refused.

use core::fmt;
use dapple_raster::RasterError;

/// Why a cellular basis was refused, or a picture of it.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct WorleyError {
    kind: WorleyErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WorleyErrorKind {
    /// A number is outside of its range.
    Range {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range it must lie in, as text.
        range: &'static str,
    },
    /// The number of values is not that of the positions.
    Length {
        /// How many values there are.
        length: usize,
        /// How many were needed.
        needed: usize,
    },
    /// The table of ranges has no entry for this combination.
    NoRange,
    /// The raster or the window was refused.
    Raster(RasterError),
}

impl WorleyError {
    pub(crate) fn new(kind: WorleyErrorKind) -> Self {
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
            Err(Self::new(WorleyErrorKind::Range { what, value, range }))
        }
    }

    /// Refuses memory of another length.
    pub(crate) fn check_length(length: usize, needed: usize) -> Result<(), Self> {
        if length == needed {
            Ok(())
        } else {
            Err(Self::new(WorleyErrorKind::Length { length, needed }))
        }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &WorleyErrorKind {
        &self.kind
    }
}

impl From<RasterError> for WorleyError {
    fn from(error: RasterError) -> Self {
        Self::new(WorleyErrorKind::Raster(error))
    }
}

impl fmt::Display for WorleyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            WorleyErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            WorleyErrorKind::Length { length, needed } => {
                write!(f, "there is room for {length} values, but {needed} are needed")
            }
            WorleyErrorKind::NoRange => f.write_str(
                "the table of ranges has the named combinations at the default density only; measure the range",
            ),
            WorleyErrorKind::Raster(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for WorleyError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            WorleyErrorKind::Raster(error) => Some(error),
            _ => None,
        }
    }
}
