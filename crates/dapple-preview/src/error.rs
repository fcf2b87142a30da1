//! Why a scene was refused.

use core::fmt;
use dapple_mesh::MeshError;
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
    /// The mesh was refused.
    Mesh(MeshError),
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

impl From<MeshError> for PreviewError {
    fn from(error: MeshError) -> Self {
        Self::new(PreviewErrorKind::Mesh(error))
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
            PreviewErrorKind::Mesh(error) => error.fmt(f),
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
            PreviewErrorKind::Mesh(error) => Some(error),
            PreviewErrorKind::Raster(error) => Some(error),
            _ => None,
        }
    }
}
