//! A basis over feature points placed by the caller.
//!
//! Worley suggests that "object geometry might be used to disperse pre-computed feature spots" ("A Cellular Texture
//! Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>), as Turk does. Here F1 to F4 are searched
//! among any list of points, through a grid of bins with about two points each.
//!
//! Differences are computed in `f64` and rounded once to `f32`, so positions may have any unit.

use crate::search::{Hit, PointId, Ranking, by_rings};
use crate::{Dimensions, Feature, MAX_NEAREST, Metric, Space, Vector, WorleyError};
use dapple_raster::Groups;

/// Mean number of points per bin.
const POINTS_PER_BIN: f64 = 2.0;

/// A basis over feature points that the caller places.
///
#[cfg_attr(doc, doc = include_str!("../docs/feature-set.md"))]
///
/// # Examples
///
/// ```
/// use dapple_worley::{FeatureSet, raster::glam::DVec2};
///
/// let spots = FeatureSet::new(&[DVec2::new(1.0, 2.0), DVec2::new(8.0, 2.0)], [Some(10.0), None])?;
/// let [nearest] = spots.sample([9.5, 2.0]);
/// assert_eq!((nearest.distance, nearest.id), (1.5, 0));
/// # Ok::<(), dapple_worley::WorleyError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FeatureSet<const N: usize> {
    /// Points with their original indices, sorted by bin and then by index.
    points: Vec<([f64; N], u32)>,
    /// Index of each bin's first point, with bins ordered so that the first axis varies fastest. The last element is
    /// the number of points.
    starts: Vec<u32>,
    bins: Bins<N>,
    metric: Metric,
}

/// A grid of bins that covers the points or, along an axis that wraps, the period.
#[derive(Clone, Copy, Debug)]
struct Bins<const N: usize> {
    origin: [f64; N],
    /// Size of a bin along each axis.
    size: [f64; N],
    /// Number of bins along each axis.
    count: [u32; N],
    wraps: [bool; N],
}

