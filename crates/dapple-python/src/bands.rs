//! Spline wavelets: halving, doubling and decomposition of rasters.

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::grid::size;
use crate::maps::per_axis;
use crate::pictures::{Pixels, array_of_planes};
use crate::seed::SeedArgument;
use crate::threads;
use crate::watch;
use dapple::raster::Raster;
use dapple::wavelet::{Bands, Border, SplineFilter, WaveletError, wavelet_tile_cancellable};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Reads the filter options.
fn filter(options: Option<&Bound<'_, PyDict>>) -> Result<SplineFilter> {
    data::options_or(
        "options",
        options.map(|options| options.as_any()),
        SplineFilter::default(),
    )
}

/// Applies `step` to each channel of an image, and returns the results as an array of the same kind.
fn each<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    step: impl Fn(&Raster<f32>) -> core::result::Result<Raster<f32>, WaveletError> + Send + 'static,
) -> Result<Bound<'py, PyAny>> {
    let planes = Pixels::read("image", image)?.planes()?;
    let planes = threads::run(py, move || {
        planes
            .iter()
            .map(step)
            .collect::<core::result::Result<_, _>>()
    })??;
    array_of_planes(py, planes)
}

/// Halves an image to (rows / 2, columns / 2[, channels]): returns the nearest spline at half the resolution.
///
/// Pixels are coefficients of B-splines. The filters are the exact ones of Cook and DeRose (2005).
///
/// Parameters
/// ----------
/// image : array_like
///     (rows, columns) or (rows, columns, channels); the length of a periodic side must be even.
/// borders : {"periodic", "mirror"} or a pair of them, default "periodic"
///     How the image continues past its edges: `"periodic"` or `"mirror"`, or one for each axis, x first.
/// **options : str
///     `degree` (`"constant"`, `"linear"`, `"quadratic"`, `"cubic"`), `phase` (`"centered"`, `"cook_de_rose"`), `fit`
///     (`"function"`, `"coefficients"`).
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The halved image, (rows / 2, columns / 2[, channels]).
///
/// Raises
/// ------
/// DappleError
///     If a side is odd, a pixel is not finite, or `borders` is unknown.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> dp.wavelet_halve(np.ones((4, 6))).tolist()
/// [[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]
#[pyfunction]
#[pyo3(signature = (image, *, borders = None, **options),
    text_signature = "(image, *, borders=\"periodic\", **options)")]
pub(crate) fn wavelet_halve<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    borders: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> Result<Bound<'py, PyAny>> {
    let borders = per_axis("borders", borders, Border::Periodic)?;
    let filter = filter(options)?;
    each(py, image, move |plane| filter.down(plane, borders))
}

/// Doubles an image to (2 rows, 2 columns[, channels]); the result is the same spline at twice the resolution.
///
/// Parameters
/// ----------
/// image : array_like
///     As for `wavelet_halve`. Halving the result restores this image.
/// size : int or tuple of int or None, default None
///     (rows, columns) of the result; needed if a mirrored side of the result has an odd length.
/// borders : {"periodic", "mirror"} or a pair of them, default "periodic"
///     As for `wavelet_halve`.
/// **options : str
///     As for `wavelet_halve`.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The doubled image, (2 rows, 2 columns[, channels]).
///
/// Raises
/// ------
/// DappleError
///     If a pixel is not finite, or `borders` is unknown.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> small = np.random.default_rng(1).random((8, 8), "f4")
/// >>> bool(np.allclose(dp.wavelet_halve(dp.wavelet_double(small)), small, atol=1e-5))
/// True
#[pyfunction]
#[pyo3(signature = (image, size = None, *, borders = None, **options),
    text_signature = "(image, size=None, *, borders=\"periodic\", **options)")]
pub(crate) fn wavelet_double<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    size: Option<&Bound<'py, PyAny>>,
    borders: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> Result<Bound<'py, PyAny>> {
    let borders = per_axis("borders", borders, Border::Periodic)?;
    let (filter, size) = (filter(options)?, size.map(self::size).transpose()?);
    each(py, image, move |plane| {
        let doubled = plane.size().map(|side| side.saturating_mul(2));
        filter.up(plane, size.unwrap_or(doubled), borders)
    })
}

/// Splits an image into bands: the details lost in each halving, finest first, and the coarse remainder.
///
/// Parameters
/// ----------
/// image : array_like
///     As for `wavelet_halve`.
/// levels : int, default 1
///     The number of halvings; the length of a periodic side must be a multiple of 2**levels.
/// borders : {"periodic", "mirror"} or a pair of them, default "periodic"
///     As for `wavelet_halve`.
/// **options : str
///     As for `wavelet_halve`.
///
/// Returns
/// -------
/// Bands
///     `Bands(details, coarse)`, from which `wavelet_synthesize` reconstructs the image.
///
/// Raises
/// ------
/// DappleError
///     If there are too many bands for the side lengths, a pixel is not finite, or `borders` is unknown.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> image = np.random.default_rng(1).random((16, 32, 3), "f4")
/// >>> bands = dp.wavelet_analyze(image, levels=2)
/// >>> [detail.shape for detail in bands.details], bands.coarse.shape
/// ([(16, 32, 3), (8, 16, 3)], (4, 8, 3))
/// >>> bool(np.allclose(dp.wavelet_synthesize(bands), image, atol=1e-6))
/// True
#[pyfunction]
#[pyo3(signature = (image, *, levels = 1, borders = None, **options),
    text_signature = "(image, *, levels=1, borders=\"periodic\", **options)")]
