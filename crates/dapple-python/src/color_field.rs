//! Fields with several values at each position, such as colors.

use crate::arrays::{self, Positions};
use crate::error::Result;
use crate::field::{FIRST, Field};
use crate::function::{Made, Reduced};
use crate::grid::{Grid, GridArguments, default_extent};
use crate::pups::{Values, Vectors};
use crate::threads;
use crate::watch;
use dapple::raster::glam::DVec2;
use dapple::raster::parallel;
use pyo3::prelude::*;
use std::sync::Arc;

/// A function of the plane with several values at every position, such as a color (linear RGB).
///
/// Color fields are created by `pups` with values of shape (n, channels), and by `color_noise`. A color field is
/// defined by its description: it can be pickled, compared and used as a dictionary key.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct ColorField {
    made: Made,
    vectors: Arc<dyn Vectors>,
}

/// Number of positions that a thread processes at a time.
const CHUNK: usize = 1024;

/// Builds a Python field from its description: a `ColorField` if it has channels, otherwise a `Field`.
pub(crate) fn object(py: Python<'_>, made: Made) -> Result<Py<PyAny>> {
    let (made, vectors) = threads::run(py, move || {
        let vectors = made.vectors();
        (made, vectors)
    })?;
    Ok(match vectors? {
        Some(vectors) => Py::new(py, ColorField { made, vectors })?.into_any(),
        None => Py::new(py, Field::new(made)?)?.into_any(),
    })
}

#[pymethods]
impl ColorField {
    /// The number of axes: 2.
    #[getter]
    fn ndim(&self) -> usize {
        2
    }

    /// The number of values at each position.
    #[getter]
    fn channels(&self) -> usize {
        self.vectors.n_channels()
    }

    /// The period along each axis, x first; None for an axis along which the field does not repeat.
    #[getter]
    fn period(&self) -> Vec<Option<f64>> {
        self.vectors.period().to_vec()
    }

    /// The extent used when an image is rendered without one.
    fn _default_extent(&self) -> Vec<f64> {
        default_extent(&self.vectors.period(), &[1.0; 2])
    }

    /// Renders the field to an array: float32 of shape (rows, columns, channels).
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
    /// out : numpy.ndarray of float32 or None, default None
    ///     Memory for the values, an array in C order; a new one by default.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32
    ///     The colors, (rows, columns, channels).
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `size`, `extent`, `origin` or `window` is out of range or has a different number of axes, or `out` has
    ///     a different shape.
    #[pyo3(signature = (size, *, extent = None, origin = None, window = None, samples = None, out = None),
        text_signature = "(self, size, *, extent=None, origin=None, window=None, samples='centers', out=None)")]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn render<'py>(
        &self,
        py: Python<'py>,
        size: &Bound<'py, PyAny>,
        extent: Option<&Bound<'py, PyAny>>,
        origin: Option<&Bound<'py, PyAny>>,
        window: Option<&Bound<'py, PyAny>>,
        samples: Option<&str>,
        out: Option<Bound<'py, PyAny>>,
    ) -> Result<Bound<'py, PyAny>> {
        let arguments = GridArguments {
            size,
            extent,
            origin,
            window,
            samples,
        };
        let grid = Grid::new(&arguments, &self.vectors.period(), &[1.0; 2])?;
        grid.n_values()?;
        let n_channels = self.vectors.n_channels();
        let shape = [&grid.shape()[..], &[n_channels]].concat();
        let window = grid.plane();
        let width = window.size[0] as usize;
        let row = width * n_channels;
        let first = FIRST / row.max(1);
        arrays::filled(py, &shape, out, |values, stop| {
            watch::in_parts(stop, window.size[1] as usize, first, |rows| {
                let size = [window.size[0], rows.len() as u32];
                let part = window.crop([0, rows.start as i64], size)?;
                let values = &mut values[rows.start * row..rows.end * row];
                Ok(self.vectors.render(&part, values)?)
            })?;
            for copies in grid.copies() {
                let mut part = vec![0.0; copies.window.n_pixels() * n_channels];
                self.vectors.render(&copies.window, &mut part)?;
                copies.write(&part, values, width, n_channels);
            }
            Ok(())
        })
    }

    /// Evaluates the field at positions of shape (…, 2), x first: float32 of shape (…, channels).
    ///
    /// Parameters
    /// ----------
    /// positions : array_like
    ///     Positions of shape (…, axes), x first.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32
    ///     The colors, of shape (…, channels).
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the last axis of `positions` does not have length 2.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyAny>> {
        let positions = Positions::read(positions, 2)?;
        let n_channels = self.vectors.n_channels();
        let shape = [&positions.shape[..], &[n_channels]].concat();
        let count = positions.numbers.len() / 2;
        arrays::filled(py, &shape, None, |values, stop| {
            watch::in_parts(stop, count, FIRST, |part| {
                let numbers = &positions.numbers[part.start * 2..];
                let values = &mut values[part.start * n_channels..part.end * n_channels];
                parallel::for_each_chunk(values, CHUNK * n_channels, |chunk, values| {
                    let places = numbers[chunk * CHUNK * 2..].chunks_exact(2);
                    for (vector, place) in values.chunks_exact_mut(n_channels).zip(places) {
                        self.vectors.sample(DVec2::from_slice(place), vector);
                    }
                });
                Ok(())
            })
        })
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| other.get().made == self.made)
    }

    fn __hash__(&self) -> Result<u64> {
        self.made.hash()
    }

    fn __reduce__(&self, py: Python<'_>) -> Result<Reduced> {
        self.made.reduced(py)
    }

    /// A token that identifies the field in Dask; it is the same in all processes.
    fn __dask_tokenize__(&self) -> Result<String> {
        self.made.token()
    }

    fn __repr__(&self) -> Result<String> {
        Ok(format!("ColorField({})", self.made.summary()?))
    }
}

impl Made {
    /// Builds the function if the description has several values at each position; `None` if it has one.
    fn vectors(&self) -> Result<Option<Arc<dyn Vectors>>> {
        let values = match self {
            Self::Pups(made) => made.get()?,
            Self::Texture(made) => made.get()?,
            _ => return Ok(None),
        };
        Ok(match values {
            Values::Vectors(vectors) => Some(vectors),
            Values::Numbers(_) => None,
        })
    }
}
