//! Computes products of a control point's axial weights.

use crate::net::BLOCK;
use crate::weight::{AxialWeight, Lane};
use fearless_simd::prelude::*;

/// Incremental product of the axial weights of up to [`BLOCK`] axes, as two partial products `q` and `t`.
///
/// The weight of an axis is a function of `u`, which is 1 at the control point and 0 at the end of the axis. An axis
/// with `u = 1` does not change the bits of the result, so it may be included or left out. Axes are given as `−u`, in
/// `[−1, 0]`, which saves one operation.
pub(crate) trait Profile: Copy + Send + Sync {
    /// Starts the partial products with the first axis.
    fn first<V: Lane>(self, minus_u: V) -> (V, V);

    /// Multiplies the partial products by another axis.
    fn step<V: Lane>(self, q: V, t: V, minus_u: V) -> (V, V);

    /// Returns the product of `n` axial weights, at least one, from their partial products.
    fn finish<V: Lane>(self, q: V, t: V, n: usize) -> V;

    /// Returns the axial weight of a single axis.
    #[inline(always)]
    fn single<V: Lane>(self, minus_u: V) -> V {
        let (q, t) = self.first(minus_u);
        self.finish(q, t, 1)
    }

    /// Returns the product of the axial weights of a block. Unused slots have the weight 1.
    #[inline(always)]
    fn product<V: Lane>(self, minus_u: [V; BLOCK]) -> V {
        let (mut q, mut t) = self.first(minus_u[0]);
        for &minus_u in &minus_u[1..] {
            (q, t) = self.step(q, t, minus_u);
        }
        self.finish(q, t, BLOCK)
    }
}

/// Computes `−u` from `along = a_x d_x` and `rest = 1 − a_y d_y`, clamped to `[−1, 0]`. It is −1 at and behind the
/// control point, and zero (of either sign) at and beyond the end of the axis.
#[inline(always)]
pub(crate) fn minus_u<S: Simd, V: SimdFloat<S, Element = f32>>(simd: S, along: V, rest: V) -> V {
    let unbounded = along - rest;
    if V::LEN < BLOCK {
        let [least, most] = [-1.0, 0.0].map(|bound| V::splat(simd, bound));
        return unbounded.max(least).min(most);
    }
    // Compare as integers, since more execution units of a processor support it. In this order, negative floats come
    // after positive ones and increase with their distance from zero.
    let [zero, minus_one] = [-0.0_f32, -1.0].map(|bound| V::Bits::splat(simd, bound.to_bits()));
    V::from_bits(unbounded.to_bits().max(zero).min(minus_one))
}

/// The cubic of equation 1, `u² (3 − 2u)`, as two partial products: `q = Π −u` and `t = Π (3/2 − u)`. The weight of
/// `n` axes is `q² · t · 2^n`, where the power of two is exact. An axis takes three operations.
#[derive(Clone, Copy)]
pub(crate) struct Cubic;

impl Profile for Cubic {
    #[inline(always)]
    fn first<V: Lane>(self, minus_u: V) -> (V, V) {
        (minus_u, minus_u + 1.5)
    }

    #[inline(always)]
    fn step<V: Lane>(self, q: V, t: V, minus_u: V) -> (V, V) {
        (q * minus_u, t * (minus_u + 1.5))
    }

    #[inline(always)]
    fn finish<V: Lane>(self, q: V, t: V, n: usize) -> V {
        // Each axis contributes a factor of 2, since 3 − 2u = 2 (3/2 − u).
        const POWERS: [f32; BLOCK + 1] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0];
        q * q * (t * POWERS[n])
    }
}

/// Any axial weight, computed by its formula. Only the partial product `q` is used.
impl Profile for AxialWeight {
    #[inline(always)]
    fn first<V: Lane>(self, minus_u: V) -> (V, V) {
        (self.of_complement(minus_u * -1.0), minus_u)
    }

    #[inline(always)]
    fn step<V: Lane>(self, q: V, t: V, minus_u: V) -> (V, V) {
        (q * self.of_complement(minus_u * -1.0), t)
    }

    #[inline(always)]
    fn finish<V: Lane>(self, q: V, _: V, _: usize) -> V {
        q
    }
}
