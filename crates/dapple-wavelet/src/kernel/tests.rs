//! Tests of taps and poles against their definitions.

use super::*;
use crate::oracle::{DEGREES, all_filters, binomials};

/// Returns the value at `z` of a symmetric polynomial whose powers are centered on 0.
fn at(polynomial: &[f64], z: f64) -> f64 {
    let mut powers = 1.0;
    let mut sum = 0.0;
    for coefficient in polynomial {
        sum += coefficient * powers;
        powers *= z;
    }
    sum
}

#[test]
fn poles_are_roots_of_what_they_invert() {
    for degree in DEGREES {
        let h = two_scale(degree);
        let autocorrelation = convolve(&h, &h);
        // Powers with the parity of the middle one
        let even: Vec<f64> = autocorrelation
            .iter()
            .skip((degree.order() as usize + 1) % 2)
            .step_by(2)
            .copied()
            .collect();
        let inverted = [
            (gram(degree).to_vec(), function_poles(degree)),
            (even, coefficient_poles(degree)),
            (samples(degree).to_vec(), sample_poles(degree)),
        ];
        for (polynomial, poles) in inverted {
            assert_eq!(
                polynomial.len(),
                2 * poles.len() + 1,
                "{degree:?}: not all poles are there"
            );
            let scale: f64 = polynomial.iter().sum();
            for &pole in poles {
                assert!(
                    pole.abs() < 1.0,
                    "{degree:?}: {pole} is outside of the unit circle"
                );
                // The pole is rounded to 53 bits, and the slope of the polynomial is at most its sum.
                let value = at(&polynomial, pole);
                assert!(value.abs() < 1e-15 * scale, "{degree:?}: {value} at {pole}");
            }
        }
    }
}

#[test]
fn two_scale_coefficients_are_binomials() {
    for degree in DEGREES {
        assert_eq!(two_scale(degree), binomials(degree), "{degree:?}");
    }
}

#[test]
fn halving_taps_are_those_of_the_note() {
    let kernel = Kernel::halving(SplineFilter::default());
    let sum: f64 = kernel.taps.iter().sum();
    let note = [1.0, 29.0, 147.0, 303.0, 303.0, 147.0, 29.0, 1.0];
    assert_eq!(kernel.first, -3, "the first tap");
    assert_eq!(kernel.taps.len(), note.len(), "the number of taps");
    for (tap, note) in kernel.taps.iter().zip(note) {
        // Tolerance: two roundings.
        assert!(
            (tap / sum - note / 960.0).abs() < 1e-15,
            "{tap} for {note}/960"
        );
    }
}

#[test]
fn reach_is_enough_and_not_much_more() {
    for filter in all_filters() {
        let kernel = Kernel::halving(filter);
        let slowest = kernel
            .poles
            .iter()
            .fold(0.0_f64, |most, pole| most.max(pole.abs()));
        let left = (0..=kernel.reach()).fold(1.0, |left, _| left * slowest);
        assert!(left <= FORGOTTEN, "{filter:?} forgets too little");
        assert!(
            kernel.reach() < 70,
            "{filter:?} reaches over {}",
            kernel.reach()
        );
    }
}
