//! Tests of distances and neighbor counts against all pairs.

use crate::statistics::test_sets::{domains, random_set};
use crate::{Domain, PointSet};
use glam::DVec2;

fn pair_distances(set: &PointSet) -> Vec<f64> {
    let mut distances = Vec::new();
    for (a, from) in set.iter() {
        for (b, to) in set.iter() {
            if a != b {
                distances.push(set.domain().delta(from, to).length_squared().sqrt());
            }
        }
    }
    distances
}

#[test]
fn minimum_distance_equals_the_one_over_all_pairs() {
    for domain in domains() {
        for (n_points, crowding) in [(2, 1), (3, 1), (10, 1), (300, 1), (300, 4)] {
            let set = random_set(domain, n_points, crowding);
            let expected = pair_distances(&set)
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            assert_eq!(
                set.minimum_distance(),
                Some(expected),
                "{n_points} points in {domain:?}"
            );
        }
    }
}

#[test]
fn neighbor_counts_equal_those_over_all_pairs() {
    for domain in domains() {
        for (n_points, crowding) in [(1, 1), (2, 1), (200, 1), (200, 4)] {
            let set = random_set(domain, n_points, crowding);
            let distances = pair_distances(&set);
            for distance in [0.0, 0.02, 0.3, 1.0, 3.5, 1e9, f64::INFINITY] {
                let expected = distances.iter().filter(|&&d| d <= distance).count();
                assert_eq!(
                    set.mean_neighbor_count(distance),
                    expected as f64 / f64::from(n_points),
                    "{n_points} points, distance {distance}, in {domain:?}"
                );
            }
            assert_eq!(set.mean_neighbor_count(-1.0), 0.0, "a negative distance");
            assert_eq!(set.mean_neighbor_count(f64::NAN), 0.0, "a distance of NaN");
        }
    }
}

#[test]
fn small_sets_have_no_distances() {
    let empty = PointSet::new(Domain::paper_torus(), Vec::new()).unwrap();
    assert_eq!(empty.minimum_distance(), None);
    assert_eq!(empty.mean_neighbor_count(1.0), 0.0);
    let single = random_set(Domain::paper_torus(), 1, 1);
    assert_eq!(single.minimum_distance(), None);
    let twins = PointSet::new(Domain::paper_torus(), vec![DVec2::ZERO; 2]).unwrap();
    assert_eq!(twins.minimum_distance(), Some(0.0));
    assert_eq!(twins.mean_neighbor_count(0.0), 1.0);
}

#[test]
fn densities_of_a_square_lattice_are_known() {
    let positions = (0..16)
        .map(|i| DVec2::new(f64::from(i % 4), f64::from(i / 4)))
        .collect();
    let set = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::splat(4.0)), positions).unwrap();
    assert_eq!(set.normalized_density(1.0), 1.0);
    assert_eq!(set.packing_fraction(1.0), core::f64::consts::FRAC_PI_4);
    assert_eq!(set.mean_coverage(1.0), core::f64::consts::PI);
}
