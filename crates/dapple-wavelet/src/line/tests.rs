//! Tests of the properties of the filters; `vectors` has their pinned values.

mod vectors;

use super::*;
use crate::ends::shortest;
use crate::oracle::{self, DEGREES, all_filters, distance, noise};
use crate::{Degree, Fit, Phase};

const PERIODIC: Border = Border::Periodic;

fn down(filter: SplineFilter, fine: &[f64], border: Border) -> Vec<f64> {
    filter
        .down_line(fine, border)
        .expect("a line that can be halved")
}

fn up(filter: SplineFilter, coarse: &[f64], len: usize, border: Border) -> Vec<f64> {
    filter
        .up_line(coarse, len, border)
        .expect("a line that can be doubled")
}

fn project(filter: SplineFilter, fine: &[f64], levels: u32) -> Vec<f64> {
    filter
        .project_line(fine, levels, PERIODIC)
        .expect("a line that can be halved")
}

/// Checks that lines differ by less than 1e-12: a few dozen roundings of values of about 1.
fn assert_near(line: &[f64], needed: &[f64], what: &str) {
    let distance = distance(line, needed);
    assert!(distance < 1e-12, "{what}: {distance} apart");
}

#[test]
fn down_agrees_with_dense_least_squares() {
    for filter in all_filters() {
        for border in [PERIODIC, Border::Mirror] {
            for len in shortest(filter, border)..14 {
                if border == PERIODIC && len % 2 == 1 {
                    continue;
                }
                let fine = noise(len);
                let needed = oracle::down(filter, &fine, border);
                let coarse = down(filter, &fine, border);
                assert_near(&coarse, &needed, &format!("{filter:?}, {len}, {border:?}"));
            }
        }
    }
}

#[test]
fn up_agrees_with_spread_splines() {
    for filter in all_filters() {
        for border in [PERIODIC, Border::Mirror] {
            for len in shortest(filter, border)..14 {
                let Ok(coarse_len) = filter.coarse_len(len, border) else {
                    assert_eq!((border, len % 2), (PERIODIC, 1), "refused a good length");
                    continue;
                };
                let coarse = noise(coarse_len);
                let needed = oracle::up(filter, &coarse, len, border);
                let fine = up(filter, &coarse, len, border);
                assert_near(&fine, &needed, &format!("{filter:?}, {len}, {border:?}"));
            }
        }
    }
}

#[test]
fn down_undoes_up() {
    for filter in all_filters() {
        for (len, border) in [
            (64, PERIODIC),
            (2, PERIODIC),
            (64, Border::Mirror),
            (37, Border::Mirror),
        ] {
            let coarse = noise(filter.coarse_len(len, border).expect("a good length"));
            let again = down(filter, &up(filter, &coarse, len, border), border);
            assert_near(&again, &coarse, &format!("{filter:?}, {len}, {border:?}"));
        }
    }
}

#[test]
fn project_changes_nothing_twice() {
    for filter in all_filters() {
        let once = project(filter, &noise(96), 3);
        assert_near(&project(filter, &once, 3), &once, &format!("{filter:?}"));
    }
}

#[test]
fn project_keeps_constants() {
    for filter in all_filters() {
        for border in [PERIODIC, Border::Mirror] {
            let line = filter
                .project_line(&[0.7; 32], 2, border)
                .expect("a good length");
            // Required: 1e-13 for a constant of 1.
            assert!(
                distance(&line, &[0.7; 32]) < 1e-13,
                "{filter:?}, {border:?}"
            );
        }
    }
}

#[test]
fn project_of_no_levels_is_the_line() {
    assert_eq!(
        project(SplineFilter::default(), &[1.0, 2.0, 4.0], 0),
        [1.0, 2.0, 4.0],
        "zero levels"
    );
}

