//! Pixel tiles in the support of a control point, and the axes that affect each tile.
//!
//! An axis whose `u` is 1 in a whole tile is skipped, which does not change a bit. A control point with an axis whose
//! `u` is 0 in a whole tile has no weight there. Both tests use the same numbers as the pixels: `u` is computed by
//! subtractions and products, whose rounding is monotonic, so its extremes are at the corners of the tile.
//!
//! The parts of `u` that depend only on columns or only on rows are computed once for all tiles. If there are many
//! tiles, they are sorted by their number of relevant axes. The processor can then predict the end of the loop over
//! axes, which it cannot if the numbers alternate at random. If there are few tiles, all axes count as relevant, for
//! the same reason.
//!
//! The evaluation processes registers in plain loops only. A closure passed to an iterator or to an array's `map` is
//! compiled for the baseline processor if it is not inlined, and then costs more than the work that it does.

use crate::net::{AxisBlock, BLOCK};
use crate::splat::{LANES, ROWS};
use fearless_simd::{f32x8, f64x4, prelude::*};
use glam::DVec2;

/// Maximum number of tiles that are not sorted.
const FEW: usize = 8;

/// The tiles that the support of a control point can touch.
#[derive(Default)]
pub(crate) struct Tiles {
    columns: Vec<Column>,
    n_columns: usize,
    /// Rows of tiles, with one element for each row of tiles and block of axes.
    strips: Vec<Strip>,
    n_strips: usize,
    n_blocks: usize,
    /// Bit mask of the used slots in the first block of axes.
    axes: u32,
    /// Buckets of tiles, one for each number of relevant axes. Each bucket has space for all tiles.
    sorted: Vec<Tile>,
    /// Number of tiles in each bucket.
    lengths: [usize; STRETCHES],
}

/// A column of tiles.
#[derive(Clone, Copy, Default)]
#[repr(align(64))]
struct Column {
    /// x offset from the control point of each pixel column.
    x: [f32; LANES],
    /// Minimum and maximum of `a_x d_x` over the pixel columns, for each axis of the first block.
    least: [f32; BLOCK],
    most: [f32; BLOCK],
}

/// A row of tiles, for one block of axes.
#[derive(Clone, Copy, Default)]
#[repr(align(64))]
pub(crate) struct Strip {
    /// `1 − a_y d_y` for each axis and pixel row.
    pub(crate) rest: [[f32; ROWS]; BLOCK],
    /// Minimum and maximum of `rest` over the pixel rows, for each axis.
    least: [f32; BLOCK],
    most: [f32; BLOCK],
    /// y offset from the control point of each pixel row.
    pub(crate) y: [f32; ROWS],
}

/// A tile in which the control point may have a weight.
#[derive(Clone, Copy, Default)]
pub(crate) struct Tile {
    /// Column and row of the tile, counted in tiles.
    pub(crate) column: u32,
    pub(crate) strip: u32,
    /// Bit mask of the first block's axes to multiply. If there are few tiles, it selects all axes or none.
    pub(crate) active: u32,
}

/// Number of buckets: one for each number of relevant axes from 0 to [`BLOCK`], and one for tiles without a weight.
const STRETCHES: usize = BLOCK + 2;

/// Index of the bucket for tiles without a weight.
const NOTHING: usize = BLOCK + 1;

