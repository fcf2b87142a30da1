//! Compares the basis over points placed by the caller with a brute-force search over all of them.

use dapple_hash::{Seed, hash1, unit_f64};
use dapple_worley::{Dimensions, FeatureSet, Metric, Space, Vector};

fn random<const N: usize>(seed: Seed, index: i64, extent: f64) -> [f64; N] {
    core::array::from_fn(|axis| extent * unit_f64(hash1(seed, [index], axis as u32)))
}

fn agrees_with_all_points<const N: usize>(n: i64, period: [Option<f64>; N], metric: Metric)
where
    Dimensions: Space<N>,
{
    let points: Vec<Vector<N>> = (0..n)
        .map(|index| random::<N>(Seed(1), index, 10.0).into())
        .collect();
    let set = FeatureSet::new(&points, period)
        .unwrap()
        .with_metric(metric)
        .unwrap();
    for index in 0..60 {
        let mut at = random::<N>(Seed(2), index, 30.0);
        at.iter_mut().for_each(|part| *part -= 10.0);
        let mut all = Vec::new();
        for (id, point) in points.iter().enumerate() {
            let point: [f64; N] = (*point).into();
            let images = 7_i64.pow(N as u32);
            for image in 0..images {
                let mut keep = true;
                let vector: [f64; N] = core::array::from_fn(|axis| {
                    let turn = image / 7_i64.pow(axis as u32) % 7 - 3;
                    keep &= turn == 0 || period[axis].is_some();
                    at[axis] - point[axis] - turn as f64 * period[axis].unwrap_or(0.0)
                });
                if keep {
                    all.push((metric.length(vector.map(|part| part as f32)), id as u64));
                }
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let found = set.sample::<4>(at);
        for (rank, feature) in found.iter().enumerate() {
            let Some(expected) = all.get(rank) else {
                assert_eq!(
                    (feature.distance, feature.id),
                    (f32::INFINITY, u64::MAX),
                    "no point is left, {n} points, {at:?}"
                );
                continue;
            };
            // The oracle takes its differences in another order, so they differ by the rounding of f64 and f32.
            assert!(
                (feature.distance - expected.0).abs() < 1e-5,
                "{n} points, {at:?}: {found:?}"
            );
        }
    }
}

#[test]
fn nearest_points_are_those_of_all_points() {
    for n in [0, 1, 2, 3, 50, 500] {
        agrees_with_all_points::<2>(n, [None, None], Metric::Euclidean);
        agrees_with_all_points::<2>(n, [Some(10.0), None], Metric::Manhattan);
        agrees_with_all_points::<2>(n, [Some(10.0), Some(12.5)], Metric::Chebyshev);
    }
    agrees_with_all_points::<3>(300, [None, Some(11.0), None], Metric::Euclidean);
    agrees_with_all_points::<4>(50, [None; 4], Metric::Minkowski(3.0));
}

#[test]
fn points_on_a_line_or_in_one_place_need_no_area() {
    let line: Vec<_> = (0..100)
        .map(|index| [f64::from(index), 3.0].into())
        .collect();
    let set = FeatureSet::<2>::new(&line, [None, None]).unwrap();
    assert_eq!(set.sample::<1>([41.25, 3.0])[0].distance, 0.25);
    let place = [[5.0, 5.0].into(); 9];
    let set = FeatureSet::<2>::new(&place, [None, None]).unwrap();
    assert_eq!(
        set.sample::<3>([5.0, 6.0]).map(|feature| feature.id),
        [0, 1, 2]
    );
    assert_eq!(set.sample::<1>([1e300, 0.0])[0].distance, f32::INFINITY);
}

#[test]
fn bad_points_and_periods_are_refused() {
    assert!(FeatureSet::<2>::new(&[[f64::NAN, 0.0].into()], [None, None]).is_err());
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            FeatureSet::<2>::new(&[], [Some(period), None]).is_err(),
            "{period}"
        );
    }
    let set = FeatureSet::<2>::new(&[[0.0, 0.0].into()], [None, None]).unwrap();
    assert!(set.sample::<1>([f64::NAN, 0.0])[0].distance.is_nan());
}
