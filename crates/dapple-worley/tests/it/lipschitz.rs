//! Tests continuity: along any path, F1 to F4 change by at most the path's length in their metric.
//!
//! A search that misses points would violate this at the borders of the cells that it visits.

use super::oracle::{METRICS, SCATTERS, position};
use super::ways::RANKS;
use dapple_hash::Seed;
use dapple_raster::{Raster, Window};
use dapple_worley::{Dimensions, Metric, POSITION_STEP, Plane, Space, Vector, Worley, WorleyError};

/// Returns the maximum rounding error of the difference of two distances. A key is rounded a few times and its root
/// once, and powers are accurate to about 1e-6.
fn slack(metric: Metric, a: f32, b: f32) -> f32 {
    let relative = match metric {
        Metric::Minkowski(_) => 2e-6,
        _ => 4.0 * f32::EPSILON,
    };
    relative * (a + b)
}

/// Walks `n` steps, and checks that F1 to F4 change by at most the length of each step. The start and the step are
/// multiples of 2^-21, so that no position is rounded.
fn walk<const N: usize>(worley: &Worley<N>, start: [f64; N], step: [f64; N], n: u32)
where
    Dimensions: Space<N>,
{
    let metric = worley.metric();
    let length = metric.length(step.map(|part| part as f32));
    let sample = |index: u32| {
        let at: [f64; N] = core::array::from_fn(|axis| start[axis] + step[axis] * f64::from(index));
        worley
            .sample::<4>(Vector::<N>::from(at))
            .map(|feature| feature.distance)
    };
    let mut before = sample(0);
    for index in 1..=n {
        let here = sample(index);
        assert!(
            here.is_sorted() && here[0] >= 0.0,
            "{here:?} are not in order: {worley:?}, step {index} of {step:?} from {start:?}"
        );
        for rank in 0..4 {
            let change = (here[rank] - before[rank]).abs();
            assert!(
                change <= length + slack(metric, here[rank], before[rank]),
                "F{} jumps from {} to {} over {length}: {worley:?}, step {index} of {step:?} from {start:?}",
                rank + 1,
                before[rank],
                here[rank]
            );
        }
        before = here;
    }
}

fn walk_everywhere<const N: usize>(lines: i64, steps: u32) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    for (metric, scatter) in METRICS.iter().flat_map(|&m| SCATTERS.map(|s| (m, s))) {
        let worley = Worley::<N>::new(Seed(31))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        for line in 0..lines {
            let start = position::<N>(Seed(32), line, 1e3);
            let mut along = [0.0; N];
            along[line as usize % N] = 1.0 / 64.0;
            walk(&worley, start, along, steps);
            // Anywhere else, by up to 1/16 of a cell along each axis.
            let oblique = position::<N>(Seed(33), line, 0.125);
            walk(&worley, start, oblique, steps / 2);
        }
    }
    Ok(())
}

#[test]
fn distances_never_change_faster_than_the_way_in_the_plane() -> Result<(), WorleyError> {
    walk_everywhere::<2>(6, 1024)
}

#[test]
fn distances_never_change_faster_than_the_way_in_space() -> Result<(), WorleyError> {
    walk_everywhere::<3>(3, 256)
}

#[test]
fn distances_never_change_faster_than_the_way_in_four_dimensions() -> Result<(), WorleyError> {
    walk_everywhere::<4>(1, 96)
}

#[test]
fn distances_never_differ_by_more_than_the_way_between_any_two_positions() -> Result<(), WorleyError>
{
    for metric in METRICS {
        let worley = Worley::<3>::new(Seed(34)).with_metric(metric)?;
        for index in 0..300 {
            let start = position::<3>(Seed(35), index, 1e3);
            walk(&worley, start, position::<3>(Seed(36), index, 4.0), 1);
        }
    }
    Ok(())
}

/// Crosses a border of cells along each axis, in the smallest possible steps.
fn cross<const N: usize>(worley: &Worley<N>, border: i64, index: i64)
where
    Dimensions: Space<N>,
{
    let step = f64::from(POSITION_STEP);
    for axis in 0..N {
        let mut start = position::<N>(Seed(37), index, 50.0);
        start[axis] = border as f64 - 2.0 * step;
        let mut along = [0.0; N];
        along[axis] = step;
        walk(worley, start, along, 4);
    }
}

