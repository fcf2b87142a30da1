//! The inner loop for values. It finds the smallest keys of sixteen adjacent pixels at a time, for several rows at
//! once.

use super::LANES;
use crate::metric::Measure;
use crate::sink::Values;
use core::ops::Range;
use fearless_simd::{f32x16, prelude::*};

/// Maximum width and height of a tile, in pixels; two registers.
pub(super) const TILE: usize = 2 * LANES;

/// A candidate's key terms at the pixels of a tile: one for each column, and one for each row that accumulates all
/// other axes. The elements after the last column or row are unused.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) columns: [f32; TILE],
    pub(super) rows: [f32; TILE],
}

/// Rows of a tile, and the parameters for rendering them.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    /// Rows of the tile, in the band.
    pub(super) rows: Range<usize>,
    /// Columns, in the window; at most [`LANES`], or exactly [`TILE`].
    pub(super) columns: Range<usize>,
    /// Index of the first register of the tile's columns, 0 or 1; 0 if both are rendered.
    pub(super) register: usize,
    pub(super) candidates: &'a [Candidate],
    /// Limit of reliable keys (see [`metric`](crate::metric)). A pixel whose key is at or above it may miss a nearer
    /// point.
    pub(super) limit: f32,
    pub(super) values: &'a Values,
}

impl Rows<'_> {
    /// Renders pixels row by row. Returns the first row that has a key at or above the limit, or the end of the rows.
    ///
    /// `depth` is the number of nearest points to find, at most `K`.
    ///
    /// Rows are rendered in groups: square roots have a long latency, during which the processor compares the next
    /// rows. The groups are small enough for it to look that far ahead.
    #[inline(always)]
    pub(super) fn fill<S: Simd, M: Measure, const K: usize>(
        &self,
        simd: S,
        measure: M,
        depth: usize,
        out: &mut [&mut [f32]],
    ) -> usize {
        // Groups have fewer rows if sixteen lanes take several registers.
        let is_split = const { <S::f32s as SimdBase<S>>::LEN < LANES };
        match self.columns.len() {
            TILE if is_split => self.fill_groups::<S, M, K, 1, 2>(simd, measure, depth, out),
            TILE if const { K == 1 } => {
                self.fill_groups::<S, M, K, 4, 2>(simd, measure, depth, out)
            }
            TILE => self.fill_groups::<S, M, K, 2, 2>(simd, measure, depth, out),
            _ => self.fill_register::<S, M, K>(simd, measure, depth, out),
        }
    }

    /// Renders at most one register of columns, otherwise like [`fill`](Self::fill).
    #[inline(always)]
    pub(super) fn fill_register<S: Simd, M: Measure, const K: usize>(
        &self,
        simd: S,
        measure: M,
        depth: usize,
        out: &mut [&mut [f32]],
    ) -> usize {
        let is_split = const { <S::f32s as SimdBase<S>>::LEN < LANES };
        match self.columns.len() {
            LANES if is_split => self.fill_groups::<S, M, K, 2, 1>(simd, measure, depth, out),
            LANES => self.fill_groups::<S, M, K, 4, 1>(simd, measure, depth, out),
            _ => self.fill_groups::<S, M, K, 1, 0>(simd, measure, depth, out),
        }
    }

    /// Renders groups of `R` rows and `C` registers of columns. `C` = 0 means less than a whole register.
    #[inline(always)]
    pub(super) fn fill_groups<
        S: Simd,
        M: Measure,
        const K: usize,
        const R: usize,
        const C: usize,
    >(
        &self,
        simd: S,
        measure: M,
        depth: usize,
        out: &mut [&mut [f32]],
    ) -> usize {
        let register = if C == 2 { 0 } else { self.register };
        let values = self.values.lanes::<S, K>(simd, depth);
        let empty = empty(simd, depth, f32::INFINITY);
        let out = &mut out[self.rows.clone()];
        for (group, out) in out.chunks_mut(R).enumerate() {
            let mut best = [[empty; 2]; R];
            // Find the K smallest keys of each pixel of the group.
            for candidate in self.candidates {
                let row_terms = &candidate.rows.as_chunks::<R>().0[group];
                for part in 0..C.max(1) {
                    // The remainder proves to the compiler that the index is within bounds.
                    let register = (register + part) % 2;
                    let columns = &candidate.columns.as_chunks::<LANES>().0[register];
                    let column_terms = f32x16::from_slice(simd, columns);
                    for row in 0..R {
                        let row_term = f32x16::splat(simd, row_terms[row]);
                        let key = measure.accumulate(column_terms, row_term);
                        insert(&mut best[row][part], key);
                    }
                }
            }
            // Stop at the first group that has a key at or above the limit.
            let mut worst = best[0][0][K - 1];
            for row in 0..R {
                for part in 0..C.max(1) {
                    worst = greater(worst, best[row][part][K - 1]);
                }
            }
            if !worst.simd_lt(self.limit).all_true() {
                return self.rows.start + group * R;
            }
            // Convert the keys to values, and store them.
            for row in 0..R {
                let Some(out) = out.get_mut(row) else {
                    break;
                };
                let out = &mut out[self.columns.clone()];
                match C {
                    0 => values.put_part(measure, best[row][0], out),
                    1 => values.put(measure, best[row][0], out),
                    _ => {
                        let (left, right) = out.split_at_mut(LANES);
                        values.put(measure, best[row][0], left);
                        values.put(measure, best[row][1], right);
                    }
                }
            }
        }
        self.rows.end
    }
}

/// Returns `K` sorted keys before any comparison. The last `depth` keys are `nothing`. The others are unused, and stay
/// zero, below all keys.
#[inline(always)]
pub(super) fn empty<S: Simd, const K: usize>(
    simd: S,
    depth: usize,
    nothing: f32,
) -> [f32x16<S>; K] {
    let mut keys = [f32x16::splat(simd, nothing); K];
    for rank in 0..K - 1 {
        if rank + depth < K {
            keys[rank] = f32x16::splat(simd, 0.0);
        }
    }
    keys
}

/// Inserts a key into `K` sorted keys, and drops the largest.
#[inline(always)]
fn insert<S: Simd, const K: usize>(best: &mut [f32x16<S>; K], key: f32x16<S>) {
    // Each rank gets the median of its key, the key before it, and the new key.
    for rank in (1..K).rev() {
        best[rank] = lesser(best[rank], greater(best[rank - 1], key));
    }
    best[0] = lesser(best[0], key);
}

/// Returns the smaller of two nonnegative numbers. The bits of such floats have the same order as integers, and most
/// processors compare integers faster.
#[inline(always)]
pub(super) fn lesser<S: Simd, V: SimdFloat<S, Element = f32>>(a: V, b: V) -> V {
    if floats_are_faster(a.token()) {
        a.min(b)
    } else {
        V::from_bits(a.to_bits().min(b.to_bits()))
    }
}

/// Returns the larger of two nonnegative numbers; see [`lesser`].
#[inline(always)]
pub(super) fn greater<S: Simd, V: SimdFloat<S, Element = f32>>(a: V, b: V) -> V {
    if floats_are_faster(a.token()) {
        a.max(b)
    } else {
        V::from_bits(a.to_bits().max(b.to_bits()))
    }
}

/// Returns whether floats are compared faster than integers. This holds for SSE2, which has no minimum of 32-bit
/// integers.
#[inline(always)]
fn floats_are_faster<S: Simd>(simd: S) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return simd.level().as_sse4_2().is_none();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return false;
}
