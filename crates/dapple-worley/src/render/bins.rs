//! Feature points sorted by the pixels near to them.
//!
//! The pixels of a block are covered by tiles of 4 × 4. A point lies in a column as wide as a tile, and in a row of half
//! tiles. Points are sorted by these, column by column, so that those near to a tile are a run in each of the columns near
//! it: an odd number of columns, which are those of the tiles, or an even number, which begin in the middle of tiles. The
//! terms of a point are computed once, for the pixels of all the tiles that may need it.

use super::LANES;
use super::table::{CellBox, numbers, row_words};
use crate::Metric;
use crate::fixed::{MOST_AXES, STEP, STEP_BITS};
use crate::lattice::{Lattice, SixteenCells};
use crate::levels::wide;
use crate::metric::{Exact, General, Kernel, Measure};
use dapple_raster::simd::{baseline, dispatch};
use fearless_simd::{Level, f32x4, f32x16, i32x4, i32x16, mask32x16, prelude::*, u32x16};

/// The number of columns and of rows of a tile.
pub(super) const TILE: usize = 4;

/// The number of rows of half a tile.
pub(super) const HALF: usize = TILE / 2;

/// The number of pixels beside a tile in so many columns.
pub(super) const fn beyond(columns: usize) -> usize {
    HALF * (columns - 1)
}

/// The range of points that a tile is compared with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// The number of columns.
    pub(super) columns: usize,
    /// The number of rows of half tiles on either side.
    pub(super) halves: usize,
    /// The largest joint key along the axes across the picture.
    pub(super) key: f32,
}

/// The coordinates of the pixels of a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// The number of axes of the space.
    pub(super) n_axes: usize,
    pub(super) metric: Metric,
    pub(super) reach: Reach,
    /// The lower corner of the cell from which coordinates are counted.
    pub(super) origin: [i64; MOST_AXES],
    /// The coordinates of the first pixel.
    pub(super) first: [i32; MOST_AXES],
    /// The numbers of columns and rows.
    pub(super) size: [usize; 2],
    /// The steps from one column to the next, and from one row to the next.
    pub(super) pixel: [f32; 2],
    /// The axis along which rows differ.
    pub(super) row_axis: usize,
}

/// A point, with its terms for the columns of `TILES` tiles.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Point<const TILES: usize> {
    /// The terms for the columns of the tiles near it.
    pub(super) terms: [[f32; TILE]; TILES],
    /// The coordinate along the axis of the rows, in steps.
    pub(super) row: i32,
    /// The accumulated terms along the axes across the picture.
    pub(super) across: f32,
}

/// Memory for points, by the number of tiles that they have terms for.
#[derive(Debug, Default)]
pub(super) struct PointLists {
    /// Those that are compared with two or three columns of tiles.
    pub(super) three: Vec<Point<3>>,
    pub(super) five: Vec<Point<5>>,
}

/// The points of a block in the order of their places, and the limits within which a row of tiles reads them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs<'a, const TILES: usize> {
    pub(super) metric: Metric,
    /// Whether there are axes across the picture.
    pub(super) is_deep: bool,
    /// The key from which on keys may be wrong.
    pub(super) limit: f32,
    pub(super) starts: &'a [u32],
    pub(super) n_halves: usize,
    /// The number of half tiles above and below a tile from which its points are taken.
    pub(super) halves: usize,
    pub(super) points: &'a [Point<TILES>],
    /// The coordinates of the rows.
    pub(super) rows: &'a [i32],
}

/// The feature points near to the pixels of a block, first in the order of their cells, then sorted by place.
#[derive(Debug)]
pub(super) struct Bins {
    /// The number of points.
    len: usize,
    /// The coordinates of the points along the axes of the picture, in the order of the cells.
    steps: [Vec<i32>; 2],
    /// The accumulated terms of the points along the other axes, in the order of the cells; they stay zero in the plane,
    /// since all blocks of a memory belong to one basis.
    across: Vec<f32>,
    /// The places of the points, in the order of the cells: the column in the upper half of the word, the index of the
    /// place in the lower half, which is enough for the 2^12 half tiles of a block and those beside it.
    places: Vec<u32>,
    /// The number of rows of half tiles with points.
    n_halves: usize,
    /// The index of the first point of each place, and at the end the number of points.
    starts: Vec<u32>,
    /// The coordinates of the columns, including those of the tiles beside the block.
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

    /// Clears the bins for another block with these columns and number of rows.
    pub(super) fn clear(&mut self, columns: &[i32], height: usize, reach: Reach) {
        let width = columns.len();
        let n_columns = width.div_ceil(TILE) + reach.columns - 1;
        self.n_halves = 2 * height.div_ceil(TILE) + 2 * reach.halves;
        self.starts.clear();
        self.starts.resize(n_columns * self.n_halves + 2, 0);
        // The columns past the ends are not used; a point may have terms for one tile more than is compared with it.
        let more = 2 * beyond(reach.columns);
        self.columns.clear();
        self.columns.resize(more, 0);
        self.columns.extend_from_slice(columns);
        let end = width.next_multiple_of(TILE) + 2 * more + TILE;
        self.columns.resize(end, 0);
    }

