//! Tests of positions whose nearest points are not all in the own cell and its neighbors.
//!
//! Points farther away than one cell are rare, so images seldom show whether they are missed. These tests search for
//! such positions, fail if there are none, and compare every sampling method with the oracle there.

use super::oracle::position;
use super::ways::{agrees_with_oracle, reach_of, sample_in_every_way};
use dapple_hash::Seed;
use dapple_worley::{Dimensions, Feature, Metric, Scatter, Space, Vector, Worley, WorleyError};

/// Returns how many cells a feature point is away, along the axis where it is farthest.
fn cells_away<const N: usize>(at: [f64; N], feature: &Feature<Vector<N>>) -> i64
where
    Dimensions: Space<N>,
{
    let vector: [f64; N] = feature.vector.into();
    let away = |axis: usize| ((at[axis] - vector[axis]).floor() - at[axis].floor()).abs() as i64;
    (0..N).map(away).max().unwrap_or(0)
}

/// Searches `n` positions for nearest points that are two or more cells away. Returns the number of such points for
/// each of F1 to F4. The first 25 positions found are checked.
fn count_far_points<const N: usize>(
    metric: Metric,
    scatter: Scatter,
    n: i64,
) -> Result<[u32; 4], WorleyError>
where
    Dimensions: Space<N>,
{
    let worley = Worley::<N>::new(Seed(51))
        .with_metric(metric)?
        .with_scatter(scatter)?;
    let reach = reach_of(&worley)?;
    let mut counts = [0; 4];
    let mut n_checked = 0;
    for index in 0..n {
        let at = position::<N>(Seed(52), index, 1e4);
        let found = worley.sample::<4>(Vector::<N>::from(at));
        let is_far = found.each_ref().map(|feature| cells_away(at, feature) > 1);
        for (count, is_far) in counts.iter_mut().zip(is_far) {
            *count += u32::from(is_far);
        }
        if is_far.contains(&true) && n_checked < 25 {
            n_checked += 1;
            let found = sample_in_every_way(&worley, at)?;
            agrees_with_oracle(&worley, at, reach, &found);
        }
    }
    Ok(counts)
}

const POISSON: Scatter = Scatter::Poisson { density: 3.0 };
const SPARSE: Scatter = Scatter::Poisson {
    density: 1.0 / 64.0,
};
const HOLES: Scatter = Scatter::Unclamped { density: 0.3 };
const JITTERED: Scatter = Scatter::Jittered { jitter: 1.0 };

#[test]
fn points_beyond_the_neighbors_are_found_in_the_plane() -> Result<(), WorleyError> {
    use Metric::{Chebyshev, Euclidean, Manhattan, Minkowski};
    // With the least rank that must occur: about as rare as one in 10^4.
    for (metric, scatter, least) in [
        (Euclidean, POISSON, 4),
        (Manhattan, POISSON, 2),
        (Manhattan, JITTERED, 1),
        (Euclidean, JITTERED, 2),
        (Chebyshev, JITTERED, 3),
        (Minkowski(3.0), JITTERED, 3),
        (Euclidean, SPARSE, 2),
        (Euclidean, HOLES, 1),
        (Manhattan, HOLES, 1),
        (Chebyshev, HOLES, 1),
        (Minkowski(1.5), HOLES, 1),
    ] {
        let counts = count_far_points::<2>(metric, scatter, 60_000)?;
        assert!(
            counts[least - 1..].iter().all(|&count| count > 0),
            "{metric:?} {scatter:?}: points beyond the neighbors are F1 to F4 {counts:?} times"
        );
        assert!(
            counts.is_sorted(),
            "{metric:?} {scatter:?}: {counts:?} do not grow"
        );
    }
    Ok(())
}

