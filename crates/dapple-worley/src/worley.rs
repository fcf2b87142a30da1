//! Worley's cellular basis: feature points, and the distances to the nearest of them.

use crate::dispatch::DimensionDispatch as _;
use crate::fixed::{MOST_AXES, Place, STEP, STEPS, first_axes};
use crate::lattice::{Density, Lattice};
use crate::search::{Hit, PointId};
use crate::{Dimensions, Metric, Scatter, Space, Vector, WorleyError};
use dapple_hash::{Seed, unit_f32};
use std::sync::Arc;

/// Maximum n for which the basis computes `F_n`.
pub const MAX_NEAREST: usize = 4;

/// Worley's basis in two dimensions.
pub type Worley2 = Worley<2>;

/// Worley's basis in three dimensions.
pub type Worley3 = Worley<3>;

/// Worley's basis in four dimensions, for animated textures. A period along the fourth axis makes the animation loop.
pub type Worley4 = Worley<4>;

/// Worley's cellular basis: feature points scattered over unit cells, and the distances to the nearest of them.
///
/// F1 is the distance to the nearest feature point, F2 to the second nearest, up to F4. All are exact: no neighbor is
/// missed, whatever the metric, the density or the number of axes. Positions are in cells.
///
#[cfg_attr(doc, doc = include_str!("../docs/worley.md"))]
///
/// # Examples
///
/// ```
/// use dapple_worley::{Metric, Worley3, hash::Seed};
///
/// let hull = Worley3::new(Seed(7)).with_metric(Metric::Manhattan)?;
/// let [first, second] = hull.sample([0.25, 0.75, -1e9]);
/// assert!(first.distance <= second.distance);
/// # Ok::<(), dapple_worley::WorleyError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Worley<const N: usize> {
    pub(crate) seed: Seed,
    pub(crate) lattice: Lattice,
    pub(crate) scatter: Scatter,
    pub(crate) metric: Metric,
}

/// A feature point, described relative to a position.
///
#[cfg_attr(doc, doc = include_str!("../docs/feature.md"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature<V> {
    /// Distance in cells, at least zero. NaN if the position is out of range; see [`Worley::sample`].
    pub distance: f32,
    /// Vector from the feature point to the position, in cells. For the Euclidean metric, this vector divided by the
    /// distance is the gradient of the distance; see [`Metric::gradient`].
    pub vector: V,
    /// Id of the point: 64 random bits that do not depend on the position.
    pub id: u64,
}

impl<V> Feature<V> {
    /// Returns the feature point's random number in `[0, 1)`, which is constant in its Voronoi cell.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/cell-value.md"))]
    #[must_use]
    pub fn cell_value(&self) -> f32 {
        cell_value(self.id)
    }
}

/// Returns the random number in `[0, 1)` of the feature point with the given id.
pub(crate) fn cell_value(id: u64) -> f32 {
    unit_f32((id >> 32) as u32)
}

