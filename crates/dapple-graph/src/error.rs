//! Errors from creating and checking graphs.

use crate::grid::Budget;
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

dapple_raster::error! {
    /// An error from creating or checking a graph.
    GraphError,
    /// Cause of a [`GraphError`], with the limit and the value.
    GraphErrorKind {
        /// Two points coincide after snapping (see [`Graph`](crate::Graph)), so the direction between them is
        /// undefined.
        Coincident {
            /// Point with the smaller index.
            first: PointIdx,
            /// The other point.
            second: PointIdx,
        } => "points {} and {} coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger side)", first.0, second.0;
        /// The number of rows of the adjacency does not match the number of points.
        Rows {
            /// Number of rows.
            rows: usize,
            /// Number of points.
            n_points: usize,
        } => "the adjacency has {rows} rows, but the set has {n_points} points";
        /// A row refers to a point that the set does not contain.
        NoSuchPoint {
            /// Point whose row it is.
            from: PointIdx,
            /// Point index found in the row.
            to: PointIdx,
            /// Number of points.
            n_points: usize,
        } => "the row of point {} names point {}, but the set has {n_points} points", from.0, to.0;
        /// A point with this index does not exist.
        NotThere {
            /// The index.
            point: PointIdx,
            /// Number of points.
            n_points: usize,
        } => "point {} is named, but there are {n_points} points", point.0;
        /// A position is outside the domain.
        Outside {
            /// The position.
            position: DVec2,
        } => "the position {position} lies outside of the domain";
        /// The number of nearest neighbors is zero or too large.
        Neighbors {
            /// Requested number of neighbors.
            k: u32,
            /// Maximum number of neighbors, given the limit and the available points.
            limit: u32,
        } => "asked for {k} nearest neighbors, but 1 to {limit} can be had";
        /// The number of cones is zero or too large.
        Cones {
            /// Requested number of cones.
            cones: u32,
            /// Maximum number of cones.
            limit: u32,
        } => "asked for {cones} cones, but 1 to {limit} are allowed";
        /// The number of axes exceeds 32 bits.
        TooManyAxes {
            /// Number of axes.
            n_axes: usize,
        } => "the graph has {n_axes} axes, but the limit is {}", u32::MAX;
        /// The domain wraps and is so thin, relative to the distance between its points, that too many images would
        /// be needed.
        Thin {
            /// Width and height of the domain.
            size: DVec2,
            /// Maximum number of images that all searches together may visit.
            limit: u64,
        } =>
            "the domain has size {size} and wraps, so thin that the search for neighbors goes through more than \
             {limit} copies of points, which is the limit";
        /// The operation was canceled by the caller's callback.
        Cancelled => "the callback asked to stop";
        /// The graph was not created as a Delaunay graph, so it has no triangles and no Voronoi diagram.
        NotDelaunay => "the graph was not made as a Delaunay graph, so that it has no triangles and no Voronoi diagram";
        /// A serialized graph's step or size does not belong to any domain.
        Lattice {
            /// Length of a step.
            step: f64,
            /// Width and height, in steps.
            size: [i64; 2],
        } =>
            "the graph has steps of {step} and a size of {} by {} steps, but a step must be a power of two, and the \
             larger side have 2^49 to 2^50 steps", size[0], size[1];
        /// The axes of a row are not in order, or contain a duplicate.
        Order {
            /// Point whose row it is.
            point: PointIdx,
        } => "the axes of point {} are not in counterclockwise order from the x axis", point.0;
        /// The vector of an axis does not lead to an image of its target.
        Vector {
            /// Start point of the axis.
            from: PointIdx,
            /// Target point of the axis.
            to: PointIdx,
            /// Vector of the axis.
            vector: DVec2,
        } => "the axis {vector} of point {} does not lead to an image of point {}", from.0, to.0;
        /// The graph is marked as symmetric, but an axis has no opposite.
        OneWay {
            /// Start point of the axis.
            from: PointIdx,
            /// Target point of the axis.
            to: PointIdx,
        } => "the axis from point {} to point {} has no opposite", from.0, to.0;
    }
}

impl GraphError {
    /// Creates the error for a domain that is too thin for its points.
    pub(crate) fn thin(points: &PointSet) -> Self {
        Self::new(GraphErrorKind::Thin {
            size: points.domain().size,
            limit: Budget::limit(points.len()),
        })
    }

    /// Creates the error for two coinciding points.
    pub(crate) fn coincident(a: PointIdx, b: PointIdx) -> Self {
        Self::new(GraphErrorKind::Coincident {
            first: a.min(b),
            second: a.max(b),
        })
    }
}
