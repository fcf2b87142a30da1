//! Generates point sets.

use super::{Domain, Points, varying};
use crate::data;
use crate::error::{Error, Result};
use crate::seed::SeedArgument;
use crate::threads;
use crate::watch::{self, Stop};
use dapple::hash::Seed;
use dapple::points::{PointSet, PointsError, RSA_DENSITY, VariablePoissonOptions};
use dapple::raster::Varying;
use pyo3::prelude::*;

/// The density of a point set, as a distance or as a number of points.
enum Wanted {
    /// Minimum distance, in units of the domain.
    Distance(Varying),
    /// Approximate number of points, with uniform density.
    Count(u32),
    /// Approximate number of points, with the given relative density.
    CountAfter(Varying, u32),
}

impl Wanted {
    /// Generates the points of a set.
    fn place(
        self,
        domain: dapple::points::Domain,
        options: &VariablePoissonOptions,
        seed: Seed,
        stop: &Stop,
    ) -> core::result::Result<PointSet, PointsError> {
        let is_cancelled = || stop.is_set();
        let distance = match self {
            Self::Distance(Varying::Constant(distance)) => distance.into(),
            Self::Count(count) => dapple::points::poisson_disk_radius(domain, count)?.into(),
            Self::Distance(distance) => distance,
            Self::CountAfter(density, count) => {
                let places = places(&domain, count);
                dapple::points::gentle_radius_for_count(domain, &density, count.into(), places)?
            }
        };
        match distance {
            Varying::Constant(distance) => {
                dapple::points::poisson_disk_cancellable(domain, distance, seed, &is_cancelled)
            }
            distance => dapple::points::variable_poisson_disk_cancellable(
                domain,
                &distance,
                options,
                seed,
                &is_cancelled,
            ),
        }
    }
}

/// Returns the size of the grid on which a density is sampled, in columns and rows: about two samples per mean point
/// spacing, from 64 to 4096.
fn places(domain: &dapple::points::Domain, count: u32) -> [u32; 2] {
    let distance = (RSA_DENSITY * domain.area() / f64::from(count.max(1))).sqrt();
    let along = |side: f64| (2.0 * side / distance).clamp(64.0, 4096.0) as u32;
    [along(domain.size.x), along(domain.size.y)]
}

/// Generates a maximal Poisson-disk set ("blue noise"): random points at least a given distance apart, with no room
/// for another point, after Cook, "Stochastic Sampling in Computer Graphics" (1986).
///
/// Pass `distance`, `density`, `count`, or `count` and `density`. A distance or density may vary with the position:
/// it is a number, {"ramp": {"from": [x, y], "to": [x, y], "start": a, "end": b}}, {"geometric_ramp": …} with equal
/// ratios over equal lengths, an array (rows, columns) that covers the domain, or a `Field`.
///
/// Parameters
/// ----------
/// domain : Domain
///     The domain of the points; distances are measured around axes that wrap.
/// distance : float, dict, Field, array_like or None, default None
///     The minimum distance between two points, above 0. If it varies, its slope must be below 1; a larger slope is
///     the error "too_steep".
/// density : float, dict, Field, array_like or None, default None
///     The number of points per unit area, which corresponds to a distance of sqrt(0.697 / density). With `count` the
///     density is relative, may be 0, and may change as abruptly as in a photograph; points then thin out gradually
///     around dense parts.
/// count : int or None, default None
///     The approximate number of points.
/// rule : {"average", "larger", "smaller"}, default "average"
///     The minimum distance between two points whose own distances differ: "average", "larger" or "smaller" of the
///     two.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// Points
///     The points.
///
/// Raises
/// ------
/// DappleError
///     If the distance is not above 0 and finite, varies by as much as the positions, does not fit twice into an axis
///     that wraps, or needs too many points.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> torus = dp.Domain(1)
/// >>> points = dp.poisson_disk(torus, distance=0.05, seed=3)
/// >>> points.array.shape[1], points.minimum_distance() >= 0.05
/// (2, True)
/// >>> hills = dp.gradient_noise(seed=1, period=4).frequency(4) + 1.0
/// >>> flock = dp.poisson_disk(torus, density=hills, count=500, seed=3)
#[pyfunction]
#[pyo3(signature = (domain, *, distance = None, density = None, count = None, rule = "average", seed = SeedArgument::default()),
    text_signature = "(domain, *, distance=None, density=None, count=None, rule='average', seed=0)")]
#[expect(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn poisson_disk(
    py: Python<'_>,
    domain: &Domain,
    distance: Option<&Bound<'_, PyAny>>,
    density: Option<&Bound<'_, PyAny>>,
    count: Option<u32>,
    rule: &str,
    seed: SeedArgument,
) -> Result<Points> {
    let domain = domain.0;
    let options = VariablePoissonOptions {
        rule: data::named("rule", rule)?,
        ..VariablePoissonOptions::default()
    };
    let read = |what, data: Option<&Bound<'_, PyAny>>| {
        data.map(|data| varying(what, data, &domain)).transpose()
    };
    let wanted = match (
        read("distance", distance)?,
        read("density", density)?,
        count,
    ) {
        (Some(distance), None, None) => Wanted::Distance(distance),
        (None, Some(density), None) => {
            Wanted::Distance(dapple::points::radius_from_density(&density))
        }
        (None, None, Some(count)) => Wanted::Count(count),
        (None, Some(density), Some(count)) => Wanted::CountAfter(density, count),
        _ => {
            let message = "give `distance`, `density`, `count`, or `density` and `count`";
            return Err(Error::new("conflict", message));
        }
    };
    let set = watch::run(py, None, move |_, stop| {
        wanted.place(domain, &options, seed.0, stop)
    })??;
    Ok(Points::new(set))
}

