//! The weights of control points, added to a band of pixels.
//!
//! The pixels that a support can touch are taken in tiles of [`TILE`] columns and [`ROWS`] rows, from its first row on; the
//! axes that matter in a tile are picked, and their weights multiplied up for a register of pixels in several rows at
//! once. Columns begin where a cache line does: sums that lie across two of them, or across the sums that were stored
//! before, take longer than all that is saved.

use crate::line::Line;
use crate::net::{AxisBlock, BLOCK, Instance};
use crate::profile::Profile;
use crate::shift::shift_weight;
use crate::sink::{Planes, Sink};
use crate::tile::{Tile, TileBlock};
use core::ops::Range;
use fearless_simd::prelude::*;

/// Columns of a tile: a register at the widest level.
pub(crate) const TILE: usize = 16;

/// Rows of a tile.
pub(crate) const ROWS: usize = 8;

/// Half of the rows of a tile; with two numbers a pixel they fill half of 16 registers.
const HALF: usize = ROWS / 2;

/// The pixels of a band, and what becomes of weights there.
pub(crate) struct Splatter<'a, P, K> {
    pub(crate) profile: P,
    pub(crate) sink: &'a K,
    /// The coordinates of columns, with the last one again for as long as a tile can reach out.
    pub(crate) xs: &'a [f64],
    pub(crate) columns: &'a Line,
    /// The coordinates of rows, likewise.
    pub(crate) ys: &'a [f64],
    pub(crate) rows: &'a Line,
}

/// A control point, or image of one, with all that its weights depend on.
#[derive(Clone, Copy)]
pub(crate) struct Member<'a> {
    pub(crate) instance: &'a Instance,
    pub(crate) blocks: &'a [AxisBlock],
    /// ε times the orientation in the plane.
    pub(crate) shift: Option<[f32; 2]>,
}

