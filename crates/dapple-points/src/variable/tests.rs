//! Tests of distances, gaps, density and determinism of sets with a varying radius, and of invalid input.

use super::leaf::{RadiusField, Tree};
use super::{DiskRule, VariablePoissonOptions, variable_poisson_disk};
use crate::{Domain, PointSet, PointsError, PointsErrorKind, RSA_DENSITY};
use core::f64::consts::TAU;
use dapple_hash::Seed;
use dapple_raster::{Ramp, Varying};
use glam::DVec2;

const RULES: [DiskRule; 3] = [DiskRule::Average, DiskRule::Larger, DiskRule::Smaller];

fn domain(wrap: [bool; 2]) -> Domain {
    Domain {
        origin: DVec2::new(-3.0, 10.0),
        size: DVec2::new(2.0, 1.0),
        wrap,
    }
}

/// Returns a geometric ramp from `start` on the left to `end` on the right of [`domain`].
fn ramp(start: f64, end: f64) -> Varying {
    let from = DVec2::new(-3.0, 10.0);
    let to = DVec2::new(-1.0, 10.0);
    Varying::GeometricRamp(Ramp {
        from,
        to,
        start,
        end,
    })
}

/// Returns a radius that is periodic along both axes of [`domain`], with slopes up to 0.5.
fn waves() -> Varying {
    Varying::function(|at| {
        let (x, y) = (libm::sin(TAU * at.x), libm::sin(TAU * at.y));
        0.05 * (1.3 + 0.9 * x * y)
    })
}

fn make(domain: Domain, radius: &Varying, rule: DiskRule, seed: u64) -> PointSet {
    let options = VariablePoissonOptions {
        rule,
        ..Default::default()
    };
    variable_poisson_disk(domain, radius, &options, Seed(seed)).unwrap()
}

fn error(domain: Domain, radius: &Varying) -> PointsError {
    variable_poisson_disk(domain, radius, &Default::default(), Seed(1)).unwrap_err()
}

/// Returns the minimum over all pairs of the distance relative to the distance that the rule requires.
fn closest_pair(set: &PointSet, radius: &Varying, rule: DiskRule) -> f64 {
    let radii: Vec<f64> = set.positions().iter().map(|&at| radius.at(at)).collect();
    let mut closest = f64::INFINITY;
    for (a, from) in set.iter() {
        for (b, to) in set.iter().skip(a.index() + 1) {
            let distance = set.domain().delta(from, to).length_squared().sqrt();
            closest = closest.min(distance / rule.distance(radii[a.index()], radii[b.index()]));
        }
    }
    closest
}

/// Returns the maximum over all positions, found on a dense lattice and refined, of the distance to the points
/// relative to the distance that the rule requires.
fn emptiest_place(set: &PointSet, radius: &Varying, rule: DiskRule) -> f64 {
    let radii: Vec<f64> = set.positions().iter().map(|&at| radius.at(at)).collect();
    let domain = set.domain();
    let freedom = |place: DVec2| {
        let place = domain.wrap(place).clamp(domain.origin, domain.end());
        let here = radius.at(place);
        let ratios = set.positions().iter().zip(&radii).map(|(&at, &there)| {
            let delta = domain.delta(at, place);
            delta.length_squared().sqrt() / rule.distance(here, there)
        });
        ratios.fold(f64::INFINITY, f64::min)
    };
    let step = domain.size / DVec2::new(96.0, 48.0);
    let lattice = (0..96 * 48)
        .map(|i| domain.origin + step * DVec2::new(f64::from(i % 96), f64::from(i / 96)));
    let mut places: Vec<(f64, DVec2)> = lattice.map(|place| (freedom(place), place)).collect();
    places.sort_by(|a, b| b.0.total_cmp(&a.0));
    places.truncate(24);
    let climb = |&(mut best, mut place): &(f64, DVec2)| {
        let mut step = step;
        for _ in 0..30 {
            let mut is_better = false;
            for way in [
                DVec2::X,
                DVec2::Y,
                -DVec2::X,
                -DVec2::Y,
                DVec2::ONE,
                -DVec2::ONE,
            ] {
                let there = freedom(place + step * way);
                if there > best {
                    (best, place, is_better) = (there, place + step * way, true);
                }
            }
            if !is_better {
                step *= 0.5;
            }
        }
        best
    };
    places.iter().map(climb).fold(0.0, f64::max)
}