pub(crate) fn wavelet_analyze<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    levels: u32,
    borders: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> Result<Bound<'py, PyAny>> {
    let borders = per_axis("borders", borders, Border::Periodic)?;
    let filter = filter(options)?;
    let planes = Pixels::read("image", image)?.planes()?;
    let bands = threads::run(py, move || {
        let bands = planes
            .iter()
            .map(|plane| filter.analyze(plane, levels, borders));
        bands.collect::<core::result::Result<Vec<_>, _>>()
    })??;
    let mut coarse = Vec::new();
    let mut details = vec![Vec::new(); levels as usize];
    for channel in bands {
        coarse.push(channel.coarse);
        for (band, detail) in details.iter_mut().zip(channel.details) {
            band.push(detail);
        }
    }
    let details = details
        .into_iter()
        .map(|planes| array_of_planes(py, planes));
    let details = details.collect::<Result<Vec<_>>>()?;
    let bands = py.import("dapple_textures._pictures")?.getattr("Bands")?;
    Ok(bands.call1((details, array_of_planes(py, coarse)?))?)
}

/// Reconstructs an image from its bands; `borders` and the options must be the same as for `wavelet_analyze`.
///
/// Parameters
/// ----------
/// bands : tuple of (sequence of array_like, array_like)
///     (details, coarse): a list of images, finest first, and the coarse remainder.
/// borders : {"periodic", "mirror"} or a pair of them, default "periodic"
///     How the image continues past its edges, as for `wavelet_halve`.
/// **options : str
///     As for `wavelet_halve`.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The image, (rows, columns[, channels]).
///
/// Raises
/// ------
/// DappleError
///     If the sizes of the bands are not those that `wavelet_analyze` returns, or `borders` is unknown.
#[pyfunction]
#[pyo3(signature = (bands, *, borders = None, **options),
    text_signature = "(bands, *, borders=\"periodic\", **options)")]
pub(crate) fn wavelet_synthesize<'py>(
    py: Python<'py>,
    bands: &Bound<'py, PyAny>,
    borders: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> Result<Bound<'py, PyAny>> {
    let borders = per_axis("borders", borders, Border::Periodic)?;
    let filter = filter(options)?;
    let (details, coarse): (Vec<Bound<'py, PyAny>>, Bound<'py, PyAny>) = bands.extract()?;
    let mut channels: Vec<Bands> = Pixels::read("coarse", &coarse)?
        .planes()?
        .into_iter()
        .map(|coarse| Bands {
            details: Vec::new(),
            coarse,
        })
        .collect();
    for detail in &details {
        let planes = Pixels::read("details", detail)?.planes()?;
        if planes.len() != channels.len() {
            let message = "the bands have not the same number of channels";
            return Err(Error::new("channels", message));
        }
        for (channel, plane) in channels.iter_mut().zip(planes) {
            channel.details.push(plane);
        }
    }
    let planes = threads::run(py, move || {
        let planes = channels
            .iter()
            .map(|bands| filter.synthesize(bands, borders));
        planes.collect::<core::result::Result<_, _>>()
    })??;
    array_of_planes(py, planes)
}

/// Generates a tile of wavelet noise that repeats without a seam, (rows, columns), from the weights of its bands.
///
/// Each band is noise of one octave, independent of the others (Cook and DeRose 2005). The mean is 0, and the
/// variance is the sum of the squared weights.
///
/// Parameters
/// ----------
/// size : int or tuple of int
///     (rows, columns), or one number for both: multiples of 2**n for n weights.
/// weights : sequence of float, default [1.0]
///     The weights of 1 to 16 bands, finest first. Band b has its power between 2**-b / 4 and 2**-b / 2 cycles per
///     pixel.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The tile, (rows, columns).
///
/// Raises
/// ------
/// DappleError
///     If a side is 0 or not a multiple of 2**n for n weights, or a weight is not finite.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> tile = dp.wavelet_tile((64, 128), [0.25, 0.5, 1.0], seed=7)
/// >>> tile.shape, bool(abs(tile.mean()) < 1e-3)
/// ((64, 128), True)
#[pyfunction]
#[pyo3(signature = (size, weights = vec![1.0], *, seed = SeedArgument::default()),
    text_signature = "(size, weights=[1.0], *, seed=0)")]
pub(crate) fn wavelet_tile<'py>(
    py: Python<'py>,
    size: &Bound<'py, PyAny>,
    weights: Vec<f32>,
    seed: SeedArgument,
) -> Result<Bound<'py, PyAny>> {
    let size = self::size(size)?;
    let tile = watch::run(py, None, move |_, stop| {
        wavelet_tile_cancellable(size, &weights, seed.0, &|| stop.is_set())
    })??;
    arrays::numbers(py, tile)
}