/// A feature point in a given cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellPoint<V> {
    /// Position relative to the lower corner of the cell; components are in `[0, 1)`.
    pub offset: V,
    /// Id of the point: 64 random bits, as in [`Feature::id`].
    pub id: u64,
}

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Creates a basis with a Poisson-distributed number of points per cell, the Euclidean metric, and no period.
    #[must_use]
    pub fn new(seed: Seed) -> Self {
        let scatter = Scatter::default();
        Self {
            seed,
            lattice: Lattice::new(N, seed, scatter, Scatter::default_counts()),
            scatter,
            metric: Metric::default(),
        }
    }

    /// Returns this basis with another seed for the feature points.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/with-seed.md"))]
    #[must_use]
    pub fn with_seed(self, seed: Seed) -> Self {
        Self {
            seed,
            lattice: self.lattice.with_seed(seed),
            ..self
        }
    }

    /// Returns this basis with another scatter and a constant density.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if the density or the jitter is out of its range.
    pub fn with_scatter(self, scatter: Scatter) -> Result<Self, WorleyError> {
        let counts = scatter.counts()?;
        let period = self.lattice.period;
        Ok(Self {
            lattice: Lattice {
                period,
                ..Lattice::new(N, self.seed, scatter, counts)
            },
            scatter,
            ..self
        })
    }

    /// Returns this basis with `density` feature points per cell on average, clamped to 1 to 9 points per cell (see
    /// [`Scatter::Poisson`]).
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/scatter-poisson.md"))]
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if the density is not from 1/64 to 64.
    pub fn with_density(self, density: f64) -> Result<Self, WorleyError> {
        self.with_scatter(Scatter::Poisson { density })
    }

    /// Returns this basis with a density that varies in space. Cells are small where it is high.
    ///
    /// `density` is called with the center of each cell, and returns the mean number of feature points per cell. The
    /// result is clamped to 1/64 to 64; NaN counts as 1/64. The number of points in a cell is not clamped, so its mean
    /// is the density itself. The search visits as many rings of cells as needed; it is slower than with a constant
    /// density.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/with-varying-density.md"))]
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_worley::{Worley2, hash::Seed, raster::{Ramp, glam::DVec2}};
    ///
    /// let ramp = Ramp { from: DVec2::ZERO, to: DVec2::X * 20.0, start: 0.5, end: 8.0 };
    /// let worley = Worley2::new(Seed(7)).with_varying_density(move |at| ramp.at(at));
    /// assert!(worley.nearest([30.0, 1.0]).distance < 2.0);
    /// ```
    #[must_use]
    pub fn with_varying_density(
        self,
        density: impl Fn(Vector<N>) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let of = Arc::new(move |position: [f64; MOST_AXES]| {
            density(Vector::<N>::from(first_axes(position)))
        });
        let lattice = Lattice {
            density: Some(Density { of }),
            ..self.lattice
        };
        Self { lattice, ..self }
    }

    /// Returns this basis with another metric.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if the exponent of [`Metric::Minkowski`] is not from 1 to 10.
    pub fn with_metric(self, metric: Metric) -> Result<Self, WorleyError> {
        Ok(Self {
            metric: metric.check()?,
            ..self
        })
    }

    /// Returns the period along each axis, in cells; `None` for an axis that does not repeat.
    pub(crate) fn period(&self) -> [Option<f64>; N] {
        self.periods().map(|cells| cells.map(f64::from))
    }

    /// Repeats the feature points after a whole number of cells along each axis; `None` for an axis that does not
    /// repeat.
    ///
    /// The repeat is exact, without blending. Repeats of a point are separate points with the same id. So with a period
    /// of 1, F1 and F2 may belong to the same id.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/with-period.md"))]
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if a period is 0.
    pub fn with_period(self, period: [Option<u32>; N]) -> Result<Self, WorleyError> {
        WorleyError::check(!period.contains(&Some(0)), "period", 0.0, "at least 1 cell")?;
        let mut cells = [0; MOST_AXES];
        for (cells, period) in cells.iter_mut().zip(period) {
            *cells = period.unwrap_or(0);
        }
        let lattice = Lattice {
            period: cells,
            ..self.lattice
        };
        Ok(Self { lattice, ..self })
    }

    /// Returns the seed of the feature points.
    #[must_use]
    pub fn seed(&self) -> Seed {
        self.seed
    }

    /// Returns the period of the feature points along each axis, in cells; `None` for an axis that does not repeat.
    #[must_use]
    pub fn periods(&self) -> [Option<u32>; N] {
        core::array::from_fn(|axis| match self.lattice.period[axis] {
            0 => None,
            cells => Some(cells),
        })
    }

    /// Returns the metric of the distances.
    #[must_use]
    pub fn metric(&self) -> Metric {
        self.metric
    }

    /// Returns the scatter of the feature points.
    #[must_use]
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// Returns the feature point nearest to `position`, the first of [`sample`](Self::sample).
    #[must_use]
    #[inline]
    pub fn nearest(&self, position: impl Into<[f64; N]>) -> Feature<Vector<N>> {
        let [nearest] = self.sample(position);
        nearest
    }

    /// Returns the `K` feature points nearest to `position`, nearest first. `K` is from 1 to 4.
    ///
    /// Points at equal distances are ordered by id. A position is out of range if a coordinate is not finite or its
    /// magnitude is above 2^62. Then distances and vectors are NaN, and ids are 0. If a short period of unclamped
    /// points contains no point at all, distances and vectors are infinite, and ids are 0.
    // Inlined, so that vectors and ids are computed only for callers that use them.
    #[must_use]
    #[inline(always)]
    pub fn sample<const K: usize>(&self, position: impl Into<[f64; N]>) -> [Feature<Vector<N>>; K] {
        const {
            assert!(
                K >= 1 && K <= MAX_NEAREST,
                "F1 to F4 are there to be asked for"
            );
        };
        let mut features = [Feature {
            distance: f32::NAN,
            vector: [f64::NAN; N].into(),
            id: 0,
        }; K];
        if let Some(place) = Place::new(position.into()) {
            // Avoid `map`, which would compile to a call for each hit.
            let hits = self.hits::<K>(&place);
            for (feature, hit) in features.iter_mut().zip(hits) {
                *feature = self.feature(hit);
            }
        }
        features
    }

    /// Returns the feature points in a cell, unordered. All other results follow from them.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/cell-points.md"))]
    #[must_use]
    pub fn cell_points(&self, cell: [i64; N]) -> Vec<CellPoint<Vector<N>>> {
        let mut points = Vec::new();
        self.lattice.visit(cell, |steps, name| {
            points.push(CellPoint {
                offset: steps
                    .map(|steps| f64::from(steps) / f64::from(STEPS))
                    .into(),
                id: name.id(),
            });
        });
        points
    }

    /// Returns the `K` points nearest to `place`.
    #[inline]
    pub(crate) fn hits<const K: usize>(&self, place: &Place<N>) -> [Hit<N>; K] {
        let mut hits = [Hit::NONE; K];
        Dimensions::nearest(self.metric, &self.lattice, place, &mut hits);
        hits
    }

    /// Returns the `n` points nearest to `place`, at most four. The remaining elements are [`Hit::NONE`].
    pub(crate) fn nearest_hits(&self, n: usize, place: &Place<N>) -> [Hit<N>; MAX_NEAREST] {
        let mut hits = [Hit::NONE; MAX_NEAREST];
        Dimensions::nearest(self.metric, &self.lattice, place, &mut hits[..n]);
        hits
    }

    /// Returns the distances from `place` to its `K` nearest points.
    pub(crate) fn distances<const K: usize>(&self, place: &Place<N>) -> [f32; K] {
        self.hits::<K>(place)
            .map(|hit| self.metric.distance(hit.key))
    }

    #[inline]
    pub(crate) fn feature(&self, hit: Hit<N>) -> Feature<Vector<N>> {
        let mut vector = [0.0; N];
        for axis in 0..N {
            vector[axis] = f64::from(hit.vector[axis]);
        }
        Feature {
            distance: self.metric.distance(hit.key),
            vector: vector.into(),
            id: hit.name.map_or(0, PointId::id),
        }
    }
}

/// Maximum rounding error of a coordinate, in cells. Positions are rounded down to whole steps.
pub const POSITION_STEP: f32 = STEP;
