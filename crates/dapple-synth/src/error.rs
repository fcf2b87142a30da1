//! Why an exemplar, a schedule or a direction was refused.

use core::fmt;
use dapple_color::ColorError;
use dapple_mesh::MeshError;
use dapple_raster::RasterError;

/// Why a texture could not be made.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct SynthError {
    kind: SynthErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SynthErrorKind {
    /// A number is outside of its range.
    Range {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range it must lie in, as text.
        range: &'static str,
    },
    /// There are more or fewer things than needed.
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many were needed, as text.
        needed: &'static str,
    },
    /// A level of the exemplar is too small for a neighborhood.
    Exemplar {
        /// The level, 0 the finest.
        level: usize,
        /// Its size in pixels.
        size: [u32; 2],
        /// The side of the neighborhood.
        side: u32,
    },
    /// A pass reads a coarser level that has no colors yet.
    Unfilled {
        /// Which pass.
        pass: usize,
        /// The level that it reads.
        level: usize,
    },
    /// A pixel of the exemplar is NaN or infinite.
    NotFinite {
        /// Its column.
        column: u32,
        /// Its row.
        row: u32,
        /// Its value.
        value: f32,
    },
    /// A direction has no part along the surface.
    Direction {
        /// Which of the directions.
        direction: usize,
    },
    /// A line of a text does not follow its format.
    Text {
        /// The format.
        format: &'static str,
        /// The number of the line, from 1.
        line: usize,
        /// What is wrong.
        why: String,
    },
    /// The caller's callback asked to stop.
    Cancelled,
    /// The mesh was refused.
    Mesh(MeshError),
    /// The raster was refused, or two sizes differ.
    Raster(RasterError),
    /// The color crate refused its input.
    Color(ColorError),
}

impl SynthError {
    pub(crate) fn new(kind: SynthErrorKind) -> Self {
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
            Err(Self::new(SynthErrorKind::Range { what, value, range }))
        }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &SynthErrorKind {
        &self.kind
    }
}

impl From<MeshError> for SynthError {
    fn from(error: MeshError) -> Self {
        Self::new(SynthErrorKind::Mesh(error))
    }
}

impl From<RasterError> for SynthError {
    fn from(error: RasterError) -> Self {
        Self::new(SynthErrorKind::Raster(error))
    }
}

impl From<ColorError> for SynthError {
    fn from(error: ColorError) -> Self {
        Self::new(SynthErrorKind::Color(error))
    }
}

impl fmt::Display for SynthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            SynthErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            SynthErrorKind::Count {
                what,
                count,
                needed,
            } => write!(f, "there are {count} {what}, but {needed} are needed"),
            SynthErrorKind::Exemplar { level, size, side } => write!(
                f,
                "level {level} of the exemplar has {} x {} pixels, too few for a neighborhood of side {side}",
                size[0], size[1]
            ),
            SynthErrorKind::Unfilled { pass, level } => write!(
                f,
                "pass {pass} reads level {level}, which no pass before it visits"
            ),
            SynthErrorKind::NotFinite { column, row, value } => write!(
                f,
                "the pixel in column {column} and row {row} is {value}, but all must be finite"
            ),
            SynthErrorKind::Direction { direction } => write!(
                f,
                "direction {direction} is zero, not finite or normal to the surface"
            ),
            SynthErrorKind::Text { format, line, why } => {
                write!(f, "line {line} of the {format}: {why}")
            }
            SynthErrorKind::Cancelled => write!(f, "the callback asked to stop"),
            SynthErrorKind::Mesh(error) => error.fmt(f),
            SynthErrorKind::Raster(error) => error.fmt(f),
            SynthErrorKind::Color(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SynthError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            SynthErrorKind::Mesh(error) => Some(error),
            SynthErrorKind::Raster(error) => Some(error),
            SynthErrorKind::Color(error) => Some(error),
            _ => None,
        }
    }
}