impl<const N: usize> FeatureSet<N>
where
    Dimensions: Space<N>,
{
    /// Creates a basis over `points`, repeated with `period` along each axis for which it is not `None`. The id of a
    /// point is its index.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::WorleyErrorKind::Range) if a coordinate or a period is not finite, a period is not positive, or
    /// there are 2^32 points or more.
    pub fn new(points: &[Vector<N>], period: [Option<f64>; N]) -> Result<Self, WorleyError> {
        let check = WorleyError::check;
        let count = points.len() as f64;
        check(
            count < f64::from(u32::MAX),
            "number of points",
            count,
            "below 2^32",
        )?;
        let mut places: Vec<[f64; N]> = points.iter().map(|&point| point.into()).collect();
        for &coordinate in places.iter().flatten() {
            check(
                coordinate.is_finite(),
                "coordinate of a point",
                coordinate,
                "finite",
            )?;
        }
        for &period in period.iter().flatten() {
            check(
                period > 0.0 && period.is_finite(),
                "period",
                period,
                "finite and above 0",
            )?;
        }
        // Wrap the points, and sort them by bin.
        for place in &mut places {
            for (coordinate, period) in place.iter_mut().zip(period) {
                if let Some(period) = period {
                    *coordinate = wrap(*coordinate, period);
                }
            }
        }
        let bins = Bins::new(&places, period);
        let bin_of = |place: &[f64; N]| {
            bins.index(core::array::from_fn(|axis| bins.bin(axis, place[axis]))) as u32
        };
        let of_places: Vec<u32> = places.iter().map(bin_of).collect();
        let n_bins = bins
            .count
            .iter()
            .map(|&count| count as usize)
            .product::<usize>();
        let sorted = Groups::sort(n_bins, &of_places);
        let points = sorted.items.iter();
        let points = points.map(|&index| (places[index as usize], index));
        Ok(Self {
            points: points.collect(),
            starts: sorted.starts,
            bins,
            metric: Metric::default(),
        })
    }

    /// Returns this set with another metric.
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

    /// Returns the `K` feature points nearest to `position`, nearest first. `K` is from 1 to 4.
    ///
    /// Points at equal distances are ordered by index. If there are fewer than `K` points, the missing ones are
    /// infinitely far away, with the id `u64::MAX`. For a position that is not finite, distances and vectors are NaN,
    /// and ids are `u64::MAX`.
    #[must_use]
    pub fn sample<const K: usize>(&self, position: impl Into<[f64; N]>) -> [Feature<Vector<N>>; K] {
        const {
            assert!(
                K >= 1 && K <= MAX_NEAREST,
                "F1 to F4 are there to be asked for"
            );
        };
        let position: [f64; N] = position.into();
        if position.iter().any(|part| !part.is_finite()) {
            return [Feature {
                distance: f32::NAN,
                vector: [f64::NAN; N].into(),
                id: u64::MAX,
            }; K];
        }
        let ranking = self.nearest(K, position);
        core::array::from_fn(|rank| {
            let hit = ranking.hits()[rank];
            Feature {
                distance: self.metric.distance(hit.key),
                vector: hit.vector.map(f64::from).into(),
                id: hit.name.map_or(u64::MAX, |name| u64::from(name.index)),
            }
        })
    }

    /// Finds the `n` nearest points. Bins are visited in rings around the bin of the position, until no bin outside can
    /// contain a nearer point.
    fn nearest(&self, n: usize, mut position: [f64; N]) -> Ranking<N> {
        let bins = &self.bins;
        for axis in 0..N {
            if bins.wraps[axis] {
                position[axis] = wrap(position[axis], bins.period(axis));
            }
        }
        let center = core::array::from_fn(|axis| i64::from(bins.bin(axis, position[axis])));
        by_rings(n, self.metric, |ring, ranking| {
            if self.points.is_empty() {
                return f32::INFINITY;
            }
            let [first, last] = bins.reach(center, ring);
            // Visit the bins of the ring; the first axis varies fastest.
            let mut bin = first;
            loop {
                if (0..N).any(|axis| (bin[axis] - center[axis]).abs() == ring) {
                    self.visit(position, bin, ranking);
                }
                let Some(axis) = (0..N).find(|&axis| bin[axis] < last[axis]) else {
                    break;
                };
                bin[axis] += 1;
                bin[..axis].copy_from_slice(&first[..axis]);
            }
            match bins.border(position, [first, last]) {
                f32::INFINITY => f32::INFINITY,
                // The key of a large finite distance may overflow to infinity.
                border => self.metric.term(border).min(f32::MAX),
            }
        })
    }

    /// Adds the points of a bin to a ranking.
    fn visit(&self, position: [f64; N], bin: [i64; N], ranking: &mut Ranking<N>) {
        let bins = &self.bins;
        let turns: [i64; N] =
            core::array::from_fn(|axis| bin[axis].div_euclid(i64::from(bins.count[axis])));
        let index = bins.index(core::array::from_fn(|axis| {
            bin[axis].rem_euclid(i64::from(bins.count[axis])) as u32
        }));
        let range = self.starts[index] as usize..self.starts[index + 1] as usize;
        for (point, index) in &self.points[range] {
            let mut vector = [0.0; N];
            for axis in 0..N {
                // Move the point to the repeat of the period that contains the bin.
                let shift = turns[axis] as f64 * bins.period(axis);
                vector[axis] = (position[axis] - (point[axis] + shift)) as f32;
            }
            let hit = Hit {
                key: self.metric.key(vector),
                vector,
                name: Some(PointId {
                    words: [0; 2],
                    index: *index,
                }),
            };
            ranking.add(hit, |name| u64::from(name.index));
        }
    }
}

