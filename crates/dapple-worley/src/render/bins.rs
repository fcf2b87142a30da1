//! Sorts feature points into bins of pixels.
//!
//! The pixels of a block are covered by tiles of 4 × 4. A bin is as wide as a tile and half as high. Points are sorted
//! by bin, with bins ordered column by column. The points near a tile are therefore one contiguous run in each of the
//! bin columns around it. If the number of bin columns is odd, they are aligned with the tiles; if it is even, they
//! begin in the middle of tiles. The key terms of a point along the image's x axis are computed once, for the pixel
//! columns of all tiles that are compared with the point.

use super::LANES;
use super::table::{CellBox, numbers, row_words};
use crate::Metric;
use crate::fixed::{MOST_AXES, STEP, STEP_BITS};
use crate::lattice::{Lattice, SixteenCells};
use crate::levels::wide;
use crate::metric::{Exact, General, Kernel, Measure};
use dapple_raster::simd::{baseline, dispatch};
use fearless_simd::{Level, f32x4, f32x16, i32x4, i32x16, mask32x16, prelude::*, u32x16};

/// Width and height of a tile, in pixels.
pub(super) const TILE: usize = 4;

/// Height of a bin, half the height of a tile, in pixels.
pub(super) const HALF: usize = TILE / 2;

/// Returns the number of pixels to the left and to the right of a tile that `columns` columns of bins cover.
pub(super) const fn beyond(columns: usize) -> usize {
    HALF * (columns - 1)
}

/// The rectangle of bins that a tile is compared with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Number of bin columns.
    pub(super) columns: usize,
    /// Number of bin rows above the tile. The number below is the same.
    pub(super) halves: usize,
    /// Maximum accumulated key term, along the axes orthogonal to the image, of points that are included.
    pub(super) key: f32,
}

/// The coordinates of the pixels of a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Number of axes of the space.
    pub(super) n_axes: usize,
    pub(super) metric: Metric,
    pub(super) reach: Reach,
    /// Lower corner of the cell that is the origin of the coordinates.
    pub(super) origin: [i64; MOST_AXES],
    /// Coordinates of the first pixel, in steps from the origin.
    pub(super) first: [i32; MOST_AXES],
    /// Number of pixel columns and rows.
    pub(super) size: [usize; 2],
    /// Distance between adjacent columns and between adjacent rows, in steps.
    pub(super) pixel: [f32; 2],
    /// Axis of space along which rows differ.
    pub(super) row_axis: usize,
}

/// A feature point, with its key terms at the pixel columns of the `TILES` tiles around it.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Point<const TILES: usize> {
    /// Key terms along the first axis, for the pixel columns of the tiles around the point.
    pub(super) terms: [[f32; TILE]; TILES],
    /// Coordinate along the axis in which pixel rows differ, in steps.
    pub(super) row: i32,
    /// Accumulated key terms along the axes orthogonal to the image.
    pub(super) across: f32,
}

/// Scratch memory for points sorted by bin, one list for each number of tiles that a point has terms for.
#[derive(Debug, Default)]
pub(super) struct PointLists {
    /// Points for two or three bin columns.
    pub(super) three: Vec<Point<3>>,
    pub(super) five: Vec<Point<5>>,
}

/// The points of a block sorted by bin, and the parameters for finding the points near a row of tiles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs<'a, const TILES: usize> {
    pub(super) metric: Metric,
    /// Whether there are axes orthogonal to the image.
    pub(super) is_deep: bool,
    /// Limit of reliable keys (see [`metric`](crate::metric)). A pixel whose key is at or above it may miss a nearer
    /// point.
    pub(super) limit: f32,
    /// Index of the first point of each bin.
    pub(super) starts: &'a [u32],
    /// Number of bin rows.
    pub(super) n_halves: usize,
    /// Number of bin rows above the tile. The number below is the same.
    pub(super) halves: usize,
    pub(super) points: &'a [Point<TILES>],
    /// Coordinates of the pixel rows, in steps.
    pub(super) rows: &'a [i32],
}

/// The feature points near the pixels of a block, first in the order of their cells, then sorted by bin.
#[derive(Debug)]
pub(super) struct Bins {
    /// Number of points.
    len: usize,
    /// Coordinates of the points along the image's two axes, in steps, ordered by cell.
    steps: [Vec<i32>; 2],
    /// Accumulated key terms of the points along the axes orthogonal to the image, ordered by cell. They stay zero in
    /// 2-D, since one `Bins` serves a single basis.
    across: Vec<f32>,
    /// Bins of the points, ordered by cell. The upper half of each word is the bin's column, the lower half its index.
    /// 16 bits are enough for the 2^12 bins of a block and the bins around it.
    places: Vec<u32>,
    /// Number of bin rows.
    n_halves: usize,
    /// Index of the first point of each bin; the last element is the number of points.
    starts: Vec<u32>,
    /// Coordinates of the pixel columns in steps. Includes the columns of the tiles to the left and right of the block.
    columns: Vec<i32>,
}

