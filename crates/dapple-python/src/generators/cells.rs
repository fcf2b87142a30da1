//! Worley's cells, in two to four dimensions.

mod features;
mod texture;

use super::{array, periods, unknown_axes};
use crate::arrays::{self, Positions};
use crate::data;
use crate::error::{Error, Result};
use crate::field::Field;
use crate::function::{Function, Made};
use crate::grid::{CELLS, Grid, GridArguments};
use crate::seed::SeedArgument;
use crate::watch;
use dapple::hash::Seed;
use dapple::recipe::WorleyValue;
use dapple::worley::{Dimensions, Metric, Octaves, Scatter, Space, Worley as Basis};
use features::{cell_points, check_count, draw, find, gradients};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use texture::Texture;

/// Description of a cellular field as data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct CellsMade {
    seed: Seed,
    dims: usize,
    value: WorleyValue,
    metric: Metric,
    scatter: Scatter,
    period: Vec<Option<u32>>,
    octaves: Option<Octaves>,
    range: CellsRange,
}

/// The range of values that is mapped to 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum CellsRange {
    /// No range: values are unscaled.
    Plain,
    /// The measured range of the value.
    Normalized,
    /// A range given by the caller.
    Given([f32; 2]),
}

impl CellsMade {
    pub(crate) fn build(&self) -> Result<Function> {
        match self.dims {
            2 => Ok(Function::Plane(self.texture()?.field())),
            3 => Ok(Function::Space(self.texture()?.field())),
            4 => Ok(Function::Time(self.texture()?.field())),
            dims => Err(unknown_axes(dims, "2, 3 or 4")),
        }
    }

    /// Builds the cellular basis from the description, without a combination of distances.
    fn basis<const N: usize>(&self) -> Result<Basis<N>>
    where
        Dimensions: Space<N>,
    {
        let basis = Basis::<N>::new(self.seed)
            .with_metric(self.metric)?
            .with_scatter(self.scatter)?;
        Ok(basis.with_period(array(&self.period)?)?)
    }

    fn texture<const N: usize>(&self) -> Result<Texture<N>>
    where
        Dimensions: Space<N>,
    {
        let basis = self.basis::<N>()?;
        let WorleyValue::Combination(combination) = self.value else {
            let is_edges = self.value == WorleyValue::EdgeDistance;
            if self.octaves.is_some() || self.range != CellsRange::Plain {
                let message = match (is_edges, self.range) {
                    (true, CellsRange::Normalized) => {
                        "the range of `edge_distance` is not measured, so it cannot be normalized: take `remap`"
                    }
                    (true, _) => "`edge_distance` has neither `octaves` nor a `range`",
                    (false, _) => "`cell_value` has neither `octaves` nor a `range`",
                };
                return Err(Error::new("conflict", message));
            }
            if is_edges && self.metric != Metric::Euclidean {
                return Err(Error::new(
                    "conflict",
                    "`edge_distance` is of the Euclidean metric",
                ));
            }
            return Ok(if is_edges {
                Texture::Edges(basis.edge_distances())
            } else {
                Texture::CellValues(basis.cell_values())
            });
        };
        let cellular = basis.combine(combination);
        let Some(octaves) = self.octaves else {
            return Ok(Texture::Cellular(match self.range {
                CellsRange::Plain => cellular,
                CellsRange::Normalized => cellular.normalized()?,
                CellsRange::Given(range) => cellular.with_range(range)?,
            }));
        };
        let fractal = cellular.fractal(octaves)?;
        Ok(Texture::Fractal(match self.range {
            CellsRange::Plain => fractal,
            CellsRange::Normalized => {
                return Err(Error::new(
                    "no_range",
                    "octaves of cells have no measured range; give one as `range`",
                ));
            }
            CellsRange::Given(range) => fractal.with_range(range)?,
        }))
    }
}

/// Worley's cells: a field computed from the distances to the nearest scattered feature points.
///
/// It has all methods of `Field`, and methods that return the feature points.
#[pyclass(extends = Field, frozen, module = "dapple_textures")]
pub(crate) struct Worley {
    made: CellsMade,
}

