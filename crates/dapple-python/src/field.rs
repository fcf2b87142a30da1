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

/// A function with a value at every position of the plane, of space, or of space and time.
///
/// Fields are created by `worley`, `gradient_noise`, `wavelet_noise`, `pups` and other functions, and can be
/// composed: `a + b`, `a * 0.5`, `a.warp(x, y, 0.1)`. A field is defined by its description: it can be pickled,
/// compared and used as a dictionary key. The same description gives the same bits on every machine.
#[pyclass(frozen, subclass, module = "dapple_textures")]
pub(crate) struct Field {
    made: Shared<Made>,
    function: Function,
}

/// Number of positions that a thread processes at a time.
const CHUNK: usize = 4096;

/// Number of values computed before the first check for signals.
pub(crate) const FIRST: usize = 1 << 14;

/// Maximum number of columns rendered at a time.
const STRIP: u32 = 1 << 17;

impl Field {
    /// Builds a field from its description, on the package's threads.
    pub(crate) fn new(made: Made) -> Result<Self> {
        let made = Shared::new(made);
        let work = made.clone();
        let built = Python::attach(|py| threads::run(py, move || work.get()))??;
        let function = built.function;
        Ok(Self { made, function })
    }

    /// Returns the function of the field; an error unless it has two axes.
    pub(crate) fn plane(&self) -> Result<Arc<dyn dapple::raster::Field>> {
        self.made.plane()
    }

    /// Returns the period along each axis; `None` for an axis without a period.
    fn periods(&self) -> Vec<Option<f64>> {
        self.function.period()
    }

    /// Returns the default extent of a rendered image along each of up to four axes. It is used for axes without a
    /// period.
    fn shown(&self) -> [f64; 4] {
        let shown = self.made.made().shown();
        [shown[0], shown[1], shown[0], shown[0]]
    }

    /// Writes the values at the pixels of a grid. `values` must have one element per pixel.
    fn fill(&self, grid: &Grid, values: &mut [f32], stop: &Stop) -> Result<()> {
        match &self.function {
            Function::Plane(field) => fill_planes(field.as_ref(), grid, values, stop),
            Function::Space(field) => fill_planes(field.as_ref(), grid, values, stop),
            Function::Time(field) => fill_planes(field.as_ref(), grid, values, stop),
        }
    }

    /// Writes the values at `positions`, given as interleaved coordinates.
    fn sample_chunk(&self, positions: &[f64], values: &mut [f32]) {
        // Ignore the result: only unequal lengths are an error, and the lengths are equal here.
        let _ = self.function.values(positions, values);
    }

    /// Combines this field with `other`, a field or a number, value by value. `is_first` is true if this field is the
    /// first operand.
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

/// Builds a field from its description, as an object of the matching Python class.
#[pyfunction]
pub(crate) fn _field_from_description(py: Python<'_>, description: &str) -> Result<Py<PyAny>> {
    let made = serde_json::from_str(description);
    match made.map_err(|error| Error::new("description", error.to_string()))? {
        Made::Worley(made) => Worley::from_made(py, made),
        made => color_field::object(py, made),
    }
}

/// Converts a number to a constant field.
///
/// Parameters
/// ----------
/// value : float
///     The number.
///
/// Returns
/// -------
/// Field
///     The field. It has the same value everywhere, and its period is 0.
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

    /// The period along each axis, x first: None if the field does not repeat or the period is unknown, and 0 for an
    /// axis along which the field is constant.
    #[getter]
    fn period(&self) -> Vec<Option<f64>> {
        self.periods()
    }

    /// The extent used when an image is rendered without one.
    fn _default_extent(&self) -> Vec<f64> {
        default_extent(&self.periods(), &self.shown())
    }

