//! Tests of measures of Voronoi cells against all feature points nearby.

use super::oracle::{brute_force_vectors, position};
use dapple_hash::Seed;
use dapple_worley::{Dimensions, Metric, Space, Worley};

/// Returns the distance from a position to the bisecting plane of two points, given the vectors from both points to
/// the position.
fn to_plane<const N: usize>(first: [f64; N], other: [f64; N]) -> f64 {
    let square = |way: [f64; N]| way.iter().map(|part| part * part).sum::<f64>();
    let between = core::array::from_fn(|axis| first[axis] - other[axis]);
    (square(other) - square(first)) / (2.0 * libm::sqrt(square(between)))
}

fn edges_agree<const N: usize>(samples: i64, reach: i64)
where
    Dimensions: Space<N>,
{
    let worley = Worley::<N>::new(Seed(5)).with_density(1.0).unwrap();
    for index in 0..samples {
        let at = position(Seed(1), index, 1e3);
        let all = brute_force_vectors(&worley, at, reach);
        let first = all[0].1;
        let planes = all[1..].iter().map(|(_, way)| to_plane(first, *way));
        let expected = planes.fold(f64::INFINITY, f64::min);
        let found = f64::from(worley.edge_distance(at));
        // Both are computed in f64 from exact vectors, and the result is rounded to f32.
        assert!(
            (found - expected).abs() <= 1e-7 * expected + 1e-12,
            "{at:?}: {found} for {expected}"
        );
    }
}

#[test]
fn edge_distance_is_that_of_all_planes() {
    edges_agree::<2>(300, 6);
    edges_agree::<3>(40, 4);
}

#[test]
fn sphere_touches_the_nearest_plane_of_its_point() {
    let worley = Worley::<2>::new(Seed(5))
        .with_metric(Metric::Euclidean)
        .unwrap();
    for index in 0..200 {
        let at = position::<2>(Seed(2), index, 1e3);
        let [first] = worley.sample::<1>(at);
        let way: [f64; 2] = first.vector.into();
        let point = [at[0] - way[0], at[1] - way[1]];
        let [own, other] = worley.sample::<2>(point);
        assert_eq!(own.distance, 0.0, "the point itself, from {at:?}");
        assert_eq!(worley.sphere_radius(at), 0.5 * other.distance, "{at:?}");
    }
}

#[test]
fn smooth_f1_lies_below_f1_and_solves_its_sum() {
    let worley = Worley::<2>::new(Seed(5));
    let mut apart = 0;
    for index in 0..300 {
        let at = position::<2>(Seed(3), index, 1e3);
        let [first, second] = worley.sample::<2>(at).map(|feature| feature.distance);
        let radius = 0.25;
        let smooth = worley.smooth_f1(at, radius).unwrap();
        assert!(
            smooth <= first && smooth >= first - radius,
            "{at:?}: {smooth} for {first}"
        );
        if second - first > radius {
            apart += 1;
            assert_eq!(smooth, first, "{at:?}");
        }
        let all = brute_force_vectors(&worley, at, 3);
        let parts = all.iter().map(|(distance, _)| {
            let part = (1.0 + (f64::from(smooth) - distance) / f64::from(radius)).max(0.0);
            part * part * part
        });
        // The slope of the sum is at most 3 / radius per point, and s is rounded to f32.
        let sum: f64 = parts.sum();
        assert!((sum - 1.0).abs() < 1e-5, "{at:?}: the sum is {sum}");
    }
    assert!(
        apart > 20,
        "only {apart} positions have one point within the radius"
    );
}

#[test]
fn positions_without_a_place_are_not_numbers() {
    let worley = Worley::<3>::new(Seed(5));
    for bad in [[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0]] {
        assert!(worley.edge_distance(bad).is_nan());
        assert!(worley.sphere_radius(bad).is_nan());
        assert!(worley.smooth_f1(bad, 0.5).unwrap().is_nan());
    }
    assert!(worley.smooth_f1([0.0; 3], 0.0).is_err());
    assert!(worley.smooth_f1([0.0; 3], f32::NAN).is_err());
}