#[test]
fn distances_do_not_jump_at_the_borders_of_cells() -> Result<(), WorleyError> {
    for (metric, scatter) in METRICS.iter().flat_map(|&m| SCATTERS.map(|s| (m, s))) {
        let plane = Worley::<2>::new(Seed(38))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        let space = Worley::<3>::new(Seed(38))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        for index in 0..30 {
            cross(&plane, index - 15, index);
            cross(&space, index - 15, index);
        }
    }
    cross(&Worley::<4>::new(Seed(38)), 0, 0);
    cross(&Worley::<4>::new(Seed(38)), -7, 1);
    Ok(())
}

#[test]
fn distances_do_not_jump_where_a_period_ends() -> Result<(), WorleyError> {
    for metric in METRICS {
        let worley = Worley::<2>::new(Seed(39)).with_metric(metric)?;
        let plane = worley.with_period([Some(3), Some(1)])?;
        let space = Worley::<3>::new(Seed(39))
            .with_metric(metric)?
            .with_period([Some(3), None, Some(2)])?;
        for (index, period) in (0..).zip([-6_000_006, -12, -6, 0, 6, 600, 6_000_000]) {
            cross(&plane, period, index);
            cross(&space, period, index);
        }
        let loops = Worley::<4>::new(Seed(39))
            .with_metric(metric)?
            .with_period([None, None, None, Some(2)])?;
        cross(&loops, 4, 0);
    }
    Ok(())
}

/// Checks that F1 to F4 in a window change by at most the distance between adjacent pixels, along rows and columns.
fn pictures_have_no_jumps<const N: usize>(
    worley: &Worley<N>,
    plane: &Plane<N>,
    window: &Window,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let metric = worley.metric();
    let [width, height] = window.size;
    for combination in RANKS {
        let mut values = Raster::filled(window.size, f32::NAN)?;
        let texture = worley.combine(combination);
        texture.render_plane(plane, window, values.view_mut())?;
        let check = |[a, b]: [f32; 2], way: f64, at: [u32; 2]| {
            assert!(
                (a - b).abs() <= way.abs() as f32 + slack(metric, a, b),
                "{combination:?} jumps from {a} to {b} at {at:?}: {worley:?} {window:?}"
            );
        };
        for (x, y) in (1..height).flat_map(|y| (1..width).map(move |x| (x, y))) {
            let [row, above] = [values.row(y), values.row(y - 1)];
            let column = x as usize;
            check([row[column - 1], row[column]], window.pixel[0], [x, y]);
            check([above[column], row[column]], window.pixel[1], [x, y]);
        }
    }
    Ok(())
}

#[test]
fn pictures_have_no_jumps_in_any_metric_or_scatter() -> Result<(), WorleyError> {
    // The pixels are powers of two, so that no position is rounded.
    let window = |pixel: [f64; 2], size: [u32; 2]| Window {
        origin: [-5.0, 1024.0],
        pixel,
        first: [0, 0],
        size,
        scale: [1.0; 2],
    };
    let slanted = Plane::slice([0.0, 0.0, 0.625].into());
    for (metric, scatter) in METRICS.iter().flat_map(|&m| SCATTERS.map(|s| (m, s))) {
        let worley = Worley::<2>::new(Seed(40))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        let plane = Plane::default();
        pictures_have_no_jumps(
            &worley,
            &plane,
            &window([1.0 / 64.0, -1.0 / 32.0], [200, 80]),
        )?;
        pictures_have_no_jumps(&worley, &plane, &window([0.25, 0.125], [50, 30]))?;
        let worley = Worley::<3>::new(Seed(40))
            .with_metric(metric)?
            .with_scatter(scatter)?;
        pictures_have_no_jumps(
            &worley,
            &slanted,
            &window([1.0 / 64.0, 1.0 / 32.0], [80, 40]),
        )?;
    }
    let worley = Worley::<4>::new(Seed(40)).with_metric(Metric::Manhattan)?;
    let slice = Plane::slice([0.0, 0.0, 0.5, -7.25].into());
    pictures_have_no_jumps(&worley, &slice, &window([1.0 / 32.0; 2], [40, 33]))
}
