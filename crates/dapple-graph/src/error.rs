//! Why a graph was refused.

use crate::grid::Budget;
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

dapple_raster::error! {
    /// Why a graph could not be made, or is not sane.
    GraphError,
    /// The limit that was broken.
    GraphErrorKind {
        /// Two points lie at the same place, so that no direction leads from one to the other.
        Coincident {
            /// The one with the smaller index.
            first: PointIdx,
            /// The other.
            second: PointIdx,
        } => "points {} and {} coincide, but an axis needs a direction", first.0, second.0;
        /// The adjacency has another number of rows than there are points.
        Rows {
            /// The number of rows.
            rows: usize,
            /// The number of points.
            n_points: usize,
        } => "the adjacency has {rows} rows, but the set has {n_points} points";
        /// A row names a point that the set does not have.
        NoSuchPoint {
            /// The point whose row it is.
            from: PointIdx,
            /// The index that was named.
            to: PointIdx,
            /// The number of points.
            n_points: usize,
        } => "the row of point {} names point {}, but the set has {n_points} points", from.0, to.0;
        /// A point is named that is not there.
        NotThere {
            /// The index that was named.
            point: PointIdx,
            /// The number of points.
            n_points: usize,
        } => "point {} is named, but there are {n_points} points", point.0;
        /// A point is to be where the domain is not.
        Outside {
            /// Where.
            position: DVec2,
        } => "the position {position} lies outside of the domain";
        /// Fewer than one or too many nearest neighbors were asked for.
        Neighbors {
            /// How many.
            k: u32,
            /// How many are allowed, or can be had.
            limit: u32,
        } => "asked for {k} nearest neighbors, but 1 to {limit} can be had";
        /// Fewer than one or too many cones were asked for.
        Cones {
            /// How many.
            cones: u32,
            /// How many are allowed.
            limit: u32,
        } => "asked for {cones} cones, but 1 to {limit} are allowed";
        /// More axes than 32 bits can count.
        TooManyAxes {
            /// How many.
            n_axes: usize,
        } => "the graph has {n_axes} axes, but the limit is {}", u32::MAX;
        /// The domain wraps, and is so thin for the distance of its points that too many copies of them count.
        Thin {
            /// Its width and height.
            size: DVec2,
            /// The most copies of points that all searches together may go through.
            limit: u64,
        } =>
            "the domain has size {size} and wraps, so thin that the search for neighbors goes through more than \
             {limit} copies of points, which is the limit";
        /// A row's axes are not in their order, or one of them comes twice.
        Order {
            /// The point whose row it is.
            point: PointIdx,
        } => "the axes of point {} are not in counterclockwise order from the x axis", point.0;
        /// The vector of an axis does not lead to an image of its point.
        Vector {
            /// The point that the axis starts at.
            from: PointIdx,
            /// The point that it says it leads to.
            to: PointIdx,
            /// Its vector.
            vector: DVec2,
        } => "the axis {vector} of point {} does not lead to an image of point {}", from.0, to.0;
        /// The graph says that it is symmetric, but an axis has no opposite.
        OneWay {
            /// The point that the axis starts at.
            from: PointIdx,
            /// The point that it leads to.
            to: PointIdx,
        } => "the axis from point {} to point {} has no opposite", from.0, to.0;
    }
}

impl GraphError {
    /// The error of a domain that is too thin for its points.
    pub(crate) fn thin(points: &PointSet) -> Self {
        Self::new(GraphErrorKind::Thin {
            size: points.domain().size,
            limit: Budget::limit(points.len()),
        })
    }

    /// The error of two points at the same place.
    pub(crate) fn coincident(a: PointIdx, b: PointIdx) -> Self {
        Self::new(GraphErrorKind::Coincident {
            first: a.min(b),
            second: a.max(b),
        })
    }
}
