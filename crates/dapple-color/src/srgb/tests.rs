//! Proofs of the tables with integers of arbitrary size.
//!
//! On the curved part `x = ((v + 0.055) / 1.055)^(12/5)`, so a number `x` is below the curve at `v` exactly if `x^5 <
//! y^12` with `y = (1000 v + 55) / 1055`. If `v` is a fraction of two small integers and `x` is an integer times a
//! power of two, both sides become integers after multiplication by the denominators.

use super::{curve_u8, curve_u16};
use core::cmp::Ordering;

/// A nonnegative integer in 32-bit digits, least significant first, without leading zeros.
#[derive(Clone, PartialEq, Eq)]
struct Natural(Vec<u32>);

impl Natural {
    fn times(mut self, factor: u64) -> Self {
        let mut carry = 0_u128;
        for digit in &mut self.0 {
            let sum = u128::from(*digit) * u128::from(factor) + carry;
            (*digit, carry) = (sum as u32, sum >> 32);
        }
        while carry > 0 {
            self.0.push(carry as u32);
            carry >>= 32;
        }
        self
    }

    fn product(factors: impl IntoIterator<Item = u64>) -> Self {
        factors.into_iter().fold(Self(vec![1]), Self::times)
    }

    fn compare(&self, other: &Self) -> Ordering {
        let by_length = self.0.len().cmp(&other.0.len());
        by_length.then_with(|| self.0.iter().rev().cmp(other.0.iter().rev()))
    }
}

/// Compares `x`, a multiple of 2^-63 in `[2^-40, 2)`, with the curve at `numerator / denominator`.
fn compare_with_curve(x: f64, [numerator, denominator]: [u64; 2]) -> Ordering {
    let exponent = 1 + 1023 - (x.to_bits() >> 52) as i32 + 52;
    let mantissa = (x.to_bits() & ((1 << 52) - 1)) | (1 << 52);
    let (zeros, shift) = (mantissa.trailing_zeros(), (exponent - 1) as u32);
    let (mantissa, shift) = (mantissa >> zeros, (shift - zeros) as usize);
    let twos = |count: usize| core::iter::repeat_n(2_u64, count);
    if numerator as f64 <= 0.040_45 * denominator as f64 {
        // x < v / 12.92, with both sides multiplied by 1292 · denominator · 2^shift.
        let left = Natural::product([mantissa, 1292, denominator]);
        let right = Natural::product([numerator, 100].into_iter().chain(twos(shift)));
        return left.compare(&right);
    }
    let (top, bottom) = (1000 * numerator + 55 * denominator, 1055 * denominator);
    let left = Natural::product([mantissa; 5].into_iter().chain([bottom; 12]));
    let right = Natural::product([top; 12].into_iter().chain(twos(5 * shift)));
    left.compare(&right)
}

/// Returns the midpoint of two adjacent numbers, which `f64` represents exactly.
fn middle(a: f32, b: f32) -> f64 {
    f64::midpoint(f64::from(a), f64::from(b))
}

#[test]
fn every_linear_value_is_the_nearest_to_the_true_one() {
    for curve in [curve_u8(), curve_u16()] {
        let max = curve.linear.len() as u64 - 1;
        assert_eq!(
            (curve.decode(0), curve.decode(max as u16)),
            (0.0, 1.0),
            "the ends of the curve"
        );
        for code in 1..max {
            let value = curve.decode(code as u16);
            let below = compare_with_curve(middle(value.next_down(), value), [code, max]);
            let above = compare_with_curve(middle(value, value.next_up()), [code, max]);
            assert_eq!(
                (below, above),
                (Ordering::Less, Ordering::Greater),
                "code {code} of {max}"
            );
        }
    }
}

#[test]
fn every_border_is_the_smallest_number_above_the_true_one() {
    for curve in [curve_u8(), curve_u16()] {
        let max = curve.linear.len() as u64 - 1;
        for code in 0..max {
            let border = curve.borders[code as usize];
            let half = [2 * code + 1, 2 * max];
            let at = compare_with_curve(border.into(), half);
            let below = compare_with_curve(border.next_down().into(), half);
            assert_eq!(
                (below, at),
                (Ordering::Less, Ordering::Greater),
                "the border above code {code} of {max}"
            );
        }
    }
}

#[test]
fn encoding_changes_at_the_borders_and_nowhere_else() {
    for curve in [curve_u8(), curve_u16()] {
        let last = curve.borders.len() - 1;
        for (code, &border) in (0..u16::MAX).zip(&curve.borders[..last]) {
            let codes = [border.next_down(), border].map(|linear| curve.encode(linear));
            assert_eq!(codes, [code, code + 1], "on both sides of {border}");
        }
    }
}

#[test]
fn every_code_survives_the_round_trip() {
    for curve in [curve_u8(), curve_u16()] {
        for code in 0..curve.linear.len() as u32 {
            let code = code as u16;
            assert_eq!(curve.encode(curve.decode(code)), code, "code {code}");
        }
    }
}

#[test]
fn encoding_equals_a_search_of_the_borders() {
    for curve in [curve_u8(), curve_u16()] {
        let oracle = |linear: f32| curve.borders.partition_point(|&border| border <= linear);
        // A prime step through the bits of all numbers from 0 to above 1 visits every binade a few hundred times.
        for bits in (0..1.1_f32.to_bits()).step_by(3079) {
            let linear = f32::from_bits(bits);
            assert_eq!(
                usize::from(curve.encode(linear)),
                oracle(linear),
                "{linear}"
            );
        }
    }
}

#[test]
fn numbers_outside_of_the_range_become_the_ends() {
    for curve in [curve_u8(), curve_u16()] {
        let max = (curve.linear.len() - 1) as u16;
        for low in [
            f32::NAN,
            -f32::NAN,
            f32::NEG_INFINITY,
            -1.0,
            -0.0,
            0.0,
            1e-45,
        ] {
            assert_eq!(curve.encode(low), 0, "{low}");
        }
        for high in [1.0, 1.000_1, 1e30, f32::INFINITY] {
            assert_eq!(curve.encode(high), max, "{high}");
        }
    }
}

#[test]
fn value_stability_srgb() {
    let decoded = [1, 10, 11, 128, 254].map(|code| curve_u8().decode(code).to_bits());
    assert_eq!(
        decoded,
        [966730420, 994503521, 995840398, 1046284937, 1065203934]
    );
    let encoded = [1e-5, 0.003, 0.2, 0.5, 0.999].map(|linear| curve_u16().encode(linear));
    assert_eq!(encoded, [8, 2540, 31754, 48192, 65506]);
}
