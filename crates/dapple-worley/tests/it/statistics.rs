//! Tests that feature points are as random as intended, and that their distances have the expected means.
//!
//! Seeds are fixed, so every test always passes or always fails. True randomness exceeds the bounds one time in 10^4.

use dapple_hash::{Seed, hash1, unit_f64};
use dapple_worley::{Dimensions, Metric, Scatter, Space, Vector, Worley, WorleyError};

/// The quantile of the standard normal distribution that is exceeded with a probability of 10^-4.
const QUANTILE: f64 = 3.719;

/// Returns the value that chi-square with the given degrees of freedom exceeds with a probability of 10^-4 (E. B.
/// Wilson and M. M. Hilferty, "The Distribution of Chi-Square", 1931, <https://doi.org/10.1073/pnas.17.12.684>).
fn chi_square_bound(freedom: f64) -> f64 {
    let part = 2.0 / (9.0 * freedom);
    let root = 1.0 - part + QUANTILE * part.sqrt();
    freedom * root * root * root
}

/// Checks by a chi-square test that counts are in proportion to `weights`.
fn follows(what: &str, counts: &[u32], weights: &[f64]) {
    let n: u32 = counts.iter().sum();
    let all: f64 = weights.iter().sum();
    let mut chi_square = 0.0;
    for (&count, weight) in counts.iter().zip(weights) {
        let expected = f64::from(n) * weight / all;
        assert!(
            expected >= 5.0,
            "{what}: {expected} are too few for chi-square"
        );
        let gap = f64::from(count) - expected;
        chi_square += gap * gap / expected;
    }
    let bound = chi_square_bound(counts.len() as f64 - 1.0);
    assert!(
        chi_square < bound,
        "{what}: chi-square is {chi_square}, above {bound}"
    );
}

fn is_uniform(what: &str, counts: &[u32]) {
    follows(what, counts, &vec![1.0; counts.len()]);
}

/// Returns a histogram of numbers in `[0, 1)`.
fn histogram(n_bins: usize, values: impl IntoIterator<Item = f64>) -> Vec<u32> {
    let mut counts = vec![0; n_bins];
    for value in values {
        counts[(value * n_bins as f64) as usize] += 1;
    }
    counts
}

/// Returns a 2-D histogram of pairs of numbers in `[0, 1)`, row by row.
fn histogram2(n_bins: usize, values: impl IntoIterator<Item = [f64; 2]>) -> Vec<u32> {
    let mut counts = vec![0; n_bins * n_bins];
    for [a, b] in values {
        let [a, b] = [a, b].map(|value| (value * n_bins as f64) as usize);
        counts[a * n_bins + b] += 1;
    }
    counts
}

/// Returns the offsets of the points in the cells of a cube around the origin, cell by cell.
fn cells<const N: usize>(worley: &Worley<N>, side: i64) -> Vec<Vec<[f64; N]>>
where
    Dimensions: Space<N>,
{
    let n_cells = side.pow(N as u32);
    let cell =
        |index: i64| core::array::from_fn(|axis| index / side.pow(axis as u32) % side - side / 2);
    let points = |index| worley.cell_points(cell(index)).into_iter();
    (0..n_cells)
        .map(|index| points(index).map(|point| point.offset.into()).collect())
        .collect()
}

fn points_are_uniform<const N: usize>(side: i64) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    for scatter in [
        Scatter::default(),
        Scatter::Unclamped { density: 2.0 },
        Scatter::Jittered { jitter: 1.0 },
    ] {
        let worley = Worley::<N>::new(Seed(71)).with_scatter(scatter)?;
        let cells = cells(&worley, side);
        let points: Vec<_> = cells.iter().flatten().collect();
        for axis in 0..N {
            let what = format!("axis {axis} of {N}, {scatter:?}");
            is_uniform(
                &what,
                &histogram(64, points.iter().map(|point| point[axis])),
            );
            // The lower bits, which are those of the pattern within 1/64 of a cell.
            let low = points.iter().map(|point| (point[axis] * 64.0).fract());
            is_uniform(&format!("lower bits of {what}"), &histogram(64, low));
            for other in axis + 1..N {
                let pairs = points.iter().map(|point| [point[axis], point[other]]);
                let what = format!("axes {axis} and {other} of {N}, {scatter:?}");
                is_uniform(&what, &histogram2(16, pairs));
            }
        }
    }
    Ok(())
}

#[test]
fn feature_points_are_uniform_in_the_plane() -> Result<(), WorleyError> {
    points_are_uniform::<2>(160)
}

#[test]
fn feature_points_are_uniform_in_space() -> Result<(), WorleyError> {
    points_are_uniform::<3>(30)
}

#[test]
fn feature_points_are_uniform_in_four_dimensions() -> Result<(), WorleyError> {
    points_are_uniform::<4>(12)
}