impl Worley {
    fn with(py: Python<'_>, made: CellsMade) -> Result<Py<Self>> {
        let field = Field::new(Made::Worley(made.clone()))?;
        Ok(Py::new(
            py,
            PyClassInitializer::from(field).add_subclass(Self { made }),
        )?)
    }

    /// Builds the Python field from the description of cells.
    pub(crate) fn from_made(py: Python<'_>, made: CellsMade) -> Result<Py<PyAny>> {
        Ok(Self::with(py, made)?.into_any())
    }
}

/// Creates Worley's cells, after Steven Worley's "A Cellular Texture Basis Function" (1996).
///
/// Positions and distances are in cells. The same seed gives the same bits on every machine.
///
/// Parameters
/// ----------
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
/// dims : int, default 2
///     Number of axes: 2, 3 or 4.
/// value : str or sequence of float, default "f1"
///     "f1" to "f4" (distance to the nearest, second, … feature point), a difference such as "f2_minus_f1",
///     "cell_value" (a random number from 0 to 1 for each cell), "edge_distance" (to the nearest border of a cell),
///     or the four coefficients of F1 to F4.
/// metric : {"euclidean", "manhattan", "chebyshev"} or dict, default "euclidean"
///     "euclidean", "manhattan", "chebyshev", or {"minkowski": 3}.
/// scatter : dict or None, default None
///     {"poisson": {"density": 3}}, as in the paper; {"unclamped": {"density": 3}}; {"jittered": {"jitter": 1}}, one
///     point in each cell.
/// period : int or tuple of int or None, default None
///     The period in cells, after which the field repeats exactly: one number, or one for each axis, x first; None
///     for an axis without a period.
/// octaves : dict or None, default None
///     A fractal sum, {"count": 6, "lacunarity": 2, "gain": 0.5, "seeds": "own"}.
/// range : tuple of float or None, default None
///     The two values that are mapped to 0 and 1.
///
/// Returns
/// -------
/// Worley
///     The cellular field.
///
/// Raises
/// ------
/// DappleError
///     If a name is not one of those above, `dims` is not 2, 3 or 4, or a number is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> cracks = dp.worley(seed=7, value="f2_minus_f1", period=8).normalized()
/// >>> cracks.render(256, extent=8).shape
/// (256, 256)
#[pyfunction]
#[pyo3(signature = (*, seed = SeedArgument::default(), dims = 2, value = None, metric = None, scatter = None, period = None, octaves = None, range = None),
    text_signature = "(*, seed=0, dims=2, value='f1', metric='euclidean', scatter=None, period=None, octaves=None, range=None)")]
#[expect(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn worley(
    py: Python<'_>,
    seed: SeedArgument,
    dims: usize,
    value: Option<&Bound<'_, PyAny>>,
    metric: Option<&Bound<'_, PyAny>>,
    scatter: Option<&Bound<'_, PyAny>>,
    period: Option<&Bound<'_, PyAny>>,
    octaves: Option<&Bound<'_, PyAny>>,
    range: Option<[f32; 2]>,
) -> Result<Py<Worley>> {
    if !(2..=4).contains(&dims) {
        return Err(unknown_axes(dims, "2, 3 or 4"));
    }
    let made = CellsMade {
        seed: seed.0,
        dims,
        value: data::options_or("value", value, WorleyValue::default())?,
        metric: data::options_or("metric", metric, Metric::default())?,
        scatter: data::options_or("scatter", scatter, Scatter::default())?,
        period: periods(period, dims)?,
        octaves: data::options_or("octaves", octaves, None)?,
        range: range.map_or(CellsRange::Plain, CellsRange::Given),
    };
    Worley::with(py, made)
}

/// Calls a function with the number of axes and the number of feature points as const generics.
macro_rules! with_counts {
    ($dims:expr, $count:expr, $call:ident($($argument:expr),*)) => {
        match ($dims, $count) {
            (2, 1) => $call::<2, 1>($($argument),*),
            (2, 2) => $call::<2, 2>($($argument),*),
            (2, 3) => $call::<2, 3>($($argument),*),
            (2, _) => $call::<2, 4>($($argument),*),
            (3, 1) => $call::<3, 1>($($argument),*),
            (3, 2) => $call::<3, 2>($($argument),*),
            (3, 3) => $call::<3, 3>($($argument),*),
            (3, _) => $call::<3, 4>($($argument),*),
            (_, 1) => $call::<4, 1>($($argument),*),
            (_, 2) => $call::<4, 2>($($argument),*),
            (_, 3) => $call::<4, 3>($($argument),*),
            _ => $call::<4, 4>($($argument),*),
        }
    };
}