#[test]
fn variable_disks_keep_their_distance_and_leave_no_room() {
    for wrap in [[false, false], [true, false], [false, true], [true, true]] {
        for rule in RULES {
            for (name, radius) in [
                ("constant", 0.06.into()),
                ("waves", waves()),
                ("ramp", ramp(0.03, 0.24)),
                (
                    "steep ramp",
                    Varying::function(|at| 0.02 + 0.45 * (at.x + 3.0) * (at.x + 3.0) * 0.25),
                ),
            ] {
                let set = make(domain(wrap), &radius, rule, 5);
                let closest = closest_pair(&set, &radius, rule);
                // Coordinates near 10 are rounded by 2e-15; radii are at least 0.02.
                assert!(
                    closest >= 1.0 - 1e-12,
                    "{name}, {rule:?}, {wrap:?}: two of {} points are {closest} of their distance apart",
                    set.len()
                );
                let emptiest = emptiest_place(&set, &radius, rule);
                // The documented tolerance
                assert!(
                    emptiest < 1.0 + 1e-6,
                    "{name}, {rule:?}, {wrap:?}: there is room of {emptiest} beside {} points",
                    set.len()
                );
            }
        }
    }
}

#[test]
fn large_radii_leave_a_single_point() {
    let plane = domain([false, false]);
    for radius in [3.0, 1e6, 1e300] {
        assert_eq!(
            make(plane, &radius.into(), DiskRule::Average, 1).len(),
            1,
            "radius {radius}"
        );
    }
}

#[test]
fn tiny_and_huge_units_give_the_same_picture() {
    let at_scale = |scale: f64| {
        let domain = Domain::torus(DVec2::ZERO, DVec2::splat(scale));
        make(domain, &(scale / 16.0).into(), DiskRule::Average, 3)
    };
    let unit = at_scale(1.0);
    for exponent in [-200, -60, 60, 200] {
        let scale = libm::ldexp(1.0, exponent);
        let scaled: Vec<DVec2> = at_scale(scale)
            .positions()
            .iter()
            .map(|&at| at / scale)
            .collect();
        assert_eq!(scaled, unit.positions(), "scale 2^{exponent}");
    }
}

#[test]
fn value_stability_variable_poisson_disk() {
    let set = make(
        domain([false, true]),
        &ramp(0.02, 0.16),
        DiskRule::Average,
        7,
    );
    let sum = set.positions().iter().sum::<DVec2>();
    assert_eq!(set.len(), 835);
    assert_eq!(
        sum.to_array().map(f64::to_bits),
        [13880266888175132495, 4666044230823999975]
    );
    assert_eq!(
        set.positions()[100].to_array().map(f64::to_bits),
        [13836822501338237467, 4622035698459658779]
    );
}

#[cfg(feature = "rayon")]
#[test]
fn variable_sets_are_the_same_for_any_number_of_threads() {
    let on_threads = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        pool.install(|| {
            make(
                domain([false, true]),
                &ramp(0.003, 0.02),
                DiskRule::Average,
                7,
            )
        })
    };
    let single = on_threads(1);
    for n_threads in [2, 7] {
        assert_eq!(on_threads(n_threads), single, "{n_threads} threads");
    }
}

/// Returns the number of points relative to the prediction 0.697 / r², in the part of the domain with x in
/// `from..to`.
fn relative_density(radius: &Varying, from: f64, to: f64) -> f64 {
    let (mut n_points, mut expected) = (0.0, 0.0);
    for seed in 0..20 {
        let set = make(domain([false, true]), radius, DiskRule::Average, seed);
        n_points += set
            .iter()
            .filter(|(_, at)| (from..to).contains(&at.x))
            .count() as f64;
        let n_steps = 1000;
        for step in 0..n_steps {
            let share = (f64::from(step) + 0.5) / f64::from(n_steps);
            let r = radius.at(DVec2::new(from + (to - from) * share, 10.5));
            expected += RSA_DENSITY / (r * r) * (to - from) / f64::from(n_steps);
        }
    }
    n_points / expected
}

#[test]
fn local_density_follows_the_radius() {
    // From 0.01 to 0.08 the slope is at most 0.083, and 0.06 in the middle of the measured part.
    let ratio = relative_density(&ramp(0.01, 0.08), -2.8, -1.4);
    // 12000 points per set and 20 sets: the noise is below 0.3 %.
    assert!(
        (ratio - 1.0).abs() < 0.03,
        "gentle slopes have {ratio} of the density"
    );
    let steep = Varying::function(|at| 0.01 + 0.35 * (at.x + 2.9).clamp(0.0, 0.4));
    let ratio = relative_density(&steep, -2.88, -2.52);
    // 600 points per set on the slope.
    assert!(
        (ratio - 1.0).abs() < 0.05,
        "slopes of 0.35 have {ratio} of the density"
    );
}