#[test]
fn residual_is_orthogonal_to_coarse_functions() {
    // Transpose of H applied to the fine Gram matrix times the residual
    for degree in DEGREES {
        let filter = SplineFilter {
            degree,
            ..SplineFilter::default()
        };
        let fine = noise(48);
        let kept = project(filter, &fine, 1);
        let residual: Vec<f64> = fine
            .iter()
            .zip(&kept)
            .map(|(fine, kept)| fine - kept)
            .collect();
        let gram = crate::kernel::gram(degree);
        let sum: f64 = gram.iter().sum();
        let at = |i: i64| residual[i.rem_euclid(48) as usize];
        let products: Vec<f64> = (0..48)
            .map(|i| {
                (0..)
                    .zip(gram)
                    .map(|(k, b)| b / sum * at(i + k - degree.order()))
                    .sum()
            })
            .collect();
        let (first, _) = oracle::spread(filter);
        for j in 0..24 {
            let h = oracle::binomials(degree);
            let product: f64 = (first..)
                .zip(&h)
                .map(|(k, h)| h * products[(2 * j + k).rem_euclid(48) as usize])
                .sum();
            assert!(product.abs() < 1e-13, "{degree:?}: {product} at {j}");
        }
    }
}

#[test]
fn residual_of_coefficients_is_orthogonal_to_coarse_lines() {
    for degree in DEGREES {
        let filter = SplineFilter {
            degree,
            fit: Fit::Coefficients,
            ..SplineFilter::default()
        };
        let (fine, other) = (noise(48), noise(24));
        let kept = project(filter, &fine, 1);
        let coarse = up(filter, &other, 48, PERIODIC);
        let product: f64 = (0..48).map(|i| (fine[i] - kept[i]) * coarse[i]).sum();
        assert!(product.abs() < 1e-13, "{degree:?}: {product}");
    }
}

#[test]
fn project_moves_with_even_shifts_only() {
    let shifted = |line: &[f64], by: usize| [&line[by..], &line[..by]].concat();
    for filter in all_filters() {
        let fine = noise(64);
        let kept = project(filter, &fine, 1);
        let gap = |by| {
            distance(
                &project(filter, &shifted(&fine, by), 1),
                &shifted(&kept, by),
            )
        };
        assert!(
            gap(2) < 1e-13,
            "{filter:?}: {} apart under a shift by 2",
            gap(2)
        );
        assert!(
            gap(1) > 1e-2,
            "{filter:?}: {} apart under a shift by 1",
            gap(1)
        );
    }
}

#[test]
fn bad_lines_are_refused() {
    let filter = SplineFilter::default();
    let kind =
        |result: Result<Vec<f64>, WaveletError>| result.expect_err("a bad line").kind().clone();
    let short = |length| WaveletErrorKind::TooShort { length, least: 2 };
    for border in [PERIODIC, Border::Mirror] {
        for len in [0, 1] {
            assert_eq!(
                kind(filter.down_line(&vec![1.0; len], border)),
                short(len),
                "down of {len}"
            );
            assert_eq!(
                kind(filter.up_line(&[1.0], len, border)),
                short(len),
                "up to {len}"
            );
            let projected = filter.project_line(&vec![1.0; len], 1, border);
            let is_refused = matches!(
                projected.expect_err("a bad line").kind(),
                WaveletErrorKind::TooShort { .. } | WaveletErrorKind::NotDivisible { .. }
            );
            assert!(is_refused, "projection of {len}");
        }
    }
    let odd = WaveletErrorKind::NotDivisible {
        length: 5,
        levels: 1,
    };
    assert_eq!(kind(filter.down_line(&[0.0; 5], PERIODIC)), odd, "odd");
    let twice = WaveletErrorKind::NotDivisible {
        length: 6,
        levels: 2,
    };
    assert_eq!(
        kind(filter.project_line(&[0.0; 6], 2, PERIODIC)),
        twice,
        "six, twice"
    );
    let length = WaveletErrorKind::Length {
        length: 5,
        needed: 4,
    };
    assert_eq!(
        kind(filter.up_line(&[0.0; 5], 8, PERIODIC)),
        length,
        "five for eight"
    );
    assert_eq!(
        kind(filter.project_line(&[0.0; 3], 3, Border::Mirror)),
        short(1),
        "three, thrice"
    );
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let line = [0.0, 1.0, value, value];
        let errors = [
            filter.down_line(&line, PERIODIC),
            filter.up_line(&line, 8, PERIODIC),
            filter.project_line(&line, 0, PERIODIC),
        ];
        for error in errors.map(kind) {
            assert!(
                matches!(error, WaveletErrorKind::NotFinite { index: 2, .. }),
                "{error:?}"
            );
        }
    }
}

