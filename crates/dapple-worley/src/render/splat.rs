//! Small cells: every feature point is compared at the few tiles about it.
//!
//! Where a cell has only a few pixels, looking for the points that matter to each tile takes longer than comparing
//! them. So tiles have 4 × 4 pixels, a register, and each is compared with all points that lie in it or in the tiles
//! about it ([`bins`](super::bins)). All points nearer to a pixel than the edge of these have been compared there
//! then, and its keys are right if the `K`-th is smaller than that.

use super::bins::{Bins, Grid, HALF, Point, Reach, TILE};
use super::block::{Block, Memory};
use super::kernel::{greater, lesser};
use super::table::CellBox;
use super::{BLOCK_COLUMNS, LANES};
use crate::fixed::{STEP, STEP_BITS};
use crate::metric::{Norm, with_norm};
use crate::sink::{ValueLanes, Values};
use crate::{Axes, Space};
use fearless_simd::{Level, dispatch, f32x4, f32x16, i32x4, prelude::*};

/// By how much of a pixel a pixel may lie beside its place: well below what [`SURE`] leaves.
const UNEVEN: f32 = 0.001;

/// The largest part of the distance from a tile to the edge of those about it that is relied upon: the place of a
/// point among the pixels is rounded.
const SURE: f32 = 0.999;

/// Where the tiles about a tile reach further than this, in cells, there are better ways;
const FARTHEST: f32 = 3.5;

/// and also where they reach further than so many times the distance that is needed.
const MOST_WASTE: f32 = 4.0;

/// The tiles about a tile that points are taken from, on either side.
const NEAR: usize = 1;
const WIDE: usize = 2;

/// More half tiles above and below a tile than this are too many.
const MOST_HALVES: usize = 8;

/// How many times as far as the guess points are taken from along the axes across the picture: searching a pixel on its
/// own takes as long as comparing hundreds.
const SPARE: f32 = 1.1;

/// How a block is filled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Splat {
    /// The tiles and half tiles about a tile that points are taken from.
    around: [usize; 2],
    /// The distance from any pixel within which no point is left out, in cells.
    pub(super) reach: f32,
    /// Steps from one column to the next, and from one row to the next along the axis that goes with the rows.
    pixel: [f32; 2],
    /// The axis that goes with the rows.
    row_axis: usize,
}

