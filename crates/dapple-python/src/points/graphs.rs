//! Graphs of point sets.

use super::{Domain, Points, set};
use crate::arrays;
use crate::error::{Error, Result};
use crate::watch::{self, Stop};
use dapple::graph::{Axis, EdgeDirection, GraphError};
use dapple::points::{PointIdx, PointSet};
use dapple::raster::glam::DVec2;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// How a graph is constructed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum GraphMade {
    /// The Delaunay graph.
    Delaunay,
    /// The Gabriel graph, which connects pairs of points whose diametral circle is empty.
    Gabriel,
    /// The Yao graph, which connects each point with the nearest point in each cone.
    Yao {
        cones: u32,
        direction: EdgeDirection,
    },
    /// The graph that connects each point with its `k` nearest points.
    KNearest { k: u32, direction: EdgeDirection },
}

impl GraphMade {
    /// Builds the graph of `points`.
    pub(crate) fn build(
        self,
        points: &PointSet,
        stop: &Stop,
    ) -> core::result::Result<dapple::graph::Graph, GraphError> {
        let is_cancelled = || stop.is_set();
        match self {
            Self::Delaunay => dapple::graph::delaunay_cancellable(points, &is_cancelled),
            Self::Gabriel => dapple::graph::gabriel_cancellable(points, &is_cancelled),
            Self::Yao { cones, direction } => {
                dapple::graph::yao_cancellable(points, cones, direction, &is_cancelled)
            }
            Self::KNearest { k, direction } => {
                dapple::graph::k_nearest_cancellable(points, k, direction, &is_cancelled)
            }
        }
    }
}

/// The neighbors of points, and the vectors to them.
///
/// Graphs are created by `delaunay`, `gabriel`, `yao` and `k_nearest`. Where axes wrap, edges may cross the boundary,
/// a point may be its own neighbor, and two points may be neighbors several times, with different vectors.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct Graph {
    points: Arc<PointSet>,
    made: GraphMade,
    graph: Arc<dapple::graph::Graph>,
}

impl Graph {
    fn new(py: Python<'_>, points: Arc<PointSet>, made: GraphMade) -> Result<Self> {
        let set = Arc::clone(&points);
        let graph = watch::run(py, None, move |_, stop| made.build(&set, stop))??;
        Ok(Self {
            points,
            made,
            graph: Arc::new(graph),
        })
    }

    /// Returns the points of the graph.
    pub(crate) fn set(&self) -> &Arc<PointSet> {
        &self.points
    }

    /// Returns the method that constructed the graph.
    pub(crate) fn made(&self) -> GraphMade {
        self.made
    }

    /// Returns the graph.
    pub(crate) fn graph(&self) -> Arc<dapple::graph::Graph> {
        Arc::clone(&self.graph)
    }

    /// Returns the edges as pairs of a source point and the edge's target and offset. Undirected edges are listed once;
    /// in a directed graph, all edges are listed.
    fn each_edge(&self) -> impl Iterator<Item = (u32, &Axis)> {
        let one_way = !self.graph.is_symmetric();
        let from = (0..self.graph.n_points() as u32).map(PointIdx);
        let axes = from.flat_map(|from| self.graph.axes(from).iter().map(move |axis| (from, axis)));
        axes.filter(move |(from, Axis { to, vector })| {
            let is_upper = vector.y > 0.0 || (vector.y == 0.0 && vector.x > 0.0);
            one_way || from < to || (from == to && is_upper)
        })
        .map(|(from, axis)| (from.0, axis))
    }

    /// Returns the triangles of a Delaunay graph; an error for other graphs.
    fn each_triangle(&self, py: Python<'_>) -> Result<Vec<dapple::graph::Triangle>> {
        if self.made != GraphMade::Delaunay {
            return Err(Error::new(
                "kind",
                "only the graph of `delaunay` has triangles",
            ));
        }
        let points = Arc::clone(&self.points);
        Ok(watch::run(py, None, move |_, stop| {
            dapple::graph::delaunay_triangles_cancellable(&points, &|| stop.is_set())
        })??)
    }
}

/// Converts rows of `N` point indices to an int64 array, the index type of NumPy and SciPy.
fn indices<const N: usize>(
    py: Python<'_>,
    rows: impl Iterator<Item = [u32; N]>,
) -> Result<Bound<'_, PyAny>> {
    let rows: Vec<[i64; N]> = rows.map(|row| row.map(i64::from)).collect();
    let shape = [rows.len(), N];
    arrays::array(py, rows.into_flattened(), &shape)
}

