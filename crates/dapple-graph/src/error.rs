//! Errors of graphs.

use crate::grid::Budget;
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

dapple_raster::error! {
    /// An error of making or checking a graph.
    GraphError,
    /// The cause of a [`GraphError`], with the limit and the value.
    GraphErrorKind {
        /// Two points lie at the same place once positions are snapped (see [`Graph`](crate::Graph)), so that no direction
        /// leads from one to the other.
        Coincident {
            /// The point with the smaller index.
            first: PointIdx,
            /// The other point.
            second: PointIdx,
        } => "points {} and {} coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger side)", first.0, second.0;
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
            /// The index in the row.
            to: PointIdx,
            /// The number of points.
            n_points: usize,
        } => "the row of point {} names point {}, but the set has {n_points} points", from.0, to.0;
        /// A point with this index does not exist.
        NotThere {
            /// The index.
            point: PointIdx,
            /// The number of points.
            n_points: usize,
        } => "point {} is named, but there are {n_points} points", point.0;
        /// A position for a point lies outside of the domain.
        Outside {
            /// The position.
            position: DVec2,
        } => "the position {position} lies outside of the domain";
        /// The number of nearest neighbors is zero or too large.
        Neighbors {
            /// The number of neighbors.
            k: u32,
            /// The largest number of neighbors that is allowed and exists.
            limit: u32,
        } => "asked for {k} nearest neighbors, but 1 to {limit} can be had";
        /// The number of cones is zero or too large.
        Cones {
            /// The number of cones.
            cones: u32,
            /// The largest number allowed.
            limit: u32,
        } => "asked for {cones} cones, but 1 to {limit} are allowed";
        /// The graph has more axes than 32 bits can count.
        TooManyAxes {
            /// The number of axes.
            n_axes: usize,
        } => "the graph has {n_axes} axes, but the limit is {}", u32::MAX;
        /// The domain wraps, and is so thin for the distance of its points that too many copies of them would be
        /// needed.
        Thin {
            /// Width and height of the domain.
            size: DVec2,
            /// The largest number of copies of points that all searches together may go through.
            limit: u64,
        } =>
            "the domain has size {size} and wraps, so thin that the search for neighbors goes through more than \
             {limit} copies of points, which is the limit";
        /// The callback of the caller asked to stop.
        Cancelled => "the callback asked to stop";
        /// A graph has no triangles and no Voronoi diagram, since it was not made as a Delaunay graph.
        NotDelaunay => "the graph was not made as a Delaunay graph, so that it has no triangles and no Voronoi diagram";
        /// The data of a graph has a step or a size that no domain leads to.
        Lattice {
            /// The length of a step.
            step: f64,
            /// Width and height in steps.
            size: [i64; 2],
        } =>
            "the graph has steps of {step} and a size of {} by {} steps, but a step must be a power of two, and the \
             larger side have 2^49 to 2^50 steps", size[0], size[1];
        /// A row's axes are not in their order, or one of them comes twice.
        Order {
            /// The point whose row it is.
            point: PointIdx,
        } => "the axes of point {} are not in counterclockwise order from the x axis", point.0;
        /// The vector of an axis does not lead to an image of its point.
        Vector {
            /// The point that the axis starts at.
            from: PointIdx,
            /// The point that the axis claims to lead to.
            to: PointIdx,
            /// The vector of the axis.
            vector: DVec2,
        } => "the axis {vector} of point {} does not lead to an image of point {}", from.0, to.0;
        /// The graph claims to be symmetric, but an axis has no opposite.
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
