//! Poisson-disk points on the whole plane, evaluated in windows that agree with each other.
//!
//! Random sequential addition (R. L. Cook, "Stochastic Sampling in Computer Graphics", ACM Transactions on Graphics
//! 5(1), 1986, <https://doi.org/10.1145/7529.8927>) with darts that are hashes of their cell. The plane is divided
//! into square cells whose diagonal is the radius, so that a cell contains at most one point. A cell throws at most
//! [`N_ROUNDS`] darts, one per round; within a round, darts have random ranks. A dart becomes a point if no point of
//! an earlier dart is too close. Whether a dart becomes a point thus depends on the earlier darts around it, which
//! depend on the darts around them. These chains end after a few radii and are followed completely. The points are
//! therefore exactly the points of a construction of the whole plane.
//!
//! The idea of sampling an unbounded plane on demand is from D. Dunbar and G. Humphreys ("A Spatial Data Structure
//! for Fast Poisson-Disk Sample Generation", SIGGRAPH 2006, <https://doi.org/10.1145/1141911.1141915>) and from
//! corner tiles (A. Lagae and P. Dutré, "An Alternative for Wang Tiles", ACM Transactions on Graphics 25(4), 2006,
//! <https://doi.org/10.1145/1183287.1183296>). Tiles repeat a finite set of patterns; ranks do not.
//!
//! Coordinates are integers in steps, a power of two between 2^-23 and 2^-22 of the radius, so that distances are
//! exact.

use crate::{DiskRule, PointsError, PointsErrorKind};
use block::{Block, Stop};
use dapple_hash::Seed;
use glam::DVec2;

mod block;

/// Maximum number of darts per cell.
///
/// Measured densities N r², relative to a maximal set: 0.85 with 4 darts, 0.89 with 8, 0.92 with 16, 0.94 with 32.
const N_ROUNDS: u8 = 16;

/// Side of a block in cells. A block is processed in one allocation.
const BLOCK_SIDE: i64 = 128;

/// Maximum absolute coordinate of a window, in radii: `f64` still has 13 bits for the position within a radius.
const FARTHEST: f64 = (1_u64 << 39) as f64;

/// Maximum expected number of points of a window: 2^26.
const MAX_POINTS: u64 = 1 << 26;

/// Maximum ratio between the two bounds of a variable radius.
const MAX_RATIO: f64 = 16.0;

/// A point of an endless set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndlessPoint {
    /// Position, in the units of the radius.
    pub position: DVec2,
    /// Radius at the position, between the set's bounds.
    pub radius: f64,
    /// 64 random bits that identify the point in every window. Use them as the seed for its other properties. In a
    /// periodic set, copies of a point have the same id.
    pub id: u64,
}

/// Poisson-disk points on the endless plane: random points at least a radius apart, evaluated in any window on
/// demand.
///
/// Overlapping windows contain the same points, bit for bit. Chunks of a world therefore agree at their borders,
/// regardless of the order, thread or machine that creates them. Nothing is stored.
///
/// * Distances: no two points are closer than the radius. Up to 2^30 radii from the origin, positions are not rounded,
///   and distances in `f64` are never below the radius; farther out, positions are rounded to `f64`.
/// * Density: 0.64 points per squared radius, 0.917 of the density of [`poisson_disk`](crate::poisson_disk) (0.697).
///   The set is not maximal: some gaps have room for another point. A denser set would take more darts.
/// * Cost: 2 to 3 microseconds per point on one core of a slow server, four to five times as much as a maximal set,
///   and memory for a block of 128 × 128 cells. A window also evaluates the darts that its points depend on: about two
///   radii on each side.
///
/// # Examples
///
/// ```
/// use dapple_points::{EndlessPoissonDisk, hash::Seed};
///
/// let trees = EndlessPoissonDisk::new(3.0, Seed(7))?;
/// // Two chunks of 64 meters side by side, a million kilometers from the origin, and both in one piece.
/// let west = trees.points([1e9, 0.0], [1e9 + 64.0, 64.0])?;
/// let east = trees.points([1e9 + 64.0, 0.0], [1e9 + 128.0, 64.0])?;
/// let both = trees.points([1e9, 0.0], [1e9 + 128.0, 64.0])?;
/// assert_eq!(west.len() + east.len(), both.len());
/// assert!(west.iter().chain(&east).all(|tree| both.contains(tree)));
/// // The height of a tree, and whatever else it has, is a function of its id.
/// let heights = west.iter().map(|tree| 5.0 + (tree.id >> 40) as f64 / (1 << 24) as f64);
/// assert!(heights.into_iter().all(|height| (5.0..6.0).contains(&height)));
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EndlessPoissonDisk {
    plane: Plane,
}

