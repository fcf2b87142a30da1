//! Computes the arctangent of 16 numbers at once, with the same bits on every platform.
//!
//! For `|x|` up to 1 the result is `x P(x²)`, where `P` is the polynomial of degree 8 with the minimum largest
//! relative error (1.5e-8 before rounding), found by the Remez exchange algorithm. Above 1 it is a right angle minus
//! the arctangent of the reciprocal. The code uses only `+ - × ÷` and select operations. The result is in radians,
//! its error is below 2e-7, and the function is exactly odd.

use fearless_simd::{f32x16, prelude::*};

/// Coefficients of the polynomial in `x²`, from the highest power down to the constant.
const COEFFICIENTS: [f32; 9] = [
    0.002_849_879_2,
    -0.016_068_587,
    0.042_691_45,
    -0.075_042_89,
    0.106_409_31,
    -0.142_036_44,
    0.199_926_2,
    -0.333_330_73,
    1.0,
];

/// Returns the arctangent of each number in radians, from -π/2 to π/2. NaN stays NaN.
#[inline(always)]
pub(crate) fn arctangent<S: Simd>(simd: S, x: f32x16<S>) -> f32x16<S> {
    let one = f32x16::splat(simd, 1.0);
    let size = x.abs();
    let is_steep = size.simd_gt(one);
    let ratio = is_steep.select(one, size) / is_steep.select(size, one);
    let ratio_sq = ratio * ratio;
    // Horner's scheme.
    let mut factor = f32x16::splat(simd, COEFFICIENTS[0]);
    for coefficient in &COEFFICIENTS[1..] {
        factor = factor * ratio_sq + *coefficient;
    }
    let angle = ratio * factor;
    let right_angle = f32x16::splat(simd, core::f32::consts::FRAC_PI_2);
    is_steep.select(right_angle - angle, angle).copysign(x)
}

#[cfg(test)]
mod tests {
    use super::arctangent;
    use dapple_raster::simd::dispatch;
    use dapple_raster::simd::for_every_level;
    use fearless_simd::{Level, f32x16, prelude::*};

    fn angles(level: Level, tangents: [f32; 16]) -> [f32; 16] {
        dispatch!(level, simd => arctangent(simd, f32x16::from_slice(simd, &tangents)).into())
    }

    /// Returns tangents of all magnitudes, most of them around 1.
    fn tangents() -> impl Iterator<Item = [f32; 16]> {
        let tangent = |i: u32| match i % 2 {
            0 => f32::from_bits(0x3000_0000 + (i << 14)),
            _ => i as f32 * 1e-4,
        };
        (0..2000).map(move |block| core::array::from_fn(|lane| tangent(16 * block + lane as u32)))
    }

    #[test]
    fn arctangent_errs_by_less_than_stated() {
        let mut worst = 0.0_f64;
        for tangents in tangents() {
            for (tangent, angle) in tangents
                .into_iter()
                .zip(angles(Level::baseline(), tangents))
            {
                worst = worst.max((f64::from(angle) - libm::atan(tangent.into())).abs());
            }
        }
        assert!(worst < 2e-7, "the largest error is {worst}");
    }

    #[test]
    fn arctangent_is_odd_and_the_same_at_every_level() {
        for_every_level(|level| {
            for tangents in tangents() {
                let expected = angles(Level::baseline(), tangents).map(f32::to_bits);
                assert_eq!(
                    angles(level, tangents).map(f32::to_bits),
                    expected,
                    "{level:?}"
                );
                let opposite = angles(level, tangents.map(|tangent| -tangent));
                let back = opposite.map(|angle| (-angle).to_bits());
                assert_eq!(back, expected, "{level:?}, negative");
            }
        });
    }

    #[test]
    fn arctangent_of_the_ends_is_exact() {
        let mut ends = [0.0; 16];
        ends[..4].copy_from_slice(&[-0.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN]);
        let angles = angles(Level::baseline(), ends);
        let right = core::f32::consts::FRAC_PI_2;
        assert_eq!(angles[..3], [0.0, right, -right], "zero and infinite");
        assert!(angles[3].is_nan(), "not a number");
    }
}
