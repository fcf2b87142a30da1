//! A graph in compressed rows, which lists the axes of each point.

use crate::angle::{by_angle, is_lower};
use crate::build::{Choice, graph_of};
#[cfg(feature = "serde")]
use crate::data::GraphData;
use crate::lattice::Lattice;
use crate::{EdgeDirection, GraphError, GraphErrorKind};
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

/// A directed edge from a point to one of its neighbors. Texture models with partition of unity call it an axis of the
/// point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Target point of the axis.
    pub to: PointIdx,
    /// Vector from the point to an image of `to`, in the same units as positions; never zero.
    pub vector: DVec2,
}

/// A graph over a point set: a list of axes for each point.
///
/// Vectors are exact differences between positions. Positions are first snapped to the nearest multiple, relative to
/// the domain's origin, of a power of two between 2^-50 and 2^-49 of the larger side of the domain.
///
/// The serialized form (feature `serde`) stores positions and vectors as integer multiples of that power of two.
/// Reading performs all checks of [`sanity_check`](Graph::sanity_check), and for a Delaunay graph, triangulates the
/// points again for comparison.
///
/// Two graphs are equal if they have the same points and axes, regardless of the function that created them.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "GraphData", into = "GraphData")
)]
pub struct Graph {
    pub(crate) lattice: Lattice,
    pub(crate) sites: Vec<DVec2>,
    pub(crate) offsets: Vec<u32>,
    pub(crate) axes: Vec<Axis>,
    pub(crate) symmetric: bool,
    /// Whether the graph was created as a Delaunay graph.
    pub(crate) delaunay: bool,
}

impl PartialEq for Graph {
    fn eq(&self, other: &Self) -> bool {
        self.lattice == other.lattice
            && self.sites == other.sites
            && self.offsets == other.offsets
            && self.axes == other.axes
    }
}

impl Graph {
    /// Creates a graph from an adjacency list: row `i` lists the points that point `i` is connected to.
    ///
    /// Each axis is the shortest vector across the wrapped axes. Duplicates in a row count once. Edges are directed:
    /// for a symmetric graph, list both ends in each other's rows.
    ///
    /// # Errors
    ///
    /// [`GraphErrorKind::Rows`] if the number of rows does not match the number of points,
    /// [`GraphErrorKind::NoSuchPoint`] for an index that is too large, [`GraphErrorKind::Coincident`] if a row lists
    /// its own point or a point at the same position.
    pub fn from_adjacency<R: AsRef<[PointIdx]>>(
        points: &PointSet,
        rows: &[R],
    ) -> Result<Self, GraphError> {
        let n_points = points.len();
        if rows.len() != n_points {
            return Err(GraphError::new(GraphErrorKind::Rows {
                rows: rows.len(),
                n_points,
            }));
        }
        let lattice = Lattice::new(points.domain());
        let sites = lattice.sites(points);
        let row = |(from, row): (PointIdx, &R)| {
            let choices = row.as_ref().iter().map(|&to| {
                let kind = GraphErrorKind::NoSuchPoint { from, to, n_points };
                let site = *sites.get(to.index()).ok_or(GraphError::new(kind))?;
                let steps = lattice.delta(sites[from.index()], site);
                if steps == DVec2::ZERO {
                    return Err(GraphError::coincident(from, to));
                }
                Ok(Choice { to: to.0, steps })
            });
            let mut choices = choices.collect::<Result<Vec<_>, _>>()?;
            choices.sort_unstable_by_key(|choice| choice.to);
            choices.dedup();
            Ok(choices)
        };
        let numbered = (0..).map(PointIdx).zip(rows);
        let rows = numbered.map(row).collect::<Result<Vec<_>, GraphError>>()?;
        graph_of(lattice, sites, rows, EdgeDirection::Directed)
    }

    /// Returns the axes of a point, counterclockwise (from the x axis toward the y axis), starting at the smallest
    /// angle from the x axis in `[0, 2π)`. Axes with the same angle are ordered by length, then by index.
    ///
    /// # Panics
    ///
    /// If the point does not exist.
    #[must_use]
    #[inline]
    pub fn axes(&self, point: PointIdx) -> &[Axis] {
        let at = point.index();
        &self.axes[self.offsets[at] as usize..self.offsets[at + 1] as usize]
    }

    /// Returns the number of points.
    #[must_use]
    pub fn n_points(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Returns the number of axes, which are directed edges. In a symmetric graph, this is twice the number of edges.
    #[must_use]
    pub fn n_axes(&self) -> usize {
        self.axes.len()
    }

    /// Returns the index of the first axis of each point in [`all_axes`](Self::all_axes), followed by the number of
    /// axes.
    #[must_use]
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// Returns the axes of all points, point by point.
    #[must_use]
    pub fn all_axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the edges of a symmetric graph, each exactly once, as a point and its axis along the edge. The axis
    /// leads toward larger y or, for equal y, toward larger x.
    pub fn edges(&self) -> impl Iterator<Item = (PointIdx, Axis)> + '_ {
        let points = (0..self.n_points() as u32).map(PointIdx);
        let axes = points.flat_map(|from| self.axes(from).iter().map(move |&axis| (from, axis)));
        axes.filter(|(_, axis)| !is_lower(axis.vector))
    }

    /// Returns whether every axis has an opposite axis, which leads back from the other end with exactly the negated
    /// vector.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// Returns whether the graph was created as a Delaunay graph and therefore has [`triangles`](Self::triangles) and
    /// a [`Voronoi`](crate::Voronoi) diagram.
    #[must_use]
    pub fn is_delaunay(&self) -> bool {
        self.delaunay
    }

    /// Fails if the graph was not created as a Delaunay graph.
    pub(crate) fn check_delaunay(&self) -> Result<(), GraphError> {
        if self.delaunay {
            Ok(())
        } else {
            Err(GraphError::new(GraphErrorKind::NotDelaunay))
        }
    }
}

impl Axis {
    /// Compares two axes of a point by the order in which the point lists them.
    pub(crate) fn order(&self, other: &Self) -> core::cmp::Ordering {
        let scale = scale(self.vector.abs().max(other.vector.abs()).max_element());
        by_angle(self.vector * scale, other.vector * scale).then(self.to.cmp(&other.to))
    }
}

/// Returns the power of two that scales a length to the range from 1 to 2, so that products do not underflow or
/// overflow. On a lattice, vectors of such lengths are multiplied without rounding.
fn scale(length: f64) -> f64 {
    let exponent_only = f64::from_bits(length.to_bits() & f64::INFINITY.to_bits());
    1.0 / exponent_only.max(f64::MIN_POSITIVE)
}
