//! Represents a spline with twice as many coefficients (equation 6).
//!
//! A fine coefficient is a sum of up to three coarse ones, with weights that depend on the parity of its index.

use crate::ends::{Halving, Line};
use crate::error::check;
use crate::kernel::two_scale;
use crate::{Border, IsCancelled, SplineFilter, WaveletError, WaveletErrorKind};
use dapple_raster::parallel;
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, Simd};

/// A filter that doubles the length of a line.
#[derive(Clone, Debug)]
pub(crate) struct Doubling {
    pub(crate) fine: Line,
    pub(crate) coarse: Line,
    /// Weights of the fine coefficients with even and with odd index. Both have the same number of weights.
    parts: [Part; 2],
}

/// The two-scale weights of fine coefficient `2 i` or `2 i + 1`, which is a weighted sum of adjacent coarse
/// coefficients.
#[derive(Clone, Debug)]
struct Part {
    /// Index of the first coarse coefficient of the sum, relative to `i`.
    first: i64,
    weights: Vec<f64>,
}

/// Number of coarse values by which a line is extended at each end, which is the filter's reach.
const PAD: usize = 4;

/// Number of fine values between two calls of the callback; enough work for all cores.
pub(crate) const BLOCK: usize = 1 << 22;

impl Doubling {
    /// Creates the filter that produces lines of length `fine_len` from the coarse lines that [`Halving`] defines for
    /// them.
    ///
    /// # Errors
    ///
    /// Same as [`Halving::new`], and `Length` if `coarse_len` does not match.
    pub(crate) fn new(
        filter: SplineFilter,
        coarse_len: usize,
        fine_len: usize,
        border: Border,
    ) -> Result<Self, WaveletError> {
        let halving = Halving::new(filter, fine_len, border)?;
        if coarse_len != halving.coarse.len {
            return Err(WaveletError::new(WaveletErrorKind::Length {
                length: coarse_len,
                needed: halving.coarse.len,
            }));
        }
        Ok(Self {
            fine: halving.fine,
            coarse: halving.coarse,
            parts: [0, 1].map(|parity| Part::new(filter, parity, halving.offset)),
        })
    }

    /// Doubles a line.
    pub(crate) fn line(&self, coarse: &[f64]) -> Vec<f64> {
        let mut fine = vec![0.0; self.fine.len];
        let mut padded = vec![0.0; coarse.len() + 2 * PAD];
        padded[PAD..PAD + coarse.len()].copy_from_slice(coarse);
        self.go_on(&mut padded);
        self.spread(&padded, &mut fine, |value| value);
        fine
    }

    /// Doubles a raster along both axes: columns with this filter, whose results are rounded to `f32`, then rows with
    /// `along_rows`. The callback is called before each block of about [`BLOCK`] values.
    pub(crate) fn plane(
        &self,
        level: Level,
        along_rows: &Self,
        coarse: &[f32],
        fine: &mut [f32],
        is_cancelled: &IsCancelled,
    ) -> Result<(), WaveletError> {
        let n_rows = (BLOCK / along_rows.fine.len).max(1);
        let blocks = fine.chunks_mut(n_rows * along_rows.fine.len);
        for (rows, first) in blocks.zip((0..).step_by(n_rows)) {
            check(is_cancelled)?;
            self.rows(level, along_rows, coarse, (first, rows));
        }
        Ok(())
    }

    /// Computes fine rows, starting at row `first`.
    pub(crate) fn rows(
        &self,
        level: Level,
        along_rows: &Self,
        coarse: &[f32],
        (first, rows): (usize, &mut [f32]),
    ) {
        let width = along_rows.coarse.len;
        let scratch = || vec![0.0; width + 2 * PAD];
        parallel::for_each_chunk_with(rows, along_rows.fine.len, scratch, |padded, row, fine| {
            let row = first + row;
            dispatch!(level, simd => self.row(simd, along_rows, row, coarse, (padded, fine)));
        });
    }

    /// Computes a row of the doubled raster. `_simd` selects the SIMD level that the loops are compiled for.
    #[inline(always)]
    fn row<S: Simd>(
        &self,
        _simd: S,
        along_rows: &Self,
        row: usize,
        coarse: &[f32],
        (padded, fine): (&mut [f64], &mut [f32]),
    ) {
        let width = along_rows.coarse.len;
        self.blend(row, coarse, &mut padded[PAD..PAD + width]);
        along_rows.go_on(padded);
        along_rows.spread(padded, fine, |value| value as f32);
    }

