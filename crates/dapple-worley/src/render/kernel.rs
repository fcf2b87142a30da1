//! The inner loop: the smallest keys of sixteen pixels side by side, for several rows at once.

use super::LANES;
use super::shortlist::{CHUNK, RowTerms};
use crate::Metric;
use crate::fixed::STEP;
use crate::metric::{Norm, with_norm};
use crate::sink::Values;
use core::ops::Range;
use fearless_simd::{Level, dispatch, f32x16, i32x16, prelude::*};

/// Some rows of a tile.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    /// The rows, in the band.
    pub(super) rows: Range<usize>,
    /// The first row of the tile, in the band.
    pub(super) first: usize,
    /// The columns, in the window; at most [`LANES`].
    pub(super) columns: Range<usize>,
    /// The coordinates of the columns, in steps.
    pub(super) steps: &'a [i32],
    /// The coordinate that is the smallest of them.
    pub(super) low: i32,
    /// The coordinates of the points that matter, along the first axis, in cells from there.
    pub(super) points: &'a [f32],
    pub(super) row_terms: RowTerms<'a>,
    /// Keys from here on may be wrong.
    pub(super) limit: f32,
    pub(super) values: &'a Values,
}

impl Rows<'_> {
    /// Fills pixels row by row, and returns the row from which on keys reach the limit: the end, if none does.
    pub(super) fn fill(
        &self,
        level: Level,
        metric: Metric,
        depth: usize,
        out: &mut [&mut [f32]],
    ) -> usize {
        with_norm!(metric, norm => match depth {
            1 => dispatch!(level, simd => self.fill_with::<_, _, 1>(simd, norm, out)),
            2 => dispatch!(level, simd => self.fill_with::<_, _, 2>(simd, norm, out)),
            _ => dispatch!(level, simd => self.fill_with::<_, _, 4>(simd, norm, out)),
        })
    }

    /// As many rows at once as there are registers for.
    #[inline(always)]
    fn fill_with<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
    ) -> usize {
        if const { <S::f32s as SimdBase<S>>::LEN < LANES } {
            self.fill_groups::<S, M, K, 2>(simd, norm, out)
        } else if self.rows.len() <= 4 {
            self.fill_groups::<S, M, K, 4>(simd, norm, out)
        } else {
            self.fill_groups::<S, M, K, 8>(simd, norm, out)
        }
    }

    #[inline(always)]
    fn fill_groups<S: Simd, M: Norm, const K: usize, const R: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
    ) -> usize {
        let columns = i32x16::from_slice(simd, &self.steps[..LANES]) - self.low;
        let columns = columns.to_float::<f32x16<S>>() * STEP;
        let mut row = self.rows.start;
        while row < self.rows.end {
            let (keys, worst) = self.smallest::<S, M, K, R>(norm, columns, row - self.first);
            if !worst.simd_lt(self.limit).all_true() {
                return row;
            }
            let end = self.rows.end.min(row + R);
            let out = &mut out[row..end];
            if let (Ok(out), LANES) = (<&mut [_; R]>::try_from(&mut *out), self.columns.len()) {
                for at in 0..R {
                    self.values
                        .put(norm, keys[at], &mut out[at][self.columns.start..][..LANES]);
                }
            } else {
                for (keys, out) in keys.into_iter().zip(out) {
                    self.values
                        .put_part(norm, keys, &mut out[self.columns.clone()]);
                }
            }
            row = end;
        }
        row
    }

    /// The `K` smallest keys, smallest first, of `R` rows from row `first` of the tile on; and the largest of the
    /// `K`-th.
    #[inline(always)]
    fn smallest<S: Simd, M: Norm, const K: usize, const R: usize>(
        &self,
        norm: M,
        columns: f32x16<S>,
        first: usize,
    ) -> ([[f32x16<S>; K]; R], f32x16<S>) {
        let simd = columns.simd;
        let mut best = [[f32x16::splat(simd, f32::INFINITY); K]; R];
        for (chunk, points) in self.points.chunks(CHUNK).enumerate() {
            let row_terms = self.row_terms.rows::<R>(chunk, first);
            for (index, &point) in points.iter().enumerate() {
                let column_terms = norm.terms(columns - point);
                for row in 0..R {
                    let row_term = f32x16::splat(simd, row_terms[row][index % CHUNK]);
                    insert(&mut best[row], norm.joins(column_terms, row_term));
                }
            }
        }
        let mut worst = best[0][K - 1];
        for row in 1..R {
            worst = greater(worst, best[row][K - 1]);
        }
        (best, worst)
    }
}

/// Takes in one more key, and leaves out the largest.
#[inline(always)]
fn insert<S: Simd, const K: usize>(best: &mut [f32x16<S>; K], key: f32x16<S>) {
    for rank in (1..K).rev() {
        best[rank] = lesser(best[rank], greater(best[rank - 1], key));
    }
    best[0] = lesser(best[0], key);
}

/// Floats of at least zero are in the order of their bits, and most processors compare whole numbers faster.
#[inline(always)]
pub(super) fn lesser<S: Simd, V: SimdFloat<S, Element = f32>>(a: V, b: V) -> V {
    if floats_are_faster(a.token()) {
        a.min(b)
    } else {
        V::from_bits(a.to_bits().min(b.to_bits()))
    }
}

#[inline(always)]
pub(super) fn greater<S: Simd, V: SimdFloat<S, Element = f32>>(a: V, b: V) -> V {
    if floats_are_faster(a.token()) {
        a.max(b)
    } else {
        V::from_bits(a.to_bits().max(b.to_bits()))
    }
}

/// SSE2 has no minimum of 32-bit whole numbers.
#[inline(always)]
fn floats_are_faster<S: Simd>(simd: S) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return simd.level().as_sse4_2().is_none();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return false;
}
