//! Pixel grids of arrays: size, extent, sample positions, and the window to compute.

use crate::data::named;
use crate::error::{Error, Result};
use dapple::raster::{Window, glam::DVec2};
use dapple::recipe::Samples;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use pyo3::types::{PySlice, PyTuple};

/// Pixel grid of an array with two to four axes. The axes are in the order of position coordinates: x first.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    axes: Vec<Axis>,
}

/// Pixel grid along one axis: the center of pixel `i` is at `origin + (first + i + ½) · pixel`. For samples at corners,
/// `origin` is half a pixel less than the caller's origin.
#[derive(Clone, Copy, Debug)]
struct Axis {
    origin: f64,
    pixel: f64,
    whole: u32,
    first: i64,
    size: u32,
    /// Index of the corner that duplicates corner 0, if any.
    copy: Option<i64>,
}

/// Pixels of an array that duplicate other pixels: the last column or row of a tile that is sampled at corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Copies {
    /// The pixels that are duplicated.
    pub(crate) window: Window,
    /// Column and row of the array to which they are copied.
    pub(crate) at: [usize; 2],
}

/// The arguments of a grid as the caller passes them: sizes and windows in NumPy's order (the last axis is x),
/// extents and origins in the order of position coordinates (x first).
pub(crate) struct GridArguments<'a, 'py> {
    pub(crate) size: &'a Bound<'py, PyAny>,
    pub(crate) extent: Option<&'a Bound<'py, PyAny>>,
    pub(crate) origin: Option<&'a Bound<'py, PyAny>>,
    pub(crate) window: Option<&'a Bound<'py, PyAny>>,
    pub(crate) samples: Option<&'a str>,
}

impl Grid {
    /// Builds the grid from the arguments and from the field's periods. The default extent is [`default_extent`].
    pub(crate) fn new(
        arguments: &GridArguments<'_, '_>,
        period: &[Option<f64>],
        shown: &[f64],
    ) -> Result<Self> {
        let n_axes = period.len();
        let sizes = sizes(arguments.size, n_axes)?;
        let samples = samples(arguments.samples)?;
        let extents = match arguments.extent {
            None => default_extent(period, shown),
            Some(extent) => numbers("extent", extent, n_axes)?,
        };
        let origins = match arguments.origin {
            None => vec![0.0; n_axes],
            Some(origin) => numbers("origin", origin, n_axes)?,
        };
        let mut axes = Vec::with_capacity(n_axes);
        for axis in 0..n_axes {
            let (origin, extent) = (origins[axis], extents[axis]);
            if !origin.is_finite() || !extent.is_finite() || extent == 0.0 {
                let message = format!(
                    "the origin is {origin} and the extent {extent} along an axis, but they must be finite, and the extent not 0"
                );
                return Err(Error::new("not_finite", message));
            }
            let whole = sizes[n_axes - 1 - axis];
            axes.push(match samples {
                Samples::Corners => Axis::on_corners(origin, extent, whole, period[axis])?,
                _ => Axis::on_centers(origin, extent, whole),
            });
        }
        if let Some(window) = arguments.window {
            let parts = slices(window, n_axes)?;
            for (axis, part) in axes.iter_mut().rev().zip(parts) {
                (axis.first, axis.size) = crop(&part, axis.whole)?;
            }
        }
        Ok(Self { axes })
    }

    /// Returns the shape of the array, x last.
    pub(crate) fn shape(&self) -> Vec<usize> {
        self.axes
            .iter()
            .rev()
            .map(|axis| axis.size as usize)
            .collect()
    }

    /// Returns the number of values; an error if there are too many.
    pub(crate) fn n_values(&self) -> Result<usize> {
        let sizes = self.axes.iter().map(|axis| axis.size as usize);
        let count = sizes.clone().try_fold(1_usize, usize::checked_mul);
        // Stay far below 2^63 bytes, the limit for NumPy arrays. Memory runs out earlier.
        count.filter(|&count| count <= 1 << 40).ok_or_else(|| {
            let message = format!("an array of shape {:?} has too many values", self.shape());
            Error::new("too_large", message)
        })
    }

