//! Fields: values at every position.

use crate::arrays::{self, Positions};
use crate::color_field;
use crate::error::{Error, Result};
use crate::function::{Function, Made, Reduced};
use crate::generators::Worley;
use crate::grid::{Grid, GridArguments, default_extent, numbers};
use crate::shared::Shared;
use crate::threads;
use crate::watch::{self, Stop};
use dapple::raster::{FractalShape, PairOperation, RasterViewMut, Window, parallel};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::sync::Arc;

/// A function with a value at every position: of the plane, of space, or of space and time.
///
/// Fields are made by `worley`, `gradient_noise`, `wavelet_noise`, `pups` and others, and can be composed: `a + b`,
/// `a * 0.5`, `a.warp(x, y, 0.1)`. A field is defined by its description: it can be pickled, compared and used as a key,
/// and the same description has the same bits on every machine.
#[pyclass(frozen, subclass, module = "dapple_textures")]
pub(crate) struct Field {
    made: Shared<Made>,
    function: Function,
}

/// Number of positions that a thread takes at a time.
const CHUNK: usize = 4096;

/// Number of values that are computed before the first check for signals.
pub(crate) const FIRST: usize = 1 << 14;

/// Maximum number of columns that are rendered at a time.
const STRIP: u32 = 1 << 17;

impl Field {
    /// Makes the field of a description, on the threads of the package.
    pub(crate) fn new(made: Made) -> Result<Self> {
        let made = Shared::new(made);
        let work = made.clone();
        let built = Python::attach(|py| threads::run(py, move || work.get()))??;
        let function = built.function;
        Ok(Self { made, function })
    }

    /// The function; an error unless it has two axes.
    pub(crate) fn plane(&self) -> Result<Arc<dyn dapple::raster::Field>> {
        self.made.plane()
    }

    /// The periods along all axes.
    fn periods(&self) -> Vec<Option<f64>> {
        self.function.period()
    }

    /// The default extent along each of four axes, for axes without a period.
    fn shown(&self) -> [f64; 4] {
        let shown = self.made.made().shown();
        [shown[0], shown[1], shown[0], shown[0]]
    }

    /// Writes the values at the pixels of a grid. `values` must have the length of the grid.
    fn fill(&self, grid: &Grid, values: &mut [f32], stop: &Stop) -> Result<()> {
        match &self.function {
            Function::Plane(field) => fill_planes(field.as_ref(), grid, values, stop),
            Function::Space(field) => fill_planes(field.as_ref(), grid, values, stop),
            Function::Time(field) => fill_planes(field.as_ref(), grid, values, stop),
        }
    }

    /// Writes the values at some positions.
    fn sample_chunk(&self, positions: &[f64], values: &mut [f32]) {
        // Ignore the result: only unequal lengths are an error, and the lengths are equal.
        let _ = self.function.values(positions, values);
    }

    /// Combines this field and another field or number, value by value.
    fn with(&self, other: Operand, operation: PairOperation, is_first: bool) -> Result<Self> {
        let (this, other) = (self.made.clone(), other.0);
        let (first, second) = if is_first {
            (this, other)
        } else {
            (other, this)
        };
        Self::new(Made::Pair {
            first,
            second,
            operation,
        })
    }

    fn times(&self, number: f32) -> Result<Self> {
        let number = Operand(Shared::new(Made::Constant(number)));
        self.with(number, PairOperation::Multiply, true)
    }

    fn fractal(
        &self,
        octaves: u32,
        gain: f64,
        lacunarity: f64,
        shape: FractalShape,
    ) -> Result<Self> {
        Self::new(Made::Fractal {
            field: self.made.clone(),
            octaves,
            gain,
            lacunarity,
            shape,
        })
    }
}

/// An operand of a binary operation: a field, or a number converted to a constant field.
pub(crate) struct Operand(Shared<Made>);

impl<'py> FromPyObject<'_, 'py> for Operand {
    type Error = PyErr;

    fn extract(other: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(field) = other.cast::<Field>() {
            return Ok(Self(field.get().made.clone()));
        }
        let number = other.extract().map_err(|_| {
            let kind = other.get_type();
            PyTypeError::new_err(format!("a field or a number is needed, not {kind}"))
        })?;
        Ok(Self(Shared::new(Made::Constant(number))))
    }
}