    /// Generates the points of `cells` that any tile is compared with.
    pub(super) fn collect(
        &mut self,
        level: Level,
        lattice: &Lattice,
        cells: &CellBox,
        grid: &Grid,
    ) {
        dispatch!(level, simd => self.collect_by(simd, lattice, cells, grid));
    }

    /// Generates points in registers.
    #[inline(always)]
    fn collect_by<S: Simd>(&mut self, simd: S, lattice: &Lattice, cells: &CellBox, grid: &Grid) {
        self.len = 0;
        let side = cells.side(0);
        let padded = side.next_multiple_of(LANES) as i64;
        let columns = (0..padded).map(|column| lattice.parts(0, cells.first[0] + column).into());
        let columns: (Vec<u32>, Vec<u32>) = columns.unzip();
        for (row, mut cell) in cells.rows(lattice) {
            for first in (0..side).step_by(LANES) {
                let words = row_words(simd, row, &columns, first);
                let sixteen = SixteenCells::new(simd, lattice, words);
                cell[0] = cells.first[0] + first as i64;
                let mut numbers = numbers(lattice, &sixteen, cell);
                numbers[LANES.min(side - first)..].fill(0);
                let numbers = u32x16::from_slice(simd, &numbers);
                self.add(lattice, &sixteen, numbers, cell, grid);
            }
        }
    }

    /// Adds those of the points of sixteen cells that any tile is compared with.
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
            let steps = cells.flat_steps(u32x16::splat(simd, index), lattice);
            let mut points = [lanes; MOST_AXES];
            for axis in 0..MOST_AXES {
                let corner = ((cell[axis] - grid.origin[axis]) as i32) << STEP_BITS;
                let ahead = steps[axis].bitcast::<i32x16<S>>() + (corner - grid.first[axis]);
                points[axis] = if axis == 0 { ahead + lanes } else { ahead };
            }
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

    /// Appends the selected ones of sixteen points.
    #[inline(always)]
    fn push<S: Simd>(&mut self, matters: mask32x16<S>, steps: [i32x16<S>; 2], place: u32x16<S>) {
        let to = self.len..self.len + LANES;
        for (steps, stored) in steps.into_iter().zip(&mut self.steps) {
            steps.compress(matters).store_slice(&mut stored[to.clone()]);
        }
        place.compress(matters).store_slice(&mut self.places[to]);
        self.len += matters.to_bitmask().count_ones() as usize;
    }

    /// Counts the points of each place, which gives the index at which each place begins.
    pub(super) fn count(&mut self) {
        for &place in &self.places[..self.len] {
            self.starts[index(place) + 2] += 1;
        }
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
    }

    /// Sorts the points by place; `rows` are the coordinates of the rows, and `points` is memory to work in.
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

    /// Sorts the points by place, and computes their terms.
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

    /// Sorts the points by place, and computes their terms in registers.
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
        for (((&column, &row), &across), &place) in from.zip(&self.places[..self.len]) {
            let start = &mut self.starts[index(place) + 1];
            let point = &mut points[*start as usize];
            *start += 1;
            let columns = &self.columns[TILE * (place >> 16) as usize..][..TILE * TILES];
            let mut places = [f32x4::splat(simd, 0.0); TILES];
            for tile in 0..TILES {
                let ahead = i32x4::from_slice(simd, &columns[tile * TILE..][..TILE]) - column;
                places[tile] = ahead.to_float::<f32x4<S>>() * STEP;
            }
            let terms = measure.terms(places);
            for tile in 0..TILES {
                terms[tile].store_slice(&mut point.terms[tile]);
            }
            point.row = row;
            point.across = across;
        }
    }
}

/// The numbers of the lanes.
const ASCENDING: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// The groups of `pixels` pixels in which sixteen points lie, from their distances to the middle of the first pixel.
/// The first group begins `before` pixels before that pixel. The result for a point before it may be the first group or a
/// very large number.
#[inline(always)]
fn bin<S: Simd>(ahead: i32x16<S>, pixel: f32, pixels: usize, before: usize) -> u32x16<S> {
    let group = pixels as f32;
    let bins =
        ahead.to_float::<f32x16<S>>() * (pixel * group).recip() + (before as f32 + 0.5) / group;
    bins.to_int::<i32x16<S>>().bitcast()
}

/// The index of a place.
#[inline(always)]
fn index(place: u32) -> usize {
    (place & 0xFFFF) as usize
}