    /// Returns the window of pixels along the first two axes.
    pub(crate) fn plane(&self) -> Window {
        let [x, y] = [self.axes[0], self.axes[1]];
        Window {
            origin: [x.origin, y.origin],
            pixel: [x.pixel, y.pixel],
            first: [x.first, y.first],
            size: [x.size, y.size],
            scale: [1.0; 2],
        }
    }

    /// Returns the copies to write over the pixels of each [`plane`](Self::plane), in this order: the last column,
    /// the last row and the last pixel of a tile sampled at corners, which have the same bits as the first ones.
    pub(crate) fn copies(&self) -> Vec<Copies> {
        let plane = self.plane();
        let [column, row] = [0, 1].map(|axis| self.axes[axis].copied());
        let mut copies = Vec::new();
        for (at_column, at_row) in [(column, None), (None, row), (column, row)] {
            let mut part = Copies {
                window: plane,
                at: [0; 2],
            };
            for (axis, at) in [at_column, at_row].into_iter().enumerate() {
                if let Some(at) = at {
                    (part.window.first[axis], part.window.size[axis]) = (0, 1);
                    part.at[axis] = at;
                }
            }
            if part.window.size != plane.size || part.window.first != plane.first {
                copies.push(part);
            }
        }
        copies
    }

    /// Returns the coordinates of each plane along the axes after the first two. Planes are in the order of the array.
    pub(crate) fn planes(&self) -> Vec<Vec<f64>> {
        let mut planes = vec![Vec::new()];
        for axis in &self.axes[2..] {
            let centers: Vec<f64> = (0..axis.size).map(|index| axis.center(index)).collect();
            // The last coordinate of positions corresponds to the first axis of the array, which varies slowest.
            let all = centers.iter().flat_map(|&center| {
                planes
                    .iter()
                    .map(move |plane| [plane.as_slice(), &[center]].concat())
            });
            planes = all.collect();
        }
        planes
    }
}

impl Copies {
    /// Writes these pixels to an array with rows of `width` pixels and `n_channels` values per pixel.
    pub(crate) fn write<T: Copy>(
        &self,
        part: &[T],
        values: &mut [T],
        width: usize,
        n_channels: usize,
    ) {
        let row = self.window.size[0] as usize * n_channels;
        for (index, part) in part.chunks_exact(row).enumerate() {
            let first = ((self.at[1] + index) * width + self.at[0]) * n_channels;
            values[first..first + row].copy_from_slice(part);
        }
    }
}

impl Axis {
    fn on_centers(origin: f64, extent: f64, whole: u32) -> Self {
        Self {
            origin,
            pixel: extent / f64::from(whole),
            whole,
            first: 0,
            size: whole,
            copy: None,
        }
    }

    /// Returns an axis with samples at corners, from one side of the extent to the other. The last corner is a copy
    /// of the first one if the extent is a whole number of periods.
    fn on_corners(origin: f64, extent: f64, whole: u32, period: Option<f64>) -> Result<Self> {
        if whole < 2 {
            let message =
                format!("the number of corners along a side is {whole}, but it must be at least 2");
            return Err(Error::new("range", message));
        }
        let spaces = whole - 1;
        let pixel = extent / f64::from(spaces);
        let repeats =
            period.is_some_and(|period| period == 0.0 || (extent / period).fract() == 0.0);
        Ok(Self {
            // Shift by half a pixel, so that pixel centers become corners. For an origin of 0, the first corner is
            // exact.
            origin: origin - 0.5 * pixel,
            pixel,
            whole,
            first: 0,
            size: whole,
            copy: repeats.then(|| spaces.into()),
        })
    }

    /// Returns the index, within the computed window, of the corner that duplicates corner 0; `None` if it is outside.
    fn copied(&self) -> Option<usize> {
        let at = usize::try_from(self.copy? - self.first).ok()?;
        (at < self.size as usize).then_some(at)
    }

    /// Returns the center of a pixel, computed with the same operations as in [`Window`].
    fn center(&self, index: u32) -> f64 {
        let index = self.first + i64::from(index);
        let index = if self.copy == Some(index) { 0 } else { index };
        self.origin + (index as f64 + 0.5) * self.pixel
    }
}

/// Returns the sample positions called `name`; pixel centers by default.
pub(crate) fn samples(name: Option<&str>) -> Result<Samples> {
    name.map_or(Ok(Samples::default()), |name| named("samples", name))
}

