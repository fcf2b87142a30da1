//! Why a scene was refused.

use core::fmt;
use dapple_raster::RasterError;
use glam::DVec3;

/// The largest size of a coordinate, a length or a scale that a scene may hold; a quartic in it is far from overflow.
const SIZE_MAX: f64 = 1e30;

/// Why a scene could not be rendered, or a mesh not be made.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct PreviewError {
    kind: PreviewErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PreviewErrorKind {
    /// A number is outside of its range, or is not a number.
    Range {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range it must lie in, as text.
        range: &'static str,
    },
    /// A vector that has to point somewhere has no length, or none that counts.
    NoDirection {
        /// What the vector is.
        what: &'static str,
    },
    /// A triangle has a corner that is not a vertex of the mesh.
    Corner {
        /// The index of the triangle.
        triangle: usize,
        /// The index of the vertex that it asks for.
        vertex: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// A mesh has more vertices or triangles than an index can tell apart.
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// The most there may be.
        limit: usize,
    },
    /// A shape without an inside cannot be cut.
    NotSolid {
        /// The name of the shape.
        shape: &'static str,
    },
    /// The picture has a size that a raster cannot have.
    Raster(RasterError),
}

impl PreviewError {
    pub(crate) fn new(kind: PreviewErrorKind) -> Self {
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
            Err(Self::new(PreviewErrorKind::Range { what, value, range }))
        }
    }

    /// Refuses a vector with a part that is not finite or too large to compute with.
    pub(crate) fn check_vector(what: &'static str, vector: DVec3) -> Result<(), Self> {
        vector.to_array().into_iter().try_for_each(|value| {
            let holds = value.abs() <= SIZE_MAX;
            Self::check(holds, what, value, "from -1e30 to 1e30")
        })
    }

    /// Refuses a length that is not above zero, or that is too small or too large to compute with.
    pub(crate) fn check_length(what: &'static str, value: f64) -> Result<(), Self> {
        let holds = (SIZE_MAX.recip()..=SIZE_MAX).contains(&value);
        Self::check(holds, what, value, "from 1e-30 to 1e30")
    }

    /// The vector with a length of 1, which must have a direction.
    pub(crate) fn direction(what: &'static str, vector: DVec3) -> Result<DVec3, Self> {
        Self::check_vector(what, vector)?;
        let none = || Self::new(PreviewErrorKind::NoDirection { what });
        vector.try_normalize().ok_or_else(none)
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &PreviewErrorKind {
        &self.kind
    }
}

impl From<RasterError> for PreviewError {
    fn from(error: RasterError) -> Self {
        Self::new(PreviewErrorKind::Raster(error))
    }
}

impl fmt::Display for PreviewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            PreviewErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            PreviewErrorKind::NoDirection { what } => {
                write!(f, "the {what} has no direction")
            }
            PreviewErrorKind::Corner {
                triangle,
                vertex,
                count,
            } => write!(
                f,
                "triangle {triangle} asks for vertex {vertex}, but there are {count} vertices"
            ),
            PreviewErrorKind::Count { what, count, limit } => {
                write!(f, "there are {count} {what}, but the limit is {limit}")
            }
            PreviewErrorKind::NotSolid { shape } => {
                write!(f, "a {shape} has no inside, so it cannot be cut")
            }
            PreviewErrorKind::Raster(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for PreviewError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            PreviewErrorKind::Raster(error) => Some(error),
            _ => None,
        }
    }
}
