//! Which parts of a cell may still take a point: 64 bits, one for each of 8 × 8 subcells.
//!
//! A bit is cleared once a single disc covers its subcell wholly. What several discs cover only together keeps its
//! bit: masks tell where to throw darts, not where the gaps are.
//!
//! The subcells that a point covers depend on where in its cell it lies. [`Coverage`] has them for a raster of 16 × 16
//! boxes of such offsets, and for a box only those subcells that are covered from everywhere in the box.

use super::grid::{Grid, HALO};

/// Subcells along a side of a cell.
pub(crate) const SIDE: usize = 8;

/// Boxes of offsets along a side of a cell. Finer ones clear more bits, but 16 × 16 still stay in the cache.
const BOXES: usize = 16;

/// Cells that a disc reaches, along an axis: its own and two on each side.
pub(crate) const REACH: usize = 2 * HALO as usize + 1;

/// For an offset within a cell, the bits that stay set in each of the 5 × 5 cells around, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Coverage {
    kept: Vec<[[u64; REACH]; REACH]>,
}

impl Coverage {
    /// Computes the table.
    pub(crate) fn new(grid: &Grid) -> Self {
        let x = farthest(grid.scale[0]);
        let y = farthest(grid.scale[1]);
        let mut kept = Vec::with_capacity(BOXES * BOXES);
        for far_y in &y {
            for far_x in &x {
                kept.push(kept_bits(far_x, far_y));
            }
        }
        Self { kept }
    }

    /// The bits that a point at `offset` of the middle cell leaves in the cells around it.
    #[inline(always)]
    pub(crate) fn kept(&self, offset: [f32; 2]) -> &[[u64; REACH]; REACH] {
        let [x, y] = offset.map(|at| ((at * BOXES as f32) as usize).min(BOXES - 1));
        &self.kept[y * BOXES + x]
    }
}

/// For each box of offsets, the square of the largest distance along one axis from the box to each subcell.
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

/// The bits of the subcells that are not wholly covered.
fn kept_bits(far_x: &[f32; REACH * SIDE], far_y: &[f32; REACH * SIDE]) -> [[u64; REACH]; REACH] {
    let mut kept = [[0; REACH]; REACH];
    for (row, y) in far_y.iter().enumerate() {
        let open = far_x.iter().enumerate().fold(0_u64, |bits, (column, x)| {
            bits | u64::from(x + y >= 1.0) << column
        });
        for (column, cell) in kept[row / SIDE].iter_mut().enumerate() {
            *cell |= (open >> (SIDE * column) & 0xFF) << (SIDE * (row % SIDE));
        }
    }
    kept
}

/// The number of the set bit of `mask` that has `rank` set bits below it.
#[inline(always)]
pub(crate) fn select(mut mask: u64, rank: u32) -> u32 {
    for _ in 0..rank {
        mask &= mask - 1;
    }
    mask.trailing_zeros()
}
