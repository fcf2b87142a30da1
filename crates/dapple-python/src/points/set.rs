//! Sets of points, and their statistics.

use super::Domain;
use crate::arrays::{self, Positions};
use crate::error::{Error, Result};
use crate::threads;
use crate::watch;
use dapple::points::PointSet;
use dapple::raster::glam::DVec2;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyList};
use std::sync::Arc;

/// Points in a domain, in a fixed order: an array of shape (n, 2) with the periods of its domain.
///
/// NumPy treats it as its array, as in `np.asarray(points)` or `scipy.spatial.KDTree(points)`; `np.array(points)` is
/// a writable copy. Two sets are equal if all of their points and their domains are equal; like arrays, they cannot
/// be dictionary keys.
///
/// Parameters
/// ----------
/// array : array_like
///     Positions of shape (n, 2), x first. Along axes that wrap they are wrapped into the domain.
/// domain : Domain or None, default None
///     The domain of the points; by default the smallest rectangle around them, which does not wrap.
///
/// Raises
/// ------
/// DappleError
///     If the positions do not have shape (n, 2), or one is outside the domain.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> points = dp.Points([[0.25, 1.5], [0.5, 0.5]], dp.Domain(1))
/// >>> points.array
/// array([[0.25, 0.5 ],
///        [0.5 , 0.5 ]])
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct Points {
    set: Arc<PointSet>,
    array: PyOnceLock<Py<PyAny>>,
}

/// Maximum magnitude of coordinates for which the corners of a rectangle around the points stay finite.
const FARTHEST: f64 = 1e299;

impl Points {
    pub(crate) fn new(set: PointSet) -> Self {
        Self {
            set: Arc::new(set),
            array: PyOnceLock::new(),
        }
    }

    /// Returns a Python point set that shares `set`.
    pub(crate) fn shared_with(set: &Arc<PointSet>) -> Self {
        Self {
            set: Arc::clone(set),
            array: PyOnceLock::new(),
        }
    }

    /// Returns the shared point set.
    pub(crate) fn set(&self) -> Arc<PointSet> {
        Arc::clone(&self.set)
    }

    /// Reads points from Python: a set, or an array with or without a domain.
    pub(crate) fn read(
        points: &Bound<'_, PyAny>,
        domain: Option<&Domain>,
    ) -> Result<Arc<PointSet>> {
        if let Ok(points) = points.cast::<Self>() {
            let set = points.get().set();
            if domain.is_some_and(|domain| domain.0 != *set.domain()) {
                let message =
                    "the points have a domain of their own, which is not the one that is given";
                return Err(Error::new("different_domains", message));
            }
            return Ok(set);
        }
        let positions = Positions::read(points, 2)?;
        if positions.shape.len() != 1 {
            let message = format!(
                "points have the shape (n, 2), but this array has {} axes",
                positions.shape.len() + 1
            );
            return Err(Error::new("shape", message));
        }
        let numbers = positions.numbers.chunks_exact(2);
        let positions: Vec<DVec2> = numbers.map(DVec2::from_slice).collect();
        let domain = domain.map_or_else(|| rectangle_around(&positions), |domain| domain.0);
        Ok(Arc::new(PointSet::new(domain, positions)?))
    }

    /// Returns the positions as a read-only array, which is built once.
    fn shared<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let array = self.array.get_or_try_init(py, || -> Result<Py<PyAny>> {
            let array = positions(py, self.set.positions())?;
            let flags = PyDict::new(py);
            flags.set_item("write", false)?;
            array.call_method("setflags", (), Some(&flags))?;
            Ok(array.unbind())
        })?;
        Ok(array.bind(py).clone())
    }
}

/// Converts positions to an array of shape (n, 2).
pub(crate) fn positions<'py>(py: Python<'py>, positions: &[DVec2]) -> Result<Bound<'py, PyAny>> {
    let numbers: Vec<[f64; 2]> = positions.iter().map(DVec2::to_array).collect();
    arrays::array(py, numbers.into_flattened(), &[positions.len(), 2])
}

