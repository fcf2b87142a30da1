//! A few pixels as seen from a control point, and which of its axes matter there.
//!
//! An axis whose `u` is 1 over a whole tile is left out, which changes no bit; a control point with an axis whose `u` is
//! 0 over a whole tile has no weight there. Both are decided with the very numbers that the pixels would get: `u` is
//! computed by a subtraction and products, whose rounding is monotonic, so the corners of the tile have the least and the
//! most.
//!
//! Here, as in the rest of the evaluation, registers pass through plain loops only: a closure in an iterator or an array's
//! `map` is compiled for the baseline processor if it is not inlined, and then costs more than what it does.

use crate::net::{AxisBlock, BLOCK};
use crate::splat::{ROWS, TILE};
use core::ops::Range;
use fearless_simd::{f32x8, prelude::*};

/// A tile as seen from a control point.
#[derive(Default)]
pub(crate) struct Tile {
    /// The offsets of columns and rows.
    pub(crate) x: [f32; TILE],
    pub(crate) y: [f32; ROWS],
    /// Its first column and row in the band.
    pub(crate) first_column: usize,
    pub(crate) first_row: usize,
    /// Which columns of the band the support can touch.
    pub(crate) columns: Range<usize>,
    /// The axes that matter.
    pub(crate) blocks: Vec<ActiveBlock>,
}

/// The axes of one block that matter in a tile.
#[derive(Clone, Copy, Default)]
pub(crate) struct ActiveBlock {
    pub(crate) axes: [ActiveAxis; BLOCK],
    pub(crate) n: usize,
}

/// An axis that matters in a tile: its x, and `1 − a_y d_y` for every row.
#[derive(Clone, Copy, Default)]
pub(crate) struct ActiveAxis {
    pub(crate) x: f32,
    pub(crate) rest: [f32; ROWS],
}

impl Tile {
    /// Picks the axes that are neither 1 nor 0 over all rows and the columns between the offsets `ends`. False if one of
    /// them is 0 there: then the control point has no weight.
    #[inline(always)]
    pub(crate) fn select_axes<S: Simd>(
        &mut self,
        simd: S,
        blocks: &[AxisBlock],
        ends: [f32; 2],
    ) -> bool {
        self.blocks.resize(blocks.len(), ActiveBlock::default());
        for (block, active) in blocks.iter().zip(&mut self.blocks) {
            if !active.select(simd, block, ends, &self.y) {
                return false;
            }
        }
        true
    }

    /// Goes to the columns `xs`, of which the first is `first_column` of the band.
    #[inline(always)]
    pub(crate) fn move_to<S: Simd>(
        &mut self,
        simd: S,
        first_column: usize,
        xs: &[f64],
        center: f64,
    ) {
        self.first_column = first_column;
        let half = S::f64s::LEN;
        for column in (0..TILE).step_by(2 * half) {
            let low = S::f64s::from_slice(simd, &xs[column..column + half]) - center;
            let high = S::f64s::from_slice(simd, &xs[column + half..column + 2 * half]) - center;
            low.narrow(high)
                .store_slice(&mut self.x[column..column + 2 * half]);
        }
    }
}

impl ActiveBlock {
    #[inline(always)]
    fn select<S: Simd>(
        &mut self,
        simd: S,
        block: &AxisBlock,
        ends: [f32; 2],
        y: &[f32; ROWS],
    ) -> bool {
        let zero = f32x8::splat(simd, 0.0);
        let one = f32x8::splat(simd, 1.0);
        let ax = f32x8::from_slice(simd, &block.x);
        let (left, right) = (ax * ends[0], ax * ends[1]);
        let (top, bottom) = rest_at_ends(simd, block, y);
        let least = top.min(bottom) - left.max(right);
        let most = top.max(bottom) - left.min(right);
        if most.simd_le(zero).any_true() {
            return false;
        }
        let y = f32x8::from_slice(simd, y);
        let mut bits = least.simd_lt(one).to_bitmask();
        self.n = 0;
        while bits != 0 {
            let axis = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let active = &mut self.axes[self.n];
            active.x = block.x[axis];
            (one - y * block.y[axis]).store_slice(&mut active.rest);
            self.n += 1;
        }
        true
    }
}

/// The stretch of x, as seen from the center, outside of which no pixel of the rows `y` has a weight. Nothing if none
/// has.
#[inline(always)]
pub(crate) fn reach<S: Simd>(simd: S, blocks: &[AxisBlock], y: &[f32; ROWS]) -> Option<[f32; 2]> {
    // What three roundings can add to a quotient.
    const SLACK: f32 = 4.0 * f32::EPSILON;
    let zero = f32x8::splat(simd, 0.0);
    let far = f32x8::splat(simd, f32::INFINITY);
    let (mut from, mut to) = (f32::NEG_INFINITY, f32::INFINITY);
    for block in blocks {
        let ax = f32x8::from_slice(simd, &block.x);
        let (top, bottom) = rest_at_ends(simd, block, y);
        let bound = top.max(bottom) / ax;
        let slack = bound.abs() * SLACK;
        to = to.min(ax.simd_gt(zero).select(bound + slack, far).reduce_min());
        from = from.max(
            ax.simd_lt(zero)
                .select(bound - slack, zero - far)
                .reduce_max(),
        );
    }
    (from <= to).then_some([from, to])
}

/// `1 − a_y d_y` of every axis, for the first and the last row.
#[inline(always)]
fn rest_at_ends<S: Simd>(simd: S, block: &AxisBlock, y: &[f32; ROWS]) -> (f32x8<S>, f32x8<S>) {
    let one = f32x8::splat(simd, 1.0);
    let ay = f32x8::from_slice(simd, &block.y);
    (one - ay * y[0], one - ay * y[ROWS - 1])
}