impl EndlessPoissonDisk {
    /// Creates the point set for `seed`, with points at least `radius` apart.
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::OutOfRange`] for a radius outside 1e-270 to 1e270.
    pub fn new(radius: f64, seed: Seed) -> Result<Self, PointsError> {
        let seed = seed.child("endless poisson disk", 0);
        let plane = Plane::new([radius; 2], seed)?;
        Ok(Self { plane })
    }

    /// Makes the set repeat exactly along the axes with a period. Copies of a point have the same id.
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::PeriodTooShort`] for a period shorter than two radii; [`PointsErrorKind::OutOfRange`] past 2^39
    /// radii.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_points::{EndlessPoissonDisk, hash::Seed};
    ///
    /// let tiles = EndlessPoissonDisk::new(0.1, Seed(7))?.with_period([Some(1.0), None])?;
    /// let (first, second) = (tiles.points([0.0, 5.0], [1.0, 6.0])?, tiles.points([1.0, 5.0], [2.0, 6.0])?);
    /// assert_eq!(first.len(), second.len());
    /// # Ok::<(), dapple_points::PointsError>(())
    /// ```
    pub fn with_period(mut self, period: [Option<f64>; 2]) -> Result<Self, PointsError> {
        self.plane.set_period(period)?;
        Ok(self)
    }

    /// Returns the points of the window from `min` (included) to `max` (excluded), in unspecified order.
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::OutOfRange`] for a coordinate past 2^39 radii from the origin, or a maximum below the minimum;
    /// [`PointsErrorKind::TooMany`] for a window of more than about 2^26 points.
    pub fn points(
        &self,
        min: impl Into<[f64; 2]>,
        max: impl Into<[f64; 2]>,
    ) -> Result<Vec<EndlessPoint>, PointsError> {
        let radius = self.plane.radii[0];
        self.plane.points([min.into(), max.into()], &|_| radius)
    }
}

/// Poisson-disk points on the endless plane with a spatially varying radius: [`EndlessPoissonDisk`] with a radius
/// function.
///
/// The radius is evaluated at each dart and clamped to two bounds. A [`DiskRule`] derives the minimum distance
/// between two points from their radii; by default it is their mean. Where the radius is r, the density is about 0.63
/// / r².
///
/// Windows agree, as for [`EndlessPoissonDisk`], provided that the function depends only on the position. Cells are
/// sized for the smaller bound s. A window costs as much per s² of area as with the fixed radius s, and up to five
/// times as much if the larger bound is 16 times s, because points with a large radius are searched in more cells.
/// The radius is evaluated about 5 times per s² where it is close to s, and up to 40 times where it is 4 s.
///
/// # Examples
///
/// ```
/// use dapple_points::{EndlessVariablePoissonDisk, hash::Seed};
///
/// // Dense near the line x = 0, four times as far apart from |x| = 100 on.
/// let radius = |[x, _]: [f64; 2]| 1.0 + 0.03 * x.abs();
/// let shrubs = EndlessVariablePoissonDisk::new([1.0, 4.0], radius, Seed(7))?;
/// let (near, far) = (shrubs.points([0.0, 0.0], [32.0, 32.0])?, shrubs.points([100.0, 0.0], [132.0, 32.0])?);
/// assert!(near.len() > 4 * far.len());
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
#[derive(Clone, Debug)]
pub struct EndlessVariablePoissonDisk<F> {
    plane: Plane,
    radius: F,
}