/// Makes the field of a description, as an object of its class.
#[pyfunction]
pub(crate) fn _field_from_description(py: Python<'_>, description: &str) -> Result<Py<PyAny>> {
    let made = serde_json::from_str(description);
    match made.map_err(|error| Error::new("description", error.to_string()))? {
        Made::Worley(made) => Worley::from_made(py, made),
        made => color_field::object(py, made),
    }
}

/// A number as a field.
///
/// Parameters
/// ----------
/// value : float
///     The number.
///
/// Returns
/// -------
/// Field
///     The field. Its value is the same everywhere, and its period 0.
///
/// Raises
/// ------
/// DappleError
///     If the number is not finite.
#[pyfunction]
pub(crate) fn constant(value: f32) -> Result<Field> {
    Field::new(Made::Constant(value))
}

#[pymethods]
impl Field {
    /// The number of axes: 2, 3 or 4.
    #[getter]
    fn ndim(&self) -> usize {
        self.periods().len()
    }

    /// The distances after which the field repeats, x first: None where it does not or where the period is unknown, and
    /// 0 for an axis along which the field is constant.
    #[getter]
    fn period(&self) -> Vec<Option<f64>> {
        self.periods()
    }

    /// The extent of a picture for which none is given.
    fn _default_extent(&self) -> Vec<f64> {
        default_extent(&self.periods(), &self.shown())
    }

