//! The weights of control points, added to a band of pixels.
//!
//! The pixels that a support can touch are taken in tiles: as wide as a register, from its first row on. The axes that
//! matter in a tile are picked, and their weights multiplied up in all of its rows at once. Columns of tiles begin where
//! registers of the whole band do: sums that lie across two cache lines, or across the sums that were stored before,
//! take longer than all that is saved.

use crate::net::{AxisBlock, BLOCK, Exponents, Instance};
use crate::power::powers;
use crate::profile::{Profile, minus_u};
use crate::shift::shift_weights;
use crate::sink::{Planes, Sink};
use crate::tile::{Strip, Tile, Tiles};
use fearless_simd::prelude::*;

/// Columns of the widest tile: a register at the widest level.
pub(crate) const LANES: usize = 16;

/// Rows of the highest tile: with two numbers a pixel they fill half of 32 registers.
pub(crate) const ROWS: usize = 8;

/// Rows of a tile where there are 16 registers, or where the support is small.
const FEW_ROWS: usize = ROWS / 2;

/// Supports up to so many columns wide are taken in smaller tiles: of larger ones, too much would lie outside of them.
const NARROW: u32 = 64;

/// The pixels of a band, and what becomes of weights there.
pub(crate) struct Splatter<'a, P, K> {
    pub(crate) profile: P,
    pub(crate) sink: &'a K,
    /// The coordinates of columns, with the last one again for as long as a tile can reach out.
    pub(crate) xs: &'a [f64],
    /// The coordinates of rows, likewise.
    pub(crate) ys: &'a [f64],
}

/// A control point, or image of one, with all that its weights depend on.
#[derive(Clone, Copy)]
pub(crate) struct Member<'a> {
    pub(crate) instance: &'a Instance,
    pub(crate) blocks: &'a [AxisBlock],
    /// The exponents of the blocks; empty where no axis fades.
    pub(crate) exponents: &'a [Exponents],
    /// ε times the orientation in the plane, where there are orientations.
    pub(crate) shift: Option<[f32; 2]>,
    pub(crate) footprint: Footprint,
}

/// The pixels of a band that a support can touch: the first, and how many columns and rows.
#[derive(Clone, Copy)]
pub(crate) struct Footprint {
    pub(crate) column: u32,
    pub(crate) row: u32,
    pub(crate) n_columns: u32,
    pub(crate) n_rows: u32,
}

impl Footprint {
    /// The first column of the first tile, which is `width` columns wide.
    #[inline(always)]
    fn first_column(&self, width: usize) -> usize {
        self.column as usize / width * width
    }
}

impl<P: Profile, K: Sink> Splatter<'_, P, K> {
    /// Adds the weights of a control point to the planes; `tiles` is memory to work in.
    #[inline(always)]
    pub(crate) fn add<S: Simd>(
        &self,
        simd: S,
        member: Member,
        tiles: &mut Tiles,
        planes: &mut Planes<K>,
    ) {
        // Where registers have 16 lanes, there are 32 of them.
        if S::f32s::LEN == LANES && member.footprint.n_columns > NARROW {
            self.add_tiles::<S, ROWS>(simd, member, tiles, planes);
        } else {
            self.add_tiles::<S, FEW_ROWS>(simd, member, tiles, planes);
        }
    }

    /// Adds the weights, in tiles as wide as a register and `N` rows high.
    #[inline(always)]
    fn add_tiles<S: Simd, const N: usize>(
        &self,
        simd: S,
        member: Member,
        tiles: &mut Tiles,
        planes: &mut Planes<K>,
    ) {
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
        tiles.sort(simd);
        let mut place = [0; 2];
        while let Some(tile) = tiles.next(simd, &mut place) {
            self.add_tile::<S, N>(simd, member, tiles, tile, planes);
        }
    }

    /// Adds the weights in one tile.
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
        if tile.active != 0 {
            let ax = &member.blocks[0].x;
            weights = self.products(simd, &strips[0], ax, tile.active, x);
        }
        let blocks = strips.iter().zip(member.blocks).enumerate().skip(1);
        for (index, (strip, block)) in blocks {
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
        if let Some(shift) = member.shift {
            let mut y = [0.0; N];
            y.copy_from_slice(&strips[0].y[..N]);
            weights = shift_weights(simd, &weights, shift, x, &y);
        }
        let footprint = &member.footprint;
        let column = footprint.first_column(S::f32s::LEN) + tile.column as usize * S::f32s::LEN;
        let row = footprint.row as usize + tile.strip as usize * N;
        let (sums, lane) = planes.rows(column, row, N);
        let point = member.instance.point;
        self.sink.add(simd, point, &weights, sums, lane);
    }

    /// The products of the axial weights of a block of axes that fade, in `N` rows.
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

    /// The products of the axial weights of a block, in `N` rows. At least one axis is `active`.
    #[inline(always)]
    fn products<S: Simd, V: SimdFloat<S, Element = f32>, const N: usize>(
        &self,
        simd: S,
        strip: &Strip,
        ax: &[f32; BLOCK],
        mut active: u32,
        x: V,
    ) -> [V; N] {
        let n_axes = active.count_ones() as usize % (BLOCK + 1);
        let mut q = [x; N];
        let mut t = [x; N];
        let axis = take_lowest(&mut active);
        let (along, rest) = (x * ax[axis], &strip.rest[axis][..N]);
        for row in 0..N {
            let minus_u = minus_u(simd, along, V::splat(simd, rest[row]));
            (q[row], t[row]) = self.profile.first(minus_u);
        }
        while active != 0 {
            let axis = take_lowest(&mut active);
            let (along, rest) = (x * ax[axis], &strip.rest[axis][..N]);
            for row in 0..N {
                let minus_u = minus_u(simd, along, V::splat(simd, rest[row]));
                (q[row], t[row]) = self.profile.step(q[row], t[row], minus_u);
            }
        }
        for row in 0..N {
            q[row] = self.profile.finish(q[row], t[row], n_axes);
        }
        q
    }
}

/// A bit for each axis of a block.
const ALL_AXES: u32 = (1 << BLOCK) - 1;

/// The place of the lowest bit, which is taken away.
#[inline(always)]
fn take_lowest(bits: &mut u32) -> usize {
    // The remainder tells the compiler what is known of eight bits.
    let lowest = bits.trailing_zeros() as usize % BLOCK;
    *bits &= bits.wrapping_sub(1);
    lowest
}
