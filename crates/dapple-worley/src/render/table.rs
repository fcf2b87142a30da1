//! Tables of the feature points in a box of cells, generated once and then looked up.

use super::LANES;
use crate::fixed::{MOST_AXES, STEP_BITS};
use crate::lattice::{IDS, Lattice, SixteenCells, both};
use core::ops::Range;
use dapple_hash::CellHashes;
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, prelude::*, u32x16};

/// A box of cells, from the first to the last along each axis. Along missing axes, both are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CellBox {
    pub(super) n_axes: usize,
    pub(super) first: [i64; MOST_AXES],
    pub(super) last: [i64; MOST_AXES],
}

impl CellBox {
    /// Returns the number of cells along an axis.
    pub(super) fn side(&self, axis: usize) -> usize {
        (self.last[axis] - self.first[axis] + 1) as usize
    }

    /// Returns the box extended by `by` cells on every side.
    pub(super) fn widened(mut self, by: i64) -> Self {
        for axis in 0..self.n_axes {
            self.first[axis] -= by;
            self.last[axis] += by;
        }
        self
    }

    /// Iterates over the rows of cells along the first axis. Each item has the combined hashed coordinates of the row
    /// along the other axes, and the row's first cell.
    pub(super) fn rows(
        &self,
        lattice: &Lattice,
    ) -> impl Iterator<Item = ([u32; 2], [i64; MOST_AXES])> {
        let n_rows: usize = (1..self.n_axes).map(|axis| self.side(axis)).product();
        (0..n_rows).map(move |mut index| {
            let mut parts = [0; 2];
            let mut cell = self.first;
            let mut rest = n_rows;
            // Convert the index to the row's first cell, and combine the parts of the cell words.
            for axis in (1..self.n_axes).rev() {
                rest /= self.side(axis);
                cell[axis] += (index / rest) as i64;
                index %= rest;
                parts = both(parts, lattice.parts(axis, cell[axis]));
            }
            (parts, cell)
        })
    }

    /// Returns the number of cells. Saturates at the largest `u128`.
    pub(super) fn n_cells(&self) -> u128 {
        let sides = self.first.iter().zip(self.last);
        sides
            .map(|(&first, last)| (i128::from(last) - i128::from(first) + 1) as u128)
            .fold(1, u128::saturating_mul)
    }
}

/// Number of points per cell that are copied unconditionally, without a branch on the cell's count.
const USUAL: usize = 4;

/// The feature points in a box of cells, stored row by row.
#[derive(Debug)]
pub(super) struct Table {
    pub(super) cells: CellBox,
    /// Index of the first point of each cell; the last element is the number of points.
    starts: Vec<u32>,
    /// Scratch memory for the points of sixteen cells.
    scratch: Vec<u32>,
    /// Coordinates along each axis, in steps from the lower corner of the box; padded by a register.
    pub(super) steps: [Vec<i32>; MOST_AXES],
    /// Whether point ids are needed.
    pub(super) wants_ids: bool,
    /// Point ids, if needed; otherwise empty.
    pub(super) ids: Vec<u64>,
}

impl Table {
    /// Creates an empty table.
    pub(super) fn new() -> Self {
        Self {
            cells: CellBox {
                n_axes: 0,
                first: [0; MOST_AXES],
                last: [0; MOST_AXES],
            },
            starts: Vec::new(),
            scratch: Vec::new(),
            steps: core::array::from_fn(|_| Vec::new()),
            wants_ids: false,
            ids: Vec::new(),
        }
    }

    /// Returns whether the table holds exactly these cells, with or without ids as requested.
    pub(super) fn has(&self, cells: &CellBox, with_ids: bool) -> bool {
        !self.starts.is_empty() && self.cells == *cells && self.wants_ids == with_ids
    }

    /// Generates the points of `cells`, at most 1000 cells along each axis.
    pub(super) fn fill(&mut self, level: Level, lattice: &Lattice, cells: CellBox) {
        dispatch!(level, simd => self.fill_by(simd, lattice, cells));
    }

