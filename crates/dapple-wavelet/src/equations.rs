//! Tests of the equations of Du, Wang and Meng, one per equation, written out as in the paper.
//!
//! The paper positions the spline φ and its shifts by their left end, so that coefficient `i` is at `i`. Here the
//! spline is centered on its coefficient. [`Phase`](crate::Phase) defines the first taps of `h` and `a`.

use crate::oracle::{DEGREES, all_filters, binomials, coarse_center, distance, noise, spread};
use crate::{Border, Degree, SplineFilter};
use dapple_raster::Raster;

const PERIODIC: Border = Border::Periodic;

/// Returns scattered positions, away from the discontinuities of the constant spline.
fn positions() -> impl Iterator<Item = f64> {
    noise(60).into_iter().map(|value| 9.0 * value)
}

fn of(degree: Degree) -> SplineFilter {
    SplineFilter {
        degree,
        ..SplineFilter::default()
    }
}

fn value(filter: SplineFilter, line: &[f64], x: f64) -> f64 {
    filter.value_line(line, x, PERIODIC).expect("a good line")
}

/// Returns the value at `[x, y]` of the spline whose coefficients are a periodic raster.
fn value_2d(filter: SplineFilter, raster: &Raster<f32>, x: f64, y: f64) -> f64 {
    let along = |row: u32| {
        let line: Vec<f64> = raster.row(row).iter().map(|&value| value.into()).collect();
        value(filter, &line, x)
    };
    value(
        filter,
        &(0..raster.height()).map(along).collect::<Vec<_>>(),
        y,
    )
}

fn noise_raster(side: u32) -> Raster<f32> {
    let pixels = noise((side * side) as usize)
        .iter()
        .map(|&value| value as f32)
        .collect();
    Raster::from_vec([side, side], pixels).expect("a good size")
}

/// Returns the taps of the halving filter `a`, for `k` from -32 to 31, from its responses to impulses in a periodic
/// line of 64 coefficients.
fn halving_taps(filter: SplineFilter) -> impl Fn(i64) -> f64 {
    let taps: Vec<f64> = (0..64)
        .map(|k| {
            let mut line = [0.0; 64];
            line[k] = 1.0;
            filter.down_line(&line, PERIODIC).expect("a good line")[0]
        })
        .collect();
    move |k| taps[k.rem_euclid(64) as usize]
}

/// Returns the doubling filter's taps `h_k`, which are zero outside their range.
fn doubling_taps(filter: SplineFilter) -> impl Fn(i64) -> f64 {
    let h = binomials(filter.degree);
    let (first, _) = spread(filter);
    move |k| {
        usize::try_from(k - first)
            .ok()
            .and_then(|k| h.get(k))
            .copied()
            .unwrap_or(0.0)
    }
}

#[test]
fn equation_01_function_is_a_weighted_sum_of_shifted_splines() {
    for degree in DEGREES {
        let f = noise(6);
        for x in positions() {
            // Enough copies of the six coefficients to include all splines at x.
            let sum: f64 = (-30..30_i64)
                .map(|i| f[i.rem_euclid(6) as usize] * degree.value(x - i as f64))
                .sum();
            let gap = (value(of(degree), &f, x) - sum).abs();
            assert!(gap < 1e-15, "{degree:?} at {x}: {gap}");
        }
    }
}

#[test]
fn equation_02_space_is_spanned_by_whole_shifts() {
    for degree in DEGREES {
        let f = noise(7);
        let shifted = [&f[6..], &f[..6]].concat();
        for x in positions() {
            let gap = (value(of(degree), &shifted, x + 1.0) - value(of(degree), &f, x)).abs();
            // The position is rounded once.
            assert!(gap < 1e-14, "{degree:?} at {x}: {gap}");
        }
        // A function of the space has unique coefficients; on a circle of 7, its values at integers determine them.
        let samples = of(degree).samples_line(&f, PERIODIC).expect("a good line");
        let again = of(degree)
            .coefficients_line(&samples, PERIODIC)
            .expect("a good line");
        assert!(distance(&again, &f) < 1e-14, "{degree:?}");
    }
}

#[test]
fn equation_03_finer_space_is_spanned_by_splines_of_half_the_width() {
    for degree in DEGREES {
        let g = noise(6);
        for x in positions() {
            let sum: f64 = (-60..60_i64)
                .map(|i| g[i.rem_euclid(6) as usize] * degree.value(2.0 * x - i as f64))
                .sum();
            let gap = (value(of(degree), &g, 2.0 * x) - sum).abs();
            assert!(gap < 1e-15, "{degree:?} at {x}: {gap}");
        }
    }
}

