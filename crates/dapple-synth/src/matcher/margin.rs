//! When a row may be skipped: the bound on rounding that makes the search exact.
//!
//! Write x for a row, q for the query, D for [`distance_sq`](super::distance_sq) as it is computed, W for the matrix of
//! the directions and m for the mean as they are stored, y and z for the rotated row and query as they are computed, and P
//! for the sum of squares of some of z - y, or of the distances of z from a box around y, as it is computed in `f32`.
//! u = 2^-24 is the most by which `f32` rounds, relatively; below the normal numbers an addition is exact and a product is
//! off by at most v = 2^-150.
//!
//! 1. A term of D is rounded `a` times, so that D >= (1 - a u) |x - q|^2 - 2 dims v, and
//!    |x - q| <= sqrt((D + 2 dims v) / (1 - a u)).
//! 2. A coordinate of z has terms that are rounded `b` times:
//!    |z_j - W_j (q - m)| <= b' u |W_j| |c| + 2 dims v, where c is the centered query as computed, and b' = 1.01 b covers
//!    the powers of u while b u < 0.01. So |z - W (q - m)| <= b' u sqrt(k) |W| |c| + 2 sqrt(k) dims v for k directions; the
//!    same for y. Call the sum of both E.
//! 3. By the triangle inequality |z - y| <= |W| |x - q| + E. A box is not farther than what it holds, and a part of a sum
//!    of squares is not larger than the sum.
//! 4. A term of P is rounded at most k + 3 times, so that P <= (1 + 1.01 (k + 3) u) |z - y|^2 + 2 k v.
//!
//! Together, a row whose D is at most B has a P of at most T(B), which [`Margin::threshold`] gives. What has a larger P has
//! a larger D, so skipping it cannot lose the nearest row, nor an equal one. The bound itself is computed in `f64`, whose
//! own roundings the last factor, 1 + 2^-20, covers many times over.
//!
//! No number may overflow on the way, therefore centered rows and queries have at most the length [`LONGEST`].

use super::basis::Basis;
use super::distance;

/// The longest centered row or query that is searched for in the tree. Its square is far from the largest `f32`.
pub(crate) const LONGEST: f64 = 1e15;

/// The relative error of rounding to `f32`.
const U: f64 = 1.0 / (1 << 24) as f64;

/// The absolute error of a product below the normal numbers: half of the least `f32`.
const V: f64 = f32::from_bits(1) as f64 / 2.0;

/// The bound for one index: what does not depend on the query.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    /// |W|.
    norm: f64,
    /// b' u sqrt(k) |W|.
    rotation: f64,
    /// 4 sqrt(k) dims v.
    underflow: f64,
    /// 2 dims v.
    distance_underflow: f64,
    /// 1 / (1 - a u).
    distance_factor: f64,
    /// (1 + 1.01 (k + 3) u) (1 + 2^-20).
    sum_factor: f64,
    /// 2 k v.
    sum_underflow: f64,
    /// The length of the longest centered row.
    longest: f64,
    /// 0.51 sqrt(k) units.
    quantization: f64,
    /// 1 / unit^2.
    per_unit_sq: f64,
}

impl Margin {
    /// The bound for rows of `dims` numbers, of which the longest one centered is no longer than `longest`.
    pub(crate) fn new(dims: usize, basis: &Basis, longest: f64, unit: f32) -> Self {
        let k = basis.n_directions() as f64;
        let norm = basis.norm_sq.sqrt();
        Self {
            norm,
            rotation: 1.01 * basis.roundings() as f64 * U * k.sqrt() * norm,
            underflow: 4.0 * k.sqrt() * dims as f64 * V,
            distance_underflow: 2.0 * dims as f64 * V,
            distance_factor: 1.0 / (1.0 - distance::roundings(dims) as f64 * U),
            sum_factor: (1.0 + 1.01 * (k + 3.0) * U) * (1.0 + 1.0 / f64::from(1 << 20)),
            sum_underflow: 2.0 * k * V,
            longest,
            quantization: 0.51 * k.sqrt() * f64::from(unit),
            per_unit_sq: 1.0 / (f64::from(unit) * f64::from(unit)),
        }
    }

    /// E for a centered query of at most this length.
    pub(crate) fn rotation_error(&self, length: f64) -> f64 {
        self.rotation * (length + self.longest) + self.underflow + self.quantization
    }

    /// The largest P that a row may have whose distance D is at most `distance_sq`; infinity for infinity.
    #[inline(always)]
    pub(crate) fn threshold(&self, distance_sq: f32, rotation_error: f64) -> f32 {
        let distance_sq = (f64::from(distance_sq) + self.distance_underflow) * self.distance_factor;
        let distance = self.norm * distance_sq.sqrt() + rotation_error;
        round_up(distance * distance * self.sum_factor * self.per_unit_sq + self.sum_underflow)
    }
}

/// The length of something, and a little more: an upper bound although the squares are rounded.
pub(crate) fn length(values: &[f32]) -> f64 {
    let mut sums = [0.0_f64; 8];
    let (values_8, values) = values.as_chunks::<8>();
    for values in values_8 {
        for lane in 0..8 {
            sums[lane] += f64::from(values[lane]) * f64::from(values[lane]);
        }
    }
    for (sum, &value) in sums.iter_mut().zip(values) {
        *sum += f64::from(value) * f64::from(value);
    }
    sums.iter().sum::<f64>().sqrt() * (1.0 + 1e-12)
}

/// The least `f32` that is not less.
fn round_up(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value {
        rounded.next_up()
    } else {
        rounded
    }
}