#[pymethods]
impl Worley {
    /// Normalizes the values to about 0 to 1, based on their measured range. Cell values are returned unchanged; edge
    /// distances have no measured range.
    ///
    /// Returns
    /// -------
    /// Worley
    ///     The normalized field.
    fn normalized(&self, py: Python<'_>) -> Result<Py<Self>> {
        // Cell values already range from 0 to 1.
        if self.made.value == WorleyValue::CellValue {
            return Self::with(py, self.made.clone());
        }
        if self.made.range != CellsRange::Plain {
            return Err(Error::new("no_range", "the range was set before"));
        }
        Self::with(
            py,
            CellsMade {
                range: CellsRange::Normalized,
                ..self.made.clone()
            },
        )
    }

    /// Finds the feature points nearest to each position, nearest first.
    ///
    /// `positions` has shape (…, dims), x first, in cells; `count` is from 1 to 4. The result has `distance` (…,
    /// count), float32, measured in cells with the field's metric; `vector` (…, count, dims), float64, from the
    /// feature point to the position; and `id` (…, count), uint64, the id of each point.
    ///
    /// Parameters
    /// ----------
    /// positions : array_like
    ///     Positions of shape (…, axes), x first.
    /// count : int, default 1
    ///     The number of feature points per position, from 1 to 4.
    ///
    /// Returns
    /// -------
    /// Features
    ///     The feature points.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the last axis of `positions` does not have length `dims`, or `count` is out of range.
    #[pyo3(signature = (positions, *, count = 1))]
    fn features<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
        count: usize,
    ) -> Result<Bound<'py, PyAny>> {
        check_count(count)?;
        let positions = Positions::read(positions, self.made.dims)?;
        let (made, numbers) = (self.made.clone(), positions.numbers);
        let found = watch::run(py, None, move |_, stop| {
            with_counts!(made.dims, count, find(&made, &numbers, stop))
        })??;
        let shape = [&positions.shape[..], &[count]].concat();
        let vectors = [&shape[..], &[self.made.dims]].concat();
        let arrays = (
            arrays::array(py, found.distance, &shape)?,
            arrays::array(py, found.vector, &vectors)?,
            arrays::array(py, found.id, &shape)?,
        );
        arrays::features(py, arrays)
    }

    /// Finds the feature points nearest to each pixel of an array; the results equal those of `features`, bit for
    /// bit.
    ///
    /// `outputs` names the arrays to compute; the others are None. For `count` points their shapes are (count, rows,
    /// columns) and, for vectors, (count, rows, columns, dims), float32. Fields with more than two axes are sliced at
    /// the remaining coordinates `at`.
    ///
    /// Parameters
    /// ----------
    /// size : int or tuple of int
    ///     (rows, columns), or one number for both.
    /// count : int, default 1
    ///     The number of feature points per pixel.
    /// outputs : sequence of {"distance", "vector", "id"}, optional
    ///     The arrays to compute.
    /// extent : float or tuple of float or None, default None
    ///     The size of the rendered rectangle, x first, as in `Field.render`.
    /// origin : float or tuple of float or None, default None
    ///     The corner of the first pixel, x first, as in `Field.render`.
    /// window : tuple of slice or None, default None
    ///     The part to compute, one slice per axis of `size`.
    /// samples : str, default "centers"
    ///     The sample positions, "centers" or "corners", as in `Field.render`.
    /// at : sequence of float or None, default None
    ///     The coordinates along the axes after the first two; 0 by default.
    ///
    /// Returns
    /// -------
    /// Features
    ///     The feature points.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `count`, `size`, `extent`, `origin` or `window` is out of range.
    #[pyo3(signature = (size, *, count = 1, outputs = None, extent = None, origin = None, window = None, samples = None, at = None),
        text_signature = "(self, size, *, count=1, outputs=('distance', 'vector', 'id'), extent=None, origin=None, window=None, samples='centers', at=None)")]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn render_features<'py>(
        &self,
        py: Python<'py>,
        size: &Bound<'py, PyAny>,
        count: usize,
        outputs: Option<Vec<String>>,
        extent: Option<&Bound<'py, PyAny>>,
        origin: Option<&Bound<'py, PyAny>>,
        window: Option<&Bound<'py, PyAny>>,
        samples: Option<&str>,
        at: Option<Vec<f64>>,
    ) -> Result<Bound<'py, PyAny>> {
        check_count(count)?;
        let dims = self.made.dims;
        let period: Vec<_> = self.made.period[..2]
            .iter()
            .map(|cells| cells.map(f64::from))
            .collect();
        let grid = Grid::new(
            &GridArguments {
                size,
                extent,
                origin,
                window,
                samples,
            },
            &period,
            &[CELLS; 2],
        )?;
        let rest = at.unwrap_or_else(|| vec![0.0; dims - 2]);
        if rest.len() != dims - 2 {
            let message = format!(
                "`at` has {} numbers, but {} are needed",
                rest.len(),
                dims - 2
            );
            return Err(Error::new("count", message));
        }
        let names = outputs.unwrap_or_else(|| OUTPUTS.map(str::to_owned).to_vec());
        if let Some(name) = names.iter().find(|name| !OUTPUTS.contains(&name.as_str())) {
            return Err(data::unknown_name("output", name, &OUTPUTS));
        }
        let wanted = OUTPUTS.map(|output| names.iter().any(|name| name == output));
        let shape = [&[count][..], &grid.shape()].concat();
        grid.n_values()?;
        let made = self.made.clone();
        let drawn = watch::run(py, None, move |_, stop| {
            with_counts!(dims, count, draw(&made, &grid, &rest, wanted, stop))
        })??;
        let vectors = [&shape[..], &[dims]].concat();
        let arrays = (
            drawn
                .distance
                .map(|values| arrays::array(py, values, &shape))
                .transpose()?,
            drawn
                .vector
                .map(|values| arrays::array(py, values, &vectors))
                .transpose()?,
            drawn
                .id
                .map(|values| arrays::array(py, values, &shape))
                .transpose()?,
        );
        arrays::features(py, arrays)
    }

    /// Computes the gradients of the value at positions of shape (…, dims), per cell: float64 of the same shape.
    ///
    /// The gradient is discontinuous at the borders between cells. Cell values and edge distances have no gradient.
    ///
    /// Parameters
    /// ----------
    /// positions : array_like
    ///     Positions of shape (…, axes), x first.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float64
    ///     The gradients, with the shape of `positions`.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the last axis of `positions` does not have length `dims`, or the value has no gradient.
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyAny>> {
        let positions = Positions::read(positions, self.made.dims)?;
        let (made, numbers) = (self.made.clone(), positions.numbers);
        let gradients = watch::run(py, None, move |_, stop| match made.dims {
            2 => gradients::<2>(&made, &numbers, stop),
            3 => gradients::<3>(&made, &numbers, stop),
            _ => gradients::<4>(&made, &numbers, stop),
        })??;
        let shape = [&positions.shape[..], &[self.made.dims]].concat();
        arrays::array(py, gradients, &shape)
    }

    /// Returns the feature points of a cell as (positions, ids): float64 of shape (n, dims), in cells, and uint64.
    ///
    /// Parameters
    /// ----------
    /// cell : sequence of int
    ///     The indices of the cell, x first.
    ///
    /// Returns
    /// -------
    /// tuple of (numpy.ndarray of float64, numpy.ndarray of uint64)
    ///     The positions, (n, dims), in cells, and the ids, (n,).
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `cell` does not have `dims` integers.
    fn cell_points<'py>(
        &self,
        py: Python<'py>,
        cell: Vec<i64>,
    ) -> Result<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (positions, ids) = match self.made.dims {
            2 => cell_points::<2>(&self.made, &cell),
            3 => cell_points::<3>(&self.made, &cell),
            _ => cell_points::<4>(&self.made, &cell),
        }?;
        let shape = [ids.len(), self.made.dims];
        Ok((
            arrays::array(py, positions, &shape)?,
            ids.into_pyarray(py).into_any(),
        ))
    }
}

/// Names of the arrays that `render_features` can compute.
const OUTPUTS: [&str; 3] = ["distance", "vector", "id"];
