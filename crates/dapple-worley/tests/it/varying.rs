//! Tests of a density that varies in space.

use super::oracle::{METRICS, position};
use super::ways::{RANKS, agrees_with_oracle, sample_in_every_way};
use dapple_hash::Seed;
use dapple_raster::{Raster, Window};
use dapple_worley::{Dimensions, Plane, Scatter, Space, Vector, Worley, WorleyError};

/// A density that varies from the minimum to the maximum and back, several times within 40 cells. It exceeds both
/// limits.
fn waves<const N: usize>(at: [f64; N]) -> f64 {
    let sum: f64 = at.iter().sum();
    let wave = 1.0 - (sum / 20.0 - (sum / 20.0).round()).abs() * 4.0;
    libm::pow(2.0, 8.0 * wave)
}

fn varying<const N: usize>(seed: u64) -> Worley<N>
where
    Dimensions: Space<N>,
{
    Worley::new(Seed(seed)).with_varying_density(|at: Vector<N>| waves::<N>(at.into()))
}

#[test]
fn points_of_a_cell_are_those_of_the_density_at_its_middle() -> Result<(), WorleyError> {
    let worley = varying::<2>(91);
    let mut least = usize::MAX;
    let mut most = 0;
    for (x, y) in (-30..30).flat_map(|y| (-30..30).map(move |x| (x, y))) {
        let density = waves([x as f64 + 0.5, y as f64 + 0.5]).clamp(1.0 / 64.0, 64.0);
        let even = Worley::<2>::new(Seed(91)).with_scatter(Scatter::Unclamped { density })?;
        let points = worley.cell_points([x, y]);
        assert_eq!(
            points,
            even.cell_points([x, y]),
            "cell {x} {y} with density {density}"
        );
        least = least.min(points.len());
        most = most.max(points.len());
    }
    assert!(
        least == 0 && most > 40,
        "{least} to {most} points are no large range"
    );
    Ok(())
}

#[test]
fn densities_out_of_range_count_as_the_nearest_within() -> Result<(), WorleyError> {
    for (density, counts_as) in [
        (f64::NAN, 1.0 / 64.0),
        (-1.0, 1.0 / 64.0),
        (0.0, 1.0 / 64.0),
        (f64::NEG_INFINITY, 1.0 / 64.0),
        (1e-300, 1.0 / 64.0),
        (f64::INFINITY, 64.0),
        (1e300, 64.0),
    ] {
        let worley = Worley::<2>::new(Seed(92)).with_varying_density(move |_| density);
        let even =
            Worley::<2>::new(Seed(92)).with_scatter(Scatter::Unclamped { density: counts_as })?;
        for index in 0..10 {
            let at = position::<2>(Seed(93), index, 1e3);
            assert_eq!(
                sample_in_every_way(&worley, at)?,
                even.sample::<4>(at),
                "{density} as {counts_as}"
            );
        }
    }
    Ok(())
}

#[test]
fn ways_agree_with_the_oracle_where_the_density_varies() -> Result<(), WorleyError> {
    for metric in METRICS {
        let plane = varying::<2>(94).with_metric(metric)?;
        for index in 0..60 {
            let at = position::<2>(Seed(95), index, 60.0);
            let found = sample_in_every_way(&plane, at)?;
            agrees_with_oracle(&plane, at, 20, &found);
        }
        let space = varying::<3>(94).with_metric(metric)?;
        for index in 0..5 {
            let at = position::<3>(Seed(96), index, 60.0);
            let found = sample_in_every_way(&space, at)?;
            agrees_with_oracle(&space, at, 10, &found);
        }
    }
    Ok(())
}

#[test]
fn windows_equal_samples_where_the_density_varies() -> Result<(), WorleyError> {
    let windows = [[1.0 / 16.0, 1.0 / 8.0], [0.5, 0.75]].map(|pixel| Window {
        origin: [-10.3, 4.1],
        pixel,
        first: [0, 0],
        size: [90, 70],
        scale: [1.0; 2],
    });
    for (index, window) in windows.iter().enumerate() {
        let worley = varying::<2>(97).with_metric(METRICS[index])?;
        for combination in RANKS {
            let texture = worley.combine(combination);
            let mut values = Raster::filled(window.size, -1.0)?;
            texture.render_plane(&Plane::default(), window, values.view_mut())?;
            for (column, row) in (0..70).flat_map(|row| (0..90).map(move |column| (column, row))) {
                let expected = texture.value(window.position(column, row));
                assert_eq!(
                    values.row(row)[column as usize].to_bits(),
                    expected.to_bits(),
                    "{combination:?} at {column} {row} of {window:?}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn denser_regions_have_more_points_and_shorter_distances() {
    let worley =
        Worley::<3>::new(Seed(98)).with_varying_density(|at| if at.x < 0.0 { 0.5 } else { 8.0 });
    let count = |first: i64| {
        let cells = (0..20 * 20 * 20).map(|index| {
            let cell = [first + index % 20, index / 20 % 20, index / 400];
            worley.cell_points(cell).len()
        });
        cells.sum::<usize>() as f64 / 8000.0
    };
    // A mean of 8000 counts has the standard error sqrt(density / 8000): 0.008, and 0.032.
    let [sparse, dense] = [count(-20), count(0)];
    assert!(
        (sparse - 0.5).abs() < 0.03 && (dense - 8.0).abs() < 0.12,
        "{sparse} and {dense} points per cell"
    );
    let mean = |start: f64| {
        let firsts = (0..2000).map(|index| {
            let at: [f64; 3] = position(Seed(99), index, 1e3);
            let [first] = worley.sample::<1>([start + at[0].abs(), at[1], at[2]]);
            first.distance
        });
        firsts.sum::<f32>() / 2000.0
    };
    // Sixteen times the density are distances 2.52 times as short.
    let ratio = mean(-600.0) / mean(10.0);
    assert!(
        (ratio - 2.52).abs() < 0.1,
        "distances are {ratio} times as short"
    );
}

#[test]
fn varying_density_repeats_exactly_with_a_period() -> Result<(), WorleyError> {
    // The density itself does not repeat; that of the first period counts.
    let worley = Worley::<2>::new(Seed(90))
        .with_varying_density(|at| 0.1 + at.x.abs())
        .with_period([Some(12), Some(5)])?;
    for index in 0..60 {
        let at = position::<2>(Seed(89), index, 100.0);
        let expected = sample_in_every_way(&worley, at)?;
        agrees_with_oracle(&worley, at, 14, &expected);
        for [x, y] in [[1.0, 0.0], [0.0, 1.0], [-3.0, 100.0], [1e6, -1e6]] {
            let moved = [at[0] + 12.0 * x, at[1] + 5.0 * y];
            assert_eq!(worley.sample::<4>(moved), expected, "{at:?} and {moved:?}");
        }
    }
    Ok(())
}

#[test]
fn varying_density_stays_when_the_rest_changes() -> Result<(), WorleyError> {
    let worley = varying::<2>(88);
    let changed = Worley::<2>::new(Seed(87))
        .with_period([Some(3), None])?
        .with_metric(METRICS[1])?
        .with_varying_density(|at| waves(at.to_array()))
        .with_seed(Seed(88))
        .with_period([None, None])?
        .with_metric(METRICS[0])?;
    for index in 0..20 {
        let at = position::<2>(Seed(86), index, 100.0);
        assert_eq!(changed.sample::<4>(at), worley.sample::<4>(at), "{at:?}");
    }
    Ok(())
}
