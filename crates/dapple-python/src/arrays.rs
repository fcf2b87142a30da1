//! Converts to and from NumPy arrays.
//!
//! The library's results become arrays without a copy. Arguments are read in place if they have the type and memory
//! order that the library expects, and are copied otherwise.

use crate::error::{Error, Result};
use crate::watch::{self, Stop};
use dapple::raster::Raster;
use numpy::ndarray::{ArrayD, IxDyn};
use numpy::{
    AllowTypeChange, Element, IntoPyArray, PyArrayDyn, PyArrayLike, PyArrayLikeDyn, PyArrayMethods,
    PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// Loads NumPy and its function tables. Otherwise the first array would load them, and a signal arriving at that
/// point, after long work, would cause a panic.
pub(crate) fn load(py: Python<'_>) -> Result<()> {
    py.import("numpy")?;
    let array = numpy::PyArray1::<f32>::zeros(py, 0, false);
    // Also load the borrow-tracking table, which all packages share.
    drop(array.try_readwrite().map_err(PyErr::from)?);
    Ok(())
}

/// Converts a list of values to an array of the given shape, without a copy.
pub(crate) fn array<'py, T: Element>(
    py: Python<'py>,
    values: Vec<T>,
    shape: &[usize],
) -> Result<Bound<'py, PyAny>> {
    let array = ArrayD::from_shape_vec(IxDyn(shape), values);
    let array = array.map_err(|error| Error::new("shape", error.to_string()))?;
    Ok(array.into_pyarray(py).into_any())
}

/// Returns an array of the given shape. `fill` writes its values, in C order. The array is new, or `out`, which must be
/// float32, of this shape, and in C order.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    shape: &[usize],
    out: Option<Bound<'py, PyAny>>,
    fill: impl FnOnce(&mut [f32], &Stop) -> Result<()> + Send,
) -> Result<Bound<'py, PyAny>> {
    let Some(out) = out else {
        let n_values = shape.iter().product();
        let values = watch::within(py, |stop| {
            let mut values = zeros(n_values)?;
            fill(&mut values, stop)?;
            Ok(values)
        })?;
        return array(py, values, shape);
    };
    let kind = |out: &Bound<'_, PyAny>| match out.cast::<PyUntypedArray>() {
        Ok(array) => format!("an array of {}", array.dtype()),
        Err(_) => out.get_type().to_string(),
    };
    let out = out.cast_into::<PyArrayDyn<f32>>().map_err(|error| {
        let kind = kind(&error.into_inner());
        PyTypeError::new_err(format!(
            "`out` is {kind}, but it must be an array of float32"
        ))
    })?;
    let mut memory = out.try_readwrite().map_err(PyErr::from)?;
    if memory.as_array().shape() != shape {
        let message = format!(
            "`out` has the shape {:?}, but {shape:?} is needed",
            memory.as_array().shape(),
        );
        return Err(Error::new("shape", message));
    }
    let is_ordered = memory.is_c_contiguous();
    let values = memory.as_slice_mut().ok().filter(|_| is_ordered);
    let values =
        values.ok_or_else(|| Error::new("order", "`out` is not in C order without gaps"))?;
    watch::within(py, |stop| fill(values, stop))?;
    drop(memory);
    Ok(out.into_any())
}

/// Allocates `count` zeros. Fails with an error, instead of aborting, if there is not enough memory.
fn zeros(count: usize) -> Result<Vec<f32>> {
    // Try a reservation first, which can fail without aborting. Neither it nor the zeroed allocation touches the
    // memory pages.
    reserve(&mut Vec::new(), count)?;
    Ok(vec![0.0; count])
}

/// Reserves memory for `count` numbers. Fails with an error, instead of aborting, if there is not enough memory.
pub(crate) fn reserve(values: &mut Vec<f32>, count: usize) -> Result<()> {
    values.try_reserve_exact(count).map_err(|_| {
        let message = format!("there is no memory for {count} numbers");
        Error::new("memory", message)
    })
}

/// Converts a raster of numbers to an array (rows, columns).
pub(crate) fn numbers<'py>(py: Python<'py>, raster: Raster<f32>) -> Result<Bound<'py, PyAny>> {
    let [width, height] = raster.size().map(|side| side as usize);
    array(py, raster.into_pixels(), &[height, width])
}

/// Converts a raster with several numbers per pixel to an array (rows, columns, channels).
pub(crate) fn channels<'py, const N: usize>(
    py: Python<'py>,
    raster: Raster<[f32; N]>,
) -> Result<Bound<'py, PyAny>> {
    let [width, height] = raster.size().map(|side| side as usize);
    array(
        py,
        raster.into_pixels().into_flattened(),
        &[height, width, N],
    )
}

/// Positions read from an array of shape (…, axes).
pub(crate) struct Positions {
    /// Coordinates of all positions, interleaved: x, y and so on of the first position, then of the next one.
    pub(crate) numbers: Vec<f64>,
    /// Shape of the array without its last axis.
    pub(crate) shape: Vec<usize>,
}

impl Positions {
    /// Reads positions from an array or nested lists.
    pub(crate) fn read(positions: &Bound<'_, PyAny>, n_axes: usize) -> Result<Self> {
        let array: PyArrayLikeDyn<'_, f64, AllowTypeChange> = positions.extract()?;
        let array = array.as_array();
        let Some((&last, shape)) = array
            .shape()
            .split_last()
            .filter(|(last, _)| **last == n_axes)
        else {
            let message = format!(
                "positions have the shape {:?}, but the last axis must have {n_axes} numbers, x first",
                array.shape()
            );
            return Err(Error::new("shape", message));
        };
        debug_assert_eq!(last, n_axes, "the last axis holds a position");
        Ok(Self {
            numbers: array.iter().copied().collect(),
            shape: shape.to_vec(),
        })
    }
}

/// Copies a 2-D array (rows, columns) into a raster.
pub(crate) fn raster(what: &str, data: &Bound<'_, PyAny>) -> Result<Raster<f32>> {
    let array: PyArrayLike<'_, f32, numpy::Ix2, AllowTypeChange> = data.extract()?;
    let array = array.as_array();
    let values = array.iter().copied().collect();
    Ok(Raster::from_vec(raster_size(what, array.shape())?, values)?)
}

/// Returns the numbers of columns and rows of an array whose first axes are rows and columns.
pub(crate) fn raster_size(what: &str, shape: &[usize]) -> Result<[u32; 2]> {
    let side = |length: usize| {
        u32::try_from(length).map_err(|_| {
            Error::new(
                "too_large",
                format!("the {what} has a side of {length} pixels"),
            )
        })
    };
    Ok([side(shape[1])?, side(shape[0])?])
}

/// Converts distances, vectors and ids of feature points to Python's `Features`.
pub(crate) fn features<'py>(
    py: Python<'py>,
    arrays: impl pyo3::call::PyCallArgs<'py>,
) -> Result<Bound<'py, PyAny>> {
    Ok(py
        .import("dapple_textures._types")?
        .getattr("Features")?
        .call1(arrays)?)
}

/// Creates an instance of `class`, a named tuple in `dapple_textures._types`.
pub(crate) fn result<'py>(
    py: Python<'py>,
    class: &str,
    parts: impl pyo3::call::PyCallArgs<'py>,
) -> Result<Bound<'py, PyAny>> {
    let class = py.import("dapple_textures._types")?.getattr(class)?;
    Ok(class.call1(parts)?)
}