fn points_of_a_cell_are_independent<const N: usize>(side: i64)
where
    Dimensions: Space<N>,
{
    let cells = cells(&Worley::<N>::new(Seed(72)), side);
    for index in 0..4 {
        let points = || cells.iter().filter_map(|points| points.get(index));
        let pairs = points().map(|point| [point[0], point[N - 1]]);
        is_uniform(&format!("point {index} in {N} axes"), &histogram2(8, pairs));
    }
    for count in 1..=6 {
        let points = || {
            let cells = cells.iter().filter(|points| points.len() == count);
            cells.flatten()
        };
        let pairs = points().map(|point| [point[0], point[N - 1]]);
        is_uniform(
            &format!("cells of {count} points in {N} axes"),
            &histogram2(8, pairs),
        );
        let first = cells.iter().filter(|points| points.len() == count);
        let pairs = first.map(|points| [points[0][0], points[0][1]]);
        is_uniform(
            &format!("the first of {count} points in {N} axes"),
            &histogram2(4, pairs),
        );
    }
    for (first, second) in [(0, 1), (1, 2), (0, 2)] {
        for (axis, other) in [(0, 0), (1, 1), (0, 1), (1, 0), (N - 1, N - 1), (N - 1, 0)] {
            let both = cells
                .iter()
                .filter_map(|points| Some([points.get(first)?[axis], points.get(second)?[other]]));
            let what = format!("points {first} and {second} along {axis} and {other} of {N}");
            is_uniform(&what, &histogram2(12, both));
        }
    }
}

#[test]
fn feature_points_depend_neither_on_their_index_nor_on_their_number_nor_on_each_other() {
    points_of_a_cell_are_independent::<2>(180);
    points_of_a_cell_are_independent::<3>(32);
    points_of_a_cell_are_independent::<4>(13);
}

#[test]
fn neighboring_cells_do_not_depend_on_each_other() {
    let side = 180;
    let cells = cells(&Worley::<2>::new(Seed(73)), side);
    let side = side as usize;
    for (what, step) in [
        ("to the right", 1),
        ("above", side),
        ("diagonally", side + 1),
        ("two to the right", 2),
    ] {
        // The last column is next to the first of another row, which is as good.
        let pairs = || cells.iter().zip(&cells[step..]);
        for (axis, other) in [(0, 0), (1, 1), (0, 1), (1, 0)] {
            let offsets = pairs().map(|(a, b)| [a[0][axis], b[0][other]]);
            let name = format!("first points {what} along {axis} and {other}");
            is_uniform(&name, &histogram2(16, offsets));
        }
        let counts = |points: &[[f64; 2]]| points.len() as f64;
        let n = pairs().count() as f64;
        let mean = cells.iter().map(|points| counts(points)).sum::<f64>() / cells.len() as f64;
        let [mut covariance, mut variance] = [0.0; 2];
        for (a, b) in pairs() {
            covariance += (counts(a) - mean) * (counts(b) - mean);
            variance += (counts(a) - mean) * (counts(a) - mean);
        }
        let correlation = covariance / variance;
        // Of independent numbers, it has the standard deviation 1 / sqrt(n).
        assert!(
            correlation.abs() < QUANTILE / n.sqrt(),
            "the counts {what} correlate by {correlation}"
        );
    }
}

/// Returns the probabilities of the counts 0, 1, … for a Poisson distribution. The last one is the total probability
/// of all larger counts.
fn poisson(mean: f64, len: usize) -> Vec<f64> {
    let mut probabilities = Vec::new();
    let mut probability = libm::exp(-mean);
    for count in 0..len - 1 {
        probabilities.push(probability);
        probability *= mean / (count + 1) as f64;
    }
    probabilities.push(1.0 - probabilities.iter().sum::<f64>());
    probabilities
}

/// Checks the numbers of cells with the minimum number of points, one more, and so on. The last weight is for all
/// larger numbers.
fn counts_follow<const N: usize>(
    side: i64,
    scatter: Scatter,
    weights: &[f64],
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let worley = Worley::<N>::new(Seed(74)).with_scatter(scatter)?;
    let counts: Vec<_> = cells(&worley, side).iter().map(Vec::len).collect();
    let least = usize::from(matches!(scatter, Scatter::Poisson { .. }));
    let mut seen = vec![0; weights.len()];
    for &count in &counts {
        seen[count.min(least + weights.len() - 1) - least] += 1;
    }
    follows(
        &format!("counts of {scatter:?} in {N} axes"),
        &seen,
        weights,
    );
    let n = counts.len() as f64;
    let mean = counts.iter().map(|&count| count as f64).sum::<f64>() / n;
    let squares = counts
        .iter()
        .map(|&count| (count as f64 - mean) * (count as f64 - mean));
    let error = (squares.sum::<f64>() / n / n).sqrt();
    let expected = scatter.mean()?;
    assert!(
        (mean - expected).abs() <= QUANTILE * error,
        "{scatter:?}: {mean} points per cell, not {expected}, with a standard error of {error}"
    );
    Ok(())
}