#[pymethods]
impl Graph {
    /// The points of the graph.
    #[getter]
    fn points(&self) -> Points {
        Points::shared_with(&self.points)
    }

    /// Whether every edge exists in both directions.
    #[getter]
    fn is_symmetric(&self) -> bool {
        self.graph.is_symmetric()
    }

    /// Returns each edge once, as a pair of point indices: int64 of shape (m, 2). In a symmetric graph the smaller
    /// index is first; otherwise an edge leads from the first point to the second.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of int64
    ///     The indices of both points of each edge, (m, 2).
    fn edges<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        indices(py, self.each_edge().map(|(from, axis)| [from, axis.to.0]))
    }

    /// Returns the vector of each edge, from its first point to its second, across the boundary where axes wrap:
    /// float64 of shape (m, 2).
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float64
    ///     The vectors, (m, 2), in the order of `edges`.
    fn vectors<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let vectors: Vec<DVec2> = self.each_edge().map(|(_, axis)| axis.vector).collect();
        set::positions(py, &vectors)
    }

    /// Returns the neighbors of all points in compressed rows: the neighbors of point i are
    /// `indices[indptr[i]:indptr[i + 1]]`, sorted by the angle of the vectors to them, `vectors`.
    ///
    /// `scipy.sparse.csr_array((lengths, indices, indptr))` is the matrix of a graph on a domain that does not wrap;
    /// if it wraps, pairs may occur more than once.
    ///
    /// Returns
    /// -------
    /// Axes
    ///     The neighbors in compressed rows.
    fn axes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let offsets: Vec<i64> = self.graph.offsets().iter().map(|&at| at.into()).collect();
        let axes = self.graph.all_axes();
        let to: Vec<i64> = axes.iter().map(|axis| axis.to.0.into()).collect();
        let vectors: Vec<DVec2> = axes.iter().map(|axis| axis.vector).collect();
        let (n_offsets, n_axes) = (offsets.len(), to.len());
        let parts = (
            arrays::array(py, offsets, &[n_offsets])?,
            arrays::array(py, to, &[n_axes])?,
            set::positions(py, &vectors)?,
        );
        arrays::result(py, "Axes", parts)
    }

    /// Returns the Delaunay triangles as point indices: int64 of shape (t, 3), ordered in the direction from x to y.
    ///
    /// Where more than three points are on an empty circle, one of several valid triangulations is chosen.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of int64
    ///     The indices of the corners, (t, 3).
    fn triangles<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let triangles = self.each_triangle(py)?;
        indices(
            py,
            triangles
                .iter()
                .map(|triangle| triangle.corners.map(|corner| corner.0)),
        )
    }

    /// Returns the corner positions of the triangles: float64 of shape (t, 3, 2). Where axes wrap, the second and the
    /// third corner may be outside the domain, so that the triangle is in one piece.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float64
    ///     The positions of the corners, (t, 3, 2), in the order of `triangles`.
    fn corners<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let triangles = self.each_triangle(py)?;
        let corners = triangles.iter().flat_map(|triangle| {
            let first = self.points.position(triangle.corners[0]);
            [first, first + triangle.sides[0], first + triangle.sides[1]]
        });
        let numbers: Vec<[f64; 2]> = corners.map(|corner| corner.to_array()).collect();
        arrays::array(py, numbers.into_flattened(), &[triangles.len(), 3, 2])
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| {
            let other = other.get();
            other.points == self.points && other.made == self.made
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Result<(Bound<'py, PyAny>, (Points, String))> {
        let make = py
            .import("dapple_textures._native")?
            .getattr("_graph_from_description")?;
        let made = serde_json::to_string(&self.made)
            .map_err(|error| Error::new("description", error.to_string()))?;
        Ok((make, (self.points(), made)))
    }

    fn __repr__(&self) -> String {
        let n_edges = self.each_edge().count();
        format!(
            "<graph of {} points and {n_edges} edges>",
            self.points.len()
        )
    }
}

/// Builds a graph from its description.
#[pyfunction]
pub(crate) fn _graph_from_description(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    description: &str,
) -> Result<Graph> {
    let made = serde_json::from_str(description);
    let made = made.map_err(|error| Error::new("description", error.to_string()))?;
    Graph::new(py, Points::read(points, None)?, made)
}

/// Returns the edge direction for the argument `symmetric`.
fn direction(symmetric: bool) -> EdgeDirection {
    if symmetric {
        EdgeDirection::Symmetric
    } else {
        EdgeDirection::Directed
    }
}

