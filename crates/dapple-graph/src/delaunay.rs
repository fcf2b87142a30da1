//! The Delaunay graph, in the plane and on domains that wrap.
//!
//! Reference: Boris Delaunay, "Sur la sphère vide", Izvestia Akademii Nauk SSSR, 1934. The triangulations come from the
//! crate `spade`.
//!
//! On a domain that wraps, the graph is that of the points and all of their images, seen from the points in the domain.
//! It needs only few of the images: first those in a margin around the domain, then, disc by disc, the ones that lie in the
//! circumcircle of a triangle at a point of the domain. When no such circumcircle holds another image, all of these triangles are true ones. So
//! any number of points is welcome, one or two as well, and points may lead to their own images.
//!
//! Where four or more points (images counted) lie on one empty circle, the triangulation is not unique; the diagonals
//! in that circle are dropped, by exact predicates. What is left is unique: the pairs of points whose Voronoi cells
//! share a side of positive length. It is the same for all images and does not depend on where the domain begins.

mod images;
mod order;
mod patch;
mod star;
mod tiles;

use crate::grid::LazyGrid;
use crate::lattice::{Lattice, check_distinct};
use crate::{Graph, GraphError};
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;
use images::Cover;
use patch::{Patch, Rows};
use tiles::Tiles;

/// The Delaunay graph of the points: two are connected if some circle through both has no other point on it or in it,
/// counting all images.
///
/// Equivalently, their Voronoi cells share a side of positive length: diagonals of squares and other co-circular
/// points are left out. The graph is symmetric, bit for bit. Without wrapping, points on one line are connected to a
/// path; on a wrapped axis a single point is connected to its own images.
///
/// # Errors
///
/// [`GraphErrorKind::Coincident`](crate::GraphErrorKind::Coincident) if two points lie at the same place.
///
/// # Examples
///
/// ```
/// use dapple_graph::{PointIdx, PointSet, delaunay, glam::DVec2, points::Domain};
///
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
/// let positions = square.map(DVec2::from).to_vec();
/// let points = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::splat(2.0)), positions)?;
/// let graph = delaunay(&points)?;
/// let neighbors: Vec<u32> = graph.axes(PointIdx(0)).iter().map(|axis| axis.to.0).collect();
/// assert_eq!(neighbors, [1, 3, 1, 3], "right, up, left, down");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn delaunay(points: &PointSet) -> Result<Graph, GraphError> {
    let lattice = Lattice::new(points.domain());
    let sites = lattice.sites(points);
    let Some(rows) = rows(&lattice, &sites) else {
        check_distinct(&sites)?;
        // Images of different sites never coincide, so this is never reached.
        return Err(GraphError::coincident(PointIdx(0), PointIdx(0)));
    };
    Ok(Graph {
        lattice,
        sites,
        offsets: rows.offsets,
        axes: rows.axes,
        symmetric: true,
    })
}

/// The rows of the graph; `None` if two sites coincide.
fn rows(lattice: &Lattice, sites: &[DVec2]) -> Option<Rows> {
    let margin = MARGIN * (lattice.size.x * (lattice.size.y / sites.len().max(1) as f64)).sqrt();
    if let Some(tiles) = Tiles::new(lattice, sites.len(), margin) {
        return tiles.rows(sites);
    }
    let cover = Cover::new(lattice, DVec2::ZERO, lattice.size, margin);
    let images = cover.images(lattice, sites);
    let mut patch = Patch::new(lattice, cover, &images, sites.len())?;
    Some(patch.rows(&LazyGrid::new(lattice, sites)))
}

/// The margin of images around the domain at first, in mean distances (the root of the area per point).
const MARGIN: f64 = 1.6;