impl<F: Fn([f64; 2]) -> f64> EndlessVariablePoissonDisk<F> {
    /// Creates the point set for `seed`, with a radius between two bounds (smaller bound first).
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::OutOfRange`] for a bound outside 1e-270 to 1e270, and for a second bound below the first
    /// one or above 16 times the first one.
    pub fn new(bounds: [f64; 2], radius: F, seed: Seed) -> Result<Self, PointsError> {
        let seed = seed.child("endless variable poisson disk", 0);
        let plane = Plane::new(bounds, seed)?;
        Ok(Self { plane, radius })
    }

    /// Sets the rule for the minimum distance between points with different radii.
    #[must_use]
    pub fn with_rule(mut self, rule: DiskRule) -> Self {
        self.plane.rule = rule;
        self
    }

    /// Makes the set repeat along each axis with a period. The radius is evaluated in the first period, which starts
    /// at 0.
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::PeriodTooShort`] for a period shorter than two of the largest radii;
    /// [`PointsErrorKind::OutOfRange`] past 2^39 of the smallest radii.
    pub fn with_period(mut self, period: [Option<f64>; 2]) -> Result<Self, PointsError> {
        self.plane.set_period(period)?;
        Ok(self)
    }

    /// Returns the points of the window from `min` (included) to `max` (excluded), in unspecified order.
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::Radius`] where the radius is not above zero and finite;
    /// [`PointsErrorKind::OutOfRange`] for a coordinate past 2^39 of the smallest radii from the origin, or a maximum
    /// below the minimum; [`PointsErrorKind::TooMany`] for a window that could have more than about 2^26 points.
    pub fn points(
        &self,
        min: impl Into<[f64; 2]>,
        max: impl Into<[f64; 2]>,
    ) -> Result<Vec<EndlessPoint>, PointsError> {
        self.plane.points([min.into(), max.into()], &self.radius)
    }
}

/// Grid of the plane, and the parameters of its dart throwing.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    seed: Seed,
    rule: DiskRule,
    /// Minimum and maximum radius.
    radii: [f64; 2],
    /// Length of a step in the caller's units, a power of two.
    step: f64,
    axes: [Axis; 2],
}

/// The cells along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    /// Width of a cell in steps. On an axis with a period, the maximum width.
    width: i64,
    period: Option<Period>,
}

/// The period of the point set along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Period {
    /// Length of the period in the caller's units.
    length: f64,
    /// Length of the period in whole steps. A remainder of less than a step stays empty.
    n_steps: i64,
    n_cells: i64,
}

/// A column or a row of cells.
#[derive(Clone, Copy, Debug)]
struct Strip {
    /// Index of the cell within its period.
    cell: i64,
    /// Start of the cell's period, in the caller's units.
    origin: f64,
    /// Start of the cell relative to its period, in steps.
    start: i64,
    /// Start of the cell relative to the origin of the plane, in steps.
    absolute: i64,
    width: i64,
}

impl Plane {
    fn new(radii: [f64; 2], seed: Seed) -> Result<Self, PointsError> {
        let [least, most] = radii;
        check_range("the radius", least, [1e-270, 1e270])?;
        check_range("the largest radius", most, [least, MAX_RATIO * least])?;
        let exponent_only = f64::from_bits(least.to_bits() & f64::INFINITY.to_bits());
        let step = exponent_only / (1 << 22) as f64;
        let axis = Axis {
            width: (least / step * core::f64::consts::FRAC_1_SQRT_2) as i64,
            period: None,
        };
        Ok(Self {
            seed,
            rule: DiskRule::default(),
            radii,
            step,
            axes: [axis; 2],
        })
    }

    fn set_period(&mut self, period: [Option<f64>; 2]) -> Result<(), PointsError> {
        for (axis, length) in period.into_iter().enumerate() {
            let cells = &mut self.axes[axis];
            let Some(length) = length else {
                cells.period = None;
                continue;
            };
            let [least, most] = self.radii;
            check_range("the period", length, [0.0, FARTHEST * least])?;
            if length < 2.0 * most {
                return Err(PointsError::new(PointsErrorKind::PeriodTooShort {
                    axis: axis as u32,
                    period: length,
                    radius: most,
                }));
            }
            let n_steps = (length / self.step) as i64;
            cells.period = Some(Period {
                length,
                n_steps,
                n_cells: n_steps / cells.width + i64::from(n_steps % cells.width > 0),
            });
        }
        Ok(())
    }

    /// Returns the points of the window between its minimum and maximum corner.
    fn points(
        &self,
        window: [[f64; 2]; 2],
        radius: &impl Fn([f64; 2]) -> f64,
    ) -> Result<Vec<EndlessPoint>, PointsError> {
        let [min, max] = window;
        let least = self.radii[0];
        let mut cells = [[0; 2]; 2];
        for axis in 0..2 {
            let farthest = FARTHEST * least;
            check_range("the start of the window", min[axis], [-farthest, farthest])?;
            check_range("the end of the window", max[axis], [min[axis], farthest])?;
            // Add one cell on both sides, because positions are rounded.
            let cell = |coordinate| self.axes[axis].cell(coordinate, self.step);
            cells[axis] = [cell(min[axis]) - 1, cell(max[axis]) + 2];
        }
        let needed = 0.64 * (max[0] - min[0]) / least * ((max[1] - min[1]) / least);
        if needed > MAX_POINTS as f64 {
            return Err(PointsError::new(PointsErrorKind::TooMany {
                needed,
                limit: MAX_POINTS,
            }));
        }
        let is_inside =
            |at: DVec2| (0..2).all(|axis| at[axis] >= min[axis] && at[axis] < max[axis]);
        let mut points = Vec::new();
        if min[0] == max[0] || min[1] == max[1] {
            return Ok(points);
        }
        for y in (cells[1][0]..cells[1][1]).step_by(BLOCK_SIDE as usize) {
            for x in (cells[0][0]..cells[0][1]).step_by(BLOCK_SIDE as usize) {
                let end = |axis: usize, first: i64| cells[axis][1].min(first + BLOCK_SIDE);
                let part = [[x, end(0, x)], [y, end(1, y)]];
                let found = self.block(part, radius)?;
                points.extend(found.into_iter().filter(|point| is_inside(point.position)));
            }
        }
        Ok(points)
    }

    /// Returns the points of a block of cells, given as a half-open range along each axis.
    fn block(
        &self,
        cells: [[i64; 2]; 2],
        radius: &impl Fn([f64; 2]) -> f64,
    ) -> Result<Vec<EndlessPoint>, PointsError> {
        // Darts rarely depend on cells beyond this margin. If they do, start again with a larger one.
        let mut margin = 6 * self.reach() + 4;
        loop {
            match Block::new(self, cells, margin, radius).solve() {
                Ok(points) => return Ok(points),
                Err(Stop::Margin) => margin *= 2,
                Err(Stop::Radius { position, radius }) => {
                    let kind = PointsErrorKind::Radius { position, radius };
                    return Err(PointsError::new(kind));
                }
            }
        }
    }

    /// Returns the search radius in cells. Conflicting points are at most this many cells apart.
    fn reach(&self) -> i64 {
        let most = (self.radii[1] / self.step) as i64 + 1;
        let narrowest = self.axes[0].narrowest().min(self.axes[1].narrowest());
        most / narrowest + 1
    }
}

impl Axis {
    /// Returns the approximate index of the cell at `coordinate`, in the caller's units.
    fn cell(&self, coordinate: f64, step: f64) -> i64 {
        let cells = match self.period {
            Some(period) => coordinate / period.length * period.n_cells as f64,
            None => coordinate / (self.width as f64 * step),
        };
        cells.floor() as i64
    }

    /// Returns the column or row of cells with this index, which counts across periods.
    fn strip(&self, cell: i64) -> Strip {
        let Some(period) = self.period else {
            return Strip {
                cell,
                origin: 0.0,
                start: cell * self.width,
                absolute: cell * self.width,
                width: self.width,
            };
        };
        let n_cells = period.n_cells;
        let (turn, cell) = (cell.div_euclid(n_cells), cell.rem_euclid(n_cells));
        let start_of = |cell: i64| {
            (i128::from(cell) * i128::from(period.n_steps) / i128::from(n_cells)) as i64
        };
        let start = start_of(cell);
        Strip {
            cell,
            origin: turn as f64 * period.length,
            start,
            absolute: turn * period.n_steps + start,
            width: start_of(cell + 1) - start,
        }
    }

    /// Returns the minimum width of a cell, in steps.
    fn narrowest(&self) -> i64 {
        self.period
            .map_or(self.width, |period| period.n_steps / period.n_cells)
    }
}

/// Fails if a number is outside a range.
fn check_range(what: &'static str, value: f64, range: [f64; 2]) -> Result<(), PointsError> {
    if value >= range[0] && value <= range[1] {
        return Ok(());
    }
    Err(PointsError::new(PointsErrorKind::OutOfRange {
        what,
        value,
        range,
    }))
}

#[cfg(test)]
mod tests;