    /// SIMD implementation of [`fill`](Self::fill).
    #[inline(always)]
    fn fill_by<S: Simd>(&mut self, simd: S, lattice: &Lattice, cells: CellBox) {
        self.cells = cells;
        self.starts.clear();
        self.starts.push(0);
        self.ids.clear();
        let side = cells.side(0);
        // All rows of cells share the parts of the cell words along the first axis.
        let columns = 0..side.next_multiple_of(LANES) as i64;
        let columns = columns.map(|column| lattice.parts(0, cells.first[0] + column).into());
        let columns: (Vec<u32>, Vec<u32>) = columns.unzip();
        for (row, cell) in cells.rows(lattice) {
            let mut corner: [i32; MOST_AXES] =
                core::array::from_fn(|axis| ((cell[axis] - cells.first[axis]) as i32) << STEP_BITS);
            for first in (0..side).step_by(LANES) {
                corner[0] = (first as i32) << STEP_BITS;
                let n_cells = (side - first).min(LANES);
                let words = row_words(simd, row, &columns, first);
                self.add(simd, lattice, words, corner, n_cells);
            }
        }
    }

    /// Appends the points of up to sixteen adjacent cells.
    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        lattice: &Lattice,
        words: [u32x16<S>; 2],
        corner: [i32; MOST_AXES],
        n_cells: usize,
    ) {
        let n_axes = lattice.n_axes;
        let cells = SixteenCells::new(simd, lattice, words);
        let cell = core::array::from_fn(|axis| {
            self.cells.first[axis] + i64::from(corner[axis] >> STEP_BITS)
        });
        let numbers = numbers(lattice, &cells, cell);
        let most = numbers[..n_cells].iter().copied().fold(0, u32::max);
        let mut scratch = core::mem::take(&mut self.scratch);
        scratch.resize(most.max(USUAL as u32) as usize * n_axes * LANES, 0);
        // Generate the points of all sixteen cells, one point per cell at a time.
        for index in 0..most {
            let steps = cells.flat_steps(u32x16::splat(simd, index), lattice);
            for axis in 0..MOST_AXES {
                if axis < n_axes {
                    let at = (index as usize * n_axes + axis) * LANES;
                    steps[axis].store_slice(&mut scratch[at..at + LANES]);
                }
            }
        }
        // Compact the points, cell by cell, and shift them to the corners of their cells.
        let start = *self.starts.last().unwrap_or(&0) as usize;
        for axis in 0..n_axes {
            let room = start + most as usize * LANES + LANES;
            if self.steps[axis].len() < room {
                self.steps[axis].resize(room.next_power_of_two(), 0);
            }
            let steps = &mut self.steps[axis][start..];
            let along = if axis == 0 { 1 << STEP_BITS } else { 0 };
            let (mut end, mut shift) = (0, corner[axis]);
            for (lane, &number) in numbers[..n_cells].iter().enumerate() {
                let number = number as usize;
                let from = |index: usize| {
                    scratch[(index * n_axes + axis) * LANES + lane].cast_signed() + shift
                };
                // Most cells have at most `USUAL` points; the next cell overwrites the surplus.
                let to = &mut steps[end..end + number.max(USUAL)];
                for index in 0..USUAL {
                    to[index] = from(index);
                }
                for index in USUAL..number {
                    to[index] = from(index);
                }
                end += number;
                shift += along;
            }
        }
        // Record where each cell's points begin.
        let mut end = start as u32;
        for number in &numbers[..n_cells] {
            end += number;
            self.starts.push(end);
        }
        self.scratch = scratch;
        if self.wants_ids {
            self.add_ids(simd, CellHashes::of_words(words), &numbers[..n_cells]);
        }
    }

    /// Appends the point ids of up to sixteen cells, given the cells' numbers of points.
    #[inline(always)]
    fn add_ids<S: Simd>(&mut self, simd: S, hashes: CellHashes<S>, numbers: &[u32]) {
        let most = numbers.iter().copied().fold(0, u32::max);
        let mut end = self.ids.len();
        // Find the index of each cell's first point.
        let starts: Vec<usize> = numbers
            .iter()
            .map(|&number| {
                end += number as usize;
                end - number as usize
            })
            .collect();
        self.ids.resize(end, 0);
        // Hash the ids of all cells, one point per cell at a time.
        for index in 0..most {
            let [high, low] = hashes.at(u32x16::splat(simd, IDS + index));
            for (lane, &number) in numbers.iter().enumerate() {
                if index < number {
                    self.ids[starts[lane] + index as usize] =
                        u64::from(high[lane]) << 32 | u64::from(low[lane]);
                }
            }
        }
    }

    /// Returns the coordinates of a point, in steps from the lower corner of the box.
    pub(super) fn point(&self, index: usize) -> [i32; MOST_AXES] {
        let mut point = [0; MOST_AXES];
        for axis in 0..self.cells.n_axes {
            point[axis] = self.steps[axis][index];
        }
        point
    }

    /// Returns whether the table contains the cells from `first` to `last` along each axis, counted from the box's
    /// first cell.
    pub(super) fn has_cells(&self, [first, last]: [[i32; MOST_AXES]; 2]) -> bool {
        (0..self.cells.n_axes)
            .all(|axis| first[axis] >= 0 && (last[axis] as usize) < self.cells.side(axis))
    }

    /// Returns the ranges of points in the cells within `reach` steps of a point along each axis; `None` if a cell is
    /// outside the table.
    pub(super) fn around<'a>(
        &self,
        point: &[i32; MOST_AXES],
        reach: i32,
        runs: &'a mut Vec<Range<usize>>,
    ) -> Option<&'a [Range<usize>]> {
        let cells = [-reach, reach].map(|way| point.map(|steps| (steps + way) >> STEP_BITS));
        if !self.has_cells(cells) {
            return None;
        }
        self.runs(cells, runs);
        Some(runs)
    }

    /// Collects the ranges of points in the cells from `first` to `last` along each axis, one for each row of cells.
    pub(super) fn runs(&self, [first, last]: [[i32; MOST_AXES]; 2], runs: &mut Vec<Range<usize>>) {
        let n_axes = self.cells.n_axes;
        runs.clear();
        let columns = first[0] as usize..last[0] as usize + 1;
        let mut row = first;
        loop {
            // Find the points in this row of cells.
            let mut index = 0;
            for axis in (1..n_axes).rev() {
                index = index * self.cells.side(axis) + row[axis] as usize;
            }
            runs.push(self.run(index, columns.clone()));
            // Advance to the next row of cells.
            let Some(axis) = (1..n_axes).find(|&axis| row[axis] < last[axis]) else {
                return;
            };
            row[axis] += 1;
            row[1..axis].copy_from_slice(&first[1..axis]);
        }
    }

    /// Returns the range of points in the given cells of a row. `columns` are cell indices along the first axis.
    #[inline(always)]
    fn run(&self, row: usize, columns: Range<usize>) -> Range<usize> {
        let first = row * self.cells.side(0);
        self.starts[first + columns.start] as usize..self.starts[first + columns.end] as usize
    }
}

