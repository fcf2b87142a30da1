//! Independent points: white noise, and a jittered grid.
//!
//! Each point is a hash of its index or its cell, so that a larger set starts with the points of a smaller one.
//! Positions are in the units of the domain.
//!
//! Reference: none; both methods are as old as sampling.

use crate::{Domain, PointSet, PointsError, PointsErrorKind};
use dapple_hash::{CellHash, Seed, unit_f64};
use glam::DVec2;

/// Maximum number of points of both functions: 2^31, the maximum of a [`PointSet`].
const MAX_POINTS: u64 = 1 << 31;

/// Creates `n_points` independent points, uniformly distributed in the domain.
///
/// Point `i` depends only on the seed and on `i`.
///
#[cfg_attr(doc, doc = include_str!("../docs/white-noise.md"))]
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] for a domain without area, [`PointsErrorKind::TooMany`] for more than 2^31 points.
///
/// # Examples
///
/// ```
/// use dapple_points::{Domain, hash::Seed, white_noise};
///
/// let points = white_noise(Domain::paper_torus(), 100, Seed(7))?;
/// let more = white_noise(Domain::paper_torus(), 200, Seed(7))?;
/// assert_eq!(points.positions(), &more.positions()[..100]);
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn white_noise(domain: Domain, n_points: u32, seed: Seed) -> Result<PointSet, PointsError> {
    let domain = checked(domain, u64::from(n_points))?;
    let seed = seed.child("white noise", 0);
    let positions = (0..n_points)
        .map(|point| {
            let hash = CellHash::new(seed, [i64::from(point)]);
            place(&domain, unit_square(hash))
        })
        .collect();
    PointSet::new(domain, positions)
}

/// Creates one point in each cell of a grid of `cells[0]` columns and `cells[1]` rows, row by row.
///
/// With a `jitter` of 0, each point is at the center of its cell; with 1, it can be anywhere in the cell. In between,
/// it is in a concentric cell scaled by `jitter`.
///
#[cfg_attr(doc, doc = include_str!("../docs/jittered-grid.md"))]
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] for a domain without area, [`PointsErrorKind::TooMany`] for more than 2^31 points,
/// [`PointsErrorKind::OutOfRange`] for a jitter outside `0..=1`.
///
/// # Examples
///
/// ```
/// use dapple_points::{Domain, glam::DVec2, hash::Seed, jittered_grid};
///
/// let points = jittered_grid(Domain::paper_torus(), [2, 1], 0.0, Seed(7))?;
/// assert_eq!(points.positions(), [DVec2::new(-0.5, 0.0), DVec2::new(0.5, 0.0)]);
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn jittered_grid(
    domain: Domain,
    cells: [u32; 2],
    jitter: f64,
    seed: Seed,
) -> Result<PointSet, PointsError> {
    let [columns, rows] = cells;
    let domain = checked(domain, u64::from(columns) * u64::from(rows))?;
    if !(0.0..=1.0).contains(&jitter) {
        return Err(PointsError::new(PointsErrorKind::OutOfRange {
            what: "the jitter",
            value: jitter,
            range: [0.0, 1.0],
        }));
    }
    let seed = seed.child("jittered grid", 0);
    let count = DVec2::new(f64::from(columns), f64::from(rows));
    let position = |column: u32, row: u32| {
        let hash = CellHash::new(seed, [i64::from(column), i64::from(row)]);
        let offset = DVec2::splat(0.5) + (unit_square(hash) - 0.5) * jitter;
        place(
            &domain,
            (DVec2::new(f64::from(column), f64::from(row)) + offset) / count,
        )
    };
    let positions = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| position(column, row)))
        .collect();
    PointSet::new(domain, positions)
}

/// Checks the domain and the number of points, and returns the domain.
fn checked(domain: Domain, n_points: u64) -> Result<Domain, PointsError> {
    if n_points > MAX_POINTS {
        return Err(PointsError::new(PointsErrorKind::TooMany {
            needed: n_points as f64,
            limit: MAX_POINTS,
        }));
    }
    domain.checked()
}

