//! Groups of lines that are transformed together, and their conversion from and to planes.

use crate::error::map_cancellable;
use crate::{IsCancelled, TileError};

/// Number of complex lines that are transformed together. They fill vector registers, and lines of a few thousand
/// elements stay in the second-level cache.
pub(crate) const LANES: usize = 8;

/// Number of real lines in [`LANES`] complex lines.
pub(crate) const BAND: usize = 2 * LANES;

/// The elements of [`BAND`] real lines at one index. Line `l` below [`LANES`] and line `LANES + l` are the real and the
/// imaginary part of one complex line.
pub(crate) type Element = [f64; BAND];

/// Multiplies all complex lines by a complex factor.
pub(crate) fn times(element: &Element, [re, im]: [f64; 2]) -> Element {
    let mut product = [0.0; BAND];
    for lane in 0..LANES {
        product[lane] = element[lane] * re - element[LANES + lane] * im;
        product[LANES + lane] = element[lane] * im + element[LANES + lane] * re;
    }
    product
}

/// Returns [`BAND`] columns of a plane, starting at `first`, with zeros beyond the last column.
pub(crate) fn columns(plane: &[f64], width: usize, first: usize) -> Vec<Element> {
    let n_columns = BAND.min(width - first);
    let element = |row: &[f64]| {
        let mut element = [0.0; BAND];
        element[..n_columns].copy_from_slice(&row[first..first + n_columns]);
        element
    };
    plane.chunks_exact(width).map(element).collect()
}

/// Applies a function to the columns of a plane, [`BAND`] at a time, and returns the result transposed.
///
/// `change` must treat the real and the imaginary parts as separate lines, like every linear map with real
/// coefficients.
pub(crate) fn map_columns(
    plane: &[f64],
    width: usize,
    is_cancelled: &IsCancelled,
    change: impl Fn(Vec<Element>) -> Vec<Element> + Sync,
) -> Result<Vec<f64>, TileError> {
    par_flat_map(width.div_ceil(BAND), is_cancelled, |band| {
        let first = band * BAND;
        let elements = change(columns(plane, width, first));
        let line = |line| elements.iter().map(move |element: &Element| element[line]);
        (0..BAND.min(width - first)).flat_map(line).collect()
    })
}

/// Concatenates the results of `make` for the indices below `count`, like [`map_cancellable`]. With the feature `rayon`,
/// they are computed in parallel.
pub(crate) fn par_flat_map<T: Copy + Send>(
    count: usize,
    is_cancelled: &IsCancelled,
    make: impl Fn(usize) -> Vec<T> + Sync,
) -> Result<Vec<T>, TileError> {
    Ok(map_cancellable(count, is_cancelled, make)?.concat())
}
