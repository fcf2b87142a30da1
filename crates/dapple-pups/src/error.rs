//! Errors of partition-of-unity textures.

use dapple_graph::{GraphError, GraphErrorKind, IsCancelled};
use dapple_points::{PointsError, PointsErrorKind};
use dapple_raster::RasterError;

dapple_raster::error! {
    /// An error of a partition-of-unity texture: an option out of its limits, or a failed construction.
    PupsError,
    /// The cause of a [`PupsError`], with the limit and the value.
    PupsErrorKind with Range {
        /// No control points, so there is nothing to interpolate.
        NoPoints => "there is no control point";
        /// The number of elements in a graph or list does not match the number of points.
        Count {
            /// The kind of elements.
            what: &'static str,
            /// Number of elements given.
            count: usize,
            /// Number of elements needed.
            needed: usize,
        } => "there are {count} {what}, but {needed} are needed";
        /// An axis is too short to divide by its length in single precision.
        ShortAxis {
            /// Index of the axis's control point.
            point: u32,
            /// Length of the axis.
            length: f64,
            /// Minimum length in this domain.
            limit: f64,
        } => "an axis of point {point} has length {length}, but the limit is {limit}";
        /// An axis of the domain must wrap, but does not.
        NotWrapped {
            /// Index of the axis: 0 for x, 1 for y.
            axis: usize,
        } => "axis {axis} of the domain must wrap around, but does not";
        /// The spacing of points varies, but must be constant.
        SpacingVaries => "the spacing of nested points must be the same everywhere";
        /// Two options exclude each other, or an option lacks another one that it requires.
        Conflict {
            /// The violated rule, as a sentence without a period.
            rule: &'static str,
        } => "{rule}";
        /// The operation was canceled by the caller's callback.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// Generating the points failed.
        Points(PointsError),
        /// Building the graph failed.
        Graph(GraphError),
        /// The raster or the window is invalid.
        Raster(RasterError),
    }
}

impl PupsError {
    /// Returns an error if the caller's callback cancels.
    pub(crate) fn check_wanted(is_cancelled: &IsCancelled) -> Result<(), Self> {
        match is_cancelled() {
            true => Err(Self::new(PupsErrorKind::Cancelled)),
            false => Ok(()),
        }
    }

    /// Converts an error from generating points or building a graph. Cancellation becomes [`PupsErrorKind::Cancelled`].
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

    /// Returns an error if `count` differs from `needed`.
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
