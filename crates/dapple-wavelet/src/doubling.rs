//! Equation 6: writing a spline with twice as many coefficients.
//!
//! A fine coefficient is a sum of up to three coarse ones, with weights that depend on whether its index is even or odd.

use crate::ends::{Halving, Line};
use crate::kernel::two_scale;
use crate::pass::for_chunks;
use crate::{Border, SplineFilter, WaveletError, WaveletErrorKind};

/// A filter that doubles a line.
#[derive(Clone, Debug)]
pub(crate) struct Doubling {
    pub(crate) fine: Line,
    pub(crate) coarse: Line,
    /// For even and for odd fine indices.
    parts: [Part; 2],
}

/// The coarse coefficients that fine coefficient `2 i`, or `2 i + 1`, is made of.
#[derive(Clone, Debug)]
struct Part {
    /// The first of them, from `i`.
    first: i64,
    weights: Vec<f64>,
}

impl Doubling {
    /// The filter to lines of `fine_len` from those that [`Halving`] makes of them.
    ///
    /// # Errors
    ///
    /// As [`Halving::new`], and `Length` if `coarse_len` is not the coarse length.
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

    /// The line, doubled.
    pub(crate) fn double_line(&self, coarse: &[f64]) -> Vec<f64> {
        let value = |index| {
            let terms = self
                .terms(index)
                .map(|(coarse_idx, weight)| weight * coarse[coarse_idx]);
            terms.fold(0.0, |sum, term| sum + term)
        };
        (0..self.fine.len).map(value).collect()
    }

    /// Doubles the columns of a plane, and then its rows by `along_rows`.
    pub(crate) fn double_plane(&self, along_rows: &Self, coarse: &[f32], fine: &mut [f32]) {
        let width = along_rows.coarse.len;
        for_chunks(fine, along_rows.fine.len, |row, fine| {
            let mut sums = vec![0.0; width];
            for (coarse_row, weight) in self.terms(row) {
                let coarse = &coarse[coarse_row * width..(coarse_row + 1) * width];
                for (sum, &value) in sums.iter_mut().zip(coarse) {
                    *sum += weight * f64::from(value);
                }
            }
            for sum in &mut sums {
                *sum = f64::from(*sum as f32);
            }
            for (fine, value) in fine.iter_mut().zip(along_rows.double_line(&sums)) {
                *fine = value as f32;
            }
        });
    }

    /// The indices of the coarse coefficients that fine coefficient `index` is made of, with their weights.
    fn terms(&self, index: usize) -> impl Iterator<Item = (usize, f64)> {
        let part = &self.parts[index % 2];
        let first = (index / 2) as i64 + part.first;
        part.weights
            .iter()
            .zip(first..)
            .map(|(&weight, coarse)| (self.coarse.index(coarse), weight))
    }
}

impl Part {
    fn new(filter: SplineFilter, parity: i64, offset: i64) -> Self {
        let h = two_scale(filter.degree);
        let first_tap = filter.first_tap();
        // Fine coefficient 2 i + parity has tap k = 2 (i - j) + parity - first_tap of coarse coefficient j.
        let least = (parity - first_tap).rem_euclid(2);
        let weights: Vec<f64> = h
            .iter()
            .skip(least as usize)
            .step_by(2)
            .rev()
            .copied()
            .collect();
        let greatest = least + 2 * (weights.len() as i64 - 1);
        Self {
            first: (parity - first_tap - greatest) / 2 - offset,
            weights,
        }
    }
}
