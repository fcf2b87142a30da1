//! Renders small cells by comparing every tile with all feature points of a rectangle around it.
//!
//! If a cell has only a few pixels, culling points for each tile takes longer than comparing them. Tiles therefore
//! have 4 × 4 pixels, one register, and each is compared with all points in the bins around it
//! ([`bins`](super::bins)). The bins include all points that are nearer to a pixel than the edge of their rectangle.
//! The keys of a pixel are therefore exact if the `K`-th key is smaller than the key of the distance to that edge.

use super::bins::{Grid, HALF, Reach, Runs, TILE, beyond};
use super::block::{Block, Memory};
use super::kernel::{empty, greater, lesser};
use super::table::CellBox;
use super::{BLOCK_COLUMNS, LANES, Picture};
use crate::MAX_NEAREST;
use crate::fixed::{MOST_AXES, STEP, STEP_BITS};
use crate::levels::{is_wide, wide};
use crate::metric::{Additive, Exact, General, Kernel, Longest, Measure};
use crate::sink::{ValueLanes, Values};
use dapple_raster::simd::baseline;
use fearless_simd::{Level, f32x4, f32x16, i32x4, prelude::*};

/// Maximum offset of a pixel from its evenly spaced position, in pixels. It is well below the margin that [`SURE`]
/// leaves.
const UNEVEN: f32 = 0.001;

/// Reliable fraction of the distance from a tile to the edge of the rectangle around it. It is below 1 because the
/// positions of points relative to the pixels are rounded.
const SURE: f32 = 0.999;

/// Maximum reach of the rectangle around a tile, in cells. Coordinates that differ by less are exact in `f32`.
const FARTHEST: f32 = 8.0;

/// Maximum ratio of the reach to the required distance. Above it, searching each pixel individually is as fast.
const MOST_WASTE: f32 = 10.0;

/// Numbers of bin columns that a tile may be compared with. The first is used only in 2-D, for metrics whose key is a
/// sum, which is the most common case.
const COLUMNS: [usize; 3] = [2, 3, 5];

/// Upper limit, exclusive, for the number of bin rows above a tile, and for the number below it.
const MOST_HALVES: usize = 8;

/// Maximum distance of points along the axes orthogonal to the image, as a multiple of the estimated distance to the
/// nearest points. A larger value would compare too many points, a smaller one would leave more pixels to individual
/// searches, which take as long as comparing hundreds of points.
const SPARE: f32 = 1.1;

/// Parameters of the method for small cells, for one block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Splat {
    /// Number of bin columns that a tile is compared with, and number of bin rows above (and below) it.
    around: [usize; 2],
    /// Distance from any pixel within which all points are compared, in cells.
    pub(super) reach: f32,
    /// Distance between adjacent columns, and between adjacent rows along `row_axis`, in steps.
    pixel: [f32; 2],
    /// Axis along which rows differ.
    row_axis: usize,
}

impl Splat {
    /// Chooses the parameters for a block whose pixels need their `depth` nearest points, up to `distance` cells away.
    /// Returns `None` if the method does not apply.
    pub(super) fn new(block: &Block<'_>, depth: usize, distance: f32) -> Option<Self> {
        let Picture { section, basis, .. } = &block.bands[0].picture;
        let row_axis = section.row_axis()?;
        // The terms of the axes orthogonal to the image are accumulated before those of the rows.
        if section.n_axes == 4 && row_axis != 1 {
            return None;
        }
        let window = block.bands[0].picture.window;
        let frequency = block.bands[0].picture.frequency;
        // Compute the distance between pixels, in cells.
        let [x, y] = [0, 1].map(|axis| window.pixel[axis] * window.scale[axis]);
        let pixel = [
            (section.u[0] * x * frequency) as f32,
            (section.v[row_axis] * y * frequency) as f32,
        ];
        // A tile begins half a pixel before the center of its first pixel.
        let reach = |pixel: f32, pixels: usize| (pixels as f32 + 0.5) * pixel.abs() * SURE;
        let useful = distance..FARTHEST.min(MOST_WASTE * distance);
        let is_flat_sum = section.n_axes == 2 && basis.metric().is_exact_sum();
        let is_usual = is_flat_sum && depth <= 2 && is_wide(block.level);
        // Choose the fewest bin columns and rows that reach far enough.
        for &columns in &COLUMNS[usize::from(!is_usual)..] {
            let along_row = reach(pixel[0], beyond(columns));
            let halves = (1..MOST_HALVES).find(|halves| reach(pixel[1], HALF * halves) >= distance);
            let Some(halves) = halves.filter(|_| useful.contains(&along_row)) else {
                continue;
            };
            // Within this distance, neither the rectangle nor the limit along the other axes excludes a point.
            let along = along_row.min(reach(pixel[1], HALF * halves));
            let across = if section.n_axes > 2 {
                distance * SPARE
            } else {
                f32::INFINITY
            };
            return Some(Self {
                around: [columns, halves],
                reach: along.min(across),
                pixel: pixel.map(|cells| cells / STEP),
                row_axis,
            });
        }
        None
    }

