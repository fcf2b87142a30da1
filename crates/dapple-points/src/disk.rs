//! Maximal Poisson-disk sets: random points at least a radius apart, with no room for another point.
//!
//! The distribution is random sequential addition: darts fall uniformly at random, one at a time, and a dart becomes
//! a point if it is far enough from all earlier points (R. L. Cook, "Stochastic Sampling in Computer Graphics", ACM
//! Transactions on Graphics 5(1), 1986, <https://doi.org/10.1145/7529.8927>). Taken literally, this process never
//! ends. As in M. S. Ebeida, S. A. Mitchell, A. Patney, A. A. Davidson and J. D. Owens ("A Simple Algorithm for
//! Maximal Poisson-Disk Sampling in High Dimensions", Computer Graphics Forum 31, 2012,
//! <https://doi.org/10.1111/j.1467-8659.2012.03059.x>), darts are thrown only where the area is not known to be
//! covered. This implementation differs from theirs in two ways:
//!
//! * Time is divided into slices. In each slice, every cell throws at most one dart, at the part of the cell that is
//!   not known to be covered, and random ranks resolve the conflicts between these darts. The result does not depend
//!   on the order of work. Passes over colored cells, which leave a lattice in the spectrum, are not needed.
//! * An exact search, down to single positions of a lattice of 2^22 steps per cell, finds the last gaps. It proves
//!   that the set is maximal: the largest empty circle has a radius of at most `radius` · (1 + 1e-6).
//!
//! Positions are in the units of the domain. A large set has [`RSA_DENSITY`] · area / radius² points.

mod gap;
mod grid;
mod mask;
mod sheet;
mod slice;
mod solve;

use crate::{Domain, IsCancelled, PointIdx, PointSet, PointsError, PointsErrorKind, RSA_DENSITY};
use dapple_hash::Seed;
use fearless_simd::Level;
use grid::{Cell, Grid};
use mask::Coverage;
use solve::Solution;

/// Maximum expected number of points of a set: 2^26.
pub const MAX_POISSON_DISK_POINTS: u64 = 1 << 26;

/// Relative tolerance for the distance between given points, whose positions may have been rounded.
const GIVEN_SLACK: f64 = 1e-9;

/// Creates a maximal Poisson-disk set: random points at least `radius` apart, with no room for another point.
///
/// `radius` is in units of the domain. Distances wrap around wrapped axes. Points are ordered by rows of cells, so
/// neighbors in the plane are often neighbors in memory.
///
#[cfg_attr(doc, doc = include_str!("../docs/poisson-disk.md"))]
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] if the domain has no area; [`PointsErrorKind::NotPositive`] for a radius that is not
/// above zero and finite; [`PointsErrorKind::PeriodTooShort`] if a wrapped side is shorter than two radii;
/// [`PointsErrorKind::TooMany`] if there would be more than about [`MAX_POISSON_DISK_POINTS`] points.
///
/// # Examples
///
/// ```
/// use dapple_points::{Domain, hash::Seed, poisson_disk};
///
/// let points = poisson_disk(Domain::paper_torus(), 0.1, Seed(7))?;
/// assert!((260..300).contains(&points.len()));
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn poisson_disk(domain: Domain, radius: f64, seed: Seed) -> Result<PointSet, PointsError> {
    poisson_disk_cancellable(domain, radius, seed, &|| false)
}

/// Same as [`poisson_disk`], but fails if `is_cancelled` returns true.
///
/// # Errors
///
/// Same as [`poisson_disk`], plus [`PointsErrorKind::Cancelled`].
///
/// # Examples
///
/// ```
/// use dapple_points::{Domain, PointsErrorKind, hash::Seed, poisson_disk_cancellable};
///
/// let error = poisson_disk_cancellable(Domain::paper_torus(), 0.1, Seed(7), &|| true).unwrap_err();
/// assert_eq!(error.kind(), &PointsErrorKind::Cancelled);
/// ```
pub fn poisson_disk_cancellable(
    domain: Domain,
    radius: f64,
    seed: Seed,
    is_cancelled: &IsCancelled,
) -> Result<PointSet, PointsError> {
    PoissonDisk::new(domain, radius)?.sample_cancellable(seed, is_cancelled)
}

