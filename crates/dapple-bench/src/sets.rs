//! Inputs that several groups share: point sets of the unit torus, values for them, and query positions.

use anyhow::Result;
use dapple_hash::{Seed, hash1, unit_f32};
use dapple_points::glam::DVec2;
use dapple_points::{Domain, PointSet};

/// The seed of every set.
pub(crate) const SEED: Seed = Seed(2013);

/// The unit torus.
pub(crate) const UNIT_TORUS: Domain = Domain::torus(DVec2::ZERO, DVec2::ONE);

/// Number of points times the squared radius, for a maximal Poisson-disk set on the unit torus.
pub(crate) const NORMALIZED_DENSITY: f64 = 0.697;

/// Returns the radius at which the unit torus holds about `n_points` maximal Poisson-disk points.
pub(crate) fn radius_of(n_points: u32) -> f64 {
    (NORMALIZED_DENSITY / f64::from(n_points)).sqrt()
}

/// Generates about `n_points` maximal Poisson-disk points on the unit torus.
pub(crate) fn poisson_disk(n_points: u32) -> Result<PointSet> {
    poisson_disk_from(SEED, n_points)
}

/// Generates about `n_points` maximal Poisson-disk points from the given seed.
pub(crate) fn poisson_disk_from(seed: Seed, n_points: u32) -> Result<PointSet> {
    Ok(dapple_points::poisson_disk(
        UNIT_TORUS,
        radius_of(n_points),
        seed,
    )?)
}

/// Returns a value in [0, 1) for each of `n` points.
pub(crate) fn values(n: usize) -> Vec<f32> {
    let seed = SEED.child("bench values", 0);
    (0..n as i64)
        .map(|index| unit_f32((hash1(seed, [index], 0) >> 32) as u32))
        .collect()
}

/// Returns `n` random positions in the unit square.
#[cfg(feature = "peers")]
pub(crate) fn positions(n: usize) -> Vec<DVec2> {
    let seed = SEED.child("bench positions", 0);
    let unit = |index, axis| dapple_hash::unit_f64(hash1(seed, [index], axis));
    (0..n as i64)
        .map(|index| DVec2::new(unit(index, 0), unit(index, 1)))
        .collect()
}

/// Returns `n` random positions in a cube with sides of length `side`, whose minimum corner is the origin.
#[cfg(feature = "peers")]
pub(crate) fn positions_in<const N: usize>(n: usize, side: f64) -> Vec<[f64; N]> {
    let seed = SEED.child("bench scattered positions", 0);
    let unit = |index, axis| dapple_hash::unit_f64(hash1(seed, [index], axis));
    (0..n as i64)
        .map(|index| std::array::from_fn(|axis| side * unit(index, axis as u32)))
        .collect()
}