impl Bins {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            steps: [Vec::new(), Vec::new()],
            across: Vec::new(),
            places: Vec::new(),
            n_halves: 0,
            starts: Vec::new(),
            columns: Vec::new(),
        }
    }

    /// Clears the bins for a block with the given column coordinates and number of rows.
    pub(super) fn clear(&mut self, columns: &[i32], height: usize, reach: Reach) {
        let width = columns.len();
        // Count the bins that the block's tiles are compared with.
        let n_columns = width.div_ceil(TILE) + reach.columns - 1;
        self.n_halves = 2 * height.div_ceil(TILE) + 2 * reach.halves;
        self.starts.clear();
        self.starts.resize(n_columns * self.n_halves + 2, 0);
        // The padding is not read for pixels, but a point may have terms for one tile more than is compared with it.
        let more = 2 * beyond(reach.columns);
        self.columns.clear();
        self.columns.resize(more, 0);
        self.columns.extend_from_slice(columns);
        let end = width.next_multiple_of(TILE) + 2 * more + TILE;
        self.columns.resize(end, 0);
    }

    /// Generates the points in `cells` that are within reach of a tile.
    pub(super) fn collect(
        &mut self,
        level: Level,
        lattice: &Lattice,
        cells: &CellBox,
        grid: &Grid,
    ) {
        dispatch!(level, simd => self.collect_by(simd, lattice, cells, grid));
    }

    /// SIMD implementation of [`collect`](Self::collect).
    #[inline(always)]
    fn collect_by<S: Simd>(&mut self, simd: S, lattice: &Lattice, cells: &CellBox, grid: &Grid) {
        self.len = 0;
        let side = cells.side(0);
        // All rows of cells share the parts of the cell words along the first axis.
        let padded = side.next_multiple_of(LANES) as i64;
        let columns = (0..padded).map(|column| lattice.parts(0, cells.first[0] + column).into());
        let columns: (Vec<u32>, Vec<u32>) = columns.unzip();
        for (row, mut cell) in cells.rows(lattice) {
            for first in (0..side).step_by(LANES) {
                let words = row_words(simd, row, &columns, first);
                let sixteen = SixteenCells::new(simd, lattice, words);
                cell[0] = cells.first[0] + first as i64;
                let mut numbers = numbers(lattice, &sixteen, cell);
                // Cells beyond the end of the row have no points.
                numbers[LANES.min(side - first)..].fill(0);
                let numbers = u32x16::from_slice(simd, &numbers);
                self.add(lattice, &sixteen, numbers, cell, grid);
            }
        }
    }

    /// Appends the points in sixteen cells that are within reach of a tile.
    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        lattice: &Lattice,
        cells: &SixteenCells<S>,
        numbers: u32x16<S>,
        cell: [i64; MOST_AXES],
        grid: &Grid,
    ) {
        let simd = numbers.simd;
        let Grid {
            metric,
            reach,
            row_axis,
            ..
        } = *grid;
        // Reserve memory for the largest possible number of points.
        let most = numbers.reduce_max();
        let room = self.len + (most as usize + 1) * LANES;
        if self.places.len() < room {
            let room = room.next_power_of_two();
            self.places.resize(room, 0);
            for steps in &mut self.steps {
                steps.resize(room, 0);
            }
            self.across.resize(room, 0.0);
        }
        let lanes = i32x16::from_slice(simd, &ASCENDING) << STEP_BITS;
        let n_columns = (grid.size[0].div_ceil(TILE) + reach.columns - 1) as u32;
        for index in 0..most {
            // Generate one point of each cell, and its coordinates from the first pixel.
            let steps = cells.flat_steps(u32x16::splat(simd, index), lattice);
            let mut points = [lanes; MOST_AXES];
            for axis in 0..MOST_AXES {
                let corner = ((cell[axis] - grid.origin[axis]) as i32) << STEP_BITS;
                let ahead = steps[axis].bitcast::<i32x16<S>>() + (corner - grid.first[axis]);
                points[axis] = if axis == 0 { ahead + lanes } else { ahead };
            }
            // Select the coordinate along the rows, and accumulate the terms of the axes that are orthogonal to the
            // image.
            let [x, mut rows, ..] = points;
            let is_deep = lattice.n_axes > 2;
            let mut across = f32x16::splat(simd, 0.0);
            for axis in (1..MOST_AXES).rev().filter(|_| is_deep) {
                if axis == row_axis {
                    rows = points[axis];
                } else if axis < lattice.n_axes {
                    let ahead = points[axis].to_float::<f32x16<S>>() * STEP;
                    let [terms] = General(metric).terms([ahead]);
                    across = General(metric).accumulate(terms, across);
                }
            }
            // Find the bins, and select the points that exist and are inside the rectangle of bins.
            let column = bin(x, grid.pixel[0], TILE, beyond(reach.columns));
            let half = bin(rows, grid.pixel[1], HALF, HALF * reach.halves);
            let mut matters = numbers.simd_gt(index)
                & column.simd_lt(n_columns)
                & half.simd_lt(self.n_halves as u32);
            let to = self.len..self.len + LANES;
            if is_deep {
                matters &= across.simd_le(reach.key);
                let across = across.compress(matters);
                across.store_slice(&mut self.across[to]);
            }
            let steps = [x + grid.first[0], rows + grid.first[row_axis]];
            self.push(
                matters,
                steps,
                column << 16 | (column * self.n_halves as u32 + half),
            );
        }
    }

    /// Appends the points whose lanes are set in `matters`: their coordinates and bins.
    #[inline(always)]
    fn push<S: Simd>(&mut self, matters: mask32x16<S>, steps: [i32x16<S>; 2], place: u32x16<S>) {
        let to = self.len..self.len + LANES;
        for (steps, stored) in steps.into_iter().zip(&mut self.steps) {
            steps.compress(matters).store_slice(&mut stored[to.clone()]);
        }
        place.compress(matters).store_slice(&mut self.places[to]);
        self.len += matters.to_bitmask().count_ones() as usize;
    }

    /// Counts the points of each bin, and accumulates the counts to the index of each bin's first point.
    pub(super) fn count(&mut self) {
        for &place in &self.places[..self.len] {
            // Count two elements ahead, so that element i + 1 becomes the index of the first point of bin i.
            self.starts[index(place) + 2] += 1;
        }
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
    }

    /// Sorts the points by bin into `points`. `rows` are the coordinates of the pixel rows, in steps.
    pub(super) fn runs<'a, const TILES: usize>(
        &'a mut self,
        level: Level,
        grid: &Grid,
        rows: &'a [i32],
        points: &'a mut Vec<Point<TILES>>,
    ) -> Runs<'a, TILES> {
        let (metric, reach) = (grid.metric, grid.reach);
        self.sort(level, metric, points);
        Runs {
            metric,
            is_deep: grid.n_axes > 2,
            limit: metric.tightened(reach.key),
            starts: &self.starts,
            n_halves: self.n_halves,
            halves: reach.halves,
            points,
            rows,
        }
    }

    /// Sorts the points by bin, and computes their key terms at the pixel columns.
    fn sort<const TILES: usize>(
        &mut self,
        level: Level,
        metric: Metric,
        points: &mut Vec<Point<TILES>>,
    ) {
        let done = match metric.kernel() {
            Kernel::General => None,
            _ => wide!(level, simd => self.sort_by(simd, Exact(metric), points)),
        };
        if done.is_none() {
            baseline!(simd => self.sort_by(simd, General(metric), points));
        }
    }

    /// SIMD implementation of [`sort`](Self::sort).
    #[inline(always)]
    fn sort_by<S: Simd, M: Measure, const TILES: usize>(
        &mut self,
        simd: S,
        measure: M,
        points: &mut Vec<Point<TILES>>,
    ) {
        if points.len() < self.len {
            let none = Point {
                terms: [[0.0; TILE]; TILES],
                row: 0,
                across: 0.0,
            };
            points.resize(self.len, none);
        }
        let [columns, rows] = &self.steps;
        let from = columns[..self.len]
            .iter()
            .zip(&rows[..self.len])
            .zip(&self.across[..self.len]);
        // Counting sort: the next free slot of the bin.
        for (((&column, &row), &across), &place) in from.zip(&self.places[..self.len]) {
            // Advancing the slot turns element i + 1 into the end of bin i, which is the start of bin i + 1.
            let start = &mut self.starts[index(place) + 1];
            let point = &mut points[*start as usize];
            *start += 1;
            // Compute the terms at the columns of the tiles near the bin.
            let columns = &self.columns[TILE * (place >> 16) as usize..][..TILE * TILES];
            let mut places = [f32x4::splat(simd, 0.0); TILES];
            for tile in 0..TILES {
                let ahead = i32x4::from_slice(simd, &columns[tile * TILE..][..TILE]) - column;
                places[tile] = ahead.to_float::<f32x4<S>>() * STEP;
            }
            // The column terms are the same in all rows, so they are computed once for each point.
            let terms = measure.terms(places);
            for tile in 0..TILES {
                terms[tile].store_slice(&mut point.terms[tile]);
            }
            point.row = row;
            point.across = across;
        }
    }
}

/// Index of each lane.
const ASCENDING: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Returns the index of the bin that contains each of sixteen points, for bins of `pixels` pixels. `ahead` are the
/// points' offsets from the center of the first pixel, in steps. Bin 0 begins `before` pixels before that pixel. The
/// index of a point before bin 0 is either 0 or a very large number.
#[inline(always)]
fn bin<S: Simd>(ahead: i32x16<S>, pixel: f32, pixels: usize, before: usize) -> u32x16<S> {
    let group = pixels as f32;
    let bins =
        ahead.to_float::<f32x16<S>>() * (pixel * group).recip() + (before as f32 + 0.5) / group;
    bins.to_int::<i32x16<S>>().bitcast()
}

/// Returns the index of a bin from the packed word in [`Bins::places`].
#[inline(always)]
fn index(place: u32) -> usize {
    (place & 0xFFFF) as usize
}
