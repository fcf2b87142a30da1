//! Tests of the largest empty circle against all positions of a lattice, and against known circles of a few points.

use crate::statistics::test_sets::{domains, random_set};
use crate::{Domain, PointSet};
use glam::DVec2;

/// Returns the distance from a position to the nearest point, by brute force.
fn distance_at(set: &PointSet, place: DVec2) -> f64 {
    let squared = set
        .positions()
        .iter()
        .map(|&position| set.domain().delta(place, position).length_squared());
    squared.fold(f64::INFINITY, f64::min).sqrt()
}

#[test]
fn no_place_is_farther_than_the_radius_and_the_center_is_that_far() {
    for domain in domains() {
        for (n_points, crowding) in [(1, 1), (2, 1), (3, 1), (17, 1), (200, 1), (200, 4)] {
            let set = random_set(domain, n_points, crowding);
            let circle = set.largest_empty_circle().unwrap();
            assert!(
                domain.contains(circle.center),
                "{circle:?} is centered outside"
            );
            // The domain is near 100, where a center is rounded by 2e-14.
            let reached = distance_at(&set, circle.center);
            assert!(
                (reached - circle.radius).abs() < 1e-12,
                "the center of {circle:?} is {reached} from {n_points} points in {domain:?}"
            );
            let side = 60;
            for place in 0..=side * side {
                let fraction = DVec2::new(f64::from(place % side), f64::from(place / side));
                let place = domain.origin + domain.size * fraction / f64::from(side);
                let distance = distance_at(&set, domain.wrap(place));
                assert!(
                    distance <= circle.radius + 1e-12,
                    "{place} is {distance} from {n_points} points in {domain:?}: {circle:?}"
                );
            }
        }
    }
}

#[test]
fn empty_circle_of_few_points_is_known() {
    let torus = Domain::torus(DVec2::ZERO, DVec2::new(8.0, 6.0));
    let empty = PointSet::new(torus, Vec::new()).unwrap();
    assert_eq!(empty.largest_empty_circle(), None);
    let twins = PointSet::new(torus, vec![DVec2::ONE; 2]).unwrap();
    assert_eq!(twins.largest_empty_circle().unwrap().radius, 5.0);
    let rectangle = PointSet::new(
        Domain {
            wrap: [false; 2],
            ..torus
        },
        vec![DVec2::ZERO],
    )
    .unwrap();
    let circle = rectangle.largest_empty_circle().unwrap();
    assert_eq!((circle.center, circle.radius), (DVec2::new(8.0, 6.0), 10.0));
}

#[test]
fn empty_circle_of_a_lattice_is_at_the_cell_centers() {
    let positions = (0..64)
        .map(|i| DVec2::new(f64::from(i % 8), f64::from(i / 8)))
        .collect();
    let set = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::splat(8.0)), positions).unwrap();
    assert_eq!(set.largest_empty_circle().unwrap().radius, 0.5_f64.sqrt());
}

#[test]
fn value_stability_empty_circle_and_minimum_distance() {
    let set = random_set(Domain::paper_torus(), 100, 1);
    let circle = set.largest_empty_circle().unwrap();
    assert_eq!(
        circle.center.to_array().map(f64::to_bits),
        [13829594496493087618, 13819796123644757500]
    );
    assert_eq!(circle.radius.to_bits(), 4599090453264265080);
    assert_eq!(
        set.minimum_distance().unwrap().to_bits(),
        4579146080416364689
    );
}

#[test]
fn thin_domains_do_not_take_forever() {
    for wrap in [[true, true], [false, true], [true, false], [false, false]] {
        let size = DVec2::new(1.0, 1e-12);
        let domain = Domain {
            origin: DVec2::ZERO,
            size,
            wrap,
        };
        let circle = random_set(domain, 50, 1).largest_empty_circle().unwrap();
        // Half of the widest gap between points, or all of a gap at an open end.
        assert!(
            circle.radius > 0.01 && circle.radius < 1.0,
            "{circle:?} in {domain:?}"
        );
    }
}