/// Creates a maximal Poisson-disk set of about `n_points` points.
///
/// The radius is [`poisson_disk_radius`]. The number of points varies with the seed. For a large set, the deviation
/// is less than its square root.
///
/// # Errors
///
/// Same as [`poisson_disk`], plus [`PointsErrorKind::NoPoints`] for `n_points` of zero.
///
/// # Examples
///
/// ```
/// use dapple_points::{Domain, hash::Seed, poisson_disk_about};
///
/// let points = poisson_disk_about(Domain::paper_torus(), 700, Seed(7))?;
/// assert!((680..720).contains(&points.len()));
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn poisson_disk_about(
    domain: Domain,
    n_points: u32,
    seed: Seed,
) -> Result<PointSet, PointsError> {
    poisson_disk(domain, poisson_disk_radius(domain, n_points)?, seed)
}

/// Returns the radius at which a maximal Poisson-disk set has about `n_points` points, in units of the domain.
///
/// The result accounts for borders that do not wrap, where points are denser because no points beyond the border
/// exclude them. It is at most half of the shortest wrapped side, the maximum that [`poisson_disk`] accepts. On a
/// torus, sets of three points or fewer are therefore not possible.
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] if the domain has no area, [`PointsErrorKind::NoPoints`] for `n_points` of zero.
pub fn poisson_disk_radius(domain: Domain, n_points: u32) -> Result<f64, PointsError> {
    let domain = domain.checked()?;
    if n_points == 0 {
        return Err(PointsError::new(PointsErrorKind::NoPoints));
    }
    // Solve n · r² = RSA_DENSITY · area + BORDER_DENSITY · r · (length of the borders) for r.
    let sides = [0, 1].map(|axis: usize| {
        if domain.wrap[axis] {
            0.0
        } else {
            2.0 * domain.size[1 - axis]
        }
    });
    let half = 0.5 * BORDER_DENSITY * (sides[0] + sides[1]);
    let n_points = f64::from(n_points);
    let root = (half * half + n_points * RSA_DENSITY * domain.area()).sqrt();
    let narrowest = [0, 1]
        .iter()
        .filter(|&&axis| domain.wrap[axis])
        .fold(f64::INFINITY, |least, &axis| least.min(domain.size[axis]));
    Ok(((half + root) / n_points).min(0.5 * narrowest))
}

/// Number of points that a border adds to a set, per length of one radius along the border. Measured on cylinders and
/// squares of 100 to 30 000 points: 0.232 ± 0.003. A corner adds less than a tenth of a point.
const BORDER_DENSITY: f64 = 0.232;

/// Creates a maximal Poisson-disk set that contains the given points, which come first and in order.
///
#[cfg_attr(doc, doc = include_str!("../docs/extend-poisson-disk.md"))]
///
/// # Errors
///
/// Same as [`poisson_disk`], plus [`PointsErrorKind::TooClose`] if two of the given points are closer than `radius`.
///
/// # Examples
///
/// ```
/// use dapple_points::{Domain, PointSet, extend_poisson_disk, glam::DVec2, hash::Seed};
///
/// let corners = PointSet::new(Domain::paper_torus(), vec![DVec2::NEG_ONE, DVec2::ZERO])?;
/// let points = extend_poisson_disk(&corners, 0.1, Seed(7))?;
/// assert_eq!(points.positions()[..2], corners.positions()[..]);
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn extend_poisson_disk(
    given: &PointSet,
    radius: f64,
    seed: Seed,
) -> Result<PointSet, PointsError> {
    extend_poisson_disk_cancellable(given, radius, seed, &|| false)
}

/// Same as [`extend_poisson_disk`], but fails if `is_cancelled` returns true.
///
/// # Errors
///
/// Same as [`extend_poisson_disk`], plus [`PointsErrorKind::Cancelled`].
pub fn extend_poisson_disk_cancellable(
    given: &PointSet,
    radius: f64,
    seed: Seed,
    is_cancelled: &IsCancelled,
) -> Result<PointSet, PointsError> {
    PoissonDisk::new(*given.domain(), radius)?.extend_cancellable(given, seed, is_cancelled)
}

/// A sampler of Poisson-disk sets with one radius in one domain, for any number of seeds.
#[derive(Clone, Debug)]
pub struct PoissonDisk {
    radius: f64,
    grid: Grid,
    coverage: Coverage,
}