    /// Returns whether pixels are spaced evenly enough for bins. Far from the origin, rounding of `f64` may make them
    /// uneven.
    pub(super) fn is_even(&self, lines: &[Vec<i32>; MOST_AXES]) -> bool {
        let is_even = |axis: usize, pixel: f32| {
            let line = &lines[axis][..lines[axis].len() - LANES];
            line.iter().enumerate().all(|(index, &steps)| {
                let expected = line[0] as f32 + index as f32 * pixel;
                (steps as f32 - expected).abs() <= UNEVEN * pixel.abs()
            })
        };
        is_even(0, self.pixel[0]) && is_even(self.row_axis, self.pixel[1])
    }

    /// Renders the pixels of a block, whose coordinates are relative to the lower corner of `cells`.
    pub(super) fn render(
        &self,
        block: &Block<'_>,
        cells: &CellBox,
        values: &Values,
        out: &mut [&mut [f32]],
        memory: &mut Memory,
    ) {
        let near = self.cells(block, cells, memory);
        let Memory {
            bins,
            points,
            lines,
            ..
        } = memory;
        let basis = block.bands[0].picture.basis;
        let metric = basis.metric();
        let [columns, halves] = self.around;
        let reach = Reach {
            columns,
            halves,
            key: metric.term(self.reach),
        };
        let grid = Grid {
            n_axes: cells.n_axes,
            metric,
            reach,
            origin: cells.first,
            first: lines
                .each_ref()
                .map(|line| line.first().copied().unwrap_or(0)),
            size: [block.range.len(), block.bands[0].n_rows],
            pixel: self.pixel,
            row_axis: self.row_axis,
        };
        // Generate the points, and sort them by bin.
        bins.clear(&lines[0][..block.range.len()], block.bands[0].n_rows, reach);
        bins.collect(block.level, basis.lattice(), &near, &grid);
        bins.count();
        // Render the tiles with the loop for the number of bin columns.
        let rows = &lines[self.row_axis];
        if columns < 5 {
            let runs = bins.runs(block.level, &grid, rows, &mut points.three);
            let fill = if columns == 2 { fill_two } else { fill_three };
            fill_block(block, runs, fill, values, out);
        } else {
            let runs = bins.runs(block.level, &grid, rows, &mut points.five);
            fill_block(block, runs, fill_any, values, out);
        }
    }

    /// Returns the box of cells whose points are within reach of the block.
    fn cells(&self, block: &Block<'_>, cells: &CellBox, memory: &Memory) -> CellBox {
        let pixels = memory.pixel_box(&block.all());
        // The conversion truncates, so add a step.
        let reach = (self.reach / STEP) as i32 + 1;
        let mut near = *cells;
        for axis in 0..cells.n_axes {
            let cell = |steps: i32| cells.first[axis] + i64::from(steps >> STEP_BITS);
            near.first[axis] = cell(pixels.low[axis] - reach);
            near.last[axis] = cell(pixels.high[axis] + reach);
        }
        near
    }
}

