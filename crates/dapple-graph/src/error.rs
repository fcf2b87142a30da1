//! Why a graph was refused.

use core::fmt;
use dapple_points::PointIdx;

/// Why a graph could not be made, or is not sane.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct GraphError {
    kind: GraphErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GraphErrorKind {
    /// Two points lie at the same place, so that no direction leads from one to the other.
    Coincident {
        /// The one with the smaller index.
        first: PointIdx,
        /// The other.
        second: PointIdx,
    },
    /// The adjacency has another number of rows than there are points.
    Rows {
        /// The number of rows.
        rows: usize,
        /// The number of points.
        n_points: usize,
    },
    /// A row names a point that the set does not have.
    NoSuchPoint {
        /// The point whose row it is.
        from: PointIdx,
        /// The index that was named.
        to: PointIdx,
        /// The number of points.
        n_points: usize,
    },
}

impl GraphError {
    pub(crate) fn new(kind: GraphErrorKind) -> Self {
        Self { kind }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &GraphErrorKind {
        &self.kind
    }
}

impl fmt::Display for GraphError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            GraphErrorKind::Coincident { first, second } => write!(
                f,
                "points {} and {} coincide, but an axis needs a direction",
                first.0, second.0
            ),
            GraphErrorKind::Rows { rows, n_points } => write!(
                f,
                "the adjacency has {rows} rows, but the set has {n_points} points"
            ),
            GraphErrorKind::NoSuchPoint { from, to, n_points } => write!(
                f,
                "the row of point {} names point {}, but the set has {n_points} points",
                from.0, to.0
            ),
        }
    }
}

impl core::error::Error for GraphError {}

impl GraphError {
    /// The error of two points at the same place.
    pub(crate) fn coincident(a: PointIdx, b: PointIdx) -> Self {
        Self::new(GraphErrorKind::Coincident {
            first: a.min(b),
            second: a.max(b),
        })
    }
}
