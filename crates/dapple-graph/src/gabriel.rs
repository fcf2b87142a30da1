//! The Gabriel graph.
//!
//! Reference: K. Ruben Gabriel and Robert R. Sokal, "A New Statistical Approach to Geographic Variation Analysis",
//! Systematic Zoology 18(3), 1969, doi:10.2307/2412323.
//!
//! The Gabriel graph is a subgraph of the Delaunay graph. A point on the circle counts as inside, as in the paper.
//! The remaining edges are those that cross the side shared by the Voronoi cells of their two ends.

use crate::build::{Choice, EdgeDirection, graph_of};
use crate::{Axis, Graph, GraphError, IsCancelled, delaunay_cancellable};
use dapple_points::PointSet;
use glam::DVec2;

/// Creates the Gabriel graph: two points are connected if the circle whose diameter is the segment between them has
/// no other point (or image of a point) on it or inside it.
///
/// It is symmetric, and connects each point to its nearest neighbor if that is unique.
///
#[cfg_attr(doc, doc = include_str!("../docs/gabriel.md"))]
///
/// # Errors
///
/// [`GraphErrorKind::Coincident`](crate::GraphErrorKind::Coincident) if two points coincide;
/// [`GraphErrorKind::Thin`](crate::GraphErrorKind::Thin) on a wrapping domain that is too thin for the distance
/// between its points.
///
/// # Examples
///
/// ```
/// use dapple_graph::{PointSet, gabriel, glam::DVec2, points::Domain};
///
/// // The third point lies in the circle over the first two.
/// let positions = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.25)].map(DVec2::from).to_vec();
/// let points = PointSet::new(Domain::rectangle(DVec2::ZERO, DVec2::ONE), positions)?;
/// assert_eq!(gabriel(&points)?.n_axes(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn gabriel(points: &PointSet) -> Result<Graph, GraphError> {
    gabriel_cancellable(points, &|| false)
}

/// Same as [`gabriel`], but fails if `is_cancelled` returns true. The callback is called as in
/// [`delaunay_cancellable`].
///
/// # Errors
///
/// Same as [`delaunay_cancellable`].
pub fn gabriel_cancellable(
    points: &PointSet,
    is_cancelled: &IsCancelled,
) -> Result<Graph, GraphError> {
    let Graph {
        lattice,
        sites,
        offsets,
        axes,
        ..
    } = delaunay_cancellable(points, is_cancelled)?;
    let steps = |axis: &Axis| lattice.steps(axis.vector);
    let rows = offsets.windows(2).map(|range| {
        let star = &axes[range[0] as usize..range[1] as usize];
        // If the circle contains a point, it also contains the third corner of a triangle at the edge. If several
        // triangles share a circle, all their corners are on it.
        let empty = |axis: &&Axis| {
            let edge = steps(axis);
            star.iter().all(|other| is_outside(edge, steps(other)))
        };
        let choice = |axis: &Axis| Choice {
            to: axis.to.0,
            steps: steps(axis),
        };
        star.iter().filter(empty).map(choice).collect()
    });
    let rows: Vec<Vec<Choice>> = rows.collect();
    graph_of(lattice, sites, rows, EdgeDirection::Directed)
}

/// Returns whether a position equals `edge`, or is outside the circle whose diameter goes from the origin to `edge`.
/// The test is exact.
fn is_outside(edge: DVec2, at: DVec2) -> bool {
    // The angle at the position is acute: at · (at - edge) > 0. Products of integers below 2^53 are below 2^106.
    let dot = at.x as i128 * (at.x - edge.x) as i128 + at.y as i128 * (at.y - edge.y) as i128;
    dot > 0 || at == edge
}
