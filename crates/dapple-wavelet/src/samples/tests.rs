//! Tests of prefilters against the values of splines.

use super::*;
use crate::Degree;
use crate::oracle::{DEGREES, distance, noise};

const BORDERS: [Border; 2] = [Border::Periodic, Border::Mirror];

fn of(degree: Degree) -> SplineFilter {
    SplineFilter {
        degree,
        ..SplineFilter::default()
    }
}

fn samples(degree: Degree, line: &[f64], border: Border) -> Vec<f64> {
    of(degree).samples_line(line, border).expect("a good line")
}

#[test]
fn samples_are_values_at_whole_numbers() {
    for degree in DEGREES {
        for border in BORDERS {
            for len in 2..9 {
                let line = noise(len);
                let values: Vec<f64> = (0..len)
                    .map(|i| {
                        of(degree)
                            .value_line(&line, i as f64, border)
                            .expect("a good line")
                    })
                    .collect();
                let gap = distance(&samples(degree, &line, border), &values);
                // Tolerance: a few roundings.
                assert!(gap < 1e-15, "{degree:?}, {border:?}, {len}: {gap}");
            }
        }
    }
}

#[test]
fn samples_are_those_of_the_formula() {
    let line = [0.0, 8.0, 0.0, 0.0, 0.0];
    assert_eq!(
        samples(Degree::Quadratic, &line, Border::Periodic),
        [1.0, 6.0, 1.0, 0.0, 0.0],
        "quadratic"
    );
    let line = [0.0, 6.0, 0.0, 0.0, 0.0];
    assert_eq!(
        samples(Degree::Cubic, &line, Border::Periodic),
        [1.0, 4.0, 1.0, 0.0, 0.0],
        "cubic"
    );
    assert_eq!(
        samples(Degree::Cubic, &[6.0, 0.0, 0.0], Border::Mirror),
        [4.0, 1.0, 0.0],
        "mirrored once"
    );
    assert_eq!(
        samples(Degree::Quadratic, &[8.0, 0.0, 0.0], Border::Mirror),
        [7.0, 1.0, 0.0],
        "mirrored twice"
    );
    for degree in [Degree::Constant, Degree::Linear] {
        let line = noise(7);
        assert_eq!(samples(degree, &line, Border::Mirror), line, "{degree:?}");
    }
}

#[test]
fn coefficients_undo_samples() {
    for degree in DEGREES {
        for border in BORDERS {
            for len in (1..9).chain([50, 51]) {
                let line = noise(len);
                let Ok(coefficients) = of(degree).coefficients_line(&line, border) else {
                    assert_eq!((border, len), (Border::Mirror, 1), "refused a good line");
                    continue;
                };
                let gap = distance(&samples(degree, &coefficients, border), &line);
                assert!(gap < 1e-12, "{degree:?}, {border:?}, {len}: {gap}");
            }
        }
    }
}

#[test]
fn coefficients_of_rasters_undo_samples() {
    let pixels: Vec<f32> = noise(21 * 10).iter().map(|&value| value as f32).collect();
    let picture = Raster::from_vec([21, 10], pixels).expect("a good size");
    for degree in DEGREES {
        for borders in [BORDERS, [Border::Mirror; 2], [Border::Periodic; 2]] {
            let filter = of(degree);
            let coefficients = filter
                .coefficients(&picture, borders)
                .expect("a good raster");
            let again = filter
                .samples(&coefficients, borders)
                .expect("a good raster");
            let gaps = again
                .pixels()
                .iter()
                .zip(picture.pixels())
                .map(|(a, b)| (a - b).abs());
            let gap = gaps.fold(0.0, f32::max);
            // Tolerance: roundings to f32 of coefficients of up to about 10.
            assert!(gap < 4e-6, "{degree:?}, {borders:?}: {gap}");
        }
    }
}

#[test]
fn value_line_repeats_and_mirrors() {
    for degree in DEGREES {
        let line = noise(5);
        let value = |x, border| {
            of(degree)
                .value_line(&line, x, border)
                .expect("a good line")
        };
        // Positions are exact sums of powers of two, away from discontinuities.
        for x in [-0.375, 0.25, 1.875, 3.125, 4.375] {
            let periodic = value(x, Border::Periodic);
            assert_eq!(
                value(x + 5.0 * 1_048_576.0, Border::Periodic),
                periodic,
                "{degree:?}, {x}"
            );
            let edge = if degree.order() % 2 == 0 { -1.0 } else { 0.0 };
            let gap = (value(edge - x, Border::Mirror) - value(x, Border::Mirror)).abs();
            assert!(gap < 1e-15, "{degree:?}, {x}: {gap}");
        }
    }
}

#[test]
fn bad_samples_are_refused() {
    let filter = SplineFilter::default();
    for border in BORDERS {
        for result in [
            filter.samples_line(&[], border),
            filter.coefficients_line(&[], border),
        ] {
            let error = result.expect_err("no values");
            assert!(
                matches!(error.kind(), WaveletErrorKind::TooShort { length: 0, .. }),
                "{error}"
            );
        }
        let line = [1.0, f64::NAN];
        for result in [
            filter.samples_line(&line, border),
            filter.coefficients_line(&line, border),
        ] {
            let error = result.expect_err("NaN");
            assert!(
                matches!(error.kind(), WaveletErrorKind::NotFinite { index: 1, .. }),
                "{error}"
            );
        }
        for x in [f64::NAN, f64::INFINITY, -1e300] {
            let error = filter
                .value_line(&[1.0, 2.0], x, border)
                .expect_err("nowhere");
            assert!(
                matches!(error.kind(), WaveletErrorKind::Range { .. }),
                "{error}"
            );
        }
    }
    let pixels = Raster::filled([3, 1], f32::NAN).expect("a good size");
    assert!(
        filter.coefficients(&pixels, BORDERS).is_err(),
        "a mirrored side of 1"
    );
    assert!(
        filter.coefficients(&pixels, [Border::Periodic; 2]).is_err(),
        "NaN"
    );
}

#[test]
fn value_stability_coefficients_line() {
    let line = [0.0, 1.0, 4.0, 2.0, -1.0];
    let bits = [Degree::Quadratic, Degree::Cubic].map(|degree| {
        let line = of(degree)
            .coefficients_line(&line, Border::Mirror)
            .expect("a good line");
        line[2].to_bits()
    });
    assert_eq!(
        bits,
        [0x4013_9611_a7b9_611a, 0x4015_8000_0000_0001],
        "{bits:#x?}"
    );
}
