//! Bit masks of a cell's open parts, with one bit for each of its 8 × 8 subcells.
//!
//! A bit is cleared once a single disc covers its subcell. A subcell that is covered only by several discs together
//! keeps its bit. Masks therefore guide the darts, but do not find the last gaps.
//!
//! The subcells that a point covers depend on its offset in its cell. [`Coverage`] tabulates them for 16 × 16 boxes of
//! offsets. A box lists only the subcells that are covered from every offset in the box.

use super::grid::{Grid, HALO};
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, f32x8, prelude::*};

/// Number of subcells along a side of a cell.
pub(crate) const SIDE: usize = 8;

/// Number of offset boxes along a side of a cell. Finer boxes clear more bits, but 16 × 16 still fit the cache.
const BOXES: usize = 16;

/// Number of cells that a disc reaches along an axis: its cell and two on each side.
pub(crate) const REACH: usize = 2 * HALO as usize + 1;

/// Table of coverage masks. Each box of offsets has the masks, row by row, of the subcells that remain open in the 5 ×
/// 5 cells around a point with such an offset.
#[derive(Clone, Debug)]
pub(crate) struct Coverage {
    kept: Vec<[[u64; REACH]; REACH]>,
}

impl Coverage {
    /// Computes the table.
    pub(crate) fn new(grid: &Grid, level: Level) -> Self {
        let x = farthest(grid.scale[0]);
        let y = farthest(grid.scale[1]);
        let mut kept = Vec::with_capacity(BOXES * BOXES);
        for far_y in &y {
            dispatch!(level, simd => kept_in_row(simd, &x, far_y, &mut kept));
        }
        Self { kept }
    }

    /// Returns the masks of the subcells that stay open in the 5 × 5 cells around a point at `offset` in the center
    /// cell.
    #[inline(always)]
    pub(crate) fn kept(&self, offset: [f32; 2]) -> &[[u64; REACH]; REACH] {
        let [x, y] = offset.map(|at| ((at * BOXES as f32) as usize).min(BOXES - 1));
        &self.kept[y * BOXES + x]
    }
}

/// Returns, for each box of offsets, the squared maximum distance along one axis from the box to each subcell.
fn farthest(scale: f32) -> [[f32; REACH * SIDE]; BOXES] {
    core::array::from_fn(|offset| {
        core::array::from_fn(|subcell| {
            let low = subcell as f32 / SIDE as f32 - HALO as f32;
            let high = low + 1.0 / SIDE as f32;
            let start = offset as f32 / BOXES as f32;
            let end = start + 1.0 / BOXES as f32;
            let far = (end - low).max(high - start) * scale;
            far * far
        })
    })
}

/// Computes the masks of subcells that are not covered, for a row of boxes.
#[inline(always)]
fn kept_in_row<S: Simd>(
    simd: S,
    x: &[[f32; REACH * SIDE]; BOXES],
    far_y: &[f32; REACH * SIDE],
    into: &mut Vec<[[u64; REACH]; REACH]>,
) {
    for far_x in x {
        let mut kept = [[0; REACH]; REACH];
        for (row, &far_y) in far_y.iter().enumerate() {
            for (cell, far_x) in kept[row / SIDE].iter_mut().zip(far_x.chunks_exact(SIDE)) {
                let far_sq = f32x8::from_slice(simd, far_x) + far_y;
                *cell |= far_sq.simd_ge(1.0).to_bitmask() << (SIDE * (row % SIDE));
            }
        }
        into.push(kept);
    }
}

/// Returns the position of the set bit of `mask` that has `rank` set bits below it; the bit must exist.
///
/// Branch-free and without tables, after S. Vigna, "Broadword Implementation of Rank/Select Queries", Experimental
/// Algorithms 2008, DOI 10.1007/978-3-540-68552-4_12.
#[inline(always)]
pub(crate) fn select(mask: u64, rank: u32) -> u32 {
    // Prefix sums of the number of set bits, by byte
    let pairs = mask - (mask >> 1 & 0x5555_5555_5555_5555);
    let fours = (pairs & 0x3333_3333_3333_3333) + (pairs >> 2 & 0x3333_3333_3333_3333);
    let ends = ((fours + (fours >> 4)) & 0x0F0F_0F0F_0F0F_0F0F).wrapping_mul(ONES);
    // Find the byte of the bit.
    let byte = 8 * bytes_up_to(ends, rank);
    let rank = rank - ((ends << 8) >> byte & 0xFF) as u32;
    // Spread the bits of that byte, one per byte.
    let spread = (mask >> byte & 0xFF).wrapping_mul(ONES) & 0x8040_2010_0804_0201;
    let bits = ((spread + 0x7F7F_7F7F_7F7F_7F7F) | spread) >> 7 & ONES;
    byte + bytes_up_to(bits.wrapping_mul(ONES), rank)
}

/// The value 1 in every byte.
const ONES: u64 = 0x0101_0101_0101_0101;

/// Returns the number of bytes of `ends` that are at most `rank`; all bytes are below 128.
#[inline(always)]
fn bytes_up_to(ends: u64, rank: u32) -> u32 {
    let high = ONES << 7;
    let up_to = (((u64::from(rank) * ONES) | high) - ends) & high;
    ((up_to >> 7).wrapping_mul(ONES) >> 56) as u32
}

#[cfg(test)]
mod tests {
    use super::select;
    use dapple_hash::{Seed, hash1};

    #[test]
    fn select_finds_every_set_bit_in_order() {
        let random = (0..200).map(|i| {
            let bits = |j| hash1(Seed(i), [0], j);
            [
                bits(0),
                bits(0) & bits(1) & bits(2),
                bits(0) | bits(1) | bits(2),
            ]
        });
        for mask in random
            .flatten()
            .chain([1, 1 << 63, u64::MAX, 0x8000_0000_0000_0001])
        {
            let set = (0..64).filter(|bit| mask >> bit & 1 == 1);
            for (rank, bit) in (0..).zip(set) {
                assert_eq!(select(mask, rank), bit, "bit {rank} of {mask:#x}");
            }
        }
    }
}
