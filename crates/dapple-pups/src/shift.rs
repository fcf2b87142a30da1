//! Weights shifted towards an orientation (equation 4).

use crate::power::power;
use fearless_simd::prelude::*;

/// What is added to the square of a distance, so that it is not zero; it changes no distance above 1e-15.
const LEAST_SQUARE: f32 = f32::MIN_POSITIVE;

/// `w^(1 − K)` where the position lies on the side of the orientation, `w^(1 / (1 + K))` on the other; `shift` is ε times
/// the orientation in the plane, `x` and `y` lead from the control point to the position.
///
/// With `n = ε (x − c)·v` and `d = |x − c|` both exponents are `(d − max(n, 0)) / (d + min(n, 0))`. At the control
/// point itself the angle has no meaning; there the weight is 1 and stays so.
#[inline(always)]
pub(crate) fn shift_weight<S: Simd>(
    simd: S,
    weight: S::f32s,
    shift: [f32; 2],
    x: S::f32s,
    y: S::f32s,
) -> S::f32s {
    let zero = S::f32s::splat(simd, 0.0);
    let distance = (x * x + (y * y + LEAST_SQUARE)).sqrt();
    let along = x * shift[0] + y * shift[1];
    let exponent = (distance - along.max(zero)) / (distance + along.min(zero));
    power(simd, weight, exponent)
}
