//! Tests of transforms against the naive sum.

use super::*;
use proptest::prelude::*;

/// Iterates over lengths with the factors 2, 3, 5 and 7, alone and combined, and primes that need the convolution.
fn lengths() -> impl Iterator<Item = usize> {
    (1..=40).chain([97, 100, 128, 343, 360])
}

/// Returns unstructured values between −1 and 1.
fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

fn random_lines(length: usize) -> Vec<Element> {
    let values = noise(length * BAND, 1);
    let element = |at: usize| core::array::from_fn(|line| values[at * BAND + line]);
    (0..length).map(element).collect()
}

/// Transforms one line by the definition.
fn naive(lines: &[Element], lane: usize) -> Vec<[f64; 2]> {
    let n = lines.len();
    let frequency = |k: usize| {
        let mut sum = [0.0, 0.0];
        for (x, element) in lines.iter().enumerate() {
            let [cos, sin] = turn((k * x) as u64, n as u64);
            sum[0] += element[lane] * cos - element[LANES + lane] * sin;
            sum[1] += element[lane] * sin + element[LANES + lane] * cos;
        }
        sum
    };
    (0..n).map(frequency).collect()
}

#[test]
fn forward_equals_the_definition_for_every_kind_of_length() {
    for length in lengths() {
        let lines = random_lines(length);
        let mut spectra = lines.clone();
        Fourier::new(length).forward(&mut spectra);
        for lane in [0, 3, LANES - 1] {
            for (k, [re, im]) in naive(&lines, lane).into_iter().enumerate() {
                let error = (spectra[k][lane] - re)
                    .abs()
                    .max((spectra[k][LANES + lane] - im).abs());
                // Rounding of up to 360 terms of about 1; the sum of the definition is less exact than the transform.
                assert!(error < 1e-12, "length {length}, frequency {k}: {error}");
            }
        }
    }
}

#[test]
fn backward_after_forward_gives_the_lines_times_their_length() {
    for length in lengths() {
        let lines = random_lines(length);
        let fourier = Fourier::new(length);
        let mut back = lines.clone();
        fourier.forward(&mut back);
        fourier.backward(&mut back);
        for (back, wanted) in back.as_flattened().iter().zip(lines.as_flattened()) {
            let error = (back / length as f64 - wanted).abs();
            // A few dozen roundings of values of about 1.
            assert!(error < 1e-14, "length {length}: {error}");
        }
    }
}

#[test]
fn a_line_has_the_same_bits_in_whatever_company() {
    for length in [31, 64, 105, 360] {
        let mut many = random_lines(length);
        let mut one: Vec<_> = many.iter().map(|element| only(element, 5)).collect();
        let fourier = Fourier::new(length);
        fourier.forward(&mut many);
        fourier.forward(&mut one);
        for (many, one) in many.iter().zip(&one) {
            assert_eq!(only(many, 5), *one, "length {length}");
        }
    }
}

/// Returns an element with zeros in all lines except `lane`.
fn only(element: &Element, lane: usize) -> Element {
    let mut only = [0.0; BAND];
    only[lane] = element[lane];
    only[LANES + lane] = element[LANES + lane];
    only
}

#[test]
fn power_spectrum_equals_the_definition() {
    for size in [[1, 1], [1, 6], [7, 1], [2, 2], [6, 5], [33, 18], [17, 40]] {
        let [width, height] = size;
        let values = noise(width * height, 3);
        let powers = power_spectrum(&values, size);
        for (k, power) in powers.iter().enumerate() {
            let [kx, ky] = [k % width, k / width];
            let mut sum = [0.0, 0.0];
            for (at, value) in values.iter().enumerate() {
                let steps = kx * (at % width) * height + ky * (at / width) * width;
                let [cos, sin] = turn(steps as u64, (width * height) as u64);
                sum[0] += value * cos;
                sum[1] += value * sin;
            }
            let wanted = sum[0] * sum[0] + sum[1] * sum[1];
            // Sums of up to 680 terms, squared.
            let error = (power - wanted).abs() / (1.0 + wanted);
            assert!(error < 1e-11, "{size:?} at {kx}, {ky}: {error}");
        }
    }
}

#[test]
fn power_spectrum_keeps_the_sum_of_squares() {
    for size in [[1, 1], [3, 4], [64, 48], [31, 37]] {
        let values = noise(size[0] * size[1], 4);
        let sum: f64 = power_spectrum(&values, size).iter().sum();
        let squares: f64 = values.iter().map(|value| value * value).sum();
        let wanted = squares * values.len() as f64;
        // Parseval's theorem; both sums round some thousand times.
        assert!((sum / wanted - 1.0).abs() < 1e-12, "{size:?}: {sum}");
    }
}

#[test]
fn value_stability_fourier() {
    let transformed = |length: usize| {
        let mut lines = random_lines(length);
        Fourier::new(length).forward(&mut lines);
        [lines[length / 3][2], lines[length / 3][LANES + 2]].map(f64::to_bits)
    };
    let bits = [transformed(420), transformed(11)];
    let pinned = [
        [4_613_782_699_444_185_812, 4_620_985_999_273_285_417],
        [13_835_399_329_570_157_991, 4_605_214_492_366_644_560],
    ];
    assert_eq!(bits, pinned, "the bits have not changed");
}

proptest! {
    #[test]
    fn map_columns_twice_gives_back_what_is_not_changed(width in 1_usize..50, height in 1_usize..50) {
        let plane = noise(width * height, 6);
        let turned = map_columns(&plane, width, &|| false, |lines| lines).unwrap();
        let back = map_columns(&turned, height, &|| false, |lines| lines).unwrap();
        prop_assert_eq!(turned[height * (width - 1)], plane[width - 1], "it is transposed");
        prop_assert_eq!(back, plane);
    }
}
