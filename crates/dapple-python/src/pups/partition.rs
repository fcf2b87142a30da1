//! Control points with weights that sum to 1 at every position, and the fields interpolated from their values.

use super::vectors::Values;
use crate::arrays::{self, Positions};
use crate::color_field;
use crate::data;
use crate::error::{Error, Result};
use crate::function::Made;
use crate::grid::{Grid, GridArguments};
use crate::options;
use crate::points::{Domain, Graph, GraphMade, Points};
use crate::seed::SeedArgument;
use crate::shared::{Build, Shared};
use crate::threads;
use crate::watch::Stop;
use dapple::hash::Seed;
use dapple::points::{PointIdx, PointSet};
use dapple::pups::{Orientation, Orientations, Pups, PupsOptions};
use dapple::raster::RasterViewMut;
use dapple::raster::glam::{DVec2, DVec3};
use dapple::raster::parallel;
use numpy::{AllowTypeChange, PyArrayLikeDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use serde::{Deserialize, Serialize};

/// The description of a net of control points as data.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct NetMade {
    domain: dapple::points::Domain,
    points: Vec<DVec2>,
    graph: GraphMade,
    options: PupsOptions,
}

impl Build for NetMade {
    type Built = Pups;

    fn build(&self) -> Result<Pups> {
        let points = PointSet::new(self.domain, self.points.clone())?;
        let options = self.options.clone();
        let stop = Stop::current();
        let is_cancelled = || stop.is_set();
        Ok(match self.graph {
            GraphMade::Delaunay => Pups::delaunay_cancellable(&points, options, &is_cancelled)?,
            graph => {
                let graph = graph.build(&points, &stop)?;
                Pups::new_cancellable(&points, &graph, options, &is_cancelled)?
            }
        })
    }
}

/// The description, as data, of a field interpolated from control-point values.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PupsMade {
    net: Shared<NetMade>,
    values: Vec<f32>,
    /// Number of values per control point; `None` if the values are scalars.
    channels: Option<usize>,
    labels: Option<Vec<u32>>,
}

impl Build for PupsMade {
    type Built = Values;

    fn build(&self) -> Result<Values> {
        Values::new(
            self.net.get()?,
            &self.values,
            self.channels,
            self.labels.as_deref(),
        )
    }
}

/// Control points, with weights that sum to 1 at every position: Caron and Mould, "Partition of Unity Parametrics for
/// Texture Synthesis" (2013).
///
/// The weight of a point falls off along its axes, which are its edges in a graph, and is 0 beyond its neighbors.
/// With values at the points, the weighted mean is a smooth field. With labels, each position takes the label of the
/// point with the largest weight, which gives cells.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array (n, 2) in `domain`.
/// domain : Domain or None, default None
///     The domain of an array of points; by default the smallest rectangle around it, which does not wrap.
/// graph : Graph or None, default None
///     A graph of the points; by default the Delaunay graph.
/// net : Net, dict or None, default None
///     The weights of the control points; by default Net().
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Raises
/// ------
/// DappleError
///     If two points coincide, `weight` is unknown, or a number is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp, numpy as np
/// >>> points = dp.poisson_disk(dp.Domain(1), distance=0.1, seed=3)
/// >>> partition = dp.Partition(points)
/// >>> round(float(partition.weights([0.3, 0.4]).weights.sum()), 6)
/// 1.0
/// >>> land = partition.field(np.random.default_rng(1).random(len(points)))
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct Partition {
    net: Shared<NetMade>,
    pups: Pups,
}

/// Reads the orientation vectors; `seed` is the seed of the net.
fn vectors(
    orientations: Option<Bound<'_, PyAny>>,
    points: &PointSet,
    seed: Seed,
) -> Result<Option<Vec<DVec3>>> {
    let Some(orientations) = orientations else {
        return Ok(None);
    };
    if orientations.is_instance_of::<PyString>() || orientations.is_instance_of::<PyDict>() {
        let orientations: Orientations = data::options("orientations", &orientations)?;
        let seed = seed.child("orientation", 0);
        return Ok(orientations.vectors(points, seed)?);
    }
    let array: PyArrayLikeDyn<'_, f64, AllowTypeChange> = orientations.extract()?;
    let array = array.as_array();
    let axes = match *array.shape() {
        [_, axes @ (2 | 3)] => axes,
        _ => {
            let message = format!(
                "the orientations have the shape {:?}, but they must be rows of 2 or 3 numbers",
                array.shape()
            );
            return Err(Error::new("shape", message));
        }
    };
    let numbers: Vec<f64> = array.iter().copied().collect();
    let vector = |row: &[f64]| DVec3::new(row[0], row[1], row.get(2).copied().unwrap_or(0.0));
    Ok(Some(numbers.chunks_exact(axes).map(vector).collect()))
}

