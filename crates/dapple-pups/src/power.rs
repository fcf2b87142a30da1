//! Computes powers of numbers in `[0, 1]`, with the same bits at every SIMD level.
//!
//! `w^e = 2^(e · log₂ w)`, with two polynomials whose coefficients minimize the maximum error (fitted in double
//! precision; their comments state the errors). Only sums, products and integer operations are used. The relative error
//! of the result is at most `4e-6 · (1 + e) + 1e-7 · e · |log₂ w|`, for powers above 1e-30 of normal numbers `w`.

use fearless_simd::prelude::*;

/// `log₂(1 + x) = x · P(x)` for `x` from `√½ − 1` to `√2 − 1`, with an error up to 2.3e-6.
const LOG2: [f32; 6] = [
    1.442_712_9,
    -0.721_135_85,
    0.479_364_13,
    -0.367_429_32,
    0.322_039_8,
    -0.206_722_7,
];

/// `2^f = 1 + f · P(f)` for `f` from −½ to ½, with an error up to 2.7e-6.
const EXP2: [f32; 4] = [0.693_121_55, 0.240_220_22, 0.055_919_46, 0.009_681_896];

/// Minimum binary exponent. Smaller ones are clamped to it; the result is then negligible.
const LEAST_EXPONENT: f32 = -126.0;

/// Raises `bases` in `[0, 1]` to the powers `exponents`, at least 0. Zero and one are fixed points.
///
/// Each step is computed for all elements before the next step, which hides its latency.
#[inline(always)]
pub(crate) fn powers<S: Simd, V: SimdFloat<S, Element = f32>, const N: usize>(
    simd: S,
    bases: &[V; N],
    exponents: &[V; N],
) -> [V; N] {
    /// Bits of √½, the start of the range of mantissas.
    const SQRT_HALF: u32 = 0x3F35_04F3;
    const ONE: u32 = 0x3F80_0000;
    /// Bits of the float 2^23. Adding an integer below 2^23 gives the bits of 2^23 plus that integer.
    const WHOLE: u32 = 0x4B00_0000;
    /// Rounding constant. Adding it to a float leaves the nearest integer in the lowest bits.
    const ROUND: f32 = 12_582_912.0;

    let mut x = *bases;
    let mut scaled = *bases;
    // Split each base into a binary exponent and a mantissa from √½ to √2.
    for i in 0..N {
        let bits = bases[i].to_bits() + (ONE - SQRT_HALF);
        x[i] = V::from_bits((bits & 0x007F_FFFF) + SQRT_HALF) - 1.0;
        // An integer in the low bits of 2^23 is a float; subtract 2^23 and the exponent's bias.
        scaled[i] = V::from_bits((bits >> 23) | WHOLE) - (8_388_608.0 + 127.0);
    }
    // Compute `e · log₂ w`, and split it into the nearest integer and a fraction.
    let logarithms = polynomials(simd, LOG2, &x);
    let mut rounded = x;
    for i in 0..N {
        scaled[i] = (scaled[i] + x[i] * logarithms[i]) * exponents[i];
        scaled[i] = scaled[i].max(V::splat(simd, LEAST_EXPONENT));
        // Adding 1.5 · 2^23 rounds to an integer, which is then in the low bits.
        rounded[i] = scaled[i] + ROUND;
        scaled[i] -= rounded[i] - ROUND;
    }
    // Compute 2 to the fraction, and add the integer to the exponent's bits.
    let fractions = polynomials(simd, EXP2, &scaled);
    let zero = V::splat(simd, 0.0);
    for i in 0..N {
        let fraction = scaled[i] * fractions[i] + 1.0;
        let result = V::from_bits(fraction.to_bits() + (rounded[i].to_bits() << 23));
        x[i] = bases[i].simd_gt(zero).select(result, zero);
    }
    x
}

/// Evaluates polynomials by Horner's scheme. The constant term is the first of `coefficients`.
#[inline(always)]
fn polynomials<S: Simd, V: SimdFloat<S, Element = f32>, const DEGREE: usize, const N: usize>(
    simd: S,
    coefficients: [f32; DEGREE],
    x: &[V; N],
) -> [V; N] {
    let mut sums = [V::splat(simd, coefficients[DEGREE - 1]); N];
    for &coefficient in coefficients[..DEGREE - 1].iter().rev() {
        for i in 0..N {
            sums[i] = sums[i] * x[i] + coefficient;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::powers;
    use dapple_raster::simd::dispatch;
    use dapple_raster::simd::for_every_level;
    use fearless_simd::prelude::*;

    fn powers_of(level: fearless_simd::Level, pairs: &[(f32, f32)]) -> Vec<f32> {
        let one =
            |&(base, exponent): &(f32, f32)| dispatch!(level, simd => power(simd, base, exponent));
        pairs.iter().map(one).collect()
    }

    #[inline(always)]
    fn power<S: Simd>(simd: S, base: f32, exponent: f32) -> f32 {
        let [base, exponent] = [base, exponent].map(|number| S::f32s::splat(simd, number));
        powers(simd, &[base], &[exponent])[0].as_slice()[0]
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
        let reference = powers_of(fearless_simd::Level::baseline(), &pairs);
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
                bits(powers_of(level, &pairs)),
                bits(reference.clone()),
                "{level:?}"
            );
        });
    }
}