impl<const N: usize> Bins<N> {
    fn new(points: &[[f64; N]], period: [Option<f64>; N]) -> Self {
        let mut origin = [0.0; N];
        let mut extent = [0.0; N];
        for axis in 0..N {
            let along = points.iter().map(|point| point[axis]);
            let low = along.clone().fold(f64::INFINITY, f64::min);
            let high = along.fold(f64::NEG_INFINITY, f64::max);
            (origin[axis], extent[axis]) = match period[axis] {
                Some(period) => (0.0, period),
                None if low <= high => (low, high - low),
                None => (0.0, 0.0),
            };
        }
        // Choose cubic bins for the target number of bins, with at least one bin along each axis.
        let wanted = (points.len() as f64 / POINTS_PER_BIN).max(1.0);
        let longest = extent.iter().copied().fold(0.0, f64::max);
        let mut side = longest;
        // Shrink the side of the bins until there are enough; the number of steps is fixed, since a grid without extent
        // never gets more bins.
        for _ in 0..64 {
            let n_bins: f64 = extent
                .iter()
                .map(|&extent| (extent / side).max(1.0))
                .product();
            if n_bins < wanted {
                side *= 0.75;
            }
        }
        let count = extent.map(|extent| {
            let count = (extent / side).floor();
            if count >= 1.0 {
                count.min(65_536.0) as u32
            } else {
                1
            }
        });
        let size = core::array::from_fn(|axis| extent[axis] / f64::from(count[axis]));
        Self {
            origin,
            size,
            count,
            wraps: period.map(|period| period.is_some()),
        }
    }

    /// Returns the extent of the grid along an axis. It equals the period if the axis wraps.
    fn period(&self, axis: usize) -> f64 {
        self.size[axis] * f64::from(self.count[axis])
    }

    /// Returns the bin that contains a coordinate, or the nearest bin.
    fn bin(&self, axis: usize, coordinate: f64) -> u32 {
        let bin = (coordinate - self.origin[axis]) / self.size[axis];
        // Coordinates below the first bin, and NaN from an extent of zero, are in the first bin.
        (bin as u32).min(self.count[axis] - 1)
    }

    fn index(&self, bin: [u32; N]) -> usize {
        (0..N).rev().fold(0, |index, axis| {
            index * self.count[axis] as usize + bin[axis] as usize
        })
    }

    /// Returns the first and the last bin within `ring` bins of `center`. They exceed the grid only along axes that
    /// wrap.
    fn reach(&self, center: [i64; N], ring: i64) -> [[i64; N]; 2] {
        let mut reach = [center; 2];
        for axis in 0..N {
            let [low, high] = [center[axis] - ring, center[axis] + ring];
            let last = i64::from(self.count[axis]) - 1;
            [reach[0][axis], reach[1][axis]] = if self.wraps[axis] {
                [low, high]
            } else {
                [low.max(0), high.min(last)]
            };
        }
        reach
    }

    /// Returns a lower bound on the distance from a position to the points beyond these bins; infinite if there are
    /// none.
    fn border(&self, position: [f64; N], [first, last]: [[i64; N]; 2]) -> f32 {
        let mut border = f64::INFINITY;
        for axis in 0..N {
            let edge = |bin: i64| self.origin[axis] + bin as f64 * self.size[axis];
            // Along an axis that does not wrap, there are no points beyond the grid.
            if self.wraps[axis] || first[axis] > 0 {
                border = border.min(position[axis] - edge(first[axis]));
            }
            if self.wraps[axis] || last[axis] + 1 < i64::from(self.count[axis]) {
                border = border.min(edge(last[axis] + 1) - position[axis]);
            }
        }
        // Edges are rounded, and so are differences to points beyond them. In doubt, the margin makes the search visit
        // one more ring.
        let scale = position
            .iter()
            .fold(0.0, |scale: f64, part| scale.max(part.abs()));
        let doubt = 1e-6 * border + 1e-15 * scale;
        if border == f64::INFINITY {
            f32::INFINITY
        } else {
            (border - doubt).max(0.0) as f32
        }
    }
}

/// Wraps a coordinate to `[0, period)`.
fn wrap(coordinate: f64, period: f64) -> f64 {
    let wrapped = coordinate - (coordinate / period).floor() * period;
    // Rounding can put the result just outside.
    if (0.0..period).contains(&wrapped) {
        wrapped
    } else {
        0.0
    }
}