impl Tiles {
    /// Computes the tiles of a control point, given its blocks of axes and its center. `xs` are the coordinates of the
    /// pixel columns, starting at the first tile, with `width` columns per tile. `ys` are the coordinates of the rows,
    /// with `H` rows per tile.
    #[inline(always)]
    pub(crate) fn enter<S: Simd, const H: usize>(
        &mut self,
        simd: S,
        (blocks, center): (&[AxisBlock], DVec2),
        (xs, width): (&[f64], usize),
        ys: &[f64],
    ) {
        self.n_blocks = blocks.len();
        self.axes = blocks[0].slots(simd);
        self.n_columns = xs.len() / width;
        self.n_strips = ys.len() / H;
        // Memory is reused by all control points of a band, so it only grows.
        if self.columns.len() < self.n_columns {
            self.columns.resize(self.n_columns, Column::default());
        }
        // Compute the offsets of the columns, and bounds of a_x d_x for each column of tiles.
        for (column, xs) in self.columns.iter_mut().zip(xs.chunks_exact(width)) {
            column.enter(simd, &blocks[0], xs, center.x);
        }
        if self.strips.len() < self.n_strips * self.n_blocks {
            self.strips
                .resize(self.n_strips * self.n_blocks, Strip::default());
        }
        // Compute 1 − a_y d_y, and its bounds, for each row of tiles and each block of axes.
        let mut strips = self.strips.iter_mut();
        for ys in ys.chunks_exact(H) {
            for (axes, strip) in blocks.iter().zip(strips.by_ref()) {
                strip.enter::<S, H>(simd, axes, ys, center.y);
            }
        }
    }

    /// Returns whether there are too few tiles to be worth sorting.
    #[inline(always)]
    fn are_few(&self) -> bool {
        self.n_columns * self.n_strips <= FEW
    }

    /// Sorts the tiles into buckets by their number of relevant axes, if there are enough tiles.
    #[inline(always)]
    pub(crate) fn sort<S: Simd>(&mut self, simd: S) {
        if self.are_few() {
            return;
        }
        let n_tiles = self.n_columns * self.n_strips;
        if self.sorted.len() < n_tiles * STRETCHES {
            self.sorted.resize(n_tiles * STRETCHES, Tile::default());
        }
        self.lengths = [0; STRETCHES];
        let columns = &self.columns[..self.n_columns];
        // Append each tile to the section of its number of axes.
        for strip in 0..self.n_strips {
            // Only axes of the first block are selected; further blocks are always multiplied.
            let rest = self.strips[strip * self.n_blocks].ends(simd);
            for (column, ends) in columns.iter().enumerate() {
                let (active, has_weight) = ends.active_axes(simd, rest);
                let stretch = if has_weight {
                    active.count_ones() as usize
                } else {
                    NOTHING
                };
                let length = &mut self.lengths[stretch];
                self.sorted[stretch * n_tiles + *length] = Tile {
                    column: column as u32,
                    strip: strip as u32,
                    active,
                };
                *length += 1;
            }
        }
    }

    /// Returns the next tile in which the control point has a weight; call [`sort`](Self::sort) first. The second
    /// argument is the state of the iteration, initially zero: the row and column of the next tile if there are few
    /// tiles, otherwise a bucket and an index in it.
    #[inline(always)]
    pub(crate) fn next<S: Simd>(&self, simd: S, [outer, inner]: &mut [usize; 2]) -> Option<Tile> {
        // A few tiles are tested when they are visited, row by row.
        if self.are_few() {
            while *outer < self.n_strips {
                let (strip, column) = (*outer, *inner);
                *inner += 1;
                if *inner == self.n_columns {
                    (*outer, *inner) = (strip + 1, 0);
                }
                let rest = self.strips[strip * self.n_blocks].ends(simd);
                let (active, has_weight) = self.columns[column].active_axes(simd, rest);
                if has_weight {
                    // Use all axes if any matters. There are fewer than 2^32 columns and rows of pixels.
                    return Some(Tile {
                        column: column as u32,
                        strip: strip as u32,
                        active: if active == 0 { 0 } else { self.axes },
                    });
                }
            }
            return None;
        }
        // Sorted tiles are visited section by section. The last section, tiles without a weight, is left out.
        let n_tiles = self.n_columns * self.n_strips;
        while *outer < NOTHING {
            if *inner < self.lengths[*outer] {
                *inner += 1;
                return Some(self.sorted[*outer * n_tiles + *inner - 1]);
            }
            (*outer, *inner) = (*outer + 1, 0);
        }
        None
    }

    /// Returns the x offsets of a tile's pixel columns from the control point.
    #[inline(always)]
    pub(crate) fn x(&self, tile: Tile) -> &[f32; LANES] {
        &self.columns[tile.column as usize].x
    }

