//! Generators of fields from a seed: Worley's cells, gradient noise, wavelet noise.

mod cells;
mod gradient;
mod wavelet;

pub(crate) use cells::{CellsMade, Worley, worley};
pub(crate) use gradient::{GradientMade, gradient_noise};
pub(crate) use wavelet::{WaveletMade, wavelet_noise};

use crate::error::{Error, Result};
use crate::grid::per_axis;
use pyo3::prelude::*;

/// Reads the period along each axis, in cells: one for all axes, or one for each axis. `None` means no period.
fn periods(data: Option<&Bound<'_, PyAny>>, n_axes: usize) -> Result<Vec<Option<u32>>> {
    let Some(data) = data else {
        return Ok(vec![None; n_axes]);
    };
    per_axis(data, n_axes).ok_or_else(|| {
        let message = format!(
            "the period is {data:?}, but it must be a whole number of cells, or {n_axes} numbers or None, x first"
        );
        Error::new("period", message)
    })
}

/// Returns the error for an unsupported number of axes.
fn unknown_axes(dims: usize, known: &str) -> Error {
    Error::new(
        "axes",
        format!("the number of axes is {dims}, but it must be {known}"),
    )
}

/// Converts numbers to an array of length `N`; fails for any other length.
fn array<T: Copy, const N: usize>(numbers: &[T]) -> Result<[T; N]> {
    numbers.try_into().map_err(|_| {
        Error::new(
            "count",
            format!("there are {} numbers, but {N} are needed", numbers.len()),
        )
    })
}
