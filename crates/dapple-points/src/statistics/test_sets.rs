//! Point sets for the tests of the statistics.

use crate::{Domain, PointSet};
use dapple_hash::{Seed, hash1, unit_f64};
use glam::DVec2;

/// Domains with every kind of wrapping, square and thin, far from the origin.
pub(super) fn domains() -> Vec<Domain> {
    let mut domains = Vec::new();
    for wrap in [[false, false], [true, false], [false, true], [true, true]] {
        for size in [DVec2::ONE, DVec2::new(7.0, 0.25)] {
            domains.push(Domain {
                origin: DVec2::new(-3.0, 100.0),
                size,
                wrap,
            });
        }
    }
    domains
}

/// Returns random positions; `crowding` above 1 concentrates them near the corner of the domain.
pub(super) fn random_set(domain: Domain, n_points: u32, crowding: i32) -> PointSet {
    let unit = |index| unit_f64(hash1(Seed(3), [i64::from(n_points)], index));
    let place = |index| (0..crowding).fold(1.0, |product, _| product * unit(index));
    let positions = (0..n_points)
        .map(|point| {
            domain.origin + domain.size * DVec2::new(place(2 * point), place(2 * point + 1))
        })
        .collect();
    PointSet::new(domain, positions).unwrap()
}
