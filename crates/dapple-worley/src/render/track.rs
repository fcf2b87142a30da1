//! The inner loop of pictures that tell which feature points are the nearest.
//!
//! Keys hold the number of their candidate in the low bits, as in [`many`](crate::many). Pixels at which the order of
//! two of the nearest cannot be told from the other bits are searched on their own.

use super::LANES;
use super::kernel::{greater, lesser};
use super::shortlist::Shortlist;
use crate::features::FeatureRows;
use crate::fixed::STEP;
use crate::many::NOTHING;
use crate::metric::Norm;
use core::ops::Range;
use fearless_simd::{f32x16, i32x16, prelude::*, u8x64, u32x16};

/// Some rows of a tile.
#[derive(Debug)]
pub(super) struct TrackedRows<'a, const N: usize> {
    /// The rows of the tile, in the band.
    pub(super) rows: Range<usize>,
    /// The columns, in the window; at most [`LANES`].
    pub(super) columns: Range<usize>,
    /// The first column, in the block.
    pub(super) first_column: usize,
    /// The coordinates of the block's columns and of the band's rows, in steps.
    pub(super) lines: &'a [Vec<i32>; N],
    /// The smallest of them in the tile.
    pub(super) low: [i32; N],
    pub(super) shortlist: &'a Shortlist<N>,
    /// Keys from here on may be wrong.
    pub(super) limit: f32,
}

/// The `K` nearest points of the pixels of a row.
pub(super) struct Found<const N: usize, const K: usize> {
    pub(super) row: usize,
    pub(super) columns: Range<usize>,
    pub(super) distances: [[f32; LANES]; K],
    pub(super) vectors: [[[f32; N]; LANES]; K],
    pub(super) ids: [[u64; LANES]; K],
    /// The lanes whose order is not known, as bits.
    pub(super) unknown: u64,
}

impl<const N: usize> TrackedRows<'_, N> {
    /// Finds the nearest points row by row, and returns the row from which on keys reach the limit: the end, if none
    /// does.
    #[inline(always)]
    pub(super) fn fill<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        mut put: impl FnMut(&Found<N, K>),
    ) -> usize {
        let mut found = Found {
            row: self.rows.start,
            columns: self.columns.clone(),
            distances: [[0.0; LANES]; K],
            vectors: [[[0.0; N]; LANES]; K],
            ids: [[0; LANES]; K],
            unknown: 0,
        };
        let columns = i32x16::from_slice(simd, &self.lines[0][self.first_column..][..LANES]);
        let mut places = [(columns - self.low[0]).to_float::<f32x16<S>>() * STEP; N];
        let n_bits = usize::BITS - self.shortlist.len.leading_zeros();
        let mask = (1_u32 << n_bits) - 1;
        for row in self.rows.clone() {
            for axis in 1..N {
                let ahead = self.lines[axis][row] - self.low[axis];
                places[axis] = f32x16::splat(simd, ahead as f32 * STEP);
            }
            let (best, next) = self.smallest::<S, M, K>(norm, places[0], row, mask);
            let last = (best[K - 1] | mask).bitcast::<f32x16<S>>();
            if !last.simd_lt(self.limit).all_true() {
                return row;
            }
            found.row = row;
            found.unknown = 0;
            for rank in 0..K {
                let after = if rank + 1 < K { best[rank + 1] } else { next };
                let is_unknown = (best[rank] | mask).simd_ge(after | mask);
                found.unknown |= is_unknown.to_bitmask();
                self.look_up(simd, norm, &places, best[rank] & mask, (&mut found, rank));
            }
            put(&found);
        }
        self.rows.end
    }

    /// The keys of the `K` nearest, and of the next, with the numbers of their candidates in the low bits.
    #[inline(always)]
    fn smallest<S: Simd, M: Norm, const K: usize>(
        &self,
        norm: M,
        columns: f32x16<S>,
        row: usize,
        mask: u32,
    ) -> ([u32x16<S>; K], u32x16<S>) {
        let simd = columns.simd;
        let mut best = [f32x16::splat(simd, f32::from_bits(NOTHING)); K];
        let mut next = best[0];
        let shortlist = self.shortlist;
        let points = &shortlist.coordinates[0][..shortlist.len];
        let row = row - self.rows.start;
        for (number, (&point, row_terms)) in points.iter().zip(&shortlist.row_terms).enumerate() {
            let row_term = f32x16::splat(simd, row_terms[row]);
            let key = norm.joins(norm.terms(columns - point), row_term);
            let coded = (key.to_bits() & !mask) | number as u32;
            let mut coded = f32x16::from_bits(coded);
            for best in &mut best {
                let larger = greater(*best, coded);
                *best = lesser(*best, coded);
                coded = larger;
            }
            next = lesser(next, coded);
        }
        let mut bits = [next.to_bits(); K];
        for rank in 0..K {
            bits[rank] = best[rank].to_bits();
        }
        (bits, next.to_bits())
    }

    /// Takes down which points they are.
    #[inline(always)]
    fn look_up<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        places: &[f32x16<S>; N],
        numbers: u32x16<S>,
        (found, rank): (&mut Found<N, K>, usize),
    ) {
        let mut vector = *places;
        let mut parts = [[0.0; LANES]; N];
        for axis in 0..N {
            let points = look_up(simd, self.shortlist.coordinates(axis), numbers);
            vector[axis] = places[axis] - points;
            vector[axis].store_slice(&mut parts[axis]);
        }
        norm.distances(norm.keys(vector))
            .store_slice(&mut found.distances[rank]);
        let mut lanes = [0; LANES];
        numbers.store_slice(&mut lanes);
        let ids = &self.shortlist.ids;
        for lane in 0..LANES {
            for axis in 0..N {
                found.vectors[rank][lane][axis] = parts[axis][lane];
            }
            if !ids.is_empty() {
                found.ids[rank][lane] = ids[lanes[lane] as usize];
            }
        }
    }
}

/// The numbers of a table at sixteen indices. The table is padded to a whole register.
#[inline(always)]
fn look_up<S: Simd>(simd: S, table: &[f32], indices: u32x16<S>) -> f32x16<S> {
    if table.len() <= LANES {
        // Each index selects four bytes.
        let bytes = indices * 0x0404_0404 + 0x0302_0100;
        return f32x16::from_slice(simd, table).swizzle_dyn(bytes.bitcast::<u8x64<S>>());
    }
    let mut lanes = [0; LANES];
    indices.store_slice(&mut lanes);
    let values = lanes.map(|index| table[index as usize]);
    f32x16::from_slice(simd, &values)
}

impl<const N: usize, const K: usize> Found<N, K> {
    /// Puts the row into memory, but for what is unknown.
    pub(super) fn put(&self, features: &mut [FeatureRows<'_, N>]) {
        let columns = self.columns.clone();
        for (rank, out) in features.iter_mut().enumerate() {
            let n = columns.len();
            if let Some(out) = out.distance.get_mut(self.row) {
                out[columns.clone()].copy_from_slice(&self.distances[rank][..n]);
            }
            if let Some(out) = out.vector.get_mut(self.row) {
                out[columns.clone()].copy_from_slice(&self.vectors[rank][..n]);
            }
            if let Some(out) = out.id.get_mut(self.row) {
                out[columns.clone()].copy_from_slice(&self.ids[rank][..n]);
            }
        }
    }
}