    /// The values at the pixels of an array, float32.
    ///
    /// Parameters
    /// ----------
    /// size : int or tuple of int
    ///     (rows, columns), or a number for all axes; (z, rows, columns) of three axes, (w, z, rows, columns) of four.
    /// extent : float or tuple of float or None, default None
    ///     (x, y), the size of the rectangle of the array, in units of the field; one period by default. Where there is
    ///     none, 8 cells of `worley` and `gradient_noise`, and 1 for other fields. (x, y, z) for three axes and (x, y,
    ///     z, w) for four.
    /// origin : float or tuple of float or None, default None
    ///     (x, y) of the corner of the first pixel, with z and w as for `extent`; 0 by default.
    /// window : tuple of slice or None, default None
    ///     The part to compute, such as `np.s_[100:150, 33:94]`, a slice for each axis of `size`: bit for bit the crop
    ///     of the whole. It may lie outside: negative numbers are before the array, and not at its end as in NumPy.
    /// samples : str, default "centers"
    ///     The positions of the samples: "centers" of pixels, or "corners" of a grid that reaches the sides of the extent, as
    ///     in `Plan.bake`. On corners, along an axis whose extent is a whole number of periods, the last index is a copy of
    ///     the first.
    /// out : numpy.ndarray of float32 or None, default None
    ///     Memory for the values, a float32 array in C order; a new array by default.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32
    ///     The values, (rows, columns), with z and w before them for three and four axes. It is `out` if that is given.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `size`, `extent`, `origin` or `window` is out of range or of another number of axes, or `out` has another
    ///     shape.
    /// TypeError
    ///     If `out` is no array of float32.
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
        let grid = Grid::new(
            &GridArguments {
                size,
                extent,
                origin,
                window,
                samples,
            },
            &self.periods(),
            &self.shown(),
        )?;
        grid.n_values()?;
        arrays::filled(py, &grid.shape(), out, |values, stop| {
            self.fill(&grid, values, stop)
        })
    }

    /// The values at positions of the shape (…, ndim), x first: float32 of the shape (…).
    ///
    /// Parameters
    /// ----------
    /// positions : array_like
    ///     Positions of the shape (…, axes), x first.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32
    ///     The values, of the shape of `positions` without its last axis.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the last axis of `positions` does not have the length `ndim`.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyAny>> {
        let n_axes = self.ndim();
        let positions = Positions::read(positions, n_axes)?;
        arrays::filled(py, &positions.shape, None, |values, stop| {
            watch::in_parts(stop, values.len(), CHUNK, |part| {
                let numbers = &positions.numbers[part.start * n_axes..part.end * n_axes];
                parallel::for_each_chunk(&mut values[part], CHUNK, |chunk, values| {
                    let first = chunk * CHUNK * n_axes;
                    let positions = &numbers[first..first + values.len() * n_axes];
                    self.sample_chunk(positions, values);
                });
                Ok(())
            })
        })
    }

    /// The plane of the first two axes at fixed further coordinates: `slice(z)` for three axes, `slice(z, w)` for four.
    ///
    /// Parameters
    /// ----------
    /// *rest : float
    ///     The further coordinates.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field of the plane, of two axes.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the field is of the plane, or the number of coordinates is not that of its further axes.
    #[pyo3(signature = (*rest))]
    fn slice(&self, rest: Vec<f64>) -> Result<Self> {
        Self::new(Made::Slice {
            field: self.made.clone(),
            rest,
        })
    }

    /// This field at positions times a frequency: one number, or one for each axis, x first.
    ///
    /// Parameters
    /// ----------
    /// frequency : float or tuple of float
    ///     One number, or one for each axis, x first.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field, with its periods divided by the frequency.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If a number is not finite, or there is not one for each axis.
    fn frequency(&self, frequency: &Bound<'_, PyAny>) -> Result<Self> {
        let frequency = numbers("frequency", frequency, self.ndim())?;
        Self::new(Made::Frequency {
            field: self.made.clone(),
            frequency,
        })
    }

    /// This field at positions plus an offset, x first.
    ///
    /// Parameters
    /// ----------
    /// offset : float or tuple of float
    ///     One number, or one for each axis, x first.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field, with the same periods.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If a number is not finite, or there is not one for each axis.
    fn offset(&self, offset: &Bound<'_, PyAny>) -> Result<Self> {
        let offset = numbers("offset", offset, self.ndim())?;
        Self::new(Made::Offset {
            field: self.made.clone(),
            offset,
        })
    }

    /// This field at positions rotated by an angle about the origin, in radians, from x to y; about the
    /// further axes in space.
    ///
    /// Parameters
    /// ----------
    /// angle : float
    ///     In radians, from x to y.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field. It has no period along x and y.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the angle is not finite.
    fn rotate(&self, angle: f64) -> Result<Self> {
        Self::new(Made::Rotate {
            field: self.made.clone(),
            angle,
        })
    }

    /// This field at positions moved by `amount` times the values of other fields, one for each axis (domain warping).
    ///
    /// Parameters
    /// ----------
    /// x : Field
    ///     The field of displacements along x.
    /// y : Field
    ///     The field of displacements along y.
    /// amount : float
    ///     The factor of the displacements.
    /// z : Field or None, default None
    ///     The field of displacements along z, of fields with three or four axes; positions keep their z by default.
    /// w : Field or None, default None
    ///     The field of displacements along w, of fields with four axes; positions keep their w by default.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The warped field. It has the largest number of axes of these fields.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `amount` is not finite, if fields of three and of four axes are combined, or if no field has the axis `z`
    ///     or `w` of a displacement.
    ///
    /// Examples
    /// --------
    /// >>> import dapple_textures as dp
    /// >>> smoke, x, y, z = (dp.gradient_noise(seed=seed, dims=3) for seed in range(4))
    /// >>> smoke.warp(x, y, 0.5, z=z).render((4, 64, 64), extent=4).shape
    /// (4, 64, 64)
    #[pyo3(signature = (x, y, amount, *, z = None, w = None))]
    fn warp(
        &self,
        x: &Self,
        y: &Self,
        amount: f64,
        z: Option<PyRef<'_, Self>>,
        w: Option<PyRef<'_, Self>>,
    ) -> Result<Self> {
        let along = |field: Option<&PyRef<'_, Self>>| match field {
            Some(field) => field.made.clone(),
            None => Shared::new(Made::Constant(0.0)),
        };
        let n_further = match (&z, &w) {
            (_, Some(_)) => 2,
            (Some(_), None) => 1,
            (None, None) => 0,
        };
        let further = [z.as_ref(), w.as_ref()].map(along);
        Self::new(Made::Warp {
            field: self.made.clone(),
            x: x.made.clone(),
            y: y.made.clone(),
            amount,
            further: further[..n_further].to_vec(),
        })
    }

    /// This field with the range `old` of its values mapped linearly to the range `new`, also beyond it.
    ///
    /// Parameters
    /// ----------
    /// old : sequence of float
    ///     The range of values that is mapped.
    /// new : sequence of float, optional
    ///     The range that it becomes.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field, with values from `new[0]` to `new[1]` where they were from `old[0]` to `old[1]`.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the length of `old` is 0, or a number is not finite.
    #[pyo3(signature = (old, new = [0.0, 1.0]), text_signature = "(self, old, new=(0.0, 1.0))")]
    fn remap(&self, old: [f32; 2], new: [f32; 2]) -> Result<Self> {
        Self::new(Made::Remap {
            field: self.made.clone(),
            from: old,
            to: new,
        })
    }

    /// This field with values below `low` and above `high` replaced by these.
    ///
    /// Parameters
    /// ----------
    /// low : float, default 0.0
    ///     The lower bound.
    /// high : float, default 1.0
    ///     The upper bound.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field, with values from `low` to `high`.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If a bound is not finite, or `low` is above `high`.
    #[pyo3(signature = (low = 0.0, high = 1.0))]
    fn clamp(&self, low: f32, high: f32) -> Result<Self> {
        Self::new(Made::Clamp {
            field: self.made.clone(),
            bounds: [low, high],
        })
    }

    /// The smaller of this field and another field or number, everywhere.
    ///
    /// Parameters
    /// ----------
    /// other : Field or float
    ///     A field or a number.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field of the smaller values.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If fields of three and of four axes are combined, or the composition nests too deep.
    fn minimum(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Minimum, true)
    }

    /// The larger of this field and another field or number, everywhere.
    ///
    /// Parameters
    /// ----------
    /// other : Field or float
    ///     A field or a number.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field of the larger values.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If fields of three and of four axes are combined, or the composition nests too deep.
    fn maximum(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Maximum, true)
    }

    /// Interpolates from this field, where `by` is 0, to another field or number, where it is 1.
    ///
    /// Parameters
    /// ----------
    /// to : Field or float
    ///     A field or a number.
    /// by : Field or float
    ///     The weight, from 0 to 1: a field or a number.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field `self + (to - self) * by`.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If fields of three and of four axes are combined, or the composition nests too deep.
    fn mix(&self, to: Operand, by: Operand) -> Result<Self> {
        Self::new(Made::Mix {
            from: self.made.clone(),
            to: to.0,
            by: by.0,
        })
    }

    /// Fractional Brownian motion of this field: the sum of octaves, each finer and lower than the one before.
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b have sums from -w * b to w * b, for a gain from 0 to 1.
    ///
    /// Parameters
    /// ----------
    /// octaves : int, default 6
    ///     The number of octaves.
    /// gain : float, default 0.5
    ///     The ratio of the heights of an octave and the one before.
    /// lacunarity : float, default 2.0
    ///     The ratio of the frequencies of an octave and the one before.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The sum, which is not divided by w.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the octaves are not 1 to 32, the gain not from -1 to 1, or the lacunarity not from 1 to 16.
    #[pyo3(signature = (octaves = 6, *, gain = 0.5, lacunarity = 2.0))]
    fn fbm(&self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Self> {
        self.fractal(octaves, gain, lacunarity, FractalShape::Sum)
    }

    /// The sum of octaves of `1 - |value|`: ridges where values cross 0.
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b have sums from w * (1 - b) to w, for a gain from 0 to 1.
    ///
    /// Parameters
    /// ----------
    /// octaves : int, default 6
    ///     The number of octaves.
    /// gain : float, default 0.5
    ///     The ratio of the heights of an octave and the one before.
    /// lacunarity : float, default 2.0
    ///     The ratio of the frequencies of an octave and the one before.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The sum, which is not divided by w.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the octaves are not 1 to 32, the gain not from -1 to 1, or the lacunarity not from 1 to 16.
    #[pyo3(signature = (octaves = 6, *, gain = 0.5, lacunarity = 2.0))]
    fn ridged(&self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Self> {
        self.fractal(octaves, gain, lacunarity, FractalShape::Ridged)
    }

    /// The sum of octaves of `|value|`: creases, and round hills between them (turbulence).
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b have sums from 0 to w * b, for a gain from 0 to 1.
    ///
    /// Parameters
    /// ----------
    /// octaves : int, default 6
    ///     The number of octaves.
    /// gain : float, default 0.5
    ///     The ratio of the heights of an octave and the one before.
    /// lacunarity : float, default 2.0
    ///     The ratio of the frequencies of an octave and the one before.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The sum, which is not divided by w.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the octaves are not 1 to 32, the gain not from -1 to 1, or the lacunarity not from 1 to 16.
    #[pyo3(signature = (octaves = 6, *, gain = 0.5, lacunarity = 2.0))]
    fn billow(&self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Self> {
        self.fractal(octaves, gain, lacunarity, FractalShape::Billow)
    }

    fn __add__(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Add, true)
    }

    fn __radd__(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Add, false)
    }

    fn __sub__(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Subtract, true)
    }

    fn __rsub__(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Subtract, false)
    }

    fn __mul__(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Multiply, true)
    }

    fn __rmul__(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Multiply, false)
    }

    /// This field times `1 / divisor`, rounded to float32.
    fn __truediv__(&self, divisor: f64) -> Result<Self> {
        if divisor == 0.0 || !divisor.is_finite() {
            let message =
                format!("a field is divided by {divisor}, but it must be finite and not 0");
            return Err(Error::new("range", message));
        }
        self.times((1.0 / divisor) as f32)
    }

    fn __neg__(&self) -> Result<Self> {
        self.times(-1.0)
    }

    fn __pos__(field: Py<Self>) -> Py<Self> {
        field
    }

    /// NumPy leaves `array + field` to the field, which raises an error.
    #[classattr]
    fn __array_ufunc__() -> Option<()> {
        None
    }

    fn __abs__(&self) -> Result<Self> {
        Self::new(Made::Absolute(self.made.clone()))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| other.get().made == self.made)
    }

    fn __hash__(&self) -> Result<u64> {
        self.made.made().hash()
    }

    fn __reduce__(&self, py: Python<'_>) -> Result<Reduced> {
        self.made.made().reduced(py)
    }

    /// The token by which Dask identifies results of the field: the same in all processes.
    fn __dask_tokenize__(&self) -> Result<String> {
        self.made.made().token()
    }

    fn __repr__(&self) -> Result<String> {
        Ok(format!("Field({})", self.made.made().summary()?))
    }
}

