//! Fields: values at every position.

use crate::arrays::{self, Positions};
use crate::color_field;
use crate::error::{Error, Result};
use crate::function::{Function, Made, Reduced, position};
use crate::generators::Worley;
use crate::grid::{Grid, GridArguments, pair};
use crate::shared::Shared;
use crate::threads;
use dapple::raster::{Field as _, FractalShape, PairOperation, RasterViewMut, parallel};
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

/// The number of positions that a thread takes at a time.
const CHUNK: usize = 4096;

impl Field {
    /// Makes the field of a description, on the threads of the package.
    pub(crate) fn new(made: Made) -> Result<Self> {
        let made = Shared::new(made);
        let function = Python::attach(|py| threads::run(py, || made.get()))??.function;
        Ok(Self { made, function })
    }

    /// The function, if it is one of the plane.
    pub(crate) fn plane(&self) -> Result<Arc<dyn dapple::raster::Field>> {
        self.made.plane()
    }

    /// The periods along all axes.
    fn periods(&self) -> Vec<Option<f64>> {
        match &self.function {
            Function::Plane(field) => field.period().to_vec(),
            Function::Space(volume) => volume.period(),
        }
    }

    /// Writes the values at the pixels of a grid into memory of the right length.
    fn fill(&self, grid: &Grid, values: &mut [f32]) -> Result<()> {
        let window = grid.plane();
        match &self.function {
            Function::Plane(field) => {
                field.render(
                    &window,
                    RasterViewMut::new(values, window.size[0] as usize, window.size)?,
                )?;
            }
            Function::Space(volume) => volume.render(&window, &grid.planes(), values)?,
        }
        Ok(())
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

/// A field, or a number as a field.
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

    /// The values at the pixels of an array, float32.
    ///
    /// Parameters
    /// ----------
    /// size : (rows, columns), or a number for all axes; (z, rows, columns) of three axes, (w, z, rows, columns) of four.
    /// extent : (x, y), the size of the rectangle of the array, in units of the field; one period by default, and 1
    ///     where there is none. (x, y, z) for three axes and (x, y, z, w) for four.
    /// origin : (x, y) of the corner of the first pixel, with z and w as for `extent`; 0 by default.
    /// window : the part to compute, such as `np.s_[100:150, 33:94]`, a slice for each axis of `size`: bit for bit the
    ///     crop of the whole. It may lie outside: negative numbers are before the array, and not at its end as in
    ///     NumPy.
    /// out : memory for the values, a float32 array in C order; a new array by default.
    #[pyo3(signature = (size, *, extent = None, origin = None, window = None, out = None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        size: &Bound<'py, PyAny>,
        extent: Option<&Bound<'py, PyAny>>,
        origin: Option<&Bound<'py, PyAny>>,
        window: Option<&Bound<'py, PyAny>>,
        out: Option<Bound<'py, PyAny>>,
    ) -> Result<Bound<'py, PyAny>> {
        let grid = Grid::new(
            &GridArguments {
                size,
                extent,
                origin,
                window,
            },
            &self.periods(),
        )?;
        grid.n_values()?;
        arrays::filled(py, &grid.shape(), out, |values| self.fill(&grid, values))
    }

    /// The values at positions of the shape (…, ndim), x first: float32 of the shape (…).
    fn sample<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyAny>> {
        let n_axes = self.ndim();
        let positions = Positions::read(positions, n_axes)?;
        arrays::filled(py, &positions.shape, None, |values| {
            parallel::for_each_chunk(values, CHUNK, |chunk, values| {
                let places = positions.numbers[chunk * CHUNK * n_axes..].chunks_exact(n_axes);
                match &self.function {
                    Function::Plane(field) => {
                        let places: Vec<_> = places.take(values.len()).map(position).collect();
                        // The lengths are equal, and there are no other errors.
                        let _ = field.sample_many(&places, values);
                    }
                    Function::Space(volume) => {
                        for (value, place) in values.iter_mut().zip(places) {
                            *value = volume.sample(place);
                        }
                    }
                }
            });
            Ok(())
        })
    }

    /// The plane of the first two axes at fixed further coordinates: `slice(z)` for three axes, `slice(z, w)` for four.
    #[pyo3(signature = (*rest))]
    fn slice(&self, rest: Vec<f64>) -> Result<Self> {
        Self::new(Made::Slice {
            field: self.made.clone(),
            rest,
        })
    }

    /// This field at positions times a frequency: one number, or (x, y).
    fn frequency(&self, frequency: &Bound<'_, PyAny>) -> Result<Self> {
        let frequency = pair("frequency", frequency)?.to_array();
        Self::new(Made::Frequency {
            field: self.made.clone(),
            frequency,
        })
    }

    /// This field at positions plus an offset (x, y).
    fn offset(&self, offset: &Bound<'_, PyAny>) -> Result<Self> {
        let offset = pair("offset", offset)?.to_array();
        Self::new(Made::Offset {
            field: self.made.clone(),
            offset,
        })
    }

    /// This field at positions rotated by an angle about the origin, in radians, from x to y.
    fn rotate(&self, angle: f64) -> Result<Self> {
        Self::new(Made::Rotate {
            field: self.made.clone(),
            angle,
        })
    }

    /// This field at positions moved by `amount` times the values of the fields `x` and `y` (domain warping).
    fn warp(&self, x: &Self, y: &Self, amount: f64) -> Result<Self> {
        Self::new(Made::Warp {
            field: self.made.clone(),
            x: x.made.clone(),
            y: y.made.clone(),
            amount,
        })
    }

    /// This field with the range `old` of its values mapped linearly to the range `new`, also beyond it.
    #[pyo3(signature = (old, new = [0.0, 1.0]), text_signature = "(self, old, new=(0.0, 1.0))")]
    fn remap(&self, old: [f32; 2], new: [f32; 2]) -> Result<Self> {
        Self::new(Made::Remap {
            field: self.made.clone(),
            from: old,
            to: new,
        })
    }

    /// This field with values below `low` and above `high` replaced by these.
    #[pyo3(signature = (low = 0.0, high = 1.0))]
    fn clamp(&self, low: f32, high: f32) -> Result<Self> {
        Self::new(Made::Clamp {
            field: self.made.clone(),
            bounds: [low, high],
        })
    }

    /// The smaller of this field and another field or number, everywhere.
    fn minimum(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Minimum, true)
    }

    /// The larger of this field and another field or number, everywhere.
    fn maximum(&self, other: Operand) -> Result<Self> {
        self.with(other, PairOperation::Maximum, true)
    }

    /// Interpolates from this field, where `by` is 0, to another field or number, where it is 1.
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
    #[pyo3(signature = (octaves = 6, *, gain = 0.5, lacunarity = 2.0))]
    fn fbm(&self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Self> {
        self.fractal(octaves, gain, lacunarity, FractalShape::Sum)
    }

    /// The sum of octaves of `1 - |value|`: ridges where values cross 0.
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b have sums from w * (1 - b) to w, for a gain from 0 to 1.
    #[pyo3(signature = (octaves = 6, *, gain = 0.5, lacunarity = 2.0))]
    fn ridged(&self, octaves: u32, gain: f64, lacunarity: f64) -> Result<Self> {
        self.fractal(octaves, gain, lacunarity, FractalShape::Ridged)
    }

    /// The sum of octaves of `|value|`: creases, and round hills between them (turbulence).
    ///
    /// With w = 1 + gain + gain**2 + …, values from -b to b have sums from 0 to w * b, for a gain from 0 to 1.
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