#[test]
fn counts_follow_the_poisson_distribution() -> Result<(), WorleyError> {
    for (density, len) in [(3.0, 11), (0.1, 3), (8.0, 20), (0.5, 5)] {
        let scatter = Scatter::Unclamped { density };
        counts_follow::<2>(160, scatter, &poisson(density, len))?;
        counts_follow::<3>(30, scatter, &poisson(density, len))?;
    }
    counts_follow::<4>(13, Scatter::Unclamped { density: 1.0 }, &poisson(1.0, 6))
}

#[test]
fn clamped_counts_follow_the_clamped_poisson_distribution() -> Result<(), WorleyError> {
    // With the density 64, hardly any cell has fewer than 9.
    for density in [0.1, 1.0, 3.0, 6.0] {
        let mut weights = poisson(density, 10);
        // An empty cell gets one point.
        let empty = weights.remove(0);
        weights[0] += empty;
        // Rare counts are taken together.
        while weights.last().is_some_and(|&last| last * 25_000.0 < 6.0) {
            let last = weights.pop().unwrap_or(0.0);
            *weights.last_mut().unwrap() += last;
        }
        counts_follow::<2>(160, Scatter::Poisson { density }, &weights)?;
        counts_follow::<3>(30, Scatter::Poisson { density }, &weights)?;
    }
    let full = Worley::<2>::new(Seed(74)).with_density(64.0)?;
    assert!(
        cells(&full, 50).iter().all(|points| points.len() == 9),
        "64 points are clamped to 9"
    );
    Ok(())
}

/// Returns a random position within 2^20 cells of the origin along each axis.
fn anywhere<const N: usize>(index: i64) -> [f64; N] {
    let unit = |axis: usize| unit_f64(hash1(Seed(75), [index], axis as u32));
    core::array::from_fn(|axis| (unit(axis) - 0.5) * f64::from(1 << 21))
}

/// Returns the means of F1 to F4 and their standard errors.
fn means<const N: usize>(worley: &Worley<N>, n: i64) -> [[f64; 2]; 4]
where
    Dimensions: Space<N>,
{
    let mut sums = [[0.0; 2]; 4];
    for index in 0..n {
        let features = worley.sample::<4>(Vector::<N>::from(anywhere(index)));
        for (sums, feature) in sums.iter_mut().zip(features) {
            let distance = f64::from(feature.distance);
            sums[0] += distance;
            sums[1] += distance * distance;
        }
    }
    let n = n as f64;
    sums.map(|[sum, squares]| {
        let mean = sum / n;
        [mean, ((squares / n - mean * mean) / n).sqrt()]
    })
}

fn means_are_those_measured<const N: usize>(n: i64, expected: [f64; 4])
where
    Dimensions: Space<N>,
{
    let found = means(&Worley::<N>::new(Seed(76)), n);
    for ([mean, error], expected) in found.into_iter().zip(expected) {
        // The expected means were measured too, and are rounded to 1/1000.
        assert!(
            (mean - expected).abs() < QUANTILE * error + 0.001,
            "the means in {N} axes are {found:?}, not {expected}"
        );
    }
}

#[test]
fn mean_distances_at_the_default_density_are_those_measured() {
    means_are_those_measured::<2>(60_000, [0.282, 0.427, 0.535, 0.625]);
    means_are_those_measured::<3>(20_000, [0.381, 0.509, 0.594, 0.660]);
    means_are_those_measured::<4>(5000, [0.459, 0.575, 0.646, 0.700]);
}

/// Returns the volume of the metric's unit ball in `n_axes` dimensions.
fn unit_ball(metric: Metric, n_axes: usize) -> f64 {
    use core::f64::consts::PI;
    let n = n_axes as f64;
    match metric {
        Metric::Manhattan => libm::pow(2.0, n) / libm::tgamma(n + 1.0),
        Metric::Chebyshev => libm::pow(2.0, n),
        _ => libm::pow(PI, n / 2.0) / libm::tgamma(n / 2.0 + 1.0),
    }
}