/// Returns a uniform position in the unit square.
fn unit_square(hash: CellHash) -> DVec2 {
    DVec2::new(unit_f64(hash.at(0)), unit_f64(hash.at(1)))
}

/// Converts `unit`, from 0 to 1 along each axis, to a position in the domain.
fn place(domain: &Domain, unit: DVec2) -> DVec2 {
    // Rounding must not move the position across a border that does not wrap.
    (domain.origin + unit * domain.size).min(domain.end())
}

#[cfg(test)]
mod tests {
    use super::{jittered_grid, white_noise};
    use crate::{Domain, PointsErrorKind};
    use dapple_hash::Seed;
    use glam::DVec2;

    const DOMAIN: Domain = Domain::rectangle(DVec2::new(-3.0, 5.0), DVec2::new(2.0, 1.0));

    #[test]
    fn white_noise_fills_the_domain_evenly() {
        let points = white_noise(DOMAIN, 64_000, Seed(1)).unwrap();
        let mut counts = [0_u32; 64];
        for (_, position) in points.iter() {
            let unit = (position - DOMAIN.origin) / DOMAIN.size * 8.0;
            counts[unit.y as usize * 8 + unit.x as usize] += 1;
        }
        // Each count is 1000 ± 32; five standard deviations for 64 counts.
        assert!(counts.iter().all(|&n| n.abs_diff(1000) < 160), "{counts:?}");
    }

    #[test]
    fn jitter_stays_within_its_part_of_the_cell() {
        for jitter in [0.0, 0.5, 1.0] {
            let points = jittered_grid(DOMAIN, [20, 10], jitter, Seed(1)).unwrap();
            let mut farthest = 0.0_f64;
            for (point, position) in points.iter() {
                let cell = DVec2::new(f64::from(point.0 % 20), f64::from(point.0 / 20));
                let center = DOMAIN.origin + (cell + 0.5) * 0.1;
                farthest = farthest.max((position - center).abs().max_element());
            }
            // Half of a cell of 0.1; the maximum over 200 points is close to it. The tolerance of 1e-12 is for
            // rounding.
            let most = 0.05 * jitter;
            assert!(farthest <= most + 1e-12, "{jitter}: {farthest}");
            assert!(farthest >= most * 0.95, "{jitter}: only {farthest}");
        }
    }

    #[test]
    fn bad_numbers_are_refused() {
        for jitter in [-0.1, 1.1, f64::NAN] {
            let error = jittered_grid(DOMAIN, [2, 2], jitter, Seed(1)).unwrap_err();
            assert!(
                matches!(error.kind(), PointsErrorKind::OutOfRange { .. }),
                "{error}"
            );
        }
        let error = jittered_grid(DOMAIN, [u32::MAX; 2], 1.0, Seed(1)).unwrap_err();
        assert!(
            matches!(error.kind(), PointsErrorKind::TooMany { .. }),
            "{error}"
        );
        let error = white_noise(DOMAIN, u32::MAX, Seed(1)).unwrap_err();
        assert!(
            matches!(error.kind(), PointsErrorKind::TooMany { .. }),
            "{error}"
        );
        let flat = Domain::rectangle(DVec2::ZERO, DVec2::X);
        assert!(white_noise(flat, 1, Seed(1)).is_err(), "no area");
        assert!(
            jittered_grid(DOMAIN, [0, 5], 1.0, Seed(1))
                .unwrap()
                .is_empty(),
            "no cells"
        );
    }

    #[test]
    fn value_stability_uniform() {
        let noise = white_noise(DOMAIN, 3, Seed(7)).unwrap().positions()[2];
        assert_eq!(noise.x.to_bits(), 13831470301199039771);
        let grid = jittered_grid(DOMAIN, [2, 2], 1.0, Seed(7))
            .unwrap()
            .positions()[3];
        assert_eq!(grid.y.to_bits(), 4618182575496362104);
    }
}
