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
    /// The rows of the tile, in the band.
    pub(super) rows: Range<usize>,
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
        if self.columns.len() < LANES {
            self.fill_rows::<S, M, K>(simd, norm, out)
        } else if const { <S::f32s as SimdBase<S>>::LEN < LANES } {
            self.fill_groups::<S, M, K, 2>(simd, norm, out)
        } else if self.rows.len() <= 4 {
            self.fill_groups::<S, M, K, 4>(simd, norm, out)
        } else {
            self.fill_groups::<S, M, K, 8>(simd, norm, out)
        }
    }

    /// Roots take long but hardly any of the processor, so those of one group are taken between the comparisons of the
    /// next. No function may be called there: it would cost all registers.
    #[inline(always)]
    fn fill_groups<S: Simd, M: Norm, const K: usize, const R: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
    ) -> usize {
        let columns = self.places(simd);
        let mut waiting = [[f32x16::splat(simd, 0.0); K]; R];
        let mut next = self.rows.start;
        let mut end = self.rows.start;
        while end < self.rows.end {
            let first = end;
            let per_point = (end - next).div_ceil(self.points.len().max(1));
            let mut best = [[f32x16::splat(simd, f32::INFINITY); K]; R];
            for (chunk, points) in self.points.chunks(CHUNK).enumerate() {
                let row_terms = self.row_terms.rows::<R>(chunk, first - self.rows.start);
                for (index, &point) in points.iter().enumerate() {
                    compare(norm, columns - point, row_terms, index, &mut best);
                    let until = end.min(next + per_point);
                    self.put_waiting(norm, &waiting, next..until, out);
                    next = until;
                }
            }
            self.put_waiting(norm, &waiting, next..end, out);
            next = end;
            if !self.is_right(&best) {
                return first;
            }
            waiting = best;
            end = self.rows.end.min(first + R);
        }
        self.put_waiting(norm, &waiting, next..end, out);
        end
    }

    /// Puts some rows of the group that waits.
    #[inline(always)]
    fn put_waiting<S: Simd, M: Norm, const K: usize, const R: usize>(
        &self,
        norm: M,
        waiting: &[[f32x16<S>; K]; R],
        rows: Range<usize>,
        out: &mut [&mut [f32]],
    ) {
        let left = self.columns.start;
        for row in rows {
            let keys = waiting[(row - self.rows.start) % R];
            self.values
                .put(norm, keys, &mut out[row][left..left + LANES]);
        }
    }

    /// The same row by row, for fewer columns.
    #[inline(always)]
    fn fill_rows<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
    ) -> usize {
        let columns = self.places(simd);
        for row in self.rows.clone() {
            let mut best = [[f32x16::splat(simd, f32::INFINITY); K]; 1];
            for (chunk, points) in self.points.chunks(CHUNK).enumerate() {
                let row_terms = self.row_terms.rows::<1>(chunk, row - self.rows.start);
                for (index, &point) in points.iter().enumerate() {
                    compare(norm, columns - point, row_terms, index, &mut best);
                }
            }
            if !self.is_right(&best) {
                return row;
            }
            self.values
                .put_part(norm, best[0], &mut out[row][self.columns.clone()]);
        }
        self.rows.end
    }

    /// Where the columns are, in cells from the lower corner of the tile.
    #[inline(always)]
    fn places<S: Simd>(&self, simd: S) -> f32x16<S> {
        let columns = i32x16::from_slice(simd, &self.steps[..LANES]) - self.low;
        columns.to_float::<f32x16<S>>() * STEP
    }

    /// Whether all keys are below the limit.
    #[inline(always)]
    fn is_right<S: Simd, const K: usize, const R: usize>(
        &self,
        best: &[[f32x16<S>; K]; R],
    ) -> bool {
        let mut worst = best[0][K - 1];
        for row in 1..R {
            worst = greater(worst, best[row][K - 1]);
        }
        worst.simd_lt(self.limit).all_true()
    }
}

/// Compares a point at the pixels of `R` rows, from the ways to it along the first axis.
#[inline(always)]
fn compare<S: Simd, M: Norm, const K: usize, const R: usize>(
    norm: M,
    ways: f32x16<S>,
    row_terms: &[[f32; CHUNK]; R],
    index: usize,
    best: &mut [[f32x16<S>; K]; R],
) {
    let column_terms = norm.terms(ways);
    for row in 0..R {
        let row_term = f32x16::splat(ways.simd, row_terms[row][index % CHUNK]);
        insert(&mut best[row], norm.joins(column_terms, row_term));
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