/// Returns the smallest rectangle around positions, with sides of positive length.
fn rectangle_around(positions: &[DVec2]) -> dapple::points::Domain {
    // Clamp infinite positions; `PointSet::new` reports them with their index.
    let held = || {
        positions
            .iter()
            .map(|at| at.clamp(DVec2::splat(-FARTHEST), DVec2::splat(FARTHEST)))
    };
    let low = held().reduce(DVec2::min).unwrap_or(DVec2::ZERO);
    let high = held().reduce(DVec2::max).unwrap_or(DVec2::ONE);
    let largest = (high - low).max_element();
    let least = if largest > 0.0 { largest * 1e-6 } else { 1.0 };
    let size = (high - low).max(DVec2::splat(least));
    // Enlarge the rectangle if, far from the origin, rounding makes it empty or excludes the last point.
    let rounding = low.abs().max(high.abs()) * (2.0 * f64::EPSILON);
    let is_lost = (low + size).cmplt(high) | (low + size).cmple(low);
    let size = DVec2::select(is_lost, size + rounding, size);
    dapple::points::Domain::rectangle(low, size)
}

#[pymethods]
impl Points {
    #[new]
    #[pyo3(signature = (array, domain = None))]
    fn from_array(array: &Bound<'_, PyAny>, domain: Option<&Domain>) -> Result<Self> {
        Ok(Self {
            set: Self::read(array, domain)?,
            array: PyOnceLock::new(),
        })
    }

    /// The positions, float64 of shape (n, 2), x first. The array is read-only.
    #[getter]
    fn array<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        self.shared(py)
    }

    /// The domain of the points.
    #[getter]
    fn domain(&self) -> Domain {
        Domain(*self.set.domain())
    }

    /// Returns the minimum distance between two points, across the boundary where axes wrap; None for fewer than two
    /// points.
    ///
    /// Returns
    /// -------
    /// float or None
    ///     The minimum distance, in units of the domain.
    fn minimum_distance(&self, py: Python<'_>) -> Result<Option<f64>> {
        let set = self.set();
        threads::run(py, move || set.minimum_distance())
    }

    /// Finds the largest circle that contains no point and whose center is in the domain, or None if there are no
    /// points.
    ///
    /// Returns
    /// -------
    /// EmptyCircle or None
    ///     The center and the radius.
    fn largest_empty_circle<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyAny>>> {
        let set = self.set();
        let circle = threads::run(py, move || set.largest_empty_circle())?;
        let circle = circle.map(|circle| {
            let center = <(f64, f64)>::from(circle.center);
            arrays::result(py, "EmptyCircle", (center, circle.radius))
        });
        circle.transpose()
    }

    /// Returns the mean number of other points within `distance` of a point.
    ///
    /// Parameters
    /// ----------
    /// distance : float
    ///     The distance, in units of the domain.
    ///
    /// Returns
    /// -------
    /// float
    ///     The mean number of neighbors.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If an argument is not a number.
    fn mean_neighbor_count(&self, py: Python<'_>, distance: f64) -> Result<f64> {
        let set = self.set();
        threads::run(py, move || set.mean_neighbor_count(distance))
    }

    /// Returns the number of points per square of side `distance`. It is 0.697 for random points that are added at
    /// this minimum distance until no more fit, and at most 1.155.
    ///
    /// Parameters
    /// ----------
    /// distance : float
    ///     The minimum distance between two points, in units of the domain.
    ///
    /// Returns
    /// -------
    /// float
    ///     The normalized density.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     If an argument is not a number.
    fn normalized_density(&self, distance: f64) -> f64 {
        self.set.normalized_density(distance)
    }

    /// Returns the positions, converted to another type if requested; called by NumPy.
    #[pyo3(signature = (dtype = None, copy = None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> Result<Bound<'py, PyAny>> {
        let array = self.shared(py)?;
        let dtype = dtype.map_or_else(|| array.getattr("dtype"), |dtype| Ok(dtype.clone()))?;
        let options = PyDict::new(py);
        options.set_item("copy", copy.unwrap_or(false))?;
        Ok(array.call_method("astype", (dtype,), Some(&options))?)
    }

    fn __len__(&self) -> usize {
        self.set.len()
    }

    fn __getitem__<'py>(
        &self,
        py: Python<'py>,
        index: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyAny>> {
        Ok(self.shared(py)?.get_item(index)?)
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(self.shared(py)?.try_iter()?.into_any())
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| other.get().set == self.set)
    }

    fn __getnewargs__<'py>(&self, py: Python<'py>) -> Result<(Bound<'py, PyAny>, Domain)> {
        Ok((self.shared(py)?, self.domain()))
    }

    fn __repr__(&self) -> String {
        format!(
            "<{} points in {}>",
            self.set.len(),
            self.domain().__repr__()
        )
    }
}