/// Returns the numbers of points in sixteen cells along the first axis, starting at `cell`.
#[inline(always)]
pub(super) fn numbers<S: Simd>(
    lattice: &Lattice,
    cells: &SixteenCells<S>,
    mut cell: [i64; MOST_AXES],
) -> [u32; LANES] {
    let mut numbers = [0; LANES];
    if lattice.density.is_none() {
        cells.counts.store_slice(&mut numbers);
        return numbers;
    }
    // With a density, the number of points depends on the position of the cell.
    for (lane, number) in numbers.iter_mut().enumerate() {
        *number = lattice.count(&cell[..lattice.n_axes], cells.words[0][lane]);
        cell[0] += 1;
    }
    numbers
}

/// Returns the hash words of sixteen cells of a row, by combining the hashed coordinates of the row and of the
/// columns.
#[inline(always)]
pub(super) fn row_words<S: Simd>(
    simd: S,
    row: [u32; 2],
    (first, second): &(Vec<u32>, Vec<u32>),
    from: usize,
) -> [u32x16<S>; 2] {
    let columns = [
        u32x16::from_slice(simd, &first[from..from + LANES]),
        u32x16::from_slice(simd, &second[from..from + LANES]),
    ];
    both(
        columns,
        [u32x16::splat(simd, row[0]), u32x16::splat(simd, row[1])],
    )
}
