//! Shifts weights toward an orientation (equation 4).

use crate::power::powers;
use fearless_simd::prelude::*;

/// Added to squared distances to make them nonzero. It changes no distance above 1e-15.
const LEAST_SQUARE: f32 = f32::MIN_POSITIVE;

/// Applies equation 4. A weight becomes `w^(1 − K)` on the side that the orientation points to, and
/// `w^(1 / (1 + K))` on the other, where `K` is ε times the cosine of the angle to the orientation.
///
/// `shift` is ε times the orientation in the plane, `s`. `x` and `y` are the offsets `o` of the positions from the
/// control point, one register for each row. With `n = s·o` and `d = |o|`, both exponents are equal to
/// `(d − max(n, 0)) / (d + min(n, 0))`. At the control point the angle is undefined; the weight there remains 1.
#[inline(always)]
pub(crate) fn shift_weights<S: Simd, V: SimdFloat<S, Element = f32>, const ROWS: usize>(
    simd: S,
    weights: &[V; ROWS],
    shift: [f32; 2],
    x: V,
    y: &[f32; ROWS],
) -> [V; ROWS] {
    let zero = V::splat(simd, 0.0);
    // Compute the terms that all rows share.
    let (square, along) = (x * x, x * shift[0]);
    let mut exponents = [x; ROWS];
    for row in 0..ROWS {
        // d = |x − c|.
        let distance = (square + (y[row] * y[row] + LEAST_SQUARE)).sqrt();
        // n = ε (x − c)·v, which is positive on the side that the orientation points to.
        let along = along + y[row] * shift[1];
        exponents[row] = (distance - along.max(zero)) / (distance + along.min(zero));
    }
    powers(simd, weights, &exponents)
}