    /// Computes row `row` of the raster whose columns are doubled, rounded to `f32`, into `sums`. `coarse` has rows of
    /// the same length.
    #[inline(always)]
    pub(crate) fn blend(&self, row: usize, coarse: &[f32], sums: &mut [f64]) {
        let part = &self.parts[row % 2];
        let width = sums.len();
        let coarse_row = |term: usize| {
            let row = self
                .coarse
                .index((row / 2) as i64 + part.first + term as i64);
            &coarse[row * width..(row + 1) * width]
        };
        match *part.weights {
            [a] => blend([a], [coarse_row(0)], sums),
            [a, b] => blend([a, b], [0, 1].map(coarse_row), sums),
            [a, b, c] => blend([a, b, c], [0, 1, 2].map(coarse_row), sums),
            // Splines have at most five two-scale weights, three per parity.
            _ => {}
        }
    }

    /// Fills the padding of a coarse line according to its border. The line has `PAD` values of padding at both ends.
    #[inline(always)]
    fn go_on(&self, padded: &mut [f64]) {
        let len = self.coarse.len;
        for place in (0..PAD).chain(PAD + len..len + 2 * PAD) {
            padded[place] = padded[PAD + self.coarse.index(place as i64 - PAD as i64)];
        }
    }

    /// Computes the fine coefficients of a padded coarse line.
    #[inline(always)]
    fn spread<T>(&self, padded: &[f64], fine: &mut [T], round: impl Fn(f64) -> T) {
        let [even, odd] = &self.parts;
        let from = |part: &Part| &padded[(PAD as i64 + part.first) as usize..];
        let lines = [from(even), from(odd)];
        match (&*even.weights, &*odd.weights) {
            (&[a], &[d]) => spread([[a], [d]], lines, fine, round),
            (&[a, b], &[d, e]) => spread([[a, b], [d, e]], lines, fine, round),
            (&[a, b, c], &[d, e, f]) => spread([[a, b, c], [d, e, f]], lines, fine, round),
            // Splines have at most five two-scale weights, three per parity.
            _ => {}
        }
    }
}

impl Part {
    fn new(filter: SplineFilter, parity: i64, offset: i64) -> Self {
        let h = two_scale(filter.degree);
        let first_tap = filter.first_tap();
        // Tap of coarse coefficient j in fine coefficient 2 i + parity: k = 2 (i - j) + parity - first_tap
        let least = (parity - first_tap).rem_euclid(2);
        let mut weights: Vec<f64> = h
            .iter()
            .skip(least as usize)
            .step_by(2)
            .rev()
            .copied()
            .collect();
        let greatest = least + 2 * (weights.len() as i64 - 1);
        // Pad the parity with fewer taps with a zero.
        weights.resize(h.len().div_ceil(2), 0.0);
        Self {
            first: (parity - first_tap - greatest) / 2 - offset,
            weights,
        }
    }
}

/// Computes the weighted sum of rows, rounded to `f32`, into `sums`.
#[inline(always)]
fn blend<const T: usize>(weights: [f64; T], rows: [&[f32]; T], sums: &mut [f64]) {
    let rows = rows.map(|row| &row[..sums.len()]);
    for (x, sum) in sums.iter_mut().enumerate() {
        let value = weigh(weights, |term| f64::from(rows[term][x]));
        *sum = f64::from(value as f32);
    }
}

/// Computes the even and odd coefficients of a fine line, each a weighted sum of consecutive coarse coefficients.
#[inline(always)]
fn spread<const T: usize, O>(
    weights: [[f64; T]; 2],
    coarse: [&[f64]; 2],
    fine: &mut [O],
    round: impl Fn(f64) -> O,
) {
    let coarse = coarse.map(|line| &line[..fine.len().div_ceil(2) + T - 1]);
    let value =
        |parity: usize, i: usize| round(weigh(weights[parity], |term| coarse[parity][i + term]));
    let (pairs, last) = fine.as_chunks_mut::<2>();
    for (i, pair) in pairs.iter_mut().enumerate() {
        *pair = [value(0, i), value(1, i)];
    }
    if let [last] = last {
        *last = value(0, pairs.len());
    }
}

/// Returns `Σ weights[i] · term(i)`, added in order of `i`.
#[inline(always)]
fn weigh<const T: usize>(weights: [f64; T], term: impl Fn(usize) -> f64) -> f64 {
    let mut sum = weights[0] * term(0);
    for (i, weight) in weights.iter().enumerate().skip(1) {
        sum += weight * term(i);
    }
    sum
}