#[test]
fn mirrored_levels_are_those_of_the_mirrored_line_where_its_mirrors_fit() {
    for filter in all_filters() {
        let odd = filter.degree.order() as usize % 2;
        for (len, levels) in (5..20).flat_map(|len| (1..4).map(move |levels| (len, levels))) {
            let Ok(lengths) = lengths(filter, len, levels, Border::Mirror) else {
                continue;
            };
            let line = noise(len);
            let needed = project(filter, &mirrored_eight_times(&line, odd), levels);
            let kept = filter.project_line(&line, levels, Border::Mirror);
            let gap = distance(&kept.expect("a good length"), &needed[..len]);
            let halved_again = &lengths[..levels as usize - 1];
            let fits =
                filter.phase == Phase::Centered && halved_again.iter().all(|len| len % 2 == odd);
            let is_exact = levels == 1 || fits;
            // Pairs of steps in a line of even length do not overlap its mirrors.
            let may_be_exact = filter.degree == Degree::Constant;
            // Either rounding errors of values of about 1, or a clear difference.
            let holds = if is_exact {
                gap < 1e-12
            } else {
                gap > 1e-4 || may_be_exact
            };
            assert!(holds, "{filter:?}, {len}, {levels} levels: {gap}");
        }
    }
}

/// Returns eight periods of the mirrored line, enough for up to three levels. `once` is 1 if the mirror does not
/// repeat its end values, and 0 if it does.
fn mirrored_eight_times(line: &[f64], once: usize) -> Vec<f64> {
    let back = line[once..line.len() - once].iter().rev();
    let period: Vec<f64> = line.iter().chain(back).copied().collect();
    period.repeat(8)
}

#[test]
fn down_stays_within_its_bound_and_comes_near_to_it() {
    let mut most = [0.0_f64; 2];
    for filter in all_filters() {
        let taps: Vec<f64> = (0..128)
            .map(|k| down(filter, &impulse_at(k), PERIODIC)[0])
            .collect();
        // Values with the maximum response: each has the sign of its tap.
        let worst =
            |size: f64| -> Vec<f64> { taps.iter().map(|tap| size.copysign(*tap)).collect() };
        let cubic = usize::from(filter.degree == Degree::Cubic);
        most[cubic] = most[cubic].max(down(filter, &worst(1.0), PERIODIC)[0]);
        for border in [PERIODIC, Border::Mirror] {
            let coarse = down(filter, &worst(f64::MAX / 4.0), border);
            let finite = coarse.iter().all(|value| value.is_finite());
            assert!(finite, "{filter:?}, {border:?}");
            let line = worst(f64::MAX / 64.0);
            let kept = filter
                .project_line(&line, 3, border)
                .expect("a good length");
            let finite = kept.iter().all(|value| value.is_finite());
            assert!(finite, "{filter:?}, {border:?}, three levels");
        }
        let coarse = down(filter, &worst(f64::MAX), PERIODIC)[0];
        assert!(!coarse.is_finite(), "{filter:?}: {coarse}");
    }
    // Bounds in the documentation, rounded up
    for (most, bound) in most.into_iter().zip([2.33, 3.82]) {
        assert!((bound - 0.01..bound).contains(&most), "{most}, not {bound}");
    }
}

/// Returns a line of 128 coefficients that are 0 except for a 1 at `index`.
fn impulse_at(index: usize) -> Vec<f64> {
    let mut line = vec![0.0; 128];
    line[index] = 1.0;
    line
}