/// Number of cells rendered by default along an axis without a period.
pub(crate) const CELLS: f64 = 8.0;

/// Returns the default extent: one period along each axis, or the value in `shown` for an axis without a period.
pub(crate) fn default_extent(period: &[Option<f64>], shown: &[f64]) -> Vec<f64> {
    let axes = period.iter().zip(shown);
    axes.map(|(period, &shown)| period.filter(|&period| period > 0.0).unwrap_or(shown))
        .collect()
}

/// Reads one value for all axes, or one value for each axis; `None` for other data.
pub(crate) fn per_axis<'py, T>(data: &Bound<'py, PyAny>, n_axes: usize) -> Option<Vec<T>>
where
    T: Clone + FromPyObjectOwned<'py>,
{
    if let Ok(value) = data.extract() {
        return Some(vec![value; n_axes]);
    }
    let values = data.try_iter().ok()?;
    let values: Option<Vec<T>> = values.map(|value| value.ok()?.extract().ok()).collect();
    values.filter(|values| values.len() == n_axes)
}

/// Reads pixel counts, each at least 1: one for all axes, or one for each axis.
pub(crate) fn sizes(size: &Bound<'_, PyAny>, n_axes: usize) -> Result<Vec<u32>> {
    let sizes = per_axis(size, n_axes).filter(|sizes| !sizes.contains(&0));
    sizes.ok_or_else(|| {
        let message = format!(
            "the size is {size:?}, but it must be a whole number of at least 1, or {n_axes} numbers, rows before columns"
        );
        Error::new("size", message)
    })
}

/// Reads the size of a 2-D array, and returns columns and rows.
pub(crate) fn size(size: &Bound<'_, PyAny>) -> Result<[u32; 2]> {
    let sizes = sizes(size, 2)?;
    Ok([sizes[1], sizes[0]])
}

/// Reads one number for all axes, or one for each axis.
pub(crate) fn numbers(what: &str, data: &Bound<'_, PyAny>, n_axes: usize) -> Result<Vec<f64>> {
    per_axis(data, n_axes).ok_or_else(|| {
        let message = format!(
            "the {what} is {data:?}, but it must be a number, or {n_axes} numbers, x first"
        );
        Error::new("count", message)
    })
}

/// Reads one number for both axes of the plane, or one for each axis.
pub(crate) fn pair(what: &str, data: &Bound<'_, PyAny>) -> Result<DVec2> {
    Ok(DVec2::from_slice(&numbers(what, data, 2)?))
}

/// Returns the slices of a window, starting with the first axis of the array.
fn slices<'py>(window: &Bound<'py, PyAny>, n_axes: usize) -> Result<Vec<Bound<'py, PySlice>>> {
    let parts = window.cast::<PyTuple>().ok().and_then(|parts| {
        let parts = parts.iter().map(|part| part.cast_into::<PySlice>());
        parts.collect::<core::result::Result<Vec<_>, _>>().ok()
    });
    let parts = parts.filter(|parts| parts.len() == n_axes);
    parts.ok_or_else(|| {
        let message = format!(
            "the window is {window:?}, but it must be {n_axes} slices, as in `np.s_[100:150, 33:94]`"
        );
        Error::new("window", message)
    })
}

/// Returns the first pixel and the number of pixels of a slice, which may begin before the array and end after it.
fn crop(part: &Bound<'_, PySlice>, whole: u32) -> Result<(i64, u32)> {
    let bound = |name: &str, default: i64| -> Result<i64> {
        let bound = part.getattr(name)?;
        Ok(if bound.is_none() {
            default
        } else {
            bound.extract()?
        })
    };
    let (start, stop, step) = (
        bound("start", 0)?,
        bound("stop", whole.into())?,
        bound("step", 1)?,
    );
    let size = stop
        .checked_sub(start)
        .and_then(|size| u32::try_from(size).ok());
    match size {
        Some(size) if size > 0 && step == 1 => Ok((start, size)),
        _ => {
            let message = format!(
                "the window goes from {start} to {stop} in steps of {step}, but it must hold at least one pixel and go in steps of 1"
            );
            Err(Error::new("window", message))
        }
    }
}
