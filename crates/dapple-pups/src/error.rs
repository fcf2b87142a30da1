//! Why a texture was refused.

use crate::Range;
use dapple_graph::{GraphError, GraphErrorKind, IsCancelled};
use dapple_points::{PointsError, PointsErrorKind};
use dapple_raster::RasterError;

dapple_raster::error! {
    /// Why a partition-of-unity texture was refused, or could not be made.
    PupsError,
    /// The limit that was broken.
    PupsErrorKind with Range {
        /// There is no control point, so there is nothing to interpolate.
        NoPoints => "there is no control point";
        /// The graph, or a column of attributes, belongs to another number of points.
        Count {
            /// The things that were counted.
            what: &'static str,
            /// How many there are.
            count: usize,
            /// How many were needed.
            needed: usize,
        } => "there are {count} {what}, but {needed} are needed";
        /// An axis is so short that single precision cannot divide by its length.
        ShortAxis {
            /// The point that the axis belongs to.
            point: u32,
            /// The length of the axis.
            length: f64,
            /// The shortest length that is accepted in this domain.
            limit: f64,
        } => "an axis of point {point} has length {length}, but the limit is {limit}";
        /// An axis of the domain has to wrap around, and does not.
        NotWrapped {
            /// The axis: 0 for x, 1 for y.
            axis: usize,
        } => "axis {axis} of the domain must wrap around, but does not";
        /// The spacing of points has to be the same everywhere, and is not.
        SpacingVaries => "the spacing of nested points must be the same everywhere";
        /// Two options exclude each other, or one needs another.
        Conflict {
            /// The rule, as a sentence without a full stop.
            rule: &'static str,
        } => "{rule}";
        /// The callback of the caller asked to stop.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// The points could not be made.
        Points(PointsError),
        /// The graph could not be made.
        Graph(GraphError),
        /// The raster or the window was refused.
        Raster(RasterError),
    }
}

impl PupsError {
    /// Fails if the caller asked to stop.
    pub(crate) fn check_wanted(is_cancelled: &IsCancelled) -> Result<(), Self> {
        match is_cancelled() {
            true => Err(Self::new(PupsErrorKind::Cancelled)),
            false => Ok(()),
        }
    }

    /// The error of making points or a graph, which is [`PupsErrorKind::Cancelled`] if the caller asked to stop.
    pub(crate) fn of_part(error: impl Into<Self>) -> Self {
        let error = error.into();
        let is_cancelled = match error.kind() {
            PupsErrorKind::Points(error) => *error.kind() == PointsErrorKind::Cancelled,
            PupsErrorKind::Graph(error) => *error.kind() == GraphErrorKind::Cancelled,
            _ => false,
        };
        match is_cancelled {
            true => Self::new(PupsErrorKind::Cancelled),
            false => error,
        }
    }

    /// Refuses a number outside of a range.
    pub(crate) fn check_in(range: Range, what: &'static str, value: f64) -> Result<(), Self> {
        Self::check(range.holds(value), what, value, range.text)
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
}