impl PoissonDisk {
    /// Creates a sampler for sets of points at least `radius` apart, in units of the domain.
    ///
    /// # Errors
    ///
    /// Same as [`poisson_disk`].
    pub fn new(domain: Domain, radius: f64) -> Result<Self, PointsError> {
        let grid = Grid::new(domain, radius, MAX_POISSON_DISK_POINTS)?;
        let coverage = Coverage::new(&grid, level());
        Ok(Self {
            radius,
            grid,
            coverage,
        })
    }

    /// Creates the point set for `seed`; see [`poisson_disk`].
    ///
    /// # Errors
    ///
    /// Never fails if [`new`](Self::new) succeeded.
    pub fn sample(&self, seed: Seed) -> Result<PointSet, PointsError> {
        self.sample_cancellable(seed, &|| false)
    }

    fn sample_cancellable(
        &self,
        seed: Seed,
        is_cancelled: &IsCancelled,
    ) -> Result<PointSet, PointsError> {
        let mut solution = Solution::new(&self.grid, &self.coverage, level(), is_cancelled)?;
        solution.fill(seed)?;
        PointSet::new(self.grid.domain, solution.positions()?)
    }

    /// Creates the point set for `seed` that contains the given points; see [`extend_poisson_disk`].
    ///
    /// # Errors
    ///
    /// [`PointsErrorKind::DifferentDomains`] if the given points are in another domain,
    /// [`PointsErrorKind::TooClose`] if two of them are closer than the radius.
    pub fn extend(&self, given: &PointSet, seed: Seed) -> Result<PointSet, PointsError> {
        self.extend_cancellable(given, seed, &|| false)
    }

    fn extend_cancellable(
        &self,
        given: &PointSet,
        seed: Seed,
        is_cancelled: &IsCancelled,
    ) -> Result<PointSet, PointsError> {
        if *given.domain() != self.grid.domain {
            return Err(PointsError::new(PointsErrorKind::DifferentDomains {
                first: self.grid.domain,
                other: *given.domain(),
            }));
        }
        let places = self.places(given)?;
        let mut solution = Solution::new(&self.grid, &self.coverage, level(), is_cancelled)?;
        solution.give(&places)?;
        solution.fill(seed)?;
        let mut positions = given.positions().to_vec();
        positions.extend(solution.positions()?);
        PointSet::new(self.grid.domain, positions)
    }

    /// Converts the given points to cells and offsets, sorted by cell.
    fn places(&self, given: &PointSet) -> Result<Vec<(Cell, [f32; 2])>, PointsError> {
        let grid = &self.grid;
        let mut holders = vec![u32::MAX; grid.stride() * grid.rows()];
        let mut places = Vec::with_capacity(given.len());
        for (point, position) in given.iter() {
            let (cell, offset) = grid.place(position);
            let around = (0..mask::REACH as u32)
                .flat_map(|row| (0..mask::REACH as u32).map(move |column| [row, column]));
            for [row, column] in around {
                let near = grid.original(Cell {
                    row: cell.row + row - grid::HALO,
                    column: cell.column + column - grid::HALO,
                });
                let holder = holders[grid.index(near)];
                if holder != u32::MAX {
                    self.check_distance(given, PointIdx(holder), point)?;
                }
            }
            holders[grid.index(cell)] = point.0;
            places.push((cell, offset));
        }
        places.sort_by_key(|&(cell, _)| cell);
        Ok(places)
    }

    fn check_distance(
        &self,
        given: &PointSet,
        first: PointIdx,
        second: PointIdx,
    ) -> Result<(), PointsError> {
        let delta = self
            .grid
            .domain
            .delta(given.position(first), given.position(second));
        let distance = delta.length();
        if distance >= self.radius * (1.0 - GIVEN_SLACK) {
            return Ok(());
        }
        Err(PointsError::new(PointsErrorKind::TooClose {
            points: [first, second],
            distance,
            radius: self.radius,
        }))
    }
}

/// Returns the SIMD level of this machine, at most AVX2: a row of five neighbors cannot fill 16 lanes.
pub(crate) fn level() -> Level {
    let level = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(token) = level.as_avx2() {
        return Level::Avx2(token);
    }
    level
}

#[cfg(test)]
mod tests;
