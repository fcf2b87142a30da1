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

/// A tile as seen from a control point, and the row of tiles that it lies in.
#[derive(Default)]
pub(crate) struct Tile {
    /// The offsets of columns and rows.
    pub(crate) x: [f32; TILE],
    pub(crate) y: [f32; ROWS],
    /// Its first column and row in the band.
    pub(crate) first_column: usize,
    pub(crate) first_row: usize,
    /// Which columns of the band the support can touch in these rows.
    pub(crate) columns: Range<usize>,
    /// The axes of the control point.
    pub(crate) blocks: Vec<TileBlock>,
}

/// The axes of one block in a tile.
#[derive(Clone, Copy, Default)]
pub(crate) struct TileBlock {
    pub(crate) axes: AxisBlock,
    /// `1 − a_y d_y`, for every axis and row.
    pub(crate) rest: [[f32; ROWS]; BLOCK],
    /// Its least and its most over the rows, for every axis.
    rest_least: [f32; BLOCK],
    rest_most: [f32; BLOCK],
    /// Which axes matter in the tile, as bits.
    pub(crate) active: u32,
}

impl Tile {
    /// Goes to the rows `y`, in which all tiles share what depends on rows only.
    #[inline(always)]
    pub(crate) fn enter_rows<S: Simd>(&mut self, simd: S, blocks: &[AxisBlock]) {
        self.blocks.resize(blocks.len(), TileBlock::default());
        for (block, axes) in self.blocks.iter_mut().zip(blocks) {
            block.enter_rows(simd, axes, &self.y);
        }
    }

    /// Picks the axes that are neither 1 nor 0 over all rows and the columns between the offsets `ends`. False if one of
    /// them is 0 there: then the control point has no weight.
    #[inline(always)]
    pub(crate) fn select_axes<S: Simd>(&mut self, simd: S, ends: [f32; 2]) -> bool {
        for block in &mut self.blocks {
            if !block.select(simd, ends) {
                return false;
            }
        }
        true
    }

    /// The stretch of x, as seen from the center, outside of which no pixel of the rows has a weight. Nothing if none has.
    #[inline(always)]
    pub(crate) fn reach<S: Simd>(&self, simd: S) -> Option<[f32; 2]> {
        // What three roundings can add to a quotient.
        const SLACK: f32 = 4.0 * f32::EPSILON;
        let zero = f32x8::splat(simd, 0.0);
        let far = f32x8::splat(simd, f32::INFINITY);
        let (mut from, mut to) = (f32::NEG_INFINITY, f32::INFINITY);
        for block in &self.blocks {
            let ax = f32x8::from_slice(simd, &block.axes.x);
            let bound = f32x8::from_slice(simd, &block.rest_most) / ax;
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

impl TileBlock {
    #[inline(always)]
    fn enter_rows<S: Simd>(&mut self, simd: S, axes: &AxisBlock, y: &[f32; ROWS]) {
        self.axes = *axes;
        let one = f32x8::splat(simd, 1.0);
        let ay = f32x8::from_slice(simd, &axes.y);
        let (top, bottom) = (one - ay * y[0], one - ay * y[ROWS - 1]);
        top.min(bottom).store_slice(&mut self.rest_least);
        top.max(bottom).store_slice(&mut self.rest_most);
        let y = f32x8::from_slice(simd, y);
        for axis in 0..BLOCK {
            (one - y * axes.y[axis]).store_slice(&mut self.rest[axis]);
        }
    }

    #[inline(always)]
    fn select<S: Simd>(&mut self, simd: S, ends: [f32; 2]) -> bool {
        let ax = f32x8::from_slice(simd, &self.axes.x);
        let (left, right) = (ax * ends[0], ax * ends[1]);
        let most = f32x8::from_slice(simd, &self.rest_most) - left.min(right);
        if most.simd_le(f32x8::splat(simd, 0.0)).any_true() {
            return false;
        }
        let least = f32x8::from_slice(simd, &self.rest_least) - left.max(right);
        // Eight lanes, eight bits.
        self.active = least.simd_lt(f32x8::splat(simd, 1.0)).to_bitmask() as u32;
        true
    }
}