/// Renders the pixels of a block from its points, one row of tiles at a time.
fn fill_block<const SLOTS: usize>(
    block: &Block<'_>,
    runs: Runs<'_, SLOTS>,
    fill: fn(Level, Runs<'_, SLOTS>, &mut TileRow<'_>),
    values: &Values,
    out: &mut [&mut [f32]],
) {
    let range = block.range.clone();
    let n_tiles = range.len().div_ceil(TILE);
    let mut whole_tiles = [[0.0; BLOCK_COLUMNS]; TILE];
    let mut unknown = [0; BLOCK_COLUMNS / TILE];
    for (tile_row, out) in out.chunks_mut(TILE).enumerate() {
        // Render incomplete tiles into a copy of whole tiles.
        let is_whole = out.len() == TILE && range.len().is_multiple_of(TILE);
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
        let mut tiles = TileRow {
            index: tile_row,
            values,
            pixels,
            unknown: &mut unknown[..n_tiles],
        };
        fill(block.level, runs, &mut tiles);
        if !is_whole {
            for (pixels, out) in whole_tiles.iter().zip(&mut *out) {
                out[range.clone()].copy_from_slice(&pixels[..range.len()]);
            }
        }
        // Search the pixels whose keys reach the limit on their own.
        for (tile, &unknown) in unknown[..n_tiles].iter().enumerate() {
            let mut rest = unknown;
            while rest != 0 {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let [column, row] = [range.start + tile * TILE + lane % TILE, lane / TILE];
                if column < range.end && row < out.len() {
                    let row_of_band = tile_row * TILE + row;
                    let place = block.bands[0]
                        .picture
                        .place(column, block.bands[0].first + row_of_band);
                    values.put_one(block.bands[0].picture.basis, place, &mut out[row][column]);
                }
            }
        }
    }
}

/// A row of tiles.
struct TileRow<'a> {
    /// Index of the row of tiles in its band.
    index: usize,
    values: &'a Values,
    /// Rows of pixels in this row of tiles.
    pixels: [&'a mut [f32]; TILE],
    /// For each tile, a mask of the pixels with a key at or above the limit. Their values are not stored.
    unknown: &'a mut [u16],
}

/// Renders a row of tiles from two bin columns. Supports 2-D, metrics whose key is a sum, one or two nearest points,
/// and wide registers.
fn fill_two(level: Level, runs: Runs<'_, 3>, tiles: &mut TileRow<'_>) {
    let sum = Additive(runs.metric);
    let _done = match tiles.values.tone.depth() {
        1 => wide!(level, simd => fill::<_, _, 1, 2, 3, false>(simd, sum, 1, runs, tiles)),
        _ => wide!(level, simd => fill::<_, _, 2, 2, 3, false>(simd, sum, 2, runs, tiles)),
    };
}

/// Renders a row of tiles from three bin columns.
fn fill_three(level: Level, runs: Runs<'_, 3>, tiles: &mut TileRow<'_>) {
    let sum = Additive(runs.metric);
    let done = match tiles.values.tone.depth() {
        _ if runs.is_deep || !runs.metric.is_exact_sum() => None,
        1 => wide!(level, simd => fill::<_, _, 1, 3, 3, false>(simd, sum, 1, runs, tiles)),
        2 => wide!(level, simd => fill::<_, _, 2, 3, 3, false>(simd, sum, 2, runs, tiles)),
        _ => None,
    };
    if done.is_none() {
        fill_any(level, runs, tiles);
    }
}

/// Renders a row of tiles from `TILES` bin columns, with the loop that is compiled for the metric and the number of
/// nearest points.
fn fill_any<const TILES: usize>(level: Level, runs: Runs<'_, TILES>, tiles: &mut TileRow<'_>) {
    let depth = match tiles.values.tone.depth() {
        depth @ ..=2 => depth,
        _ => MAX_NEAREST,
    };
    let (sum, exact, any) = (
        Additive(runs.metric),
        Exact(runs.metric),
        General(runs.metric),
    );
    let done = match (runs.metric.kernel(), depth) {
        (Kernel::Squares | Kernel::Sum, 1) => {
            wide!(level, simd => fill::<_, _, 1, TILES, TILES, true>(simd, sum, 1, runs, tiles))
        }
        (Kernel::Squares | Kernel::Sum, 2) => {
            wide!(level, simd => fill::<_, _, 2, TILES, TILES, true>(simd, sum, 2, runs, tiles))
        }
        (Kernel::Longest, ..=2) => {
            wide!(level, simd => fill::<_, _, 2, TILES, TILES, true>(simd, Longest, depth, runs, tiles))
        }
        (Kernel::General, _) => None,
        _ => {
            wide!(level, simd => fill::<_, _, MAX_NEAREST, TILES, TILES, true>(simd, exact, depth, runs, tiles))
        }
    };
    if done.is_none() {
        baseline!(simd => fill::<_, _, MAX_NEAREST, TILES, TILES, true>(simd, any, depth, runs, tiles));
    }
}

