//! Why a texture was refused.

use core::fmt;
use dapple_graph::GraphError;
use dapple_points::PointsError;
use dapple_raster::RasterError;

/// Why a partition-of-unity texture was refused, or could not be made.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct PupsError {
    kind: PupsErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PupsErrorKind {
    /// There is no control point, so there is nothing to interpolate.
    NoPoints,
    /// The graph, or a column of attributes, belongs to another number of points.
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        count: usize,
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
    /// An axis is so short that single precision cannot divide by its length.
    ShortAxis {
        /// The point that the axis belongs to.
        point: u32,
        /// The length of the axis.
        length: f64,
        /// The shortest length that is accepted in this domain.
        limit: f64,
    },
    /// An axis of the domain has to wrap around, and does not.
    NotWrapped {
        /// The axis: 0 for x, 1 for y.
        axis: usize,
    },
    /// The spacing of points has to be the same everywhere, and is not.
    SpacingVaries,
    /// The points could not be made.
    Points(PointsError),
    /// The graph could not be made.
    Graph(GraphError),
    /// The raster or the window was refused.
    Raster(RasterError),
}

impl PupsError {
    pub(crate) fn new(kind: PupsErrorKind) -> Self {
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
            Err(Self::new(PupsErrorKind::Range { what, value, range }))
        }
    }

    /// Refuses a column of another length.
    pub(crate) fn check_count(what: &'static str, count: usize, needed: usize) -> Result<(), Self> {
        if count == needed {
            Ok(())
        } else {
            Err(Self::new(PupsErrorKind::Count {
                what,
                count,
                needed,
            }))
        }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &PupsErrorKind {
        &self.kind
    }
}

impl From<PointsError> for PupsError {
    fn from(error: PointsError) -> Self {
        Self::new(PupsErrorKind::Points(error))
    }
}

impl From<GraphError> for PupsError {
    fn from(error: GraphError) -> Self {
        Self::new(PupsErrorKind::Graph(error))
    }
}

impl From<RasterError> for PupsError {
    fn from(error: RasterError) -> Self {
        Self::new(PupsErrorKind::Raster(error))
    }
}

impl fmt::Display for PupsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            PupsErrorKind::NoPoints => f.write_str("there is no control point"),
            PupsErrorKind::Count {
                what,
                count,
                needed,
            } => {
                write!(f, "there are {count} {what}, but {needed} are needed")
            }
            PupsErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            PupsErrorKind::ShortAxis {
                point,
                length,
                limit,
            } => {
                write!(
                    f,
                    "an axis of point {point} has length {length}, but the limit is {limit}"
                )
            }
            PupsErrorKind::NotWrapped { axis } => {
                write!(
                    f,
                    "axis {axis} of the domain must wrap around, but does not"
                )
            }
            PupsErrorKind::SpacingVaries => {
                f.write_str("the spacing of nested points must be the same everywhere")
            }
            PupsErrorKind::Points(error) => error.fmt(f),
            PupsErrorKind::Graph(error) => error.fmt(f),
            PupsErrorKind::Raster(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for PupsError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match &self.kind {
            PupsErrorKind::Points(error) => Some(error),
            PupsErrorKind::Graph(error) => Some(error),
            PupsErrorKind::Raster(error) => Some(error),
            _ => None,
        }
    }
}
