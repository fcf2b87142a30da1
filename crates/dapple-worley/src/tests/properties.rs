//! What holds for every metric, scatter, period and seed.

use super::doors::{agrees_with_oracle, reach_of, sample_by_every_door};
use crate::{Axes, Metric, Scatter, Space, Vector, Worley};
use dapple_hash::Seed;
use proptest::prelude::*;
use std::collections::BTreeSet;

fn any_metric() -> impl Strategy<Value = Metric> {
    prop_oneof![
        Just(Metric::Euclidean),
        Just(Metric::Manhattan),
        Just(Metric::Chebyshev),
        (1.0_f32..=10.0).prop_map(Metric::Minkowski),
    ]
}

fn any_scatter() -> impl Strategy<Value = Scatter> {
    prop_oneof![
        Just(Scatter::default()),
        (1.0 / 64.0..10.0).prop_map(|density| Scatter::Poisson { density }),
        (0.25..10.0).prop_map(|density| Scatter::Unclamped { density }),
        (0.0..=1.0).prop_map(|jitter| Scatter::Jittered { jitter }),
        // A regular grid, with many points at the same distance.
        Just(Scatter::Jittered { jitter: 0.0 }),
    ]
}

fn any_period<const N: usize>() -> impl Strategy<Value = [Option<u32>; N]> {
    proptest::array::uniform(proptest::option::of(prop_oneof![1_u32..=6, Just(1000)]))
}

fn any_worley<const N: usize>() -> impl Strategy<Value = Worley<N>>
where
    Axes: Space<N>,
{
    (any::<u64>(), any_metric(), any_scatter(), any_period::<N>()).prop_map(
        |(seed, metric, scatter, period)| {
            let worley = Worley::new(Seed(seed)).with_metric(metric).unwrap();
            worley
                .with_scatter(scatter)
                .unwrap()
                .with_period(period)
                .unwrap()
        },
    )
}

/// Multiples of 2^-21, near and up to 2^29 away, so that nothing is rounded; now and then corners of cells.
fn any_position<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    let cell = prop_oneof![-8_i64..8, -(1_i64 << 29)..1 << 29];
    let steps = prop_oneof![0_i64..1 << 21, Just(0), Just(1 << 20), Just((1 << 21) - 1)];
    proptest::array::uniform(
        (cell, steps).prop_map(|(cell, steps)| cell as f64 + steps as f64 / f64::from(1 << 21)),
    )
}

fn cases(cases: u32) -> ProptestConfig {
    let default = ProptestConfig::default();
    // More, if more are asked for.
    let more = default.cases / 256;
    ProptestConfig {
        cases: cases * more.max(1),
        failure_persistence: None,
        ..default
    }
}

fn doors_agree<const N: usize>(
    worley: &Worley<N>,
    at: [f64; N],
    oracle: bool,
) -> Result<(), TestCaseError>
where
    Axes: Space<N>,
{
    let found = sample_by_every_door(worley, at).unwrap();
    if oracle {
        agrees_with_oracle(worley, at, reach_of(worley).unwrap(), &found);
    }
    prop_assert!(
        found.is_sorted_by(|a, b| a.distance <= b.distance),
        "not in order"
    );
    Ok(())
}

/// Moves by periods along every combination of axes; everything is the same there, to the last bit.
fn repeats<const N: usize>(
    worley: &Worley<N>,
    period: [Option<u32>; N],
    at: [f64; N],
    turns: i64,
) -> Result<(), TestCaseError>
where
    Axes: Space<N>,
{
    let expected = worley.sample::<4>(Vector::<N>::from(at));
    for axes in 1..1 << N {
        let moved = core::array::from_fn(|axis| match period[axis] {
            Some(period) if axes >> axis & 1 == 1 => at[axis] + turns as f64 * f64::from(period),
            _ => at[axis],
        });
        let found = worley.sample::<4>(Vector::<N>::from(moved));
        prop_assert_eq!(found, expected, "{:?} and {:?}: {:?}", at, moved, worley);
    }
    Ok(())
}

/// The ids of all points of the cells from `first` on, as many as a period has; in order.
fn ids_of_a_period<const N: usize>(
    worley: &Worley<N>,
    period: [u32; N],
    first: [i64; N],
) -> Vec<u64>
where
    Axes: Space<N>,
{
    let mut ids = Vec::new();
    let n_cells: u32 = period.iter().product();
    for index in 0..n_cells {
        let mut rest = index;
        let cell = core::array::from_fn(|axis| {
            let part = rest % period[axis];
            rest /= period[axis];
            first[axis] + i64::from(part)
        });
        ids.extend(worley.cell_points(cell).iter().map(|point| point.id));
    }
    ids.sort_unstable();
    ids
}

