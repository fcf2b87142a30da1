//! When a row may be skipped: the bound on rounding that makes the search exact.
//!
//! Write x for a row, q for the query, D for [`distance_sq`](super::distance_sq) as it is computed, W for the matrix of k
//! directions and m for the mean as they are stored, y and z for the rotated row and query as they are computed, and P
//! for the sum of squares of differences of their whole coordinates ([`Lattice`]), or of some of them, or of the
//! distances from a box. u = 2^-24 is the most by which `f32` rounds, relatively; below the normal numbers additions are
//! exact, and a product is off by at most v = 2^-150.
//!
//! 1. A term of D is rounded at most `a` times ([`distance::roundings`]), so that D >= (1 - a u) |x - q|^2 - 2 dims v, and
//!    |x - q| <= sqrt((D + 2 dims v) / (1 - a u)).
//! 2. A term of a coordinate of z is rounded at most `b` times ([`Basis::roundings`]). With c for the centered query as
//!    computed, `|z_j - W_j (q - m)| <= 1.01 b u |W_j| |c| + 2 dims v`, where 1.01 covers the powers of u. The squares of
//!    all `|W_j|` add up to at most k |W|^2, so that |z - W (q - m)| <= 1.01 b u sqrt(k) |W| |c| + 2 sqrt(k) dims v. The same
//!    holds for y.
//! 3. Whole coordinates are nearer to each other than z and y, but for their rounding, [`Lattice::error`] for each of both.
//! 4. By the triangle inequality, sqrt(P) <= |W| |x - q| + E, with E for the errors of 2 and 3, of the row and of the query.
//!    P itself is exact, a part of a sum of squares is not larger than the sum, and a box is not farther than what is in it.
//!
//! Together, a row whose D is at most B has a P of at most T(B), which [`Margin::threshold`] gives. What has a larger P
//! has a larger D than B: to skip it loses neither the nearest row nor one that is equally near. T is computed in `f64`,
//! whose own rounding the factor [`SLACK`] covers many times over.
//!
//! No number may overflow on the way: centered rows and queries have at most the length [`LONGEST`].

use super::basis::Basis;
use super::distance;
use super::lattice::Lattice;

/// The longest centered row or query that is looked for in a tree. Its square is far below the largest `f32`.
pub(crate) const LONGEST: f64 = 1e15;

/// The relative error of rounding to `f32`.
const U: f64 = 1.0 / (1 << 24) as f64;

/// The absolute error of a product below the normal numbers: half of the least `f32`.
const V: f64 = f32::from_bits(1) as f64 / 2.0;

/// More than the relative error of a few operations, or of a sum of a thousand terms, in `f64`.
const SLACK: f64 = 1.0 + 1e-12;

/// The bound for one tree: what does not depend on the query.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margin {
    /// 2 dims v.
    distance_underflow: f64,
    /// (|W| in units)^2 / (1 - a u).
    units_sq: f64,
    /// 1.01 b u sqrt(k) |W| in units.
    rotation: f64,
    /// The value of E for a row and a query of length zero.
    fixed: f64,
}

impl Margin {
    /// The bound for rows of `dims` numbers, of which the longest one centered has the length `longest`.
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

    /// E for a centered query of this length, in units.
    #[inline(always)]
    pub(crate) fn error(&self, length: f64) -> f64 {
        self.rotation * length + self.fixed
    }

    /// T: the largest sum of squares of a row with a distance of at most `distance_sq`. Infinity gives the largest
    /// number.
    #[inline(always)]
    pub(crate) fn threshold(&self, distance_sq: f32, error: f64) -> i32 {
        let distance_sq = (f64::from(distance_sq) + self.distance_underflow) * self.units_sq;
        let distance = distance_sq.sqrt() + error;
        // The cast rounds down, as it may for sums that are whole, and stays in range.
        (distance * distance * SLACK) as i32
    }
}

/// The length of a vector of `f32`, rounded up.
#[inline(always)]
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
    sums.iter().sum::<f64>().sqrt() * SLACK
}