    /// Renders the field to an array of float32 values.
    ///
    /// Parameters
    /// ----------
    /// size : int or tuple of int
    ///     (rows, columns), or one number for all axes; (z, rows, columns) for three axes, (w, z, rows, columns) for
    ///     four.
    /// extent : float or tuple of float or None, default None
    ///     (x, y), the size of the rendered rectangle, in units of the field; by default one period. For an axis
    ///     without a period, the default is 8 cells for `worley` and `gradient_noise`, and 1 for other fields. (x, y,
    ///     z) for three axes and (x, y, z, w) for four.
    /// origin : float or tuple of float or None, default None
    ///     (x, y) of the first pixel's corner, with z and w as for `extent`; 0 by default.
    /// window : tuple of slice or None, default None
    ///     The part to compute, such as `np.s_[100:150, 33:94]`, with one slice per axis of `size`. The result is bit
    ///     for bit a crop of the whole. The window may extend outside: negative indices are before the array, not at
    ///     its end as in NumPy.
    /// samples : str, default "centers"
    ///     The sample positions: "centers" of pixels, or "corners" of a grid that reaches the sides of the extent, as
    ///     in `Plan.bake`. With corners, if the extent along an axis is a whole number of periods, the last sample is
    ///     a copy of the first.
    /// out : numpy.ndarray of float32 or None, default None
    ///     Memory for the values, a float32 array in C order; a new array by default.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32
    ///     The values, (rows, columns), preceded by z and w for three and four axes. If `out` is given, it is
    ///     returned.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `size`, `extent`, `origin` or `window` is out of range or has a different number of axes, or `out` has
    ///     a different shape.
    /// TypeError
    ///     If `out` is not a float32 array.
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

    /// Evaluates the field at positions of shape (…, ndim), x first: float32 of shape (…).
    ///
    /// Parameters
    /// ----------
    /// positions : array_like
    ///     Positions of shape (…, axes), x first.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32
    ///     The values, with the shape of `positions` without its last axis.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the last axis of `positions` does not have length `ndim`.
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

    /// Returns the 2-D slice along the first two axes at fixed other coordinates: `slice(z)` for three axes,
    /// `slice(z, w)` for four.
    ///
    /// Parameters
    /// ----------
    /// *rest : float
    ///     The coordinates along the axes after the first two.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The 2-D field.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the field has only two axes, or the number of coordinates does not match the remaining axes.
    #[pyo3(signature = (*rest))]
    fn slice(&self, rest: Vec<f64>) -> Result<Self> {
        Self::new(Made::Slice {
            field: self.made.clone(),
            rest,
        })
    }

    /// Multiplies positions by a frequency before evaluating this field: one number, or one for each axis, x first.
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
    ///     If a number is not finite, or the number of values does not match the axes.
    fn frequency(&self, frequency: &Bound<'_, PyAny>) -> Result<Self> {
        let frequency = numbers("frequency", frequency, self.ndim())?;
        Self::new(Made::Frequency {
            field: self.made.clone(),
            frequency,
        })
    }

    /// Adds an offset to positions, x first, before evaluating this field.
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
    ///     If a number is not finite, or the number of values does not match the axes.
    fn offset(&self, offset: &Bound<'_, PyAny>) -> Result<Self> {
        let offset = numbers("offset", offset, self.ndim())?;
        Self::new(Made::Offset {
            field: self.made.clone(),
            offset,
        })
    }

    /// Rotates positions about the origin by an angle in radians, from x to y, before evaluating this field. Fields
    /// with more axes are rotated in the xy plane.
    ///
    /// Parameters
    /// ----------
    /// angle : float
    ///     The angle in radians, from x to y.
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

    /// Displaces positions by `amount` times the values of other fields, one for each axis (domain warping).
    ///
    /// Parameters
    /// ----------
    /// x : Field
    ///     The field of displacements along x.
    /// y : Field
    ///     The field of displacements along y.
    /// amount : float
    ///     The factor that scales the displacements.
    /// z : Field or None, default None
    ///     The field of displacements along z, for fields with three or four axes; by default z is unchanged.
    /// w : Field or None, default None
    ///     The field of displacements along w, for fields with four axes; by default w is unchanged.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The warped field. It has as many axes as the field with the most axes.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `amount` is not finite, if fields with three and with four axes are combined, or if no field has the
    ///     axis `z` or `w` of a displacement.
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