/// Extends given points, which are at least `distance` apart, to a maximal Poisson-disk set.
///
/// `points` are `Points`, or an array (n, 2) in `domain`; by default the domain of an array is the rectangle around
/// it.
///
/// Parameters
/// ----------
/// points : array_like or Points
///     Points, or an array of shape (n, 2).
/// distance : float
///     The minimum distance between two points, in units of the domain.
/// domain : Domain or None, default None
///     The domain of the points; by default that of the `Points`, or the smallest rectangle around an array.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// Points
///     The extended set; it begins with the given points.
///
/// Raises
/// ------
/// DappleError
///     If the distance is not above 0 and finite, or two of the given points are closer than `distance`.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> given = dp.Points([[0.5, 0.5]], dp.Domain(1))
/// >>> dp.extend_poisson_disk(given, 0.1)[0]
/// array([0.5, 0.5])
#[pyfunction]
#[pyo3(signature = (points, distance, *, domain = None, seed = SeedArgument::default()),
    text_signature = "(points, distance, *, domain=None, seed=0)")]
pub(crate) fn extend_poisson_disk(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    distance: f64,
    domain: Option<&Domain>,
    seed: SeedArgument,
) -> Result<Points> {
    let given = Points::read(points, domain)?;
    let set = watch::run(py, None, move |_, stop| {
        let is_cancelled = || stop.is_set();
        dapple::points::extend_poisson_disk_cancellable(&given, distance, seed.0, &is_cancelled)
    })??;
    Ok(Points::new(set))
}

/// Generates maximal Poisson-disk sets for non-increasing distances, coarsest first; each set begins with the points
/// of the previous one.
///
/// To double the number of points, divide the distance by the square root of two.
///
/// Parameters
/// ----------
/// domain : Domain
///     The domain of the points.
/// distances : sequence of float
///     The minimum distances, from the largest to the smallest.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// list of Points
///     The sets, one for each distance.
///
/// Raises
/// ------
/// DappleError
///     If a distance is not above 0 or is larger than the previous one, or a set would have too many points.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> coarse, fine = dp.nested_poisson_disk(dp.Domain(1), [0.2, 0.1])
/// >>> bool((fine[:len(coarse)] == coarse).all())
/// True
#[pyfunction]
#[pyo3(signature = (domain, distances, *, seed = SeedArgument::default()),
    text_signature = "(domain, distances, *, seed=0)")]
pub(crate) fn nested_poisson_disk(
    py: Python<'_>,
    domain: &Domain,
    distances: Vec<f64>,
    seed: SeedArgument,
) -> Result<Vec<Points>> {
    let domain = domain.0;
    let nested = watch::run(py, None, move |_, stop| {
        let is_cancelled = || stop.is_set();
        dapple::points::nested_poisson_disk_cancellable(domain, &distances, seed.0, &is_cancelled)
    })??;
    let levels = (0..nested.lengths().len()).filter_map(|level| nested.level(level));
    Ok(levels.map(Points::new).collect())
}

/// Generates one point in each cell of a grid, row by row.
///
/// Parameters
/// ----------
/// domain : Domain
///     The domain of the points.
/// cells : int or tuple of int
///     Columns and rows, (x, y), or a number for both.
/// jitter : float, default 1.0
///     The range of random displacements, from 0 (cell centers) to 1 (anywhere in the cell).
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// Points
///     The points.
///
/// Raises
/// ------
/// DappleError
///     If `jitter` or the seed is out of range, or there would be too many points.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.jittered_grid(dp.Domain(1), (2, 1), jitter=0).array
/// array([[0.25, 0.5 ],
///        [0.75, 0.5 ]])
#[pyfunction]
#[pyo3(signature = (domain, cells, *, jitter = 1.0, seed = SeedArgument::default()),
    text_signature = "(domain, cells, *, jitter=1.0, seed=0)")]
pub(crate) fn jittered_grid(
    py: Python<'_>,
    domain: &Domain,
    cells: &Bound<'_, PyAny>,
    jitter: f64,
    seed: SeedArgument,
) -> Result<Points> {
    let cells = match cells.extract::<u32>() {
        Ok(cells) => [cells; 2],
        Err(_) => cells.extract()?,
    };
    let domain = domain.0;
    let set = threads::run(py, move || {
        dapple::points::jittered_grid(domain, cells, jitter, seed.0)
    })??;
    Ok(Points::new(set))
}

/// Generates independent random points with uniform density; a smaller count gives the first points of a larger one.
///
/// Parameters
/// ----------
/// domain : Domain
///     The domain of the points.
/// count : int
///     The number of points.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
///
/// Returns
/// -------
/// Points
///     The points.
///
/// Raises
/// ------
/// DappleError
///     If the seed is not from 0 to 2**64 - 1.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> len(dp.white_noise(dp.Domain((2, 1)), 100, seed=7))
/// 100
#[pyfunction]
#[pyo3(signature = (domain, count, *, seed = SeedArgument::default()), text_signature = "(domain, count, *, seed=0)")]
pub(crate) fn white_noise(
    py: Python<'_>,
    domain: &Domain,
    count: u32,
    seed: SeedArgument,
) -> Result<Points> {
    let domain = domain.0;
    let set = threads::run(py, move || {
        dapple::points::white_noise(domain, count, seed.0)
    })??;
    Ok(Points::new(set))
}
