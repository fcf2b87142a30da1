//! A graph in compressed rows: the axes of each point.

use crate::angle::{by_angle, is_lower};
use crate::build::{Choice, graph_of};
#[cfg(feature = "serde")]
use crate::data::GraphData;
use crate::lattice::Lattice;
use crate::{EdgeDirection, GraphError, GraphErrorKind};
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

/// One edge, as seen from one of its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The point that the axis leads to.
    pub to: PointIdx,
    /// The vector from the point to that image of `to`, in the units of the positions; never zero.
    pub vector: DVec2,
}

/// A graph over a point set: a list of axes for each point.
///
/// Vectors are exact differences of the positions after these were snapped to the nearest multiple (from the origin
/// of the domain) of a power of two between 2^-50 and 2^-49 of the domain's larger side.
///
/// As data (feature `serde`), a graph has its positions and vectors in whole steps of that power of two. Reading checks all
/// that [`sanity_check`](Graph::sanity_check) does, and triangulates the points of a Delaunay graph once more to compare.
///
/// Two graphs are equal if they have the same points and axes, whatever function made them.
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
    /// Whether the graph was made as a Delaunay graph.
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
    /// The graph given by the caller: row `i` names the points that point `i` is connected to.
    ///
    /// Each axis takes the shortest way around the wrapped axes. A name that comes twice in a row counts once. Edges
    /// are directed: name both ends in each other's rows for a symmetric graph.
    ///
    /// # Errors
    ///
    /// [`GraphErrorKind::Rows`] for another number of rows than points, [`GraphErrorKind::NoSuchPoint`] for an index
    /// that is too large, [`GraphErrorKind::Coincident`] if a row names a point at the same place or its own point.
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

    /// The axes of a point, counterclockwise, from the smallest angle in `[0, 2π)` from the x axis towards y; axes with
    /// the same angle by length, then by index.
    ///
    /// # Panics
    ///
    /// If the graph has no such point.
    #[must_use]
    #[inline]
    pub fn axes(&self, point: PointIdx) -> &[Axis] {
        let at = point.index();
        &self.axes[self.offsets[at] as usize..self.offsets[at + 1] as usize]
    }

    /// The number of points.
    #[must_use]
    pub fn n_points(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The number of axes: twice the number of edges if the graph is symmetric.
    #[must_use]
    pub fn n_axes(&self) -> usize {
        self.axes.len()
    }

    /// The index of each point's first axis in [`all_axes`](Self::all_axes), and at the end the number of axes.
    #[must_use]
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// The axes of all points, one point after another.
    #[must_use]
    pub fn all_axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The edges of a symmetric graph, each once: a point, and its axis along the edge. The axis leads towards larger
    /// y, or, where y is the same, towards larger x.
    pub fn edges(&self) -> impl Iterator<Item = (PointIdx, Axis)> + '_ {
        let points = (0..self.n_points() as u32).map(PointIdx);
        let axes = points.flat_map(|from| self.axes(from).iter().map(move |&axis| (from, axis)));
        axes.filter(|(_, axis)| !is_lower(axis.vector))
    }

    /// Whether every axis has its opposite: from the other end back, with exactly the negated vector.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// Whether the graph was made as a Delaunay graph, so that it has [`triangles`](Self::triangles) and a
    /// [`Voronoi`](crate::Voronoi) diagram.
    #[must_use]
    pub fn is_delaunay(&self) -> bool {
        self.delaunay
    }

    /// Fails if the graph was not made as a Delaunay graph.
    pub(crate) fn check_delaunay(&self) -> Result<(), GraphError> {
        if self.delaunay {
            Ok(())
        } else {
            Err(GraphError::new(GraphErrorKind::NotDelaunay))
        }
    }
}

impl Axis {
    /// The order of a point's axes.
    pub(crate) fn order(&self, other: &Self) -> core::cmp::Ordering {
        let scale = scale(self.vector.abs().max(other.vector.abs()).max_element());
        by_angle(self.vector * scale, other.vector * scale).then(self.to.cmp(&other.to))
    }
}

/// The power of two that scales a length to between 1 and 2, so that products of tiny or huge ones do not underflow or
/// overflow. On a lattice, vectors of such lengths are multiplied without rounding.
fn scale(length: f64) -> f64 {
    let exponent_only = f64::from_bits(length.to_bits() & f64::INFINITY.to_bits());
    1.0 / exponent_only.max(f64::MIN_POSITIVE)
}
