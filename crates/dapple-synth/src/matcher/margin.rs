//! Proves the pruning bound: the condition under which a row may be rejected without a full comparison.
//!
//! Notation:
//!
//! - x is a row and q the query; D is [`distance_sq`](super::distance_sq) as computed.
//! - W is the matrix of k directions and m the mean, both as stored.
//! - y and z are the rotated row and query as computed.
//! - P is the sum of the squared differences of their integer coordinates ([`Lattice`]), or of some of them, or of the
//!   distances from a box.
//! - u = 2^-24 is the largest relative rounding error of `f32`. Below the normal numbers additions are exact, and the
//!   error of a product is at most v = 2^-150.
//!
//! Steps:
//!
//! 1. A term of D is rounded at most `a` times ([`distance::roundings`]), so that D >= (1 - a u) |x - q|^2 - 2 dims v,
//!    and |x - q| <= sqrt((D + 2 dims v) / (1 - a u)).
//! 2. A term of a coordinate of z is rounded at most `b` times ([`Basis::roundings`]). With c for the centered query as
//!    computed, `|z_j - W_j (q - m)| <= 1.01 b u |W_j| |c| + 2 dims v`, where 1.01 covers the powers of u. The squares
//!    of all `|W_j|` add up to at most k |W|^2, so that
//!    |z - W (q - m)| <= 1.01 b u sqrt(k) |W| |c| + 2 sqrt(k) dims v. The bound for y has the same form.
//! 3. Integer coordinates are not farther apart than z and y, except for the rounding of each: [`Lattice::error`].
//! 4. By the triangle inequality, sqrt(P) <= |W| |x - q| + E. E is the sum of the errors of steps 2 and 3, of the row
//!    and of the query. P itself is exact. A part of a sum of squares is not larger than the sum, and a box is not
//!    farther than a point in it.
//!
//! Together: a row with D <= B has P <= T(B), which [`Margin::threshold`] returns. A row with a larger P has D > B, so
//! rejecting it loses neither the nearest row nor an equally near one. T is computed in `f64`; the factor [`SLACK`]
//! covers the rounding of this computation many times over.
//!
//! Overflow is excluded, because the length of centered rows and queries is at most [`LONGEST`].

use super::basis::Basis;
use super::distance;
use super::lattice::Lattice;

/// Maximum length of a centered row or query in the tree. Its square is far below the largest `f32`.
pub(crate) const LONGEST: f64 = 1e15;

/// Maximum relative error of rounding to `f32`.
const U: f64 = 1.0 / (1 << 24) as f64;

/// Absolute error of a subnormal product: half of the smallest positive `f32`.
const V: f64 = f32::from_bits(1) as f64 / 2.0;

/// Factor that exceeds the relative error of a few operations, or of a sum of a thousand terms, in `f64`.
const SLACK: f64 = 1.0 + 1e-12;

/// The terms of the bound that do not depend on the query, for one tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    /// 2 dims v, in the notation of the module.
    distance_underflow: f64,
    /// (|W| in units)^2 / (1 - a u).
    units_sq: f64,
    /// 1.01 b u sqrt(k) |W| in units.
    rotation: f64,
    /// E for a row of the maximum length and a query of length zero.
    fixed: f64,
}

impl Margin {
    /// Computes the bound for rows of `dims` values. `longest` is the length of the longest centered row.
    pub(crate) fn new(dims: usize, basis: &Basis, lattice: &Lattice, longest: f64) -> Self {
        let k = basis.n_directions() as f64;
        let norm = basis.norm_sq.sqrt() * lattice.per_unit();
        let distance_underflow = 2.0 * dims as f64 * V;
        let rotation = 1.01 * basis.roundings() as f64 * U * k.sqrt() * norm;
        let underflow = 2.0 * k.sqrt() * distance_underflow * lattice.per_unit();
        Self {
            distance_underflow,
            units_sq: norm * norm / (1.0 - distance::roundings(dims) as f64 * U),
            rotation,
            fixed: rotation * longest + underflow + 2.0 * Lattice::error(basis.n_directions()),
        }
    }

    /// Returns E in units. `length` is the length of the centered query.
    #[inline(always)]
    pub(crate) fn error(&self, length: f64) -> f64 {
        self.rotation * length + self.fixed
    }

    /// Returns T: the maximum P of a row with D <= `distance_sq`. If `distance_sq` is infinite, T is `i32::MAX`.
    #[inline(always)]
    pub(crate) fn threshold(&self, distance_sq: f32, error: f64) -> i32 {
        // Step 1 bounds |x - q| by D, and step 4 adds the errors E of steps 2 and 3.
        let distance_sq = (f64::from(distance_sq) + self.distance_underflow) * self.units_sq;
        let distance = distance_sq.sqrt() + error;
        // The cast rounds down, which is right for integer sums, and saturates.
        (distance * distance * SLACK) as i32
    }
}

/// Returns the length of a vector of `f32`, rounded up.
#[inline(always)]
pub(crate) fn length(values: &[f32]) -> f64 {
    let mut sums = [0.0_f64; 8];
    let (values_8, values) = values.as_chunks::<8>();
    // Squares of `f32` are exact in `f64`, and the slack covers the rounding of their sums.
    for values in values_8 {
        for lane in 0..8 {
            sums[lane] += f64::from(values[lane]) * f64::from(values[lane]);
        }
    }
    for (sum, &value) in sums.iter_mut().zip(values) {
        *sum += f64::from(value) * f64::from(value);
    }
    sums.iter().sum::<f64>().sqrt() * SLACK
}