/// Checks the distances of an unclamped Poisson scatter. The expected number of points in the ball up to the nearest
/// point is exponentially distributed, which determines the mean distances.
fn distances_are_those_of_a_poisson_process<const N: usize>(
    metric: Metric,
    density: f64,
    n: i64,
) -> Result<(), WorleyError>
where
    Dimensions: Space<N>,
{
    let worley = Worley::<N>::new(Seed(77))
        .with_scatter(Scatter::Unclamped { density })?
        .with_metric(metric)?;
    let inverse = 1.0 / N as f64;
    let points = density * unit_ball(metric, N);
    for (rank, [mean, error]) in (1..).map(f64::from).zip(means(&worley, n)) {
        let expected =
            libm::tgamma(rank + inverse) / libm::tgamma(rank) / libm::pow(points, inverse);
        // Where a cell has more than the table can draw, a point is missing: less than one time in 10^9.
        assert!(
            (mean - expected).abs() < QUANTILE * error,
            "F{rank} of {metric:?} in {N} axes: {mean}, not {expected}, with a standard error of {error}"
        );
    }
    let uniform = (0..n).map(|index| {
        let [first] = worley.sample::<1>(Vector::<N>::from(anywhere(index)));
        let inside = points * libm::pow(f64::from(first.distance), N as f64);
        libm::exp(-inside).min(1.0 - f64::EPSILON)
    });
    is_uniform(
        &format!("F1 of {metric:?} in {N} axes"),
        &histogram(32, uniform),
    );
    Ok(())
}

#[test]
fn distances_in_an_unclamped_scatter_are_those_of_a_poisson_process() -> Result<(), WorleyError> {
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        distances_are_those_of_a_poisson_process::<2>(metric, 3.0, 40_000)?;
        distances_are_those_of_a_poisson_process::<2>(metric, 0.3, 10_000)?;
        distances_are_those_of_a_poisson_process::<3>(metric, 2.0, 10_000)?;
        distances_are_those_of_a_poisson_process::<4>(metric, 1.5, 2000)?;
    }
    Ok(())
}

#[test]
fn unclamped_scatter_has_no_direction() -> Result<(), WorleyError> {
    use core::f64::consts::TAU;
    let scatter = Scatter::Unclamped { density: 2.0 };
    let n = 60_000;
    let worley = Worley::<2>::new(Seed(78)).with_scatter(scatter)?;
    let texture = worley.combine(dapple_worley::Combination::F1);
    let ways: Vec<_> = (0..n)
        .map(|index| texture.gradient(anywhere::<2>(index)))
        .collect();
    let mean = ways.iter().sum::<glam::DVec2>() / n as f64;
    // Each part of a random direction has the variance 1/2.
    let bound = QUANTILE * (0.5 / n as f64).sqrt();
    assert!(
        mean.abs().max_element() < bound,
        "the mean gradient is {mean}, beyond {bound}"
    );
    let turns = ways
        .iter()
        .map(|way| (libm::atan2(way.y, way.x) / TAU + 1.0).fract());
    is_uniform("directions to the nearest point", &histogram(64, turns));
    Ok(())
}

#[test]
fn cell_values_are_uniform() {
    let worley = Worley::<2>::new(Seed(79));
    // One position per 9 cells or more, so that hardly any two have the same point.
    let values = (0..40_000).map(|index| {
        let [nearest] = worley.sample::<1>(anywhere::<2>(index));
        f64::from(nearest.cell_value())
    });
    is_uniform("cell values", &histogram(64, values));
}

#[test]
fn cells_at_the_corners_of_rectangles_are_unrelated() {
    // The words of cells are exclusive ors of the hashes of columns and rows, which cancel each other over the four
    // corners of a rectangle. The numbers and places of points must not show it.
    const SIDE: i64 = 256;
    let worley = Worley::<2>::new(Seed(3));
    // Counts are clamped to 1 to 9, with a mean of 3.05 and a variance of 2.8; places are uniform.
    let values = |cell: [i64; 2]| {
        let points = worley.cell_points(cell);
        let count = (points.len() as f64 - 3.05) / 2.8_f64.sqrt();
        let [x, y] = [points[0].offset.x, points[0].offset.y];
        [count, (x - 0.5) * 12_f64.sqrt(), (y - 0.5) * 12_f64.sqrt()]
    };
    for [dx, dy] in [[1, 1], [2, 1], [1, 16], [64, 64]] {
        let mut products = [0.0; 3];
        for cell in 0..SIDE * SIDE {
            let [x, y] = [cell % SIDE, cell / SIDE];
            let corners = [[x, y], [x + dx, y], [x, y + dy], [x + dx, y + dy]].map(values);
            for (which, product) in products.iter_mut().enumerate() {
                *product += corners.iter().map(|corner| corner[which]).product::<f64>();
            }
        }
        for product in products {
            // The mean of so many products of independent numbers with variance 1 has a deviation of 1 / SIDE.
            let mean = product / (SIDE * SIDE) as f64;
            assert!(
                mean.abs() < QUANTILE / SIDE as f64,
                "{dx}, {dy}: {products:?}"
            );
        }
    }
}