#[test]
fn equation_04_spline_is_a_sum_of_splines_of_half_the_width() {
    for degree in DEGREES {
        let middle = (degree.order() + 1) as f64 / 2.0;
        for x in positions() {
            let h = (0..).zip(binomials(degree));
            let sum: f64 = h
                .map(|(k, h)| h * degree.value(2.0 * x + middle - f64::from(k)))
                .sum();
            let gap = (degree.value(x) - sum).abs();
            assert!(gap < 1e-15, "{degree:?} at {x}: {gap}");
        }
    }
}

#[test]
fn equation_05_coarse_function_is_in_the_finer_space() {
    for filter in all_filters() {
        let f = noise(9);
        let finer = filter.up_line(&f, 18, PERIODIC).expect("a good line");
        let origin = coarse_center(filter, 0);
        for x in positions() {
            let gap = (value(filter, &finer, 2.0 * x + origin) - value(filter, &f, x)).abs();
            assert!(gap < 1e-14, "{filter:?} at {x}: {gap}");
        }
    }
}

#[test]
fn equation_06_up_is_a_sum_over_the_doubling_filter() {
    for filter in all_filters() {
        let f = noise(32);
        let h = doubling_taps(filter);
        let needed: Vec<f64> = (0..64)
            .map(|i| {
                (-32..64_i64)
                    .map(|k| h(i - 2 * k) * f[k.rem_euclid(32) as usize])
                    .sum()
            })
            .collect();
        let finer = filter.up_line(&f, 64, PERIODIC).expect("a good line");
        assert!(distance(&finer, &needed) < 1e-15, "{filter:?}");
    }
}

#[test]
fn equation_07_down_is_a_sum_over_the_halving_filter() {
    for filter in all_filters() {
        let g = noise(64);
        let a = halving_taps(filter);
        let needed: Vec<f64> = (0..32)
            .map(|i| {
                (-32..32_i64)
                    .map(|k| a(k) * g[(k + 2 * i).rem_euclid(64) as usize])
                    .sum()
            })
            .collect();
        let coarse = filter.down_line(&g, PERIODIC).expect("a good line");
        assert!(distance(&coarse, &needed) < 1e-14, "{filter:?}");
    }
}

#[test]
fn equation_07_down_is_nearest_in_the_least_squares_sense() {
    // Integral of the squared difference of two functions, by samples between which both are smooth.
    let distance_sq = |filter: SplineFilter, fine: &[f64], coarse: &[f64]| -> f64 {
        let origin = coarse_center(filter, 0);
        let difference = |i: i32| {
            let x = (f64::from(i) + 0.5) / 64.0;
            value(filter, fine, x) - value(filter, coarse, (x - origin) / 2.0)
        };
        (0..16 * 64)
            .map(|i| difference(i) * difference(i) / 64.0)
            .sum()
    };
    for degree in DEGREES {
        let filter = of(degree);
        let g = noise(16);
        let nearest = filter.down_line(&g, PERIODIC).expect("a good line");
        let least = distance_sq(filter, &g, &nearest);
        for i in 0..8 {
            for change in [-0.02, 0.02] {
                let mut other = nearest.clone();
                other[i] += change;
                let further = distance_sq(filter, &g, &other);
                assert!(
                    further > least,
                    "{degree:?}: {further} with a change at {i}, {least} without"
                );
            }
        }
    }
}

#[test]
fn equation_08_up_of_rasters_is_a_double_sum() {
    for filter in all_filters() {
        let f = noise_raster(8);
        let h = doubling_taps(filter);
        let at =
            |x: i64, y: i64| f64::from(f.row(y.rem_euclid(8) as u32)[x.rem_euclid(8) as usize]);
        let finer = filter
            .up(&f, [16, 16], [PERIODIC; 2])
            .expect("a good raster");
        for (index, &value) in (0..).zip(finer.pixels()) {
            let (i, j) = (index % 16, index / 16);
            let row = |ky: i64| -> f64 { (-4..12).map(|kx| h(i - 2 * kx) * at(kx, ky)).sum() };
            let needed: f64 = (-4..12).map(|ky| h(j - 2 * ky) * row(ky)).sum();
            // Tolerance: two roundings to f32 of values up to 1.
            assert!(
                (f64::from(value) - needed).abs() < 2e-7,
                "{filter:?} at {i}, {j}"
            );
        }
    }
}

