//! Adds the weights of control points to a band of pixels.
//!
//! The pixels that a support can touch are processed in tiles as wide as a register, starting at the support's first
//! row. For each tile, the axes that affect it are selected, and their weights are multiplied in all rows of the tile
//! at once. Columns of tiles are aligned with the registers of the whole band. Otherwise, sums would cross cache lines
//! or overlap earlier stores, which costs more time than tighter tiles save.

use crate::net::{AxisBlock, BLOCK, Exponents, Instance};
use crate::power::powers;
use crate::profile::{Profile, minus_u};
use crate::shift::shift_weights;
use crate::sink::{Planes, Sink};
use crate::tile::{Strip, Tile, Tiles};
use fearless_simd::prelude::*;

/// Maximum number of columns in a tile. This is the number of lanes of a register at the widest SIMD level.
pub(crate) const LANES: usize = 16;

/// Maximum number of rows in a tile. With two numbers for each pixel, a tile then fills half of 32 registers.
pub(crate) const ROWS: usize = 8;

/// Number of rows in a tile on processors with 16 registers, and for small supports.
const FEW_ROWS: usize = ROWS / 2;

/// Maximum width of supports that use small tiles, in columns. Larger tiles would be mostly outside of such supports.
const NARROW: u32 = 64;

/// The pixels of a band, and the sink that accumulates their weights.
pub(crate) struct Splatter<'a, P, K> {
    pub(crate) profile: P,
    pub(crate) sink: &'a K,
    /// Coordinates of the columns, padded with the last one so that whole tiles can be read.
    pub(crate) xs: &'a [f64],
    /// Coordinates of the rows, padded with the last one so that whole tiles can be read.
    pub(crate) ys: &'a [f64],
}

/// An instance (a control point or its periodic image), with all data that its weights depend on.
#[derive(Clone, Copy)]
pub(crate) struct Member<'a> {
    pub(crate) instance: &'a Instance,
    pub(crate) blocks: &'a [AxisBlock],
    /// Exponents of the axes, block by block; empty if no axis fades.
    pub(crate) exponents: &'a [Exponents],
    /// Shift: ε times the orientation in the plane; `None` without orientations.
    pub(crate) shift: Option<[f32; 2]>,
    pub(crate) footprint: Footprint,
}

/// The rectangle of pixels of a band that a support can touch.
#[derive(Clone, Copy)]
pub(crate) struct Footprint {
    pub(crate) column: u32,
    pub(crate) row: u32,
    pub(crate) n_columns: u32,
    pub(crate) n_rows: u32,
}

impl Footprint {
    /// Returns the first column of the first tile, for tiles of `width` columns.
    #[inline(always)]
    fn first_column(&self, width: usize) -> usize {
        self.column as usize / width * width
    }
}