/// Computes the power spectrum of points, averaged over rings of equal frequency, and over several sets in the same
/// domain.
///
/// Frequencies are in units of sqrt(n / area): 1 is about the inverse of the distance between neighbors. White noise
/// has a power of 1 everywhere; points that are a minimum distance apart have little power at low frequencies ("blue
/// noise"). Lagae and Dutré, "A Comparison of Methods for Generating Poisson Disk Distributions" (2008).
///
/// Parameters
/// ----------
/// points : array_like, Points or list of Points
///     Points, or a list of them with the same domain, which must wrap along both axes.
/// highest_frequency : float, default 2.0
///     The maximum frequency of the spectrum, above 0.
/// ring_width : float, default 0.05
///     The width of a frequency ring, above 0.
///
/// Returns
/// -------
/// Spectrum
///     The spectrum.
///
/// Raises
/// ------
/// DappleError
///     If there are no points, the sets have different domains, or there would be more than 2**24 frequencies or
///     65,536 rings.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> found = dp.spectrum(dp.poisson_disk(dp.Domain(1), distance=0.04, seed=3))
/// >>> bool(found.power[found.frequency < 0.5].mean() < 0.1)
/// True
#[pyfunction]
#[pyo3(signature = (points, *, highest_frequency = 2.0, ring_width = 0.05))]
pub(crate) fn spectrum<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    highest_frequency: f64,
    ring_width: f64,
) -> Result<Bound<'py, PyAny>> {
    let sets: Vec<Bound<'_, PyAny>> = match points.cast::<PyList>() {
        Ok(sets) if sets.iter().all(|set| set.is_instance_of::<Points>()) => sets.iter().collect(),
        _ => vec![points.clone()],
    };
    let sets = sets
        .iter()
        .map(|set| Ok((*Points::read(set, None)?).clone()));
    let sets: Vec<PointSet> = sets.collect::<Result<_>>()?;
    let options = dapple::points::SpectrumOptions {
        highest_frequency,
        ring_width,
    };
    let rings = watch::run(py, None, move |_, stop| {
        dapple::points::spectrum_cancellable(&sets, &options, &|| stop.is_set())
    })??
    .rings;
    let column = |number: &dyn Fn(&dapple::points::SpectrumRing) -> f64| {
        let numbers: Vec<f64> = rings.iter().map(number).collect();
        arrays::array(py, numbers, &[rings.len()])
    };
    let counts: Vec<u32> = rings.iter().map(|ring| ring.n_frequencies).collect();
    let arrays = (
        column(&|ring| ring.frequency)?,
        column(&|ring| ring.power)?,
        column(&|ring| ring.anisotropy)?,
        arrays::array(py, counts, &[rings.len()])?,
    );
    arrays::result(py, "Spectrum", arrays)
}