    /// Returns the row of tiles that contains a tile, as one strip for each block of axes.
    #[inline(always)]
    pub(crate) fn strips(&self, tile: Tile) -> &[Strip] {
        &self.strips[tile.strip as usize * self.n_blocks..][..self.n_blocks]
    }
}

impl Column {
    #[inline(always)]
    fn enter<S: Simd>(&mut self, simd: S, axes: &AxisBlock, xs: &[f64], center: f64) {
        // Compute the offsets in double precision, and round them.
        if xs.len().is_multiple_of(BLOCK) {
            for (x, xs) in self.x.chunks_exact_mut(BLOCK).zip(xs.chunks_exact(BLOCK)) {
                offsets(simd, xs, center).store_slice(x);
            }
        } else {
            for (x, coordinate) in self.x.iter_mut().zip(xs) {
                *x = (coordinate - center) as f32;
            }
        }
        // a_x d_x is monotonic in x, so its bounds are at the first and the last column.
        let ax = f32x8::from_slice(simd, &axes.x);
        let (left, right) = (ax * self.x[0], ax * self.x[xs.len() - 1]);
        left.min(right).store_slice(&mut self.least);
        left.max(right).store_slice(&mut self.most);
    }

    /// Returns a bit mask of the first block's axes that are relevant in a tile of this column, and whether the
    /// control point has a weight there. `rest` is the result of [`ends`](Strip::ends) for the tile's row.
    #[inline(always)]
    fn active_axes<S: Simd>(&self, simd: S, rest: [f32x8<S>; 2]) -> (u32, bool) {
        // Bounds of u = (1 − a_y d_y) − a_x d_x in the tile.
        let least = rest[0] - f32x8::from_slice(simd, &self.most);
        let most = rest[1] - f32x8::from_slice(simd, &self.least);
        // An axis is relevant if its u is below 1 somewhere. One whose u is nowhere above 0 makes the weight zero.
        let active = least.simd_lt(f32x8::splat(simd, 1.0)).to_bitmask();
        let without = most.simd_le(f32x8::splat(simd, 0.0)).to_bitmask();
        // Eight lanes give eight bits.
        (active as u32, without == 0)
    }
}

impl Strip {
    #[inline(always)]
    fn enter<S: Simd, const H: usize>(
        &mut self,
        simd: S,
        axes: &AxisBlock,
        ys: &[f64],
        center: f64,
    ) {
        let y = if H == BLOCK {
            offsets(simd, ys, center)
        } else {
            // Fill a register with the four offsets twice.
            let low = f64x4::from_slice(simd, ys) - center;
            low.narrow(low)
        };
        y.store_slice(&mut self.y);
        let one = f32x8::splat(simd, 1.0);
        let ay = f32x8::from_slice(simd, &axes.y);
        // 1 − a_y d_y is monotonic in y, so its bounds are in the first and the last row.
        let (top, bottom) = (one - ay * y.as_slice()[0], one - ay * y.as_slice()[H - 1]);
        top.min(bottom).store_slice(&mut self.least);
        top.max(bottom).store_slice(&mut self.most);
        for axis in 0..BLOCK {
            (one - y * axes.y[axis]).store_slice(&mut self.rest[axis]);
        }
    }

    /// Returns the minimum and maximum of `1 − a_y d_y` over the pixel rows, for each axis.
    #[inline(always)]
    fn ends<S: Simd>(&self, simd: S) -> [f32x8<S>; 2] {
        [
            f32x8::from_slice(simd, &self.least),
            f32x8::from_slice(simd, &self.most),
        ]
    }
}

/// Returns the offsets of eight coordinates from a control point.
#[inline(always)]
fn offsets<S: Simd>(simd: S, coordinates: &[f64], center: f64) -> f32x8<S> {
    let low = f64x4::from_slice(simd, &coordinates[..4]) - center;
    let high = f64x4::from_slice(simd, &coordinates[4..]) - center;
    low.narrow(high)
}
