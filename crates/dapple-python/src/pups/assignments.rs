//! Assigns values, labels and orientations to control points.

use crate::arrays;
use crate::error::Result;
use crate::points::{Domain, Graph, Points, varying};
use crate::seed::SeedArgument;
use crate::threads;
use dapple::pups::ReferenceImage;
use dapple::raster::glam::{DVec2, DVec3};
use pyo3::prelude::*;

/// Converts labels to an integer array.
fn labels<'py>(py: Python<'py>, labels: &[u32]) -> Result<Bound<'py, PyAny>> {
    let labels: Vec<i64> = labels.iter().copied().map(i64::from).collect();
    let shape = [labels.len()];
    arrays::array(py, labels, &shape)
}

/// Converts vectors to an array of shape (n, 3).
fn vectors<'py>(py: Python<'py>, vectors: Vec<DVec3>) -> Result<Bound<'py, PyAny>> {
    let shape = [vectors.len(), 3];
    let numbers: Vec<[f64; 3]> = vectors
        .into_iter()
        .map(|vector| vector.to_array())
        .collect();
    arrays::array(py, numbers.into_flattened(), &shape)
}

/// Draws independent random values in [0, 1), float32 of shape (count,); the named textures use the same values.
///
/// Parameters
/// ----------
/// count : int
///     The number of values.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The values, (count,).
///
/// Raises
/// ------
/// DappleError
///     If the seed is not from 0 to 2**64 - 1.
/// OverflowError
///     If `count` is negative.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.random_values(3, seed=7).shape
/// (3,)
#[pyfunction]
#[pyo3(signature = (count, *, seed = SeedArgument::default()), text_signature = "(count, *, seed=0)")]
pub(crate) fn random_values(
    py: Python<'_>,
    count: usize,
    seed: SeedArgument,
) -> Result<Bound<'_, PyAny>> {
    check_count(count)?;
    arrays::array(py, dapple::pups::random_values(count, seed.0), &[count])
}

/// Draws independent random labels from 0 to `n_labels` - 1, all equally probable, int64 of shape (count,).
///
/// Parameters
/// ----------
/// count : int
///     The number of points to label.
/// n_labels : int
///     The number of labels.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// numpy.ndarray of int64
///     The labels, (count,).
///
/// Raises
/// ------
/// DappleError
///     If `n_labels` is 0, or the seed is not from 0 to 2**64 - 1.
/// OverflowError
///     If `count` is negative.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> int(dp.random_labels(100, 4, seed=7).max())
/// 3
#[pyfunction]
#[pyo3(signature = (count, n_labels, *, seed = SeedArgument::default()), text_signature = "(count, n_labels, *, seed=0)")]
pub(crate) fn random_labels(
    py: Python<'_>,
    count: usize,
    n_labels: u32,
    seed: SeedArgument,
) -> Result<Bound<'_, PyAny>> {
    check_count(count)?;
    labels(py, &dapple::pups::random_labels(count, n_labels, seed.0)?)
}

/// Checks that `count` does not exceed the maximum number of points in a set.
fn check_count(count: usize) -> Result<()> {
    if count <= 1 << 31 {
        return Ok(());
    }
    let message = format!("the count is {count}, but it must be at most 2^31");
    Err(crate::error::Error::new("too_many", message))
}

/// Draws random labels 0 and 1, int64 of shape (n,); the probability of label 1 may depend on the position.
///
/// `probability` is a number from 0 to 1, a ramp, an array over the domain, or a `Field`, as in `poisson_disk`.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// probability : float, dict, Field or array_like
///     The probability of label 1, which may vary over the domain.
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// numpy.ndarray of int64
///     The labels, (n,).
///
/// Raises
/// ------
/// DappleError
///     If a probability is not from 0 to 1.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> points = dp.white_noise(dp.Domain(1), 1000)
/// >>> ramp = {"ramp": {"from": [0, 0], "to": [1, 0], "start": 0, "end": 1}}
/// >>> white = dp.biased_labels(points, ramp, seed=2)
/// >>> bool(white[points[:, 0] > 0.5].mean() > 0.7)
/// True
#[pyfunction]
#[pyo3(signature = (points, probability, *, domain = None, seed = SeedArgument::default()),
    text_signature = "(points, probability, *, domain=None, seed=0)")]
pub(crate) fn biased_labels<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    probability: &Bound<'py, PyAny>,
    domain: Option<&Domain>,
    seed: SeedArgument,
) -> Result<Bound<'py, PyAny>> {
    let points = Points::read(points, domain)?;
    let probability = varying("probability", probability, points.domain())?;
    let found = threads::run(py, move || {
        dapple::pups::biased_labels(&points, &probability, seed.0)
    })??;
    labels(py, &found)
}

