//! Powers of numbers in `[0, 1]`, the same bits at every SIMD level.
//!
//! `w^e = 2^(e · log₂ w)`, with two polynomials whose coefficients minimize the largest error (fitted in double
//! precision; the errors are stated beside them). Only sums, products and integer operations are used. The result is
//! within `4e-6 · (1 + e) + 1e-7 · e · |log₂ w|` of the true power, relative to it, where that is above 1e-30 and `w` is a normal number.

use fearless_simd::prelude::*;

/// `log₂(1 + x) = x · P(x)` for `x` from `√½ − 1` to `√2 − 1`, up to 2.3e-6.
const LOG2: [f32; 6] = [
    1.442_712_9,
    -0.721_135_85,
    0.479_364_13,
    -0.367_429_32,
    0.322_039_8,
    -0.206_722_7,
];

/// `2^f = 1 + f · P(f)` for `f` from −½ to ½, up to 2.7e-6.
const EXP2: [f32; 4] = [0.693_121_55, 0.240_220_22, 0.055_919_46, 0.009_681_896];

/// The bits of √½, where the mantissas of [`power`] begin.
const SQRT_HALF: i32 = 0x3F35_04F3;

/// Below this exponent the result is zero, for all that matters.
const LEAST_EXPONENT: f32 = -126.0;

/// `base` to the power of `exponent`: `base` in `[0, 1]`, `exponent` at least 0. Zero stays zero, one stays one.
#[inline(always)]
pub(crate) fn power<S: Simd>(simd: S, base: S::f32s, exponent: S::f32s) -> S::f32s {
    let bits: S::i32s = base.bitcast();
    let whole = (bits - SQRT_HALF) >> 23;
    let mantissa: S::f32s = (bits - (whole << 23)).bitcast();
    let x = mantissa - 1.0;
    let logarithm = whole.to_float::<S::f32s>() + x * polynomial(simd, LOG2, x);

    let scaled = (logarithm * exponent).max(LEAST_EXPONENT);
    let whole = scaled.round_ties_even();
    let f = scaled - whole;
    let fraction = f * polynomial(simd, EXP2, f) + 1.0;
    let fraction_bits: S::i32s = fraction.bitcast();
    let result: S::f32s = (fraction_bits + (whole.to_int::<S::i32s>() << 23)).bitcast();

    let zero = S::f32s::splat(simd, 0.0);
    base.simd_gt(zero).select(result, zero)
}

/// Horner's scheme, the constant first in `coefficients`.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(simd: S, coefficients: [f32; N], x: S::f32s) -> S::f32s {
    let mut sum = S::f32s::splat(simd, coefficients[N - 1]);
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = sum * x + coefficient;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::power;
    use crate::simd::for_every_level;
    use fearless_simd::{dispatch, prelude::*};

    fn powers(level: fearless_simd::Level, pairs: &[(f32, f32)]) -> Vec<f32> {
        let one = |&(base, exponent): &(f32, f32)| dispatch!(level, simd => one_power(simd, base, exponent));
        pairs.iter().map(one).collect()
    }

    #[inline(always)]
    fn one_power<S: Simd>(simd: S, base: f32, exponent: f32) -> f32 {
        let [base, exponent] = [base, exponent].map(|number| S::f32s::splat(simd, number));
        power::<S>(simd, base, exponent).as_slice()[0]
    }

    #[test]
    fn powers_are_accurate_and_equal_at_every_level() {
        let bases = (0..=2000).map(|step| step as f32 / 2000.0).chain([
            1.2e-38,
            1e-30,
            1e-10,
            1.0 - f32::EPSILON / 2.0,
        ]);
        let exponents = [0.0, 0.1, 0.5, 1.0, 1.5, 2.0, 10.0, 1e6];
        let pairs: Vec<_> = bases
            .flat_map(|base| exponents.map(|exponent| (base, exponent)))
            .collect();
        let reference = powers(fearless_simd::Level::baseline(), &pairs);
        for (&(base, exponent), &result) in pairs.iter().zip(&reference) {
            let exact = if base == 0.0 {
                0.0
            } else {
                libm::pow(f64::from(base), f64::from(exponent))
            };
            let (exponent, logarithm) = (
                f64::from(exponent),
                libm::log2(f64::from(base.max(1e-38))).abs(),
            );
            let tolerance = 1e-30 + exact * (4e-6 * (1.0 + exponent) + 1e-7 * exponent * logarithm);
            let off = (f64::from(result) - exact).abs();
            assert!(
                off <= tolerance,
                "{base} to the {exponent} is {result}, not {exact}"
            );
        }
        for_every_level(|level| {
            let bits = |values: Vec<f32>| values.into_iter().map(f32::to_bits).collect::<Vec<_>>();
            assert_eq!(
                bits(powers(level, &pairs)),
                bits(reference.clone()),
                "{level:?}"
            );
        });
    }
}
