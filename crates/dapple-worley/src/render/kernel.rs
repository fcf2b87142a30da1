//! The inner loop: the `K` smallest keys of sixteen pixels side by side, for several rows at once.

use crate::metric::Norm;
use crate::render::LANES;
use crate::render::cull::Candidates;
use fearless_simd::{f32x16, prelude::*, u32x16};

/// The most rows of a tile: those of one register.
pub(crate) const TILE_ROWS: usize = LANES;

/// What the rows of a tile add to the key of each candidate: the terms of all axes but the first, joined.
#[derive(Debug, Default)]
pub(crate) struct RowTerms {
    /// For each candidate, one for each row of the tile.
    terms: Vec<f32>,
}

impl RowTerms {
    /// Computes them for rows with these coordinates, along the axes from the second on.
    #[inline(always)]
    pub(crate) fn fill<S: Simd, M: Norm, const N: usize>(
        &mut self,
        norm: M,
        rows: &[f32x16<S>; N],
        candidates: &Candidates<N>,
    ) {
        if self.terms.len() < candidates.len * LANES {
            self.terms.resize(candidates.len.next_power_of_two() * LANES, 0.0);
        }
        for (index, terms) in self.terms.chunks_exact_mut(LANES).take(candidates.len).enumerate() {
            let term = |axis: usize| norm.terms(rows[axis] - candidates.coordinates[axis][index]);
            let mut key = term(N - 1);
            for axis in (1..N - 1).rev() {
                key = norm.joins(term(axis), key);
            }
            key.store_slice(terms);
        }
    }
}

/// The `K` smallest keys, smallest first, of `R` rows from row `first` of a tile on; and the largest of the `K`-th.
#[inline(always)]
pub(crate) fn smallest<S: Simd, M: Norm, const N: usize, const K: usize, const R: usize>(
    norm: M,
    columns: f32x16<S>,
    candidates: &Candidates<N>,
    row_terms: &RowTerms,
    first: usize,
) -> ([[f32x16<S>; K]; R], f32x16<S>) {
    let simd = columns.simd;
    let mut best = [[f32x16::splat(simd, f32::INFINITY); K]; R];
    let coordinates = &candidates.coordinates[0][..candidates.len];
    let terms = &row_terms.terms[..candidates.len * LANES];
    for (index, &coordinate) in coordinates.iter().enumerate() {
        let column_terms = norm.terms(columns - coordinate);
        let row_terms = &terms[index * LANES + first..][..R];
        for row in 0..R {
            let key = norm.joins(column_terms, f32x16::splat(simd, row_terms[row]));
            insert(&mut best[row], key);
        }
    }
    let mut worst = best[0][K - 1];
    for row in 1..R {
        worst = greater(worst, best[row][K - 1]);
    }
    (best, worst)
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
fn lesser<S: Simd>(a: f32x16<S>, b: f32x16<S>) -> f32x16<S> {
    if floats_are_faster(a.simd) {
        a.min(b)
    } else {
        a.bitcast::<u32x16<S>>().min(b.bitcast::<u32x16<S>>()).bitcast()
    }
}

#[inline(always)]
fn greater<S: Simd>(a: f32x16<S>, b: f32x16<S>) -> f32x16<S> {
    if floats_are_faster(a.simd) {
        a.max(b)
    } else {
        a.bitcast::<u32x16<S>>().max(b.bitcast::<u32x16<S>>()).bitcast()
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