#[test]
fn equation_09_down_of_rasters_is_a_double_sum() {
    for filter in all_filters() {
        let g = noise_raster(64);
        let a = halving_taps(filter);
        let at =
            |x: i64, y: i64| f64::from(g.row(y.rem_euclid(64) as u32)[x.rem_euclid(64) as usize]);
        let coarse = filter.down(&g, [PERIODIC; 2]).expect("a good raster");
        for (i, j) in [(0, 0), (3, 17), (31, 30)] {
            let row =
                |ky: i64| -> f64 { (-32..32).map(|kx| a(kx) * at(kx + 2 * i, ky + 2 * j)).sum() };
            let needed: f64 = (-32..32).map(|ky| a(ky) * row(ky)).sum();
            let value = f64::from(coarse.row(j as u32)[i as usize]);
            // Tolerance: two roundings to f32, of values of about 1, and weights whose sum is up to 3.
            assert!((value - needed).abs() < 1e-6, "{filter:?} at {i}, {j}");
        }
    }
}

#[test]
fn equation_10_raster_is_a_function_of_the_finer_space() {
    for degree in DEGREES {
        let r = noise_raster(8);
        let at =
            |x: i64, y: i64| f64::from(r.row(y.rem_euclid(8) as u32)[x.rem_euclid(8) as usize]);
        for (x, y) in positions().zip(positions().skip(1)).take(10) {
            let row = |j: i64| -> f64 {
                (-24..24)
                    .map(|i| at(i, j) * degree.value(2.0 * x - i as f64))
                    .sum()
            };
            let sum: f64 = (-24..24)
                .map(|j| row(j) * degree.value(2.0 * y - j as f64))
                .sum();
            let gap = (value_2d(of(degree), &r, 2.0 * x, 2.0 * y) - sum).abs();
            assert!(gap < 1e-14, "{degree:?} at {x}, {y}: {gap}");
        }
    }
}

#[test]
fn equation_11_half_size_raster_is_the_function_nearest_to_the_raster() {
    // The difference from the raster's function is orthogonal to every spline of the half size, so halving it gives
    // zero.
    for degree in DEGREES {
        let filter = of(degree);
        let r = noise_raster(16);
        let half = filter.down(&r, [PERIODIC; 2]).expect("a good raster");
        let same = filter
            .up(&half, r.size(), [PERIODIC; 2])
            .expect("a good raster");
        let difference = r.zip_map(&same, |r, same| r - same).expect("equal sizes");
        let rest = filter
            .down(&difference, [PERIODIC; 2])
            .expect("a good raster");
        // Tolerance: a few roundings to f32 of values up to 2.
        assert!(
            rest.pixels().iter().all(|value| value.abs() < 1e-6),
            "{degree:?}: {rest:?}"
        );
    }
}

#[test]
fn equation_12_half_size_raster_is_halved_along_both_axes() {
    for filter in all_filters() {
        let r = noise_raster(16);
        let half = filter.down(&r, [PERIODIC; 2]).expect("a good raster");
        let flipped = Raster::from_fn([16, 16], |x, y| r.row(x)[y as usize]).expect("a good size");
        let half_flipped = filter.down(&flipped, [PERIODIC; 2]).expect("a good raster");
        for (x, y) in [(0, 0), (1, 5), (7, 2), (3, 3)] {
            let [a, b] = [half.row(y)[x as usize], half_flipped.row(x)[y as usize]];
            // The order of the axes affects only the roundings to f32.
            assert!((a - b).abs() < 1e-6, "{filter:?} at {x}, {y}: {a} and {b}");
        }
    }
}

#[test]
fn equation_13_full_size_raster_loses_nothing_of_the_half_size() {
    for filter in all_filters() {
        let half = noise_raster(8);
        let full = filter
            .up(&half, [16, 16], [PERIODIC; 2])
            .expect("a good raster");
        let origin = coarse_center(filter, 0);
        for (x, y) in positions().zip(positions().skip(1)).take(10) {
            let [u, v] = [x, y].map(|x| 2.0 * x + origin);
            let gap = (value_2d(filter, &full, u, v) - value_2d(filter, &half, x, y)).abs();
            // Tolerance: two roundings to f32 of values up to 1.
            assert!(gap < 2e-7, "{filter:?} at {x}, {y}: {gap}");
        }
        let again = filter.down(&full, [PERIODIC; 2]).expect("a good raster");
        let gaps = again
            .pixels()
            .iter()
            .zip(half.pixels())
            .map(|(a, b)| (a - b).abs());
        assert!(gaps.fold(0.0, f32::max) < 1e-6, "{filter:?}");
    }
}