#[test]
fn points_beyond_the_neighbors_are_found_in_space() -> Result<(), WorleyError> {
    use Metric::{Chebyshev, Euclidean, Manhattan, Minkowski};
    for (metric, scatter, least) in [
        (Manhattan, POISSON, 3),
        (Manhattan, JITTERED, 2),
        (Euclidean, JITTERED, 3),
        (Chebyshev, HOLES, 3),
        (Euclidean, HOLES, 1),
        (Minkowski(1.25), HOLES, 1),
    ] {
        let counts = count_far_points::<3>(metric, scatter, 10_000)?;
        assert!(
            counts[least - 1..].iter().all(|&count| count > 0),
            "{metric:?} {scatter:?}: points beyond the neighbors are F1 to F4 {counts:?} times"
        );
    }
    Ok(())
}

#[test]
fn points_beyond_the_neighbors_are_found_in_four_dimensions() -> Result<(), WorleyError> {
    for (metric, scatter, least) in [
        (Metric::Manhattan, POISSON, 4),
        (Metric::Manhattan, HOLES, 2),
    ] {
        let counts = count_far_points::<4>(metric, scatter, 1500)?;
        assert!(
            counts[least - 1..].iter().all(|&count| count > 0),
            "{metric:?} {scatter:?}: points beyond the neighbors are F1 to F4 {counts:?} times"
        );
    }
    Ok(())
}

#[test]
fn points_many_cells_away_are_found_at_the_least_density() -> Result<(), WorleyError> {
    let scatter = Scatter::Unclamped {
        density: 1.0 / 64.0,
    };
    let mut furthest = 0;
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        let worley = Worley::<2>::new(Seed(53))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        for index in 0..12 {
            let at = position::<2>(Seed(54), index, 1e4);
            let found = sample_in_every_way(&worley, at)?;
            agrees_with_oracle(&worley, at, reach_of(&worley)?, &found);
            furthest = furthest.max(cells_away(at, &found[3]));
        }
    }
    assert!(furthest > 8, "the furthest point is {furthest} cells away");
    Ok(())
}

/// Searches for cells whose only point is within `corner` of a corner, and checks the opposite corner, where the own
/// cell does not help the search. Returns the number of cases in which the fourth point is beyond the neighbors.
fn far_corners_agree<const N: usize>(metric: Metric, corner: f64) -> Result<u32, WorleyError>
where
    Dimensions: Space<N>,
{
    let worley = Worley::<N>::new(Seed(55))
        .with_metric(metric)?
        .with_scatter(JITTERED)?;
    let mut n_checked = 0;
    let mut n_far = 0;
    for index in 0..20_000 {
        let cell = position::<N>(Seed(56), index, 1e4).map(f64::floor);
        let point = &worley.cell_points(cell.map(|part| part as i64))[0];
        let offset: [f64; N] = point.offset.into();
        let is_in_a_corner = offset.iter().all(|&part| (part - 0.5).abs() > 0.5 - corner);
        if !is_in_a_corner || n_checked == 150 {
            continue;
        }
        n_checked += 1;
        let at = core::array::from_fn(|axis| {
            let inside = 1.0 / 128.0;
            cell[axis]
                + if offset[axis] < 0.5 {
                    1.0 - inside
                } else {
                    inside
                }
        });
        let found = sample_in_every_way(&worley, at)?;
        agrees_with_oracle(&worley, at, reach_of(&worley)?, &found);
        n_far += u32::from(cells_away(at, &found[3]) > 1);
    }
    assert_eq!(n_checked, 150, "points in a far corner, with {metric:?}");
    Ok(n_far)
}

#[test]
fn points_in_far_corners_do_not_mislead_the_search() -> Result<(), WorleyError> {
    let euclidean = far_corners_agree::<2>(Metric::Euclidean, 0.05)?;
    let manhattan = far_corners_agree::<2>(Metric::Manhattan, 0.05)?;
    far_corners_agree::<2>(Metric::Chebyshev, 0.05)?;
    let euclidean = euclidean + far_corners_agree::<3>(Metric::Euclidean, 0.12)?;
    let manhattan = manhattan + far_corners_agree::<3>(Metric::Manhattan, 0.12)?;
    assert!(
        euclidean > 0 && manhattan > 0,
        "the fourth point is beyond the neighbors {euclidean} and {manhattan} times"
    );
    Ok(())
}
