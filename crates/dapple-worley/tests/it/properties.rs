//! Property tests over every metric, scatter, period and seed.

use super::ways::{RANKS, agrees_with_oracle, reach_of, sample_in_every_way};
use dapple_hash::Seed;
use dapple_raster::{Raster, Window};
use dapple_worley::{
    Cellular, Combination, Dimensions, FeatureView, Metric, Plane, Scatter, Space, Vector, Worley,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn any_metric() -> impl Strategy<Value = Metric> {
    let named = Metric::NAMED.map(|(_, metric)| metric);
    prop_oneof![
        3 => prop::sample::select(named.to_vec()),
        1 => (1.0_f32..=10.0).prop_map(Metric::Minkowski),
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
    Dimensions: Space<N>,
{
    (any::<u64>(), any_metric(), any_scatter(), any_period::<N>()).prop_map(
        |(seed, metric, scatter, period)| {
            let worley = Worley::new(Seed(seed)).with_metric(metric).unwrap();
            let worley = worley.with_scatter(scatter).unwrap();
            let period = fitting(&worley, period);
            worley.with_period(period).unwrap()
        },
    )
}

/// Returns longer periods if the scatter may leave all cells of a short period empty.
fn fitting<const N: usize>(worley: &Worley<N>, period: [Option<u32>; N]) -> [Option<u32>; N]
where
    Dimensions: Space<N>,
{
    match worley.scatter() {
        Scatter::Unclamped { .. } => period.map(|period| period.map(|_| 1000)),
        _ => period,
    }
}

/// Generates positions that are multiples of 2^-21 of a cell, near the origin and up to 2^29 cells away, so that
/// nothing is rounded. Some are corners of cells.
fn any_position<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    let cell = prop_oneof![-8_i64..8, -(1_i64 << 29)..1 << 29];
    let steps = prop_oneof![0_i64..1 << 21, Just(0), Just(1 << 20), Just((1 << 21) - 1)];
    proptest::array::uniform(
        (cell, steps).prop_map(|(cell, steps)| cell as f64 + steps as f64 / f64::from(1 << 21)),
    )
}

fn cases(cases: u32) -> ProptestConfig {
    let default = ProptestConfig::default();
    // A larger number of cases, if it is set.
    let more = default.cases / 256;
    ProptestConfig {
        cases: cases * more.max(1),
        failure_persistence: None,
        ..default
    }
}

fn ways_agree<const N: usize>(
    worley: &Worley<N>,
    at: [f64; N],
    oracle: bool,
) -> Result<(), TestCaseError>
where
    Dimensions: Space<N>,
{
    let found = sample_in_every_way(worley, at).unwrap();
    if oracle {
        agrees_with_oracle(worley, at, reach_of(worley).unwrap(), &found);
    }
    prop_assert!(
        found.is_sorted_by(|a, b| a.distance <= b.distance),
        "not in order"
    );
    Ok(())
}

/// Checks that samples are equal, bit for bit, after shifts by whole periods along every combination of axes.
fn repeats<const N: usize>(
    worley: &Worley<N>,
    period: [Option<u32>; N],
    at: [f64; N],
    turns: i64,
) -> Result<(), TestCaseError>
where
    Dimensions: Space<N>,
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

fn any_combination() -> impl Strategy<Value = Combination> {
    prop_oneof![
        proptest::sample::select(&RANKS),
        Just(Combination::F2_MINUS_F1),
        proptest::array::uniform4(-2.0_f32..2.0).prop_map(Combination::new),
    ]
}

/// Generates windows with pixels of 2^-18 to 2^5 cells of either sign, and sometimes of size 0.
fn any_window() -> impl Strategy<Value = Window> {
    let exponent = prop_oneof![4 => -7.0..0.0, 1 => -18.0..5.0];
    let size = (exponent, any::<bool>(), 0..20).prop_map(|(exponent, is_flipped, zero)| {
        let size = libm::exp2(exponent);
        match (zero, is_flipped) {
            (0, _) => 0.0,
            (_, true) => -size,
            _ => size,
        }
    });
    let coordinate = prop_oneof![4 => -8.0..8.0, 1 => -1e10..1e10];
    (
        proptest::array::uniform2(coordinate),
        proptest::array::uniform2(size),
        proptest::array::uniform2(-1000_i64..1000),
        [1_u32..50, 1_u32..24],
    )
        .prop_map(|(origin, pixel, first, size)| Window {
            origin,
            pixel,
            first,
            size,
            scale: [1.0; 2],
        })
}

/// Generates planes. In most of them, columns differ along the first axis only, and rows along the others.
fn any_plane<const N: usize>() -> impl Strategy<Value = Plane<N>>
where
    Dimensions: Space<N>,
{
    let part = prop_oneof![Just(0.0), Just(1.0), -1.5..1.5];
    let way = proptest::array::uniform::<_, N>(part);
    (any_position::<N>(), way.clone(), way, 0..5).prop_map(|(origin, mut u, mut v, slanted)| {
        if slanted > 0 {
            u[1..].fill(0.0);
            v[0] = 0.0;
        }
        Plane {
            origin: origin.into(),
            u: u.into(),
            v: v.into(),
        }
    })
}

/// Checks that the values, ids and gradients of a rendered window equal those sampled at its pixel centers.
fn window_holds_samples<const N: usize>(
    texture: &Cellular<N>,
    plane: &Plane<N>,
    window: &Window,
) -> Result<(), TestCaseError>
where
    Dimensions: Space<N>,
{
    let mut values = Raster::filled(window.size, -1.0).unwrap();
    let mut gradients = Raster::filled(window.size, [-1.0; N]).unwrap();
    let mut ids = [(); 3].map(|()| Raster::filled(window.size, 1).unwrap());
    let views = ids.each_mut().map(|ids| FeatureView {
        id: Some(ids.view_mut()),
        ..FeatureView::default()
    });
    texture
        .render_plane(plane, window, values.view_mut())
        .unwrap();
    texture
        .render_gradient(plane, window, gradients.view_mut())
        .unwrap();
    texture
        .worley()
        .render_features(plane, window, views)
        .unwrap();
    let [width, height] = window.size;
    for (column, row) in (0..height).flat_map(|row| (0..width).map(move |column| (column, row))) {
        let at = plane.position(window.position(column, row));
        let pixel = column as usize;
        let found = values.row(row)[pixel];
        let expected = texture.value(at);
        prop_assert_eq!(
            found.to_bits(),
            expected.to_bits(),
            "{} for {} at {:?}",
            found,
            expected,
            at
        );
        let found = [0, 1, 2].map(|rank: usize| ids[rank].row(row)[pixel]);
        let expected = texture.worley().sample::<3>(at).map(|feature| feature.id);
        prop_assert_eq!(found, expected, "ids at {:?}", at);
        let found = Vector::<N>::from(gradients.row(row)[pixel].map(f64::from));
        prop_assert_eq!(found, texture.gradient(at), "gradient at {:?}", at);
    }
    Ok(())
}

/// Returns the sorted ids of all points in one period of cells that starts at `first`.
fn ids_of_a_period<const N: usize>(
    worley: &Worley<N>,
    period: [u32; N],
    first: [i64; N],
) -> Vec<u64>
where
    Dimensions: Space<N>,
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

/// Returns the offsets of the points in 3 × 3 cells starting at `[x, y]`.
fn points_about(worley: &Worley<2>, [x, y]: [i64; 2]) -> Vec<[f64; 2]> {
    let cells = (0..9).map(|index| [x + index % 3, y + index / 3]);
    let points = cells.flat_map(|cell| worley.cell_points(cell));
    points.map(|point| point.offset.to_array()).collect()
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn ways_agree_in_the_plane(worley in any_worley::<2>(), at in any_position::<2>()) {
        ways_agree(&worley, at, true)?;
    }

    #[test]
    fn pattern_repeats_exactly_after_its_period_in_the_plane(
        worley in any_worley::<2>(),
        period in any_period::<2>(),
        at in any_position::<2>(),
        turns in -1000_i64..1000,
    ) {
        let period = fitting(&worley, period);
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
        prop_assume!(!ids.is_empty());
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
            let changed = worley.clone().with_seed(Seed(other));
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
    fn windows_hold_what_samples_give_in_the_plane(
        worley in any_worley::<2>(),
        combination in any_combination(),
        plane in prop_oneof![Just(Plane::default()), any_plane::<2>()],
        window in any_window(),
    ) {
        window_holds_samples(&worley.combine(combination), &plane, &window)?;
    }

    #[test]
    fn windows_hold_what_samples_give_in_space(
        worley in any_worley::<3>(),
        combination in any_combination(),
        plane in any_plane::<3>(),
        window in any_window(),
    ) {
        window_holds_samples(&worley.combine(combination), &plane, &window)?;
    }

    #[test]
    fn ways_agree_in_space(worley in any_worley::<3>(), at in any_position::<3>()) {
        ways_agree(&worley, at, true)?;
    }

    #[test]
    fn pattern_repeats_exactly_after_its_period_in_space(
        worley in any_worley::<3>(),
        period in any_period::<3>(),
        at in any_position::<3>(),
        turns in -1000_i64..1000,
    ) {
        let period = fitting(&worley, period);
        let worley = worley.with_period(period).unwrap();
        repeats(&worley, period, at, turns)?;
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn ways_agree_in_four_dimensions(worley in any_worley::<4>(), at in any_position::<4>()) {
        ways_agree(&worley, at, false)?;
    }

    #[test]
    fn pattern_repeats_exactly_after_its_period_in_four_dimensions(
        worley in any_worley::<4>(),
        period in any_period::<4>(),
        at in any_position::<4>(),
        turns in -1000_i64..1000,
    ) {
        let period = fitting(&worley, period);
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
    let found = sample_in_every_way(&worley, at).unwrap();
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

#[test]
fn points_at_the_same_distance_are_in_the_order_of_their_ids() {
    // In the middle between the points of a regular grid, many are at the same distance.
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        let worley = Worley::<3>::new(Seed(64))
            .with_scatter(Scatter::Jittered { jitter: 0.0 })
            .and_then(|worley| worley.with_metric(metric))
            .unwrap();
        for cell in -20..20 {
            let cell = f64::from(cell);
            let corner = sample_in_every_way(&worley, [cell, 3.0, -cell]).unwrap();
            let mut ids: Vec<_> = (0..8)
                .map(|index| [index & 1, index >> 1 & 1, index >> 2].map(|part| part - 1))
                .flat_map(|[x, y, z]| worley.cell_points([cell as i64 + x, 3 + y, z - cell as i64]))
                .map(|point| point.id)
                .collect();
            ids.sort_unstable();
            assert_eq!(
                corner.map(|feature| feature.id).as_slice(),
                &ids[..4],
                "{metric:?} at {cell}"
            );
            let side = sample_in_every_way(&worley, [cell, 3.5, 0.5]).unwrap();
            assert_eq!(side[0].distance, side[1].distance, "{metric:?} at {cell}");
            assert!(side[0].id < side[1].id, "{metric:?} at {cell}: {side:?}");
        }
    }
}

#[test]
fn positions_just_below_a_whole_number_are_those_of_the_last_step_or_of_the_number() {
    for metric in [Metric::Euclidean, Metric::Minkowski(3.0)] {
        let worley = Worley::<2>::new(Seed(65)).with_metric(metric).unwrap();
        let periodic = worley.clone().with_period([Some(1), Some(3)]).unwrap();
        for (worley, whole) in [&worley, &periodic]
            .into_iter()
            .flat_map(|worley| [0.0, 1.0, -1.0, 3.0, 4_294_967_296.0].map(|whole| (worley, whole)))
        {
            let below = f64::next_down(whole);
            let step = f64::from(dapple_worley::POSITION_STEP);
            // Rounded down to a step, unless the way from the lower corner of its cell is rounded to a whole cell.
            let rounded = if below - below.floor() < 1.0 {
                whole - step
            } else {
                whole
            };
            let mut found = [worley.sample::<4>([0.5, 0.5]); 2];
            let positions = [[below, 0.25], [0.25, below]].map(glam::DVec2::from);
            worley.sample_many(&positions, &mut found).unwrap();
            let expected = [[rounded, 0.25], [0.25, rounded]];
            for index in 0..2 {
                let expected = worley.sample::<4>(expected[index]);
                assert_eq!(found[index], expected, "many, below {whole}");
                let single = worley.sample::<4>(positions[index]);
                assert_eq!(single, expected, "one, below {whole}");
            }
        }
    }
}

#[test]
fn periods_without_points_are_infinitely_far_from_any() {
    let scatter = Scatter::Unclamped { density: 0.25 };
    let empty = (0..20)
        .map(|seed| Worley::<2>::new(Seed(seed)).with_scatter(scatter).unwrap())
        .find(|worley| worley.cell_points([0, 0]).is_empty())
        .and_then(|worley| worley.with_period([Some(1), Some(1)]).ok())
        .expect("three of four cells are empty");
    for feature in sample_in_every_way(&empty, [0.25, 7.5]).unwrap() {
        assert_eq!(
            (feature.distance, feature.id),
            (f32::INFINITY, 0),
            "nothing is there"
        );
    }
}