impl Splat {
    /// How to fill a block whose pixels need points as far away as `distance`, if it can be filled in this way.
    pub(super) fn new<const N: usize>(block: &Block<'_, N>, distance: f32) -> Option<Self>
    where
        Axes: Space<N>,
    {
        let plane = block.picture.plane;
        let [u, v]: [[f64; N]; 2] = [plane.u.into(), plane.v.into()];
        let row_axis = plane.row_axis()?;
        // The terms of the axes across the picture are joined before those of the rows.
        if N == 4 && row_axis != 1 {
            return None;
        }
        let window = block.picture.window;
        let frequency = block.picture.frequency;
        let pixel = window.pixel * window.scale;
        let pixel = [
            (u[0] * pixel.x * frequency) as f32,
            (v[row_axis] * pixel.y * frequency) as f32,
        ];
        // A tile begins half a pixel before its first pixel.
        let reach = |pixel: f32, pixels: usize| (pixels as f32 + 0.5) * pixel.abs() * SURE;
        let useful = distance..FARTHEST.min(MOST_WASTE * distance);
        for tiles in [NEAR, WIDE] {
            let along_row = reach(pixel[0], TILE * tiles);
            let halves = (1..MOST_HALVES).find(|halves| reach(pixel[1], HALF * halves) >= distance);
            let Some(halves) = halves.filter(|_| useful.contains(&along_row)) else {
                continue;
            };
            let along = along_row.min(reach(pixel[1], HALF * halves));
            let across = if N > 2 {
                distance * SPARE
            } else {
                f32::INFINITY
            };
            return Some(Self {
                around: [tiles, halves],
                reach: along.min(across),
                pixel: pixel.map(|cells| cells / STEP),
                row_axis,
            });
        }
        None
    }

    /// Whether pixels are as evenly spaced as tiles need it: far from zero, `f64` may not tell them apart.
    pub(super) fn is_even<const N: usize>(&self, lines: &[Vec<i32>; N]) -> bool {
        let is_even = |axis: usize, pixel: f32| {
            let line = &lines[axis][..lines[axis].len() - LANES];
            line.iter().enumerate().all(|(index, &steps)| {
                let expected = line[0] as f32 + index as f32 * pixel;
                (steps as f32 - expected).abs() <= UNEVEN * pixel.abs()
            })
        };
        is_even(0, self.pixel[0]) && is_even(self.row_axis, self.pixel[1])
    }

    /// Fills the pixels of a block; its lines are counted from the corner of `cells`.
    pub(super) fn render<const N: usize>(
        &self,
        block: &Block<'_, N>,
        cells: &CellBox<N>,
        (values, out): (&Values, &mut [&mut [f32]]),
        memory: &mut Memory<N>,
    ) where
        Axes: Space<N>,
    {
        let origin = cells.first;
        let cells = self.cells(block, origin, memory);
        let Memory { bins, lines, .. } = memory;
        let lattice = &block.picture.worley.lattice;
        let grid = Grid {
            origin,
            first: lines.each_ref().map(|line| line[0]),
            size: [block.range.len(), block.n_rows],
            pixel: self.pixel,
            row_axis: self.row_axis,
        };
        let [tiles, halves] = self.around;
        with_norm!(block.picture.worley.metric, norm => {
            let reach = Reach {
                tiles,
                halves,
                key: norm.key_along_one_axis(self.reach),
            };
            bins.clear(&lines[0][..block.range.len()], block.n_rows, reach);
            dispatch!(block.level, simd => bins.collect(simd, norm, lattice, &cells, (&grid, reach)));
            bins.count();
            let rows = &lines[self.row_axis];
            if tiles == NEAR {
                let mut points = core::mem::take(&mut bins.near);
                dispatch!(block.level, simd => bins.sort(simd, norm, &mut points));
                let runs = Runs::new(bins, reach, rows, &points);
                fill_block::<_, N, 12, 3>(norm, (block, reach), runs, (values, out));
                bins.near = points;
            } else {
                let mut points = core::mem::take(&mut bins.wide);
                dispatch!(block.level, simd => bins.sort(simd, norm, &mut points));
                let runs = Runs::new(bins, reach, rows, &points);
                fill_block::<_, N, 20, 5>(norm, (block, reach), runs, (values, out));
                bins.wide = points;
            }
        });
    }

    /// The cells with points within reach.
    fn cells<const N: usize>(
        &self,
        block: &Block<'_, N>,
        origin: [i64; N],
        memory: &Memory<N>,
    ) -> CellBox<N>
    where
        Axes: Space<N>,
    {
        let pixels = memory.pixel_box(0..block.range.len(), 0..block.n_rows);
        let reach = (self.reach / STEP) as i32 + 1;
        let cell = |axis: usize, steps: i32| origin[axis] + i64::from(steps >> STEP_BITS);
        CellBox {
            first: core::array::from_fn(|axis| cell(axis, pixels.low[axis] - reach)),
            last: core::array::from_fn(|axis| cell(axis, pixels.high[axis] + reach)),
        }
    }
}

/// Fills the pixels of a block from its points.
fn fill_block<M: Norm, const N: usize, const W: usize, const TILES: usize>(
    norm: M,
    (block, reach): (&Block<'_, N>, Reach),
    runs: Runs<'_, W>,
    (values, out): (&Values, &mut [&mut [f32]]),
) where
    Axes: Space<N>,
{
    let range = block.range.clone();
    let n_tiles = range.len().div_ceil(TILE);
    let limit = norm.tightened(reach.key);
    let mut whole_tiles = [[0.0; BLOCK_COLUMNS]; TILE];
    let mut unknown = [0; BLOCK_COLUMNS / TILE];
    for (tile_row, out) in out.chunks_mut(TILE).enumerate() {
        let is_whole = out.len() == TILE && range.len() % TILE == 0;
        if !is_whole {
            for (pixels, out) in whole_tiles.iter_mut().zip(&*out) {
                pixels[..range.len()].copy_from_slice(&out[range.clone()]);
            }
        }
        let mut out_rows = out.iter_mut();
        let pixels = whole_tiles.each_mut().map(|pixels| match out_rows.next() {
            Some(out) if is_whole => &mut out[range.clone()],
            _ => &mut pixels[..n_tiles * TILE],
        });
        let unknown = &mut unknown[..n_tiles];
        let (from, limit, to) = ((runs, tile_row), (values, limit), (pixels, &mut *unknown));
        if N == 2 {
            fill_by_depth::<_, W, TILES, false>(block.level, norm, from, limit, to);
        } else {
            fill_by_depth::<_, W, TILES, true>(block.level, norm, from, limit, to);
        }
        if !is_whole {
            for (pixels, out) in whole_tiles.iter().zip(&mut *out) {
                out[range.clone()].copy_from_slice(&pixels[..range.len()]);
            }
        }
        for (tile, &unknown) in unknown.iter().enumerate() {
            let mut rest = unknown;
            while rest != 0 {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let [column, row] = [range.start + tile * TILE + lane % TILE, lane / TILE];
                if column < range.end && row < out.len() {
                    let row_of_band = tile_row * TILE + row;
                    let place = block.picture.place(column, block.first + row_of_band);
                    values.put_one(block.picture.worley, place, &mut out[row][column]);
                }
            }
        }
    }
}

/// The points of a block in the order of their places.
#[derive(Clone, Copy, Debug)]
struct Runs<'a, const W: usize> {
    starts: &'a [u32],
    n_halves: usize,
    /// The half tiles above and below a tile that its points come from.
    halves: usize,
    points: &'a [Point<W>],
    /// The coordinates of the rows.
    rows: &'a [i32],
}

impl<'a, const W: usize> Runs<'a, W> {
    fn new(bins: &'a Bins, reach: Reach, rows: &'a [i32], points: &'a [Point<W>]) -> Self {
        Self {
            starts: &bins.starts,
            n_halves: bins.n_halves,
            halves: reach.halves,
            points,
            rows,
        }
    }
}

/// Fills a row of tiles, but for the pixels whose keys reach the limit, which are put down in `unknown`.
///
/// `DEEP`, if there are axes across the picture.
fn fill_by_depth<M: Norm, const W: usize, const TILES: usize, const DEEP: bool>(
    level: Level,
    norm: M,
    from: (Runs<'_, W>, usize),
    (values, limit): (&Values, f32),
    to: ([&mut [f32]; TILE], &mut [u16]),
) {
    let limit = (values, limit);
    match values.tone.depth() {
        1 => dispatch!(level, simd => fill::<_, _, 1, W, TILES, DEEP>(simd, norm, from, limit, to)),
        2 => dispatch!(level, simd => fill::<_, _, 2, W, TILES, DEEP>(simd, norm, from, limit, to)),
        _ => dispatch!(level, simd => fill::<_, _, 4, W, TILES, DEEP>(simd, norm, from, limit, to)),
    }
}

/// The tiles that the points of one column of tiles matter to are held in registers.
#[inline(always)]
fn fill<S: Simd, M: Norm, const K: usize, const W: usize, const TILES: usize, const DEEP: bool>(
    simd: S,
    norm: M,
    (runs, tile_row): (Runs<'_, W>, usize),
    (values, limit): (&Values, f32),
    (mut pixels, unknown): ([&mut [f32]; TILE], &mut [u16]),
) {
    let values = values.lanes::<S, K>(simd);
    let empty = [f32x16::splat(simd, f32::INFINITY); K];
    let mut best = [empty; TILES];
    let rows = i32x4::from_slice(simd, &runs.rows[tile_row * TILE..][..TILE]);
    let first = tile_row * TILE / HALF;
    let last = first + TILE / HALF + 2 * runs.halves;
    for column in 0..unknown.len() + TILES - 1 {
        let starts = &runs.starts[column * runs.n_halves..];
        for point in &runs.points[starts[first] as usize..starts[last] as usize] {
            let ahead = (rows - point.row).to_float::<f32x4<S>>() * STEP;
            let mut rows = norm.terms(ahead);
            if DEEP {
                rows = norm.joins(rows, f32x4::splat(simd, point.across));
            }
            // Each of the four numbers four times.
            let rows = f32x16::block_splat(rows);
            let rows = rows.zip_low(rows);
            let rows = rows.zip_low(rows);
            for tile in 0..TILES {
                let columns = f32x4::from_slice(simd, &point.terms[tile * TILE..][..TILE]);
                let mut key = norm.joins(f32x16::block_splat(columns), rows);
                for rank in 0..K {
                    let smaller = lesser(best[tile][rank], key);
                    key = greater(best[tile][rank], key);
                    best[tile][rank] = smaller;
                }
            }
        }
        if let Some(tile) = (column + 1).checked_sub(TILES) {
            unknown[tile] = put(norm, best[0], (&values, limit), (&mut pixels, tile));
        }
        for tile in 1..TILES {
            best[tile - 1] = best[tile];
        }
        best[TILES - 1] = empty;
    }
}

/// Puts the values of a tile; returns which of its keys reach the limit.
#[inline(always)]
fn put<S: Simd, M: Norm, const K: usize>(
    norm: M,
    keys: [f32x16<S>; K],
    (values, limit): (&ValueLanes<S, K>, f32),
    (pixels, tile): (&mut [&mut [f32]; TILE], usize),
) -> u16 {
    let left = tile * TILE;
    let is_known = keys[K - 1].simd_lt(limit);
    let unknown = !is_known.to_bitmask() as u16;
    let mut lanes = [0.0; LANES];
    if values.is_added || unknown != 0 {
        for row in 0..TILE {
            lanes[row * TILE..][..TILE].copy_from_slice(&pixels[row][left..left + TILE]);
        }
    }
    let before = f32x16::from_slice(keys[0].simd, &lanes);
    values.put(norm, keys, &mut lanes);
    let after = f32x16::from_slice(keys[0].simd, &lanes);
    is_known.select(after, before).store_slice(&mut lanes);
    for row in 0..TILE {
        pixels[row][left..left + TILE].copy_from_slice(&lanes[row * TILE..][..TILE]);
    }
    unknown
}