/// Builds the Delaunay graph: two points are neighbors if some circle through both has no other point on it or in it
/// ("Sur la sphère vide", 1934).
///
/// `points` are `Points`, or an array (n, 2) in `domain`; by default the domain of an array is the smallest rectangle
/// around it, which does not wrap. Positions are first snapped to a lattice, whose step is between 2**-50 and 2**-49
/// of the larger side of the domain; all decisions are exact for the snapped positions. Points closer than a step may
/// therefore coincide, which is an error of the kind "coincident". Copies of points across axes that wrap are
/// included.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
///
/// Returns
/// -------
/// Graph
///     The graph.
///
/// Raises
/// ------
/// DappleError
///     If two points coincide, or the domain wraps and is too thin relative to the spacing of its points.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> graph = dp.delaunay([[0, 0], [1, 0], [0, 1], [2, 2]])
/// >>> graph.edges().tolist()
/// [[0, 1], [0, 2], [1, 3], [1, 2], [2, 3]]
/// >>> graph.triangles().tolist()
/// [[0, 1, 2], [1, 3, 2]]
#[pyfunction]
#[pyo3(signature = (points, *, domain = None))]
pub(crate) fn delaunay(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    domain: Option<&Domain>,
) -> Result<Graph> {
    Graph::new(py, Points::read(points, domain)?, GraphMade::Delaunay)
}

/// Builds the Gabriel graph: two points are neighbors if the circle whose diameter is the segment between them has no
/// other point on it or in it ("A New Statistical Approach to Geographic Variation Analysis", 1969).
///
/// `points` and `domain` are as for `delaunay`.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
///
/// Returns
/// -------
/// Graph
///     The graph.
///
/// Raises
/// ------
/// DappleError
///     If two points coincide, or the domain wraps and is too thin relative to the spacing of its points.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.gabriel([[0, 0], [1, 0], [0.5, 0.25]]).edges().tolist()
/// [[0, 2], [1, 2]]
#[pyfunction]
#[pyo3(signature = (points, *, domain = None))]
pub(crate) fn gabriel(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    domain: Option<&Domain>,
) -> Result<Graph> {
    Graph::new(py, Points::read(points, domain)?, GraphMade::Gabriel)
}

/// Builds the Yao graph: the plane around each point is divided into equal cones, of which the first begins at the x
/// axis, and an edge leads to the nearest point in each cone ("On Constructing Minimum Spanning Trees", 1982).
///
/// `points` and `domain` are as for `delaunay`. `cones` is from 1 to 32; with `symmetric`, every edge exists in both
/// directions.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// cones : int, default 6
///     The number of cones, from 1 to 32.
/// symmetric : bool, default False
///     Whether every edge exists in both directions.
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
///
/// Returns
/// -------
/// Graph
///     The graph.
///
/// Raises
/// ------
/// DappleError
///     If `cones` is out of range, or two points coincide.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.yao([[0.5, 0.5]], domain=dp.Domain(1), cones=4).axes().vectors.tolist()
/// [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
#[pyfunction]
#[pyo3(signature = (points, *, cones = 6, symmetric = false, domain = None))]
pub(crate) fn yao(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    cones: u32,
    symmetric: bool,
    domain: Option<&Domain>,
) -> Result<Graph> {
    let direction = direction(symmetric);
    let made = GraphMade::Yao { cones, direction };
    Graph::new(py, Points::read(points, domain)?, made)
}

/// Builds the graph in which edges lead from each point to its `k` nearest points, 1 to 4096.
///
/// `points` and `domain` are as for `delaunay`; with `symmetric`, every edge exists in both directions.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// k : int
///     The number of neighbors, from 1 to 4096.
/// symmetric : bool, default False
///     Whether every edge exists in both directions.
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
///
/// Returns
/// -------
/// Graph
///     The graph.
///
/// Raises
/// ------
/// DappleError
///     If `k` is 0 or larger than the number of possible neighbors, or two points coincide.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.k_nearest([[0, 0], [1, 0], [3, 0]], 1).edges().tolist()
/// [[0, 1], [1, 0], [2, 1]]
#[pyfunction]
#[pyo3(signature = (points, k, *, symmetric = false, domain = None))]
pub(crate) fn k_nearest(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    k: u32,
    symmetric: bool,
    domain: Option<&Domain>,
) -> Result<Graph> {
    let direction = direction(symmetric);
    let made = GraphMade::KNearest { k, direction };
    Graph::new(py, Points::read(points, domain)?, made)
}
