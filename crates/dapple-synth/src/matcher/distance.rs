//! The distance that determines which row is nearest.
//!
//! It is the squared Euclidean distance in `f32`, with one fixed order of additions, so that all SIMD levels give the
//! same bits.

use fearless_simd::{f32x16, prelude::*};

/// Number of partial sums.
pub(crate) const LANES: usize = 16;

/// Returns the squared distance between two vectors in `f32`, D(M, N) in Turk's paper. Its fixed order of additions
/// defines which row is nearest.
///
/// Sixteen partial sums, each over every sixteenth term, are added in pairs. If one slice is longer, its remaining
/// values are ignored.
#[must_use]
#[inline]
pub fn distance_sq(a: &[f32], b: &[f32]) -> f32 {
    let n = a.len().min(b.len());
    let (a_16, a) = a[..n].as_chunks::<LANES>();
    let (b_16, b) = b[..n].as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (a, b) in a_16.iter().zip(b_16) {
        for lane in 0..LANES {
            sums[lane] += (a[lane] - b[lane]) * (a[lane] - b[lane]);
        }
    }
    for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
        *sum += (a - b) * (a - b);
    }
    add_in_pairs(sums)
}

/// Rows padded with zeros to whole registers. The padding adds zeros to the sums, which does not change any bit.
#[derive(Clone, Debug)]
pub(crate) struct PaddedRows {
    values: Vec<[f32; LANES]>,
    stride: usize,
}

impl PaddedRows {
    /// Copies rows of `dims` values each. Empty if `dims` is zero.
    pub(crate) fn new(dims: usize, rows: &[f32]) -> Self {
        let stride = dims.div_ceil(LANES).max(1);
        let mut values = Vec::with_capacity(rows.len() / dims.max(1) * stride);
        for row in rows.chunks(dims.max(1)) {
            pad(row, &mut values);
        }
        Self { values, stride }
    }

    /// Returns the number of rows.
    pub(crate) fn len(&self) -> usize {
        self.values.len() / self.stride
    }

    /// Returns the values of a row, padded.
    #[inline(always)]
    pub(crate) fn row(&self, row: u32) -> &[[f32; LANES]] {
        &self.values[row as usize * self.stride..][..self.stride]
    }

    /// Returns the [`distance_sq`] between a row and a padded query.
    #[inline(always)]
    pub(crate) fn distance_sq<S: Simd>(&self, simd: S, query: &[[f32; LANES]], row: u32) -> f32 {
        let row = self.row(row);
        let mut sums = f32x16::splat(simd, 0.0);
        for (&query, &row) in query.iter().zip(row) {
            let difference = f32x16::simd_from(simd, query) - f32x16::simd_from(simd, row);
            sums += difference * difference;
        }
        // Add the sums in pairs, in the order of `add_in_pairs`.
        let (low, high) = sums.split();
        let (low, high) = (low + high).split();
        let sums: [f32; 4] = (low + high).into();
        (sums[0] + sums[2]) + (sums[1] + sums[3])
    }
}

/// Appends values to `target`, padded with zeros to whole registers.
#[inline(always)]
pub(crate) fn pad(values: &[f32], target: &mut Vec<[f32; LANES]>) {
    let (values, rest) = values.as_chunks::<LANES>();
    target.extend(values);
    if !rest.is_empty() {
        let mut last = [0.0; LANES];
        last[..rest.len()].copy_from_slice(rest);
        target.push(last);
    }
}

/// Returns the maximum number of times that a term of [`distance_sq`] is rounded: once as a difference, which is
/// squared and so counts twice, once as a square, and in the additions.
pub(crate) fn roundings(dims: usize) -> usize {
    3 + dims.div_ceil(LANES) + 4
}

#[inline(always)]
fn add_in_pairs(mut sums: [f32; LANES]) -> f32 {
    let mut n = LANES / 2;
    while n > 0 {
        for lane in 0..n {
            sums[lane] += sums[lane + n];
        }
        n /= 2;
    }
    sums[0]
}
