//! The distance that defines which row is nearest.

use fearless_simd::{f32x16, prelude::*};

/// The number of sums that are added at the end.
pub(crate) const LANES: usize = 16;

/// The paper's D(M, N): the sum of squared differences in `f32`, summed in the one fixed order that defines which row is
/// nearest.
///
/// Sixteen sums, each of every sixteenth term, are added in pairs. What one of the two has more than the other does not
/// count.
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

/// Rows, each filled up with zeros to whole registers. A zero more in a sum changes no bit of it.
#[derive(Clone, Debug)]
pub(crate) struct PaddedRows {
    values: Vec<[f32; LANES]>,
    stride: usize,
}

impl PaddedRows {
    /// Copies rows of `dims` numbers. There are none if `dims` is zero.
    pub(crate) fn new(dims: usize, rows: &[f32]) -> Self {
        let stride = dims.div_ceil(LANES).max(1);
        let mut values = Vec::with_capacity(rows.len() / dims.max(1) * stride);
        for row in rows.chunks(dims.max(1)) {
            pad(row, &mut values);
        }
        Self { values, stride }
    }

    /// The number of rows.
    pub(crate) fn len(&self) -> usize {
        self.values.len() / self.stride
    }

    /// A row.
    #[inline(always)]
    pub(crate) fn row(&self, row: u32) -> &[[f32; LANES]] {
        &self.values[row as usize * self.stride..][..self.stride]
    }

    /// [`distance_sq`] of a row and a query filled up alike.
    #[inline(always)]
    pub(crate) fn distance_sq<S: Simd>(&self, simd: S, query: &[[f32; LANES]], row: u32) -> f32 {
        let row = self.row(row);
        let mut sums = f32x16::splat(simd, 0.0);
        for (&query, &row) in query.iter().zip(row) {
            let difference = f32x16::simd_from(simd, query) - f32x16::simd_from(simd, row);
            sums += difference * difference;
        }
        let (low, high) = sums.split();
        let (low, high) = (low + high).split();
        let sums: [f32; 4] = (low + high).into();
        (sums[0] + sums[2]) + (sums[1] + sums[3])
    }
}

/// Adds numbers to whole registers, the last of them filled up with zeros.
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

/// How often at most a term of [`distance_sq`] is rounded: as a difference, twice in it, as a square, and added up.
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