/// Reads control-point values, and the number of values per control point; `None` for scalars.
fn read_values(values: &Bound<'_, PyAny>) -> Result<(Vec<f32>, Option<usize>)> {
    let array: PyArrayLikeDyn<'_, f32, AllowTypeChange> = values.extract()?;
    let array = array.as_array();
    let channels = match *array.shape() {
        [_] => None,
        [_, channels] => Some(channels),
        _ => {
            let message = format!(
                "the values have the shape {:?}, but (n,) or (n, channels) is needed",
                array.shape()
            );
            return Err(Error::new("shape", message));
        }
    };
    Ok((array.iter().copied().collect(), channels))
}

#[pymethods]
impl Partition {
    #[new]
    #[pyo3(signature = (points, *, domain = None, graph = None, net = None, seed = SeedArgument::default()),
        text_signature = "(points, *, domain=None, graph=None, net=None, seed=0)")]
    fn new(
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        domain: Option<&Domain>,
        graph: Option<&Graph>,
        net: Option<&Bound<'_, PyAny>>,
        seed: SeedArgument,
    ) -> Result<Self> {
        let points = Points::read(points, domain)?;
        if graph.is_some_and(|graph| **graph.set() != *points) {
            let message = "the graph is of other points than those that are given";
            return Err(Error::new("different_points", message));
        }
        let options: options::Net<'_> = options::read(py, "Net", "net", net)?;
        let vectors = vectors(options.orientations, &points, seed.0)?;
        let net = Shared::new(NetMade {
            domain: *points.domain(),
            points: points.positions().to_vec(),
            graph: graph.map_or(GraphMade::Delaunay, Graph::made),
            options: PupsOptions {
                axis_scale: options.axis_scale,
                weight: data::options("weight", &options.weight)?,
                orientation: vectors.map(|vectors| Orientation {
                    strength: options.strength,
                    vectors,
                }),
                fade: options.fade,
            },
        });
        let work = net.clone();
        let pups = threads::run(py, move || work.get())??;
        Ok(Self { net, pups })
    }

    /// Returns the field interpolated from the control points' values: a `Field` for values of shape (n,), a
    /// `ColorField` for (n, channels) with 1 to 8 channels.
    ///
    /// With `labels`, an integer for each point, `values` has one entry per label, and every position has the value
    /// of the label of the point with the largest weight: cells with sharp borders. `labels=range(n)` makes each
    /// point a cell.
    ///
    /// Parameters
    /// ----------
    /// values : array_like
    ///     The values, one per point, or one per label if `labels` is given.
    /// labels : sequence of int, numpy.ndarray of int or None, default None
    ///     A label for each point; `values` then has one entry per label.
    ///
    /// Returns
    /// -------
    /// Field or ColorField
    ///     The field; a `ColorField` for values with channels.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the number of values does not match the points, or a value is not finite.
    #[pyo3(signature = (values, *, labels = None))]
    fn field(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        labels: Option<Vec<u32>>,
    ) -> Result<Py<PyAny>> {
        let (values, channels) = read_values(values)?;
        let made = PupsMade {
            net: self.net.clone(),
            values,
            channels,
            labels,
        };
        color_field::object(py, Made::Pups(Shared::new(made)))
    }

    /// Finds the points with nonzero weight at positions of shape (…, 2), and their weights, which sum to 1. For
    /// position i they are `indices[indptr[i]:indptr[i + 1]]` and `weights[…]`, as in `scipy.sparse.csr_array`.
    ///
    /// A point may occur more than once if its copies across axes that wrap have nonzero weights.
    ///
    /// Parameters
    /// ----------
    /// positions : array_like
    ///     Positions of shape (…, axes), x first.
    ///
    /// Returns
    /// -------
    /// Weights
    ///     The weights.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the last axis of `positions` does not have length 2.
    fn weights<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyAny>> {
        let positions = Positions::read(positions, 2)?.numbers;
        let pups = self.pups.clone();
        let rows = threads::run(py, move || {
            parallel::map_at_least(256, positions.len() / 2, |index| {
                pups.weights(DVec2::from_slice(&positions[2 * index..]))
            })
        })?;
        let mut offsets = vec![0_i64];
        let mut end = 0;
        offsets.extend(rows.iter().map(|row| {
            end += row.len() as i64;
            end
        }));
        let all = || rows.iter().flatten();
        let points: Vec<i64> = all().map(|(point, _)| point.0.into()).collect();
        let weights: Vec<f32> = all().map(|&(_, weight)| weight).collect();
        let (n_offsets, n_weights) = (offsets.len(), weights.len());
        let parts = (
            arrays::array(py, offsets, &[n_offsets])?,
            arrays::array(py, points, &[n_weights])?,
            arrays::array(py, weights, &[n_weights])?,
        );
        arrays::result(py, "Weights", parts)
    }

    /// Returns the index of the point with the largest weight at each pixel of an array (rows, columns), uint32:
    /// indexing `labels` with it gives the labels of the pixels.
    ///
    /// The parameters are the same as for `Field.render`.
    ///
    /// Parameters
    /// ----------
    /// size : int or tuple of int
    ///     (rows, columns), or one number for both.
    /// extent : float or tuple of float or None, default None
    ///     The size of the rendered rectangle, x first, as in `Field.render`.
    /// origin : float or tuple of float or None, default None
    ///     The corner of the first pixel, x first, as in `Field.render`.
    /// window : tuple of slice or None, default None
    ///     The part to compute, one slice per axis of `size`.
    /// samples : str, default "centers"
    ///     The sample positions, "centers" or "corners", as in `Field.render`.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of uint32
    ///     The indices of the points, (rows, columns).
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `size`, `extent`, `origin` or `window` is out of range.
    #[pyo3(signature = (size, *, extent = None, origin = None, window = None, samples = None),
        text_signature = "(self, size, *, extent=None, origin=None, window=None, samples='centers')")]
    fn strongest<'py>(
        &self,
        py: Python<'py>,
        size: &Bound<'py, PyAny>,
        extent: Option<&Bound<'py, PyAny>>,
        origin: Option<&Bound<'py, PyAny>>,
        window: Option<&Bound<'py, PyAny>>,
        samples: Option<&str>,
    ) -> Result<Bound<'py, PyAny>> {
        let arguments = GridArguments {
            size,
            extent,
            origin,
            window,
            samples,
        };
        let grid = Grid::new(&arguments, &self.pups.domain().period(), &[1.0; 2])?;
        let (n_values, window) = (grid.n_values()?, grid.plane());
        let (pups, copies) = (self.pups.clone(), grid.copies());
        let points = threads::run(py, move || -> Result<Vec<PointIdx>> {
            let mut points = vec![PointIdx(0); n_values];
            let width = window.size[0] as usize;
            let view = RasterViewMut::new(&mut points, width, window.size)?;
            pups.render_strongest(&window, view)?;
            for copies in copies {
                let first = copies.at[1] * width + copies.at[0];
                let size = copies.window.size;
                let view = RasterViewMut::new(&mut points[first..], width, size)?;
                pups.render_strongest(&copies.window, view)?;
            }
            Ok(points)
        })??;
        let points: Vec<u32> = points.into_iter().map(|point| point.0).collect();
        arrays::array(py, points, &grid.shape())
    }

    fn __len__(&self) -> usize {
        self.pups.n_points()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| other.get().net == self.net)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Result<(Bound<'py, PyAny>, (String,))> {
        let make = py
            .import("dapple_textures._native")?
            .getattr("_partition_from_description")?;
        let description = serde_json::to_string(&self.net);
        let description =
            description.map_err(|error| Error::new("description", error.to_string()))?;
        Ok((make, (description,)))
    }

    fn __repr__(&self) -> String {
        format!("<partition of {} points>", self.pups.n_points())
    }
}

