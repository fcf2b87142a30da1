//! Reference implementations of the filters, written for clarity: dense least squares over literally extended lines.

use crate::{Border, Degree, Fit, Phase, SplineFilter};

/// Returns filters with every combination of options.
pub(crate) fn all_filters() -> Vec<SplineFilter> {
    let mut filters = Vec::new();
    for degree in DEGREES {
        for phase in [Phase::Centered, Phase::CookDeRose] {
            for fit in [Fit::Function, Fit::Coefficients] {
                filters.push(SplineFilter { degree, phase, fit });
            }
        }
    }
    filters
}

/// All degrees, in order.
pub(crate) const DEGREES: [Degree; 4] = [
    Degree::Constant,
    Degree::Linear,
    Degree::Quadratic,
    Degree::Cubic,
];

/// Returns pseudorandom numbers from -1 to 1 (upper bits of Knuth's linear congruential generator).
pub(crate) fn noise(count: usize) -> Vec<f64> {
    let mut state = 0x1234_5678_u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

/// Returns the maximum difference of two lines of equal length.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "lines of different lengths");
    a.iter()
        .zip(b)
        .fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// Returns the indices of the first and the last fine coefficient that coarse coefficient 0 affects, as in the table
/// of [`Phase`].
pub(crate) fn spread(filter: SplineFilter) -> (i64, i64) {
    let (first, last) = match filter.degree {
        Degree::Constant => (0, 1),
        Degree::Linear => (-1, 1),
        Degree::Quadratic => (-1, 2),
        Degree::Cubic => (-2, 2),
    };
    let earlier = i64::from(filter.phase == Phase::CookDeRose);
    (first - earlier, last - earlier)
}

/// Returns one period of the infinite line that extends a line according to its border.
fn extended(filter: SplineFilter, line: &[f64], border: Border) -> Vec<f64> {
    let even = matches!(filter.degree, Degree::Constant | Degree::Quadratic);
    let mut line = line.to_vec();
    let back: Vec<f64> = match border {
        Border::Periodic => vec![],
        Border::Mirror if even => line.iter().rev().copied().collect(),
        Border::Mirror => line[1..line.len() - 1].iter().rev().copied().collect(),
    };
    line.extend(back);
    line
}

/// Returns the indices of the stored coarse coefficients, whose centers are between the mirrors.
fn kept(filter: SplineFilter, len: usize, border: Border) -> Vec<i64> {
    let (first, last) = spread(filter);
    if border == Border::Periodic {
        return (0..len as i64 / 2).collect();
    }
    let even = matches!(filter.degree, Degree::Constant | Degree::Quadratic);
    let [low, high] = if even {
        [-0.5, len as f64 - 0.5]
    } else {
        [0.0, len as f64 - 1.0]
    };
    let center = |j: i64| (2 * j) as f64 + (first + last) as f64 / 2.0;
    let inside = |&j: &i64| (low..=high).contains(&center(j));
    (-4..len as i64 + 4).filter(inside).collect()
}

/// Halves a line by a dense least-squares fit, of the functions or of the coefficients, over one period of the
/// extended line.
pub(crate) fn down(filter: SplineFilter, fine: &[f64], border: Border) -> Vec<f64> {
    let line = extended(filter, fine, border);
    let (period, coarse_period) = (line.len(), line.len() / 2);
    let matrix = |row: usize, column: usize| match filter.fit {
        Fit::Function => function_product(filter, period, row, column),
        Fit::Coefficients => (0..period)
            .map(|i| tap(filter, period, i, row) * tap(filter, period, i, column))
            .sum(),
    };
    let right = |row: usize| -> f64 {
        let weight = |i: usize| match filter.fit {
            Fit::Function => mixed_product(filter, period, row, i),
            Fit::Coefficients => tap(filter, period, i, row),
        };
        (0..period).map(|i| weight(i) * line[i]).sum()
    };
    let system: Vec<Vec<f64>> = (0..coarse_period)
        .map(|row| {
            (0..coarse_period)
                .map(|column| matrix(row, column))
                .chain([right(row)])
                .collect()
        })
        .collect();
    let solution = solve(system);
    let at = |j: i64| solution[j.rem_euclid(coarse_period as i64) as usize];
    kept(filter, fine.len(), border)
        .into_iter()
        .map(at)
        .collect()
}

/// Doubles a line: adds the fine coefficients of every coarse spline over one period of the extended line.
pub(crate) fn up(
    filter: SplineFilter,
    coarse: &[f64],
    fine_len: usize,
    border: Border,
) -> Vec<f64> {
    let period = extended(filter, &vec![0.0; fine_len], border).len();
    let (first, last) = spread(filter);
    let kept = kept(filter, fine_len, border);
    // All coarse coefficients of one period: the stored ones, and their mirror images
    let value = |j: i64| {
        let coarse_period = period as i64 / 2;
        let mirror = match filter.degree {
            Degree::Constant | Degree::Quadratic => (-1 - first - last) / 2,
            Degree::Linear | Degree::Cubic => -(first + last) / 2,
        };
        let index = kept
            .iter()
            .position(|&k| {
                let same = (k - j).rem_euclid(coarse_period) == 0;
                let image = (k - (mirror - j)).rem_euclid(coarse_period) == 0;
                same || (border == Border::Mirror && image)
            })
            .expect("every coefficient of a period is kept or is an image");
        coarse[index]
    };
    let h = binomials(filter.degree);
    let mut fine = vec![0.0; period];
    for j in 0..period as i64 / 2 {
        for (k, i) in (first..=last).enumerate() {
            fine[(2 * j + i).rem_euclid(period as i64) as usize] += h[k] * value(j);
        }
    }
    fine.truncate(fine_len);
    fine
}

/// Returns the weights `2^-d C(d + 1, k)` by Pascal's triangle.
pub(crate) fn binomials(degree: Degree) -> Vec<f64> {
    let d = DEGREES
        .iter()
        .position(|&other| other == degree)
        .expect("listed");
    let mut row = vec![1.0];
    for _ in 0..=d {
        let shifted = [vec![0.0], row.clone()].concat();
        row.push(0.0);
        row.iter_mut().zip(&shifted).for_each(|(a, b)| *a += b);
    }
    row.iter().map(|c| c / f64::from(1 << d)).collect()
}

/// Returns the weight of coarse coefficient `j` in fine coefficient `i` of a periodic line.
fn tap(filter: SplineFilter, period: usize, i: usize, j: usize) -> f64 {
    let (first, last) = spread(filter);
    let h = binomials(filter.degree);
    let is_hit = |k: i64| (2 * j as i64 + k - i as i64).rem_euclid(period as i64) == 0;
    (first..=last)
        .zip(h)
        .filter(|&(k, _)| is_hit(k))
        .map(|(_, h)| h)
        .sum()
}

/// Returns the integral of the product of coarse splines `j` and `k` over one period. Lengths are in fine cells.
fn function_product(filter: SplineFilter, period: usize, j: usize, k: usize) -> f64 {
    let [j, k] = [j, k].map(|j| coarse_center(filter, j));
    let copy = |copy: i32| {
        integral(
            filter.degree,
            (j, 2.0),
            (k + f64::from(copy) * period as f64, 2.0),
        )
    };
    (-8..=8).map(copy).sum()
}

/// Returns the integral of the product of coarse spline `j` and fine spline `i` over one period. Lengths are in fine
/// cells.
fn mixed_product(filter: SplineFilter, period: usize, j: usize, i: usize) -> f64 {
    let j = coarse_center(filter, j);
    let copy = |copy: i32| {
        integral(
            filter.degree,
            (j, 2.0),
            (i as f64 + f64::from(copy) * period as f64, 1.0),
        )
    };
    (-8..=8).map(copy).sum()
}

/// Returns the center of coarse spline `j`, in fine cells.
pub(crate) fn coarse_center(filter: SplineFilter, j: usize) -> f64 {
    let (first, last) = spread(filter);
    2.0 * j as f64 + (first + last) as f64 / 2.0
}

/// Returns the integral of the product of two splines, each given by its center and knot distance.
///
/// Knots are at multiples of one half; four-point Gaussian quadrature is exact for degree 7 in between.
fn integral(degree: Degree, a: (f64, f64), b: (f64, f64)) -> f64 {
    if (a.0 - b.0).abs() > 8.0 {
        return 0.0;
    }
    let points = [
        (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    ];
    let product = |x: f64| degree.value((x - a.0) / a.1) * degree.value((x - b.0) / b.1);
    let mut sum = 0.0;
    for piece in -8..8 {
        let middle = (2.0 * a.0).round() / 2.0 + f64::from(piece) * 0.5 + 0.25;
        for (place, weight) in points {
            sum +=
                0.25 * weight * (product(middle - 0.25 * place) + product(middle + 0.25 * place));
        }
    }
    sum
}

/// Solves linear equations by Gaussian elimination with pivoting; the last column is the right-hand side.
fn solve(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for column in 0..n {
        let pivot = (column..n)
            .max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()))
            .expect("a row is left");
        rows.swap(column, pivot);
        let pivot = rows[column].clone();
        for row in (0..n).filter(|&row| row != column) {
            let factor = rows[row][column] / pivot[column];
            rows[row]
                .iter_mut()
                .zip(&pivot)
                .for_each(|(value, pivot)| *value -= factor * pivot);
        }
    }
    (0..n).map(|row| rows[row][n] / rows[row][row]).collect()
}