    /// Maps values linearly from the range `old` to the range `new`; values outside of `old` are extrapolated.
    ///
    /// Parameters
    /// ----------
    /// old : sequence of float
    ///     The range of values to map from.
    /// new : sequence of float, optional
    ///     The range of values to map to.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field, with `old[0]` mapped to `new[0]` and `old[1]` mapped to `new[1]`.
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

    /// Clamps this field's values to the range from `low` to `high`.
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

    /// Returns the minimum of this field and another field or number at every position.
    ///
    /// Parameters
    /// ----------
    /// other : Field or float
    ///     A field or a number.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field of minimum values.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If fields with three and with four axes are combined, or the composition is nested too deeply.
    fn minimum(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Minimum, true)
    }

    /// Returns the maximum of this field and another field or number at every position.
    ///
    /// Parameters
    /// ----------
    /// other : Field or float
    ///     A field or a number.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field of maximum values.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If fields with three and with four axes are combined, or the composition is nested too deeply.
    fn maximum(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Maximum, true)
    }

    /// Interpolates from this field, where `by` is 0, to another field or number, where `by` is 1.
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
    ///     If fields with three and with four axes are combined, or the composition is nested too deeply.
    fn mix(&self, to: Operand, by: Operand) -> Result<Self> {
        Self::new(Made::Mix {
            from: self.made.clone(),
            to: to.0,
            by: by.0,
        })
    }

    /// Computes fractional Brownian motion: the sum of octaves of this field, each finer and lower than the previous
    /// one.
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b give sums from -w * b to w * b, for a gain from 0 to 1.
    ///
    /// Parameters
    /// ----------
    /// octaves : int, default 6
    ///     The number of octaves.
    /// gain : float, default 0.5
    ///     The ratio of an octave's amplitude to the previous one's.
    /// lacunarity : float, default 2.0
    ///     The ratio of an octave's frequency to the previous one's.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The sum; it is not divided by w.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `octaves` is not from 1 to 32, `gain` is not from -1 to 1, or `lacunarity` is not from 1 to 16.
    #[pyo3(signature = (octaves = 6, *, gain = 0.5, lacunarity = 2.0))]
    fn fbm(&self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Self> {
        self.fractal(octaves, gain, lacunarity, FractalShape::Sum)
    }

    /// Sums octaves of `1 - |value|`, which has ridges where values cross 0.
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b give sums from w * (1 - b) to w, for a gain from 0 to 1.
    ///
    /// Parameters
    /// ----------
    /// octaves : int, default 6
    ///     The number of octaves.
    /// gain : float, default 0.5
    ///     The ratio of an octave's amplitude to the previous one's.
    /// lacunarity : float, default 2.0
    ///     The ratio of an octave's frequency to the previous one's.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The sum; it is not divided by w.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `octaves` is not from 1 to 32, `gain` is not from -1 to 1, or `lacunarity` is not from 1 to 16.
    #[pyo3(signature = (octaves = 6, *, gain = 0.5, lacunarity = 2.0))]
    fn ridged(&self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Self> {
        self.fractal(octaves, gain, lacunarity, FractalShape::Ridged)
    }

    /// Sums octaves of `|value|`, which has creases with round hills between them (turbulence).
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b give sums from 0 to w * b, for a gain from 0 to 1.
    ///
    /// Parameters
    /// ----------
    /// octaves : int, default 6
    ///     The number of octaves.
    /// gain : float, default 0.5
    ///     The ratio of an octave's amplitude to the previous one's.
    /// lacunarity : float, default 2.0
    ///     The ratio of an octave's frequency to the previous one's.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The sum; it is not divided by w.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `octaves` is not from 1 to 32, `gain` is not from -1 to 1, or `lacunarity` is not from 1 to 16.
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

    /// Multiplies this field by `1 / divisor`, rounded to float32.
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

    /// Set to None so that NumPy passes `array + field` to the field, which raises an error.
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

    /// A token that identifies the field in Dask; it is the same in all processes.
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

/// Writes the values at the pixels of several windows of the same size, window by window.
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
    // Render large windows in strips of columns, and each strip in parts that take some milliseconds.
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
