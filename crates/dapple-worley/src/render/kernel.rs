//! The inner loop: the smallest keys of sixteen pixels side by side, for several rows at once.

use super::LANES;
use super::shortlist::TILE_ROWS;
use crate::Metric;
use crate::fixed::STEP;
use crate::metric::{Norm, with_norm};
use crate::sink::Values;
use core::ops::Range;
use fearless_simd::{Level, dispatch, f32x16, i32x16, prelude::*};

/// The columns of two registers.
const TWICE: usize = 2 * LANES;

/// Some rows of a tile.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    /// The rows of the tile, in the band.
    pub(super) rows: Range<usize>,
    /// The columns, in the window: at most [`LANES`], or twice as many.
    pub(super) columns: Range<usize>,
    /// The coordinates of the columns, in steps.
    pub(super) steps: &'a [i32],
    /// The coordinate that is the smallest of them.
    pub(super) low: i32,
    /// The coordinates of the points that matter, along the first axis, in cells from there.
    pub(super) points: &'a [f32],
    /// What the rows add to the keys of each point.
    pub(super) row_terms: &'a [[f32; TILE_ROWS]],
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

    /// Roots take long, but while they are taken, the processor goes on to compare the next few rows: not too many at
    /// once, so that it can look that far ahead.
    #[inline(always)]
    pub(super) fn fill_with<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
    ) -> usize {
        let has_few_registers = const { <S::f32s as SimdBase<S>>::LEN < LANES };
        match self.columns.len() {
            TWICE if has_few_registers => self.fill_groups::<S, M, K, 1, 2>(simd, norm, out),
            TWICE if K == 1 => self.fill_groups::<S, M, K, 4, 2>(simd, norm, out),
            TWICE => self.fill_groups::<S, M, K, 2, 2>(simd, norm, out),
            LANES if has_few_registers => self.fill_groups::<S, M, K, 2, 1>(simd, norm, out),
            LANES => self.fill_groups::<S, M, K, 4, 1>(simd, norm, out),
            _ => self.fill_groups::<S, M, K, 1, 0>(simd, norm, out),
        }
    }

    /// `R` rows and `C` registers of columns at once; none stands for a part of one.
    #[inline(always)]
    fn fill_groups<S: Simd, M: Norm, const K: usize, const R: usize, const C: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
    ) -> usize {
        let mut columns = [f32x16::splat(simd, 0.0); 2];
        for part in 0..C.max(1) {
            let steps = i32x16::from_slice(simd, &self.steps[part * LANES..][..LANES]) - self.low;
            columns[part] = steps.to_float::<f32x16<S>>() * STEP;
        }
        let values = self.values.lanes::<S, K>(simd);
        let out = &mut out[self.rows.clone()];
        for (group, out) in out.chunks_mut(R).enumerate() {
            let mut best = [[[f32x16::splat(simd, f32::INFINITY); K]; 2]; R];
            for (&point, row_terms) in self.points.iter().zip(self.row_terms) {
                let row_terms = &row_terms.as_chunks::<R>().0[group];
                for part in 0..C.max(1) {
                    let column_terms = norm.terms(columns[part] - point);
                    for row in 0..R {
                        let row_term = f32x16::splat(simd, row_terms[row]);
                        insert(&mut best[row][part], norm.joins(column_terms, row_term));
                    }
                }
            }
            let mut worst = best[0][0][K - 1];
            for row in 0..R {
                for part in 0..C.max(1) {
                    worst = greater(worst, best[row][part][K - 1]);
                }
            }
            if !worst.simd_lt(self.limit).all_true() {
                return self.rows.start + group * R;
            }
            for row in 0..R {
                let Some(out) = out.get_mut(row) else {
                    break;
                };
                let out = &mut out[self.columns.clone()];
                match C {
                    0 => values.put_part(norm, best[row][0], out),
                    1 => values.put(norm, best[row][0], out),
                    _ => {
                        let (left, right) = out.split_at_mut(LANES);
                        values.put(norm, best[row][0], left);
                        values.put(norm, best[row][1], right);
                    }
                }
            }
        }
        self.rows.end
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