impl<P: Profile, K: Sink> Splatter<'_, P, K> {
    /// Adds the weights of an instance to the planes; `tiles` is scratch memory.
    #[inline(always)]
    pub(crate) fn add<S: Simd>(
        &self,
        simd: S,
        member: Member,
        tiles: &mut Tiles,
        planes: &mut Planes<K>,
    ) {
        // Processors whose registers have 16 lanes have 32 registers.
        if S::f32s::LEN == LANES && member.footprint.n_columns > NARROW {
            self.add_tiles::<S, ROWS>(simd, member, tiles, planes);
        } else {
            self.add_tiles::<S, FEW_ROWS>(simd, member, tiles, planes);
        }
    }

    /// Adds the weights of an instance in tiles as wide as a register and `N` rows high.
    #[inline(always)]
    fn add_tiles<S: Simd, const N: usize>(
        &self,
        simd: S,
        member: Member,
        tiles: &mut Tiles,
        planes: &mut Planes<K>,
    ) {
        // Extend the footprint to whole tiles.
        let footprint = &member.footprint;
        let (column, row) = (footprint.first_column(S::f32s::LEN), footprint.row as usize);
        let n_columns = (footprint.column + footprint.n_columns) as usize - column;
        let n_columns = n_columns.next_multiple_of(S::f32s::LEN);
        let n_rows = (footprint.n_rows as usize).next_multiple_of(N);
        tiles.enter::<S, N>(
            simd,
            (member.blocks, member.instance.center),
            (&self.xs[column..column + n_columns], S::f32s::LEN),
            &self.ys[row..row + n_rows],
        );
        // Visit the tiles in the order of their number of axes.
        tiles.sort(simd);
        let mut place = [0; 2];
        while let Some(tile) = tiles.next(simd, &mut place) {
            self.add_tile::<S, N>(simd, member, tiles, tile, planes);
        }
    }

    /// Adds the weights of an instance in one tile.
    #[inline(always)]
    fn add_tile<S: Simd, const N: usize>(
        &self,
        simd: S,
        member: Member,
        tiles: &Tiles,
        tile: Tile,
        planes: &mut Planes<K>,
    ) {
        let x = S::f32s::from_slice(simd, &tiles.x(tile)[..S::f32s::LEN]);
        let strips = tiles.strips(tile);
        let mut weights = [S::f32s::splat(simd, 1.0); N];
        // Multiply the axial weights of the active axes in the first block.
        if tile.active != 0 {
            let ax = &member.blocks[0].x;
            weights = self.products(simd, &strips[0], ax, tile.active, x);
        }
        // Multiply by the axial weights of all other blocks.
        let blocks = strips.iter().zip(member.blocks).enumerate().skip(1);
        for (index, (strip, block)) in blocks {
            // Fading axes come first in their block, so the first exponent tells whether any axis fades.
            let products: [S::f32s; N] = match member.exponents.get(index) {
                Some(exponents) if exponents[0] < 1.0 => {
                    self.faded(simd, strip, &block.x, exponents, x)
                }
                _ => self.products(simd, strip, &block.x, ALL_AXES, x),
            };
            for row in 0..N {
                weights[row] *= products[row];
            }
        }
        // Apply the orientation.
        if let Some(shift) = member.shift {
            let mut y = [0.0; N];
            y.copy_from_slice(&strips[0].y[..N]);
            weights = shift_weights(simd, &weights, shift, x, &y);
        }
        // Add the weights to the sums of the tile.
        let footprint = &member.footprint;
        let column = footprint.first_column(S::f32s::LEN) + tile.column as usize * S::f32s::LEN;
        let row = footprint.row as usize + tile.strip as usize * N;
        let (sums, lane) = planes.rows(column, row, N);
        let point = member.instance.point;
        self.sink.add(simd, point, &weights, sums, lane);
    }

    /// Computes, for each pixel of `N` rows, the product of a block's axial weights raised to the exponents of fading
    /// axes.
    #[inline(always)]
    fn faded<S: Simd, V: SimdFloat<S, Element = f32>, const N: usize>(
        &self,
        simd: S,
        strip: &Strip,
        ax: &[f32; BLOCK],
        exponents: &Exponents,
        x: V,
    ) -> [V; N] {
        let mut products = [V::splat(simd, 1.0); N];
        let mut weights = products;
        // Multiply `A(u)^e` axis by axis. Fading axes come first; unused slots have the exponent 1.
        for axis in 0..BLOCK {
            if exponents[axis] >= 1.0 {
                break;
            }
            let (along, rest) = (x * ax[axis], &strip.rest[axis][..N]);
            for row in 0..N {
                let minus_u = minus_u(simd, along, V::splat(simd, rest[row]));
                weights[row] = self.profile.single(minus_u);
            }
            let exponents = [V::splat(simd, exponents[axis]); N];
            let faded = powers(simd, &weights, &exponents);
            for row in 0..N {
                products[row] *= faded[row];
            }
        }
        products
    }

    /// Computes, for each pixel of `N` rows, the product of the axial weights of a block's `active` axes, at least
    /// one.
    #[inline(always)]
    fn products<S: Simd, V: SimdFloat<S, Element = f32>, const N: usize>(
        &self,
        simd: S,
        strip: &Strip,
        ax: &[f32; BLOCK],
        mut active: u32,
        x: V,
    ) -> [V; N] {
        // The remainder proves to the compiler that the number is at most `BLOCK`.
        let n_axes = active.count_ones() as usize % (BLOCK + 1);
        let mut q = [x; N];
        let mut t = [x; N];
        // Start the products with the first active axis.
        let axis = take_lowest(&mut active);
        let (along, rest) = (x * ax[axis], &strip.rest[axis][..N]);
        for row in 0..N {
            let minus_u = minus_u(simd, along, V::splat(simd, rest[row]));
            (q[row], t[row]) = self.profile.first(minus_u);
        }
        // Multiply by the other active axes.
        while active != 0 {
            let axis = take_lowest(&mut active);
            let (along, rest) = (x * ax[axis], &strip.rest[axis][..N]);
            for row in 0..N {
                let minus_u = minus_u(simd, along, V::splat(simd, rest[row]));
                (q[row], t[row]) = self.profile.step(q[row], t[row], minus_u);
            }
        }
        // Combine the partial products into weights.
        for row in 0..N {
            q[row] = self.profile.finish(q[row], t[row], n_axes);
        }
        q
    }
}

/// Bit mask of all axes of a block.
const ALL_AXES: u32 = (1 << BLOCK) - 1;

/// Removes the lowest bit, and returns its index.
#[inline(always)]
fn take_lowest(bits: &mut u32) -> usize {
    // The remainder proves to the compiler that the index is below `BLOCK`.
    let lowest = bits.trailing_zeros() as usize % BLOCK;
    *bits &= bits.wrapping_sub(1);
    lowest
}
