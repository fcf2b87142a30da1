//! The oracle: F1 to F4 by sorting all points of a wide neighborhood.

use dapple_hash::{Seed, hash1, unit_f64};
use dapple_worley::{Dimensions, Metric, Scatter, Space, Worley, WorleyError};

/// Returns all feature points within `reach` cells as distances and ids in double precision, nearest first.
pub(super) fn brute_force<const N: usize>(
    worley: &Worley<N>,
    position: [f64; N],
    reach: i64,
) -> Vec<(f64, u64)>
where
    Dimensions: Space<N>,
{
    let mut found: Vec<_> = vectors(worley, position, reach)
        .into_iter()
        .map(|(vector, id)| (length(worley.metric(), vector), id))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Returns the vectors from all feature points within `reach` cells, and their ids.
pub(super) fn vectors<const N: usize>(
    worley: &Worley<N>,
    position: [f64; N],
    reach: i64,
) -> Vec<([f64; N], u64)>
where
    Dimensions: Space<N>,
{
    let base = position.map(|part| part.floor() as i64);
    let side = 2 * reach + 1;
    let mut found = Vec::new();
    for index in 0..side.pow(N as u32) {
        let shift: [i64; N] =
            core::array::from_fn(|axis| index / side.pow(axis as u32) % side - reach);
        for point in worley.cell_points(core::array::from_fn(|axis| base[axis] + shift[axis])) {
            let offset: [f64; N] = point.offset.into();
            let vector = core::array::from_fn(|axis| {
                (position[axis] - base[axis] as f64) - (offset[axis] + shift[axis] as f64)
            });
            found.push((vector, point.id));
        }
    }
    found
}

fn length<const N: usize>(metric: Metric, vector: [f64; N]) -> f64 {
    let parts = vector.map(f64::abs);
    match metric {
        Metric::Euclidean => libm::sqrt(parts.iter().map(|part| part * part).sum()),
        Metric::Manhattan => parts.iter().sum(),
        Metric::Chebyshev => parts.into_iter().fold(0.0, f64::max),
        Metric::Minkowski(p) => {
            let p = f64::from(p);
            libm::pow(parts.iter().map(|&part| libm::pow(part, p)).sum(), 1.0 / p)
        }
        other => panic!("the oracle does not know {other:?}"),
    }
}

/// All metrics without an exponent, and Minkowski's metric with two exponents.
pub(super) const METRICS: [Metric; Metric::NAMED.len() + 2] = {
    let mut metrics = [Metric::Minkowski(10.0); Metric::NAMED.len() + 2];
    let mut at = 0;
    while at < Metric::NAMED.len() {
        metrics[at] = Metric::NAMED[at].1;
        at += 1;
    }
    metrics[at] = Metric::Minkowski(3.0);
    metrics
};

pub(super) const SCATTERS: [Scatter; 6] = [
    Scatter::Poisson { density: 3.0 },
    Scatter::Poisson { density: 0.1 },
    Scatter::Unclamped { density: 2.0 },
    Scatter::Unclamped { density: 0.3 },
    Scatter::Jittered { jitter: 1.0 },
    Scatter::Jittered { jitter: 0.3 },
];

/// Returns all feature points within `reach` cells in the Euclidean metric as distances and vectors, nearest first.
pub(super) fn brute_force_vectors<const N: usize>(
    worley: &Worley<N>,
    position: [f64; N],
    reach: i64,
) -> Vec<(f64, [f64; N])>
where
    Dimensions: Space<N>,
{
    let mut found: Vec<_> = vectors(worley, position, reach)
        .into_iter()
        .map(|(vector, _)| (length(Metric::Euclidean, vector), vector))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Returns a random position whose coordinates, in cells, are multiples of 2^-21, so that nothing is rounded.
pub(super) fn position<const N: usize>(seed: Seed, index: i64, spread: f64) -> [f64; N] {
    core::array::from_fn(|axis| {
        let unit = unit_f64(hash1(seed.child("position", axis as u64), [index], 0));
        let steps = (unit - 0.5) * spread * f64::from(1 << 21);
        steps.floor() / f64::from(1 << 21)
    })
}

fn agrees_with_brute_force<const N: usize>(samples: i64, reach: i64) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    for (metric, scatter) in METRICS.iter().flat_map(|&m| SCATTERS.map(|s| (m, s))) {
        let seed = Seed(5);
        let worley = Worley::<N>::new(seed)
            .with_metric(metric)?
            .with_scatter(scatter)?;
        for index in 0..samples {
            let at = position(seed, index, 1e3);
            let expected = brute_force(&worley, at, reach);
            let found = worley.sample::<4>(at);
            for (n, (feature, (distance, id))) in found.iter().zip(expected).enumerate() {
                // Keys are rounded a few times, and their roots once; powers are good to about 1e-6.
                let gap = (f64::from(feature.distance) - distance).abs();
                assert!(
                    gap <= 2e-6 * distance,
                    "F{} of {metric:?} {scatter:?} at {at:?}: {} for {distance}",
                    n + 1,
                    feature.distance
                );
                assert_eq!(
                    feature.id,
                    id,
                    "F{} of {metric:?} {scatter:?} at {at:?}",
                    n + 1
                );
            }
        }
    }
    Ok(())
}

#[test]
fn nearest_points_are_those_of_brute_force() -> Result<(), WorleyError> {
    agrees_with_brute_force::<2>(200, 9)?;
    agrees_with_brute_force::<3>(30, 6)?;
    agrees_with_brute_force::<4>(3, 4)
}