/// Writes the values at the pixels of a grid, plane by plane.
fn fill_planes<const N: usize>(
    field: &dyn dapple::raster::Field<N>,
    grid: &Grid,
    values: &mut [f32],
    stop: &Stop,
) -> Result<()> {
    let plane = grid.plane();
    let planes = grid.planes();
    let in_space = |window: &Window, rest: &[f64]| -> Window<N> {
        let mut origin = [0.0; N];
        origin[2..].copy_from_slice(rest);
        window.in_space(origin)
    };
    let windows: Vec<_> = planes.iter().map(|rest| in_space(&plane, rest)).collect();
    fill_windows(field, &windows, values, stop)?;
    let width = plane.size[0] as usize;
    for copies in grid.copies() {
        let first = copies.at[1] * width + copies.at[0];
        for (rest, values) in planes.iter().zip(values.chunks_mut(plane.n_pixels())) {
            stop.check()?;
            let view = RasterViewMut::new(&mut values[first..], width, copies.window.size)?;
            field.render(&in_space(&copies.window, rest), view)?;
        }
    }
    Ok(())
}

/// Writes the values at the pixels of several windows of equal size, window by window.
fn fill_windows<const N: usize>(
    field: &dyn dapple::raster::Field<N>,
    windows: &[Window<N>],
    values: &mut [f32],
    stop: &Stop,
) -> Result<()> {
    let Some(window) = windows.first() else {
        return Ok(());
    };
    let n_pixels = window.n_pixels();
    // Render small windows together.
    if windows.len() > 1 && n_pixels <= FIRST {
        return watch::in_parts(stop, windows.len(), FIRST / n_pixels.max(1), |part| {
            let values = &mut values[part.start * n_pixels..part.end * n_pixels];
            let views = values
                .chunks_mut(n_pixels)
                .map(|values| RasterViewMut::new(values, window.size[0] as usize, window.size));
            let views = views.collect::<core::result::Result<_, _>>()?;
            Ok(field.render_stack(&windows[part], views)?)
        });
    }
    // Render large windows in strips of columns, and each strip in parts of some milliseconds.
    let width = window.size[0] as usize;
    for (whole, values) in windows.iter().zip(values.chunks_mut(n_pixels)) {
        for left in (0..window.size[0]).step_by(STRIP as usize) {
            let columns = STRIP.min(window.size[0] - left);
            let first = FIRST / columns as usize;
            watch::in_parts(stop, window.size[1] as usize, first, |rows| {
                let size = [columns, rows.len() as u32];
                let part = whole.crop([left.into(), rows.start as i64], size)?;
                let values = &mut values[rows.start * width + left as usize..];
                Ok(field.render(&part, RasterViewMut::new(values, width, size)?)?)
            })?;
        }
    }
    Ok(())
}