/// Assigns labels to groups of points connected by a graph, int64 of shape (n,), from 0 without gaps.
///
/// A group has from `sizes[0]` to `sizes[1]` points, 1 to 16, or fewer if that is impossible.
///
/// Parameters
/// ----------
/// graph : Graph
///     A graph of the points.
/// sizes : tuple of int, default (3, 4)
///     The minimum and the maximum number of points in a group.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// numpy.ndarray of int64
///     The labels, (n,).
///
/// Raises
/// ------
/// DappleError
///     If the sizes are not from 1 to 16, or the first is above the second.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> graph = dp.delaunay(dp.poisson_disk(dp.Domain(1), distance=0.1))
/// >>> labels = dp.grouped_labels(graph, (3, 4), seed=2)
#[pyfunction]
#[pyo3(signature = (graph, sizes = [3, 4], *, seed = SeedArgument::default()), text_signature = "(graph, sizes=(3, 4), *, seed=0)")]
pub(crate) fn grouped_labels<'py>(
    py: Python<'py>,
    graph: &Graph,
    sizes: [u32; 2],
    seed: SeedArgument,
) -> Result<Bound<'py, PyAny>> {
    let graph = graph.graph();
    let found = threads::run(py, move || {
        dapple::pups::grouped_labels(&graph, sizes, seed.0)
    })??;
    labels(py, &found)
}

/// Draws random labels 0 and 1 from a gray image, int64 of shape (n,); the probability of label 1 is the value of the
/// pixel at the point.
///
/// `image` has shape (rows, columns) and values from 0 to 1; it covers the domain of the points.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// image : array_like
///     The probabilities, (rows, columns), from 0 to 1.
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// numpy.ndarray of int64
///     The labels, (n,).
///
/// Raises
/// ------
/// DappleError
///     If an image value is not from 0 to 1.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> points = dp.white_noise(dp.Domain(1), 100)
/// >>> labels = dp.reference_labels(points, [[0.0, 1.0]])
/// >>> bool((labels == (points[:, 0] >= 0.5)).all())
/// True
#[pyfunction]
#[pyo3(signature = (points, image, *, domain = None, seed = SeedArgument::default()),
    text_signature = "(points, image, *, domain=None, seed=0)")]
pub(crate) fn reference_labels<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    image: &Bound<'py, PyAny>,
    domain: Option<&Domain>,
    seed: SeedArgument,
) -> Result<Bound<'py, PyAny>> {
    let points = Points::read(points, domain)?;
    let image = ReferenceImage::new(arrays::raster("image", image)?)?;
    let found = threads::run(py, move || {
        dapple::pups::reference_labels(&points, &image, seed.0)
    })?;
    labels(py, &found)
}

/// Draws independent random unit vectors, uniformly distributed on the sphere: float64 of shape (count, 3).
///
/// Parameters
/// ----------
/// count : int
///     The number of vectors.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// numpy.ndarray of float64
///     The unit vectors, (count, 3).
///
/// Raises
/// ------
/// DappleError
///     If the seed is not from 0 to 2**64 - 1.
/// OverflowError
///     If `count` is negative.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.random_orientations(5, seed=7).shape
/// (5, 3)
#[pyfunction]
#[pyo3(signature = (count, *, seed = SeedArgument::default()), text_signature = "(count, *, seed=0)")]
pub(crate) fn random_orientations(
    py: Python<'_>,
    count: usize,
    seed: SeedArgument,
) -> Result<Bound<'_, PyAny>> {
    check_count(count)?;
    vectors(py, dapple::pups::random_orientations(count, seed.0))
}

/// Returns unit vectors in the plane that point away from a center (x, y), along the shortest path where axes wrap:
/// float64 of shape (n, 3).
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// center : tuple of float
///     The center, (x, y).
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
///
/// Returns
/// -------
/// numpy.ndarray of float64
///     The unit vectors, (n, 3).
///
/// Raises
/// ------
/// DappleError
///     If the center is not finite.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.outward_orientations([[1, 0], [0, 2]], (0, 0))
/// array([[1., 0., 0.],
///        [0., 1., 0.]])
#[pyfunction]
#[pyo3(signature = (points, center, *, domain = None))]
pub(crate) fn outward_orientations<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    center: (f64, f64),
    domain: Option<&Domain>,
) -> Result<Bound<'py, PyAny>> {
    let points = Points::read(points, domain)?;
    vectors(
        py,
        dapple::pups::outward_orientations(&points, DVec2::from(center))?,
    )
}

/// Returns unit vectors in the plane at an angle in radians, from x to y: float64 of shape (n, 3).
///
/// `angle` is a number, a ramp, an array over the domain, or a `Field`, as in `poisson_disk`.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// angle : float, dict, Field or array_like
///     The angle in radians, from x to y.
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
///
/// Returns
/// -------
/// numpy.ndarray of float64
///     The unit vectors, (n, 3).
///
/// Raises
/// ------
/// DappleError
///     If an angle is not finite.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.angle_orientations([[1, 0], [0, 2]], 0.0)
/// array([[1., 0., 0.],
///        [1., 0., 0.]])
#[pyfunction]
#[pyo3(signature = (points, angle, *, domain = None))]
pub(crate) fn angle_orientations<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    angle: &Bound<'py, PyAny>,
    domain: Option<&Domain>,
) -> Result<Bound<'py, PyAny>> {
    let points = Points::read(points, domain)?;
    let angle = varying("angle", angle, points.domain())?;
    vectors(
        py,
        threads::run(py, move || {
            dapple::pups::angle_orientations(&points, &angle)
        })??,
    )
}