/// Builds a partition from its description.
#[pyfunction]
pub(crate) fn _partition_from_description(py: Python<'_>, description: &str) -> Result<Partition> {
    let net: core::result::Result<Shared<NetMade>, _> = serde_json::from_str(description);
    let net = net.map_err(|error| Error::new("description", error.to_string()))?;
    let work = net.clone();
    let pups = threads::run(py, move || work.get())??;
    Ok(Partition { net, pups })
}

/// Creates a field interpolated from values at control points: smooth, exact at the points, and repeating where their
/// domain wraps; Caron and Mould, "Partition of Unity Parametrics for Texture Synthesis" (2013).
///
/// It equals `Partition(points, …).field(values, labels=labels)`, with the same parameters.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// values : array_like
///     The values, one per point, or one per label if `labels` is given.
/// labels : sequence of int, numpy.ndarray of int or None, default None
///     A label for each point; `values` then has one entry per label.
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
/// graph : Graph or None, default None
///     A graph of the points; by default the Delaunay graph.
/// net : Net, dict or None, default None
///     The weights of the control points; by default Net().
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// Field or ColorField
///     The field; a `ColorField` for values with channels.
///
/// Raises
/// ------
/// DappleError
///     If the number of values does not match the points, a value is not finite, two points coincide, or an option is
///     out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp, numpy as np
/// >>> points = dp.poisson_disk(dp.Domain(1), distance=0.1, seed=3)
/// >>> land = dp.pups(points, np.random.default_rng(1).random(len(points)))
/// >>> land.render((64, 64)).shape, land.period
/// ((64, 64), [1.0, 1.0])
/// >>> palette = np.array([[0.8, 0.2, 0.1], [0.1, 0.3, 0.6]])
/// >>> labels = dp.random_labels(len(points), 2, seed=5)
/// >>> dp.pups(points, palette[labels]).render(64).shape
/// (64, 64, 3)
/// >>> cells = dp.pups(points, palette, labels=labels)
#[pyfunction]
#[pyo3(signature = (points, values, *, labels = None, domain = None, graph = None, net = None, seed = SeedArgument::default()),
    text_signature = "(points, values, *, labels=None, domain=None, graph=None, net=None, seed=0)")]
#[expect(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn pups(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    values: &Bound<'_, PyAny>,
    labels: Option<Vec<u32>>,
    domain: Option<&Domain>,
    graph: Option<&Graph>,
    net: Option<&Bound<'_, PyAny>>,
    seed: SeedArgument,
) -> Result<Py<PyAny>> {
    Partition::new(py, points, domain, graph, net, seed)?.field(py, values, labels)
}