/// The points of 3 × 3 cells, as offsets.
fn points_about(worley: &Worley<2>, [x, y]: [i64; 2]) -> Vec<[f64; 2]> {
    let cells = (0..9).map(|index| [x + index % 3, y + index / 3]);
    let points = cells.flat_map(|cell| worley.cell_points(cell));
    points.map(|point| point.offset.to_array()).collect()
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn doors_agree_in_the_plane(worley in any_worley::<2>(), at in any_position::<2>()) {
        doors_agree(&worley, at, true)?;
    }

    #[test]
    fn pattern_repeats_exactly_after_its_period_in_the_plane(
        worley in any_worley::<2>(),
        period in any_period::<2>(),
        at in any_position::<2>(),
        turns in -1000_i64..1000,
    ) {
        let worley = worley.with_period(period).unwrap();
        repeats(&worley, period, at, turns)?;
    }

    #[test]
    fn ids_of_a_period_are_the_same_from_anywhere(
        worley in any_worley::<2>(),
        period in [1_u32..7, 1_u32..7],
        first in proptest::array::uniform2(-1_000_000_i64..1_000_000),
        at in any_position::<2>(),
    ) {
        let worley = worley.with_period(period.map(Some)).unwrap();
        let ids = ids_of_a_period(&worley, period, [0, 0]);
        prop_assert_eq!(&ids_of_a_period(&worley, period, first), &ids, "from {:?}", first);
        prop_assert!(ids.is_sorted_by(|a, b| a < b), "an id comes twice within a period");
        for feature in worley.sample::<4>(at) {
            prop_assert!(ids.contains(&feature.id), "{:#x} is none of the period", feature.id);
        }
    }

    #[test]
    fn cell_points_lie_in_their_cell_and_are_as_many_as_clamped(
        seed: u64,
        density in 1.0 / 64.0..=64.0,
        cell: [i64; 2],
        far: [i32; 4],
    ) {
        let worley = Worley::<2>::new(Seed(seed)).with_density(density).unwrap();
        let space = Worley::<4>::new(Seed(seed)).with_density(density).unwrap();
        // Neighbors of cells must be whole numbers too.
        let points = worley.cell_points(cell.map(|part| part / 2));
        prop_assert!((1..=9).contains(&points.len()), "{} points", points.len());
        for point in points {
            let offset = point.offset.to_array();
            prop_assert!(offset.iter().all(|part| (0.0..1.0).contains(part)), "{:?}", offset);
        }
        let points = space.cell_points(far.map(i64::from));
        prop_assert!((1..=9).contains(&points.len()), "{} points", points.len());
        for point in points {
            let offset = point.offset.to_array();
            prop_assert!(offset.iter().all(|part| (0.0..1.0).contains(part)), "{:?}", offset);
        }
    }

    #[test]
    fn jittered_cells_have_one_point_that_leaves_the_middle_by_the_jitter(
        seed: u64,
        jitter in 0.0..=1.0,
        cell: [i32; 3],
    ) {
        let scatter = Scatter::Jittered { jitter };
        let worley = Worley::<3>::new(Seed(seed)).with_scatter(scatter).unwrap();
        let points = worley.cell_points(cell.map(i64::from));
        prop_assert_eq!(points.len(), 1);
        for part in points[0].offset.to_array() {
            // The jitter is rounded to a multiple of 1/1024, and the offset to a step.
            prop_assert!((part - 0.5).abs() <= jitter / 2.0 + 0.0005, "{} for jitter {}", part, jitter);
        }
    }

    #[test]
    fn pattern_is_another_after_whole_cells_without_a_period(
        seed: u64,
        cell in proptest::array::uniform2(-1_000_000_000_i64..1_000_000_000),
        shift in proptest::array::uniform2(-1_000_000_i64..1_000_000),
    ) {
        prop_assume!(shift != [0, 0]);
        let worley = Worley::<2>::new(Seed(seed));
        let moved = [cell[0] + shift[0], cell[1] + shift[1]];
        prop_assert_ne!(points_about(&worley, cell), points_about(&worley, moved));
    }

    #[test]
    fn pattern_is_another_with_another_seed(
        seed: u64,
        other in prop_oneof![any::<u64>(), Just(0), Just(1)],
        bit in 0_u32..64,
        cell in proptest::array::uniform2(-1_000_000_000_i64..1_000_000_000),
    ) {
        let worley = Worley::<2>::new(Seed(seed));
        for other in [other, seed ^ 1 << bit, seed.wrapping_add(1)] {
            prop_assume!(other != seed);
            let changed = worley.with_seed(Seed(other));
            prop_assert_ne!(points_about(&worley, cell), points_about(&changed, cell));
            let ids = [&worley, &changed].map(|worley| worley.sample::<1>(cell.map(|part| part as f64))[0].id);
            prop_assert_ne!(ids[0], ids[1]);
        }
    }

    #[test]
    fn seeded_bases_are_those_that_began_with_the_seed(
        worley in any_worley::<2>(),
        seed: u64,
        at in any_position::<2>(),
    ) {
        let anew = Worley::<2>::new(Seed(seed))
            .with_metric(worley.metric())
            .and_then(|anew| anew.with_scatter(worley.scatter()))
            .unwrap();
        let changed = worley.with_seed(Seed(seed)).with_period([None, None]).unwrap();
        prop_assert_eq!(changed.sample::<4>(at), anew.sample::<4>(at));
    }
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn doors_agree_in_space(worley in any_worley::<3>(), at in any_position::<3>()) {
        doors_agree(&worley, at, true)?;
    }

    #[test]
    fn pattern_repeats_exactly_after_its_period_in_space(
        worley in any_worley::<3>(),
        period in any_period::<3>(),
        at in any_position::<3>(),
        turns in -1000_i64..1000,
    ) {
        let worley = worley.with_period(period).unwrap();
        repeats(&worley, period, at, turns)?;
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn doors_agree_in_four_dimensions(worley in any_worley::<4>(), at in any_position::<4>()) {
        doors_agree(&worley, at, false)?;
    }

    #[test]
    fn pattern_repeats_exactly_after_its_period_in_four_dimensions(
        worley in any_worley::<4>(),
        period in any_period::<4>(),
        at in any_position::<4>(),
        turns in -1000_i64..1000,
    ) {
        let worley = worley.with_period(period).unwrap();
        repeats(&worley, period, at, turns)?;
    }
}

#[test]
fn repeats_of_a_period_of_one_are_points_of_their_own_with_one_id() {
    let worley = Worley::<2>::new(Seed(61))
        .with_scatter(Scatter::Jittered { jitter: 1.0 })
        .and_then(|worley| worley.with_period([Some(1), Some(1)]))
        .unwrap();
    let point = &worley.cell_points([0, 0])[0];
    let at = [17.25, -3.5];
    let found = sample_by_every_door(&worley, at).unwrap();
    assert!(
        found.iter().all(|feature| feature.id == point.id),
        "{found:?}"
    );
    // The four nearest repeats of the one point.
    let offset = point.offset.to_array();
    let mut distances = Vec::new();
    for index in 0..25 {
        let [x, y] = [
            f64::from(index % 5 - 2) + offset[0] - 0.25,
            f64::from(index / 5 - 2) + offset[1] - 0.5,
        ];
        distances.push((x * x + y * y).sqrt());
    }
    distances.sort_by(f64::total_cmp);
    for (feature, distance) in found.iter().zip(distances) {
        // A square and its root are rounded, to 24 bits.
        assert!(
            (f64::from(feature.distance) - distance).abs() < 1e-6,
            "{feature:?} for {distance}"
        );
    }
}

#[test]
fn ids_come_once_in_a_block_of_cells() {
    // Were ids of 64 bits drawn at random, two of these 400 000 would agree with a probability of 4e-9.
    let mut seen = BTreeSet::new();
    let mut n_points = 0;
    let mut add = |id| {
        n_points += 1;
        seen.insert(id);
    };
    let plane = Worley::<2>::new(Seed(62));
    for index in 0..200 * 200 {
        let points = plane.cell_points([index % 200 - 100, index / 200 - 100]);
        points.iter().for_each(|point| add(point.id));
    }
    let other = plane.with_seed(Seed(63));
    for index in 0..200 * 200 {
        let points = other.cell_points([index % 200 - 100, index / 200 - 100]);
        points.iter().for_each(|point| add(point.id));
    }
    let space = Worley::<3>::new(Seed(62));
    for index in 0..30 * 30 * 30 {
        let cell = [index % 30 - 15, index / 30 % 30 - 15, index / 900 - 15];
        space
            .cell_points(cell)
            .iter()
            .for_each(|point| add(point.id));
    }
    let four = Worley::<4>::new(Seed(62));
    for index in 0..12 * 12 * 12 * 12 {
        let cell = [
            index % 12 - 6,
            index / 12 % 12 - 6,
            index / 144 % 12 - 6,
            index / 1728 - 6,
        ];
        four.cell_points(cell)
            .iter()
            .for_each(|point| add(point.id));
    }
    assert!(n_points > 350_000, "{n_points} points are too few");
    assert_eq!(seen.len(), n_points, "ids come twice");
}