#[test]
fn estimated_numbers_of_points_agree_with_the_sets() {
    let domain = domain([false, true]);
    for density in [ramp(1.0, 64.0), ramp(5.0, 5.0)] {
        let radius = super::radius_for_count(domain, &density, 5000.0).unwrap();
        let set = make(domain, &radius, DiskRule::Average, 1);
        // Both ends of the cylinder have room for some additional points.
        assert!(
            (set.len() as f64 / 5000.0 - 1.0).abs() < 0.02,
            "there are {} points",
            set.len()
        );
        let by_density = super::radius_from_density(&Varying::function(move |at| density.at(at)));
        assert!(
            by_density.at(domain.origin) > 0.0,
            "the radius is not above zero"
        );
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = super::radius_for_count(domain, &1.0.into(), bad).unwrap_err();
        assert!(
            matches!(refused.kind(), PointsErrorKind::NotPositive { .. }),
            "{refused}"
        );
        let refused = super::radius_for_count(domain, &bad.into(), 10.0).unwrap_err();
        assert!(
            matches!(refused.kind(), PointsErrorKind::NotPositive { .. }),
            "{refused}"
        );
    }
}

#[test]
fn bad_radii_are_refused_with_their_place() {
    let torus = domain([true, true]);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let hole = Varying::function(move |at| if at.x > -1.5 { bad } else { 0.1 });
        for radius in [bad.into(), hole] {
            let refused = error(torus, &radius);
            assert!(
                matches!(refused.kind(), PointsErrorKind::Radius { .. }),
                "{bad}: {refused}"
            );
        }
    }
    for slope in [1.0, 1.5, 40.0] {
        let steep = Varying::function(move |at| 0.01 + slope * (at.y - 10.0));
        let refused = error(domain([false, false]), &steep);
        assert!(
            matches!(refused.kind(), PointsErrorKind::TooSteep { .. }),
            "{slope}: {refused}"
        );
    }
    let refused = error(torus, &0.51.into());
    assert_eq!(
        refused.to_string(),
        "axis 1 wraps around after 1, but it must reach over two radii of 0.51"
    );
    assert!(
        make(torus, &0.5.into(), DiskRule::Average, 1).len() > 1,
        "two radii fit"
    );
}

#[test]
fn sets_past_the_limit_are_refused_before_they_are_made() {
    let square = Domain::torus(DVec2::ZERO, DVec2::ONE);
    for radius in [1e-4, 1e-9, 1e-150, f64::MIN_POSITIVE] {
        let refused = error(square, &radius.into());
        assert!(
            matches!(refused.kind(), PointsErrorKind::TooMany { .. }),
            "{radius}: {refused}"
        );
        let refused = error(square, &Varying::function(move |_| radius));
        assert!(
            matches!(refused.kind(), PointsErrorKind::TooMany { .. }),
            "{radius}: {refused}"
        );
    }
}

#[test]
fn radii_that_jump_end_with_points_or_an_error() {
    let jumpy = [
        Varying::function(|at| if at.x < -2.0 { 0.02 } else { 0.021 }),
        Varying::function(|at| {
            if libm::sin(at.x * 1e4) > 0.0 {
                0.05
            } else {
                0.06
            }
        }),
        Varying::function(|at| 0.05 + 0.01 * libm::sin(at.x * 12345.0 + at.y * 777.0)),
    ];
    for (number, radius) in jumpy.iter().enumerate() {
        let options = VariablePoissonOptions::default();
        match variable_poisson_disk(domain([false, true]), radius, &options, Seed(1)) {
            Ok(set) => {
                let closest = closest_pair(&set, radius, DiskRule::Average);
                assert!(closest >= 1.0 - 1e-12, "radius {number}: {closest}");
            }
            Err(refused) => assert!(
                matches!(refused.kind(), PointsErrorKind::TooSteep { .. }),
                "radius {number}: {refused}"
            ),
        }
    }
}

#[test]
fn leaves_cover_the_domain_with_their_radii() {
    let domain = domain([false, true]);
    let radius = ramp(0.003, 0.02);
    let tree = Tree::new(
        RadiusField {
            domain: &domain,
            radius: &radius,
            rise: 0.1,
        },
        1 << 24,
        &|| false,
    )
    .unwrap();
    let area: f64 = tree
        .leaves
        .iter()
        .map(|leaf| leaf.size.x * leaf.size.y)
        .sum();
    assert!(
        (area / domain.area() - 1.0).abs() < 1e-12,
        "the leaves have area {area}"
    );
    for leaf in &tree.leaves {
        let cell = leaf.size / DVec2::new(f64::from(leaf.cells[0]), f64::from(leaf.cells[1]));
        assert!(
            cell.length() <= leaf.radii.least,
            "the cells of {leaf:?} are too large"
        );
        for place in 0..100 {
            let share = DVec2::new(f64::from(place % 10), f64::from(place / 10)) / 9.0;
            let here = radius.at(domain.origin + leaf.min + leaf.size * share);
            assert!(
                leaf.radii.least <= here && here <= leaf.radii.most,
                "{here} is not in {leaf:?}"
            );
        }
    }
}
