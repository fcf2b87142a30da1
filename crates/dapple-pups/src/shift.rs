//! Weights shifted towards an orientation (equation 4).

use crate::power::powers;
use fearless_simd::prelude::*;

/// A summand of squared distances that keeps them above zero; it changes no distance above 1e-15.
const LEAST_SQUARE: f32 = f32::MIN_POSITIVE;

/// `w^(1 − K)` where the position lies on the side of the orientation, `w^(1 / (1 + K))` on the other; `shift` is ε times
/// the orientation in the plane, `x` and `y` lead from the control point to the positions, a register in each row.
///
/// With `n = ε (x − c)·v` and `d = |x − c|` both exponents are `(d − max(n, 0)) / (d + min(n, 0))`. At the control
/// point itself the angle has no meaning; there the weight is 1 and stays so.
#[inline(always)]
pub(crate) fn shift_weights<S: Simd, V: SimdFloat<S, Element = f32>, const ROWS: usize>(
    simd: S,
    weights: &[V; ROWS],
    shift: [f32; 2],
    x: V,
    y: &[f32; ROWS],
) -> [V; ROWS] {
    let zero = V::splat(simd, 0.0);
    let (square, along) = (x * x, x * shift[0]);
    let mut exponents = [x; ROWS];
    for row in 0..ROWS {
        let distance = (square + (y[row] * y[row] + LEAST_SQUARE)).sqrt();
        let along = along + y[row] * shift[1];
        exponents[row] = (distance - along.max(zero)) / (distance + along.min(zero));
    }
    powers(simd, weights, &exponents)
}