impl<P: Profile, K: Sink> Splatter<'_, P, K> {
    /// Adds the weights of a control point to the planes; `tile` is memory to work in.
    #[inline(always)]
    pub(crate) fn add<S: Simd>(
        &self,
        simd: S,
        member: Member,
        tile: &mut Tile,
        planes: &mut Planes,
    ) {
        let Instance {
            center, min, max, ..
        } = *member.instance;
        let columns = self.columns.touched(min.x, max.x);
        let rows = self.rows.touched(min.y, max.y);
        if columns.is_empty() {
            return;
        }
        for first_row in rows.clone().step_by(ROWS) {
            tile.first_row = first_row;
            for (row, y) in tile.y.iter_mut().enumerate() {
                *y = (self.ys[first_row + row] - center.y) as f32;
            }
            tile.columns = columns.clone();
            tile.enter_rows(simd, member.blocks);
            if columns.len() > 2 * TILE {
                // The box is wide, so it is worth knowing how much of it lies in these rows.
                let Some([left, right]) = tile.reach(simd) else {
                    continue;
                };
                let [left, right] = [center.x + f64::from(left), center.x + f64::from(right)];
                tile.columns = self.columns.touched(left.max(min.x), right.min(max.x));
            }
            let n_rows = rows.end - first_row;
            self.add_row_of_tiles(simd, member, n_rows, tile, planes);
        }
    }

    /// Adds the weights in the columns of the tile, and in `n_rows` rows, if there are as many.
    #[inline(always)]
    fn add_row_of_tiles<S: Simd>(
        &self,
        simd: S,
        member: Member,
        n_rows: usize,
        tile: &mut Tile,
        planes: &mut Planes,
    ) {
        let center = member.instance.center.x;
        let Range { start, end } = tile.columns;
        if start >= end {
            return;
        }
        let aligned = start / TILE * TILE..end.next_multiple_of(TILE);
        // A support that is narrower than a tile gets its axes picked once, for the one or two tiles that it lies in.
        let group = if end - start <= TILE {
            aligned.len()
        } else {
            TILE
        };
        for first in aligned.step_by(group) {
            let last = (first + group).min(self.xs.len()) - 1;
            let ends = [
                (self.xs[first] - center) as f32,
                (self.xs[last] - center) as f32,
            ];
            if tile.select_axes(simd, ends) {
                for first_column in (first..first + group).step_by(TILE) {
                    tile.move_to(
                        simd,
                        first_column,
                        &self.xs[first_column..first_column + TILE],
                        center,
                    );
                    self.add_tile(simd, member, n_rows, tile, planes);
                }
            }
        }
    }

    /// Adds the weights of one tile.
    #[inline(always)]
    fn add_tile<S: Simd>(
        &self,
        simd: S,
        member: Member,
        n_rows: usize,
        tile: &Tile,
        planes: &mut Planes,
    ) {
        for column in (0..TILE).step_by(S::f32s::LEN) {
            let first = tile.first_column + column;
            if first >= tile.columns.end || first + S::f32s::LEN <= tile.columns.start {
                continue;
            }
            // A row takes two registers, and an axis a few: 32 registers of 16 lanes hold all rows, 16 registers half.
            if S::f32s::LEN >= 16 && n_rows > HALF {
                self.add_rows::<S, ROWS>(simd, member, tile, planes, [column, 0]);
                continue;
            }
            self.add_rows::<S, HALF>(simd, member, tile, planes, [column, 0]);
            if n_rows > HALF {
                self.add_rows::<S, HALF>(simd, member, tile, planes, [column, HALF]);
            }
        }
    }

    /// Adds the weights of a register's columns in `N` rows, from the column and row `at` of the tile.
    #[expect(
        clippy::needless_range_loop,
        reason = "registers pass through plain loops only"
    )]
    #[inline(always)]
    fn add_rows<S: Simd, const N: usize>(
        &self,
        simd: S,
        member: Member,
        tile: &Tile,
        planes: &mut Planes,
        [column, first_row]: [usize; 2],
    ) {
        let x = S::f32s::from_slice(simd, &tile.x[column..column + S::f32s::LEN]);
        let mut weights = self.products::<S, N>(simd, &tile.blocks[0], x, first_row);
        for block in &tile.blocks[1..] {
            let products = self.products::<S, N>(simd, block, x, first_row);
            for row in 0..N {
                weights[row] *= products[row];
            }
        }
        if let Some(shift) = member.shift {
            for row in 0..N {
                if weights[row].simd_gt(S::f32s::splat(simd, 0.0)).any_true() {
                    let y = S::f32s::splat(simd, tile.y[first_row + row]);
                    weights[row] = shift_weight(simd, weights[row], shift, x, y);
                }
            }
        }
        let at = (tile.first_row + first_row) * planes.stride + tile.first_column + column;
        self.sink
            .add(simd, member.instance.point, &weights, planes, at);
    }

    /// The products of the axial weights of a block, in `N` rows.
    #[inline(always)]
    fn products<S: Simd, const N: usize>(
        &self,
        simd: S,
        block: &TileBlock,
        x: S::f32s,
        first_row: usize,
    ) -> [S::f32s; N] {
        let zero = S::f32s::splat(simd, 0.0);
        let one = S::f32s::splat(simd, 1.0);
        let mut q = [one; N];
        let mut t = [one; N];
        let mut active = block.active;
        while active != 0 {
            // The mask tells the compiler what is known of the lowest of eight bits.
            let axis = active.trailing_zeros() as usize % BLOCK;
            active &= active - 1;
            let along = x * block.axes.x[axis];
            let rest = &block.rest[axis][first_row..first_row + N];
            for row in 0..N {
                let u = S::f32s::splat(simd, rest[row]) - along;
                (q[row], t[row]) = self.profile.step(q[row], t[row], u.max(zero).min(one));
            }
        }
        let n = block.active.count_ones() as usize % (BLOCK + 1);
        for row in 0..N {
            q[row] = self.profile.finish(q[row], t[row], n);
        }
        q
    }
}