/// Renders a row of tiles. Each bin column is compared with the `TILES` tiles around it, whose keys are held in
/// registers.
///
/// `depth` is the number of nearest points to find, at most `K`. Points have key terms for `SLOTS` tiles. `DEEP` means
/// that there may be axes orthogonal to the image.
#[inline(always)]
fn fill<
    S: Simd,
    M: Measure,
    const K: usize,
    const TILES: usize,
    const SLOTS: usize,
    const DEEP: bool,
>(
    simd: S,
    measure: M,
    depth: usize,
    runs: Runs<'_, SLOTS>,
    tiles: &mut TileRow<'_>,
) {
    let values = tiles.values.lanes::<S, K>(simd, depth);
    let empty = empty::<S, K>(simd, depth, f32::INFINITY);
    let mut best = [empty; TILES];
    let rows = i32x4::from_slice(simd, &runs.rows[tiles.index * TILE..][..TILE]);
    // Find the bin rows that this row of tiles is compared with.
    let first = tiles.index * TILE / HALF;
    let last = first + TILE / HALF + 2 * runs.halves;
    for column in 0..tiles.unknown.len() + TILES - 1 {
        let starts = &runs.starts[column * runs.n_halves..];
        // Compare the points of this bin column with the tiles around it.
        for point in &runs.points[starts[first] as usize..starts[last] as usize] {
            // Compute the point's terms at the four rows of the tiles.
            let ahead = (rows - point.row).to_float::<f32x4<S>>() * STEP;
            let [mut rows] = measure.terms([ahead]);
            if DEEP {
                rows = measure.accumulate(rows, f32x4::splat(simd, point.across));
            }
            // Repeat each of the four row terms four times.
            let rows = f32x16::block_splat(rows);
            let rows = rows.zip_low(rows);
            let rows = rows.zip_low(rows);
            // Compare the point with the tiles around its bin column, and insert the keys into the sorted ones.
            for tile in 0..TILES {
                let columns = f32x4::from_slice(simd, &point.terms[tile]);
                let mut key = measure.accumulate(f32x16::block_splat(columns), rows);
                for rank in 0..K {
                    let smaller = lesser(best[tile][rank], key);
                    key = greater(best[tile][rank], key);
                    best[tile][rank] = smaller;
                }
            }
        }
        // The first tile has been compared with all of its bin columns. Store it, and shift the others.
        if let Some(tile) = (column + 1).checked_sub(TILES) {
            tiles.put(measure, &values, best[0], runs.limit, tile);
        }
        for tile in 1..TILES {
            best[tile - 1] = best[tile];
        }
        best[TILES - 1] = empty;
    }
}

impl TileRow<'_> {
    /// Stores the values of a tile, except for pixels with a key at or above the limit.
    #[inline(always)]
    fn put<S: Simd, M: Measure, const K: usize>(
        &mut self,
        measure: M,
        values: &ValueLanes<S, K>,
        keys: [f32x16<S>; K],
        limit: f32,
        tile: usize,
    ) {
        let left = tile * TILE;
        let is_known = keys[K - 1].simd_lt(limit);
        let unknown = !is_known.to_bitmask() as u16;
        let mut lanes = [0.0; LANES];
        // Read the pixels if values are added to them, or if unknown pixels must not change.
        if values.is_added || unknown != 0 {
            for row in 0..TILE {
                lanes[row * TILE..][..TILE].copy_from_slice(&self.pixels[row][left..left + TILE]);
            }
        }
        let before = f32x16::from_slice(keys[0].simd, &lanes);
        values.put(measure, keys, &mut lanes);
        let after = f32x16::from_slice(keys[0].simd, &lanes);
        // Store the values of the known pixels only.
        is_known.select(after, before).store_slice(&mut lanes);
        for row in 0..TILE {
            self.pixels[row][left..left + TILE].copy_from_slice(&lanes[row * TILE..][..TILE]);
        }
        self.unknown[tile] = unknown;
    }
}
