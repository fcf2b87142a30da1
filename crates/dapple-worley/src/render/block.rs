//! A block: a few columns of a band, whose feature points are made once.

use super::cull::Candidates;
use super::table::{CellBox, Table};
use super::tile::{Guess, Tile};
use super::{LANES, Line, Output, Picture};
use crate::fixed::{STEP, STEPS};
use crate::{Axes, Feature, LIMIT, Space};
use core::ops::Range;
use fearless_simd::{Level, dispatch};

/// The most cells of a block, with its neighborhood; where there are more, a pixel is larger than a cell.
const MOST_CELLS: u128 = 1 << 16;

/// The most cells along an axis, so that steps fit into 32 bits.
const LONGEST_SIDE: usize = 1000;

/// The most rows of a tile: those of one register.
const TILE_ROWS: usize = LANES;

/// A few columns of a band.
pub(super) struct Block<'a, const N: usize>
where
    Axes: Space<N>,
{
    pub(super) picture: &'a Picture<'a, N>,
    pub(super) level: Level,
    pub(super) columns: &'a Line,
    /// The rows of the band, along every axis.
    pub(super) rows: &'a [Line; N],
    pub(super) n_rows: usize,
    /// The first row of the band, in the window.
    pub(super) first: usize,
    /// The columns of the block, in the window.
    pub(super) range: Range<usize>,
}

/// What a thread works with, kept from block to block.
pub(super) struct Memory<const N: usize> {
    pub(super) table: Table<N>,
    /// The points about a tile whose neighborhood had to grow.
    pub(super) wide_table: Table<N>,
    pub(super) candidates: Candidates<N>,
    /// The coordinates of the columns of the block, in steps from the lower corner of the table, and those of the rows
    /// of the band along the other axes; the last one is repeated to fill a register.
    pub(super) lines: [Vec<i32>; N],
}

impl<const N: usize> Memory<N> {
    pub(super) fn new() -> Self {
        Self {
            table: Table::new(),
            wide_table: Table::new(),
            candidates: Candidates::new(),
            lines: core::array::from_fn(|_| Vec::new()),
        }
    }
}

impl<const N: usize> Block<'_, N>
where
    Axes: Space<N>,
{
    /// Fills the pixels of the block; `out` has the rows of the band.
    pub(super) fn render(&self, out: &mut Output<'_, N>, memory: &mut Memory<N>) {
        let lattice = &self.picture.worley.lattice;
        let depth = out.depth();
        let guess = Guess::new(lattice, self.middle(), depth);
        let Some(cells) = self.cells(guess.ring) else {
            self.one_by_one(0..self.n_rows, self.range.clone(), out);
            return;
        };
        memory.table.wants_ids = out.wants_ids();
        memory.wide_table.wants_ids = out.wants_ids();
        dispatch!(self.level, simd => memory.table.fill(simd, lattice, cells));
        for axis in 0..N {
            let places = match axis {
                0 => &self.columns.places[self.range.clone()],
                _ => &self.rows[axis].places,
            };
            let steps = places
                .iter()
                .map(|&(cell, steps)| ((cell - cells.first[axis]) as i32) * STEPS + steps);
            let line = &mut memory.lines[axis];
            line.clear();
            line.extend(steps);
            let last = line.last().copied().unwrap_or(0);
            line.resize(line.len() + LANES, last);
        }
        let height = self.tile_height(&memory.lines[0]);
        for row in (0..self.n_rows).step_by(height) {
            let rows = row..self.n_rows.min(row + height);
            for column in (0..self.range.len()).step_by(LANES) {
                let tile = Tile {
                    block: self,
                    depth,
                    rows: rows.clone(),
                    column,
                    guess,
                };
                tile.render(out, memory);
            }
        }
    }

    /// The cell in the middle.
    fn middle(&self) -> [i64; N] {
        core::array::from_fn(|axis| match axis {
            0 => self.columns.places[self.range.start + self.range.len() / 2].0,
            _ => self.rows[axis].places[self.n_rows / 2].0,
        })
    }

    /// The cells that the block needs, if it can be filled from a table.
    fn cells(&self, ring: i32) -> Option<CellBox<N>> {
        let is_finite = self.columns.is_finite && self.rows.iter().all(|rows| rows.is_finite);
        if !is_finite || !self.picture.plane.is_upright() {
            return None;
        }
        let mut cells = CellBox {
            first: [0; N],
            last: [0; N],
        };
        for axis in 0..N {
            [cells.first[axis], cells.last[axis]] = match axis {
                0 => self.columns.cells(self.range.clone()),
                _ => self.rows[axis].cells(0..self.n_rows),
            };
        }
        let cells = cells.widened(i64::from(ring));
        let is_small =
            cells.n_cells() <= MOST_CELLS && (0..N).all(|axis| cells.side(axis) <= LONGEST_SIDE);
        is_small.then_some(cells)
    }

    /// How many rows a tile has: fewer, where sixteen columns go further.
    fn tile_height(&self, columns: &[i32]) -> usize {
        let width = (columns[LANES.min(self.range.len()) - 1] - columns[0]).unsigned_abs();
        match width as f32 * STEP {
            ..0.5 => TILE_ROWS,
            ..1.5 => TILE_ROWS / 2,
            _ => TILE_ROWS / 4,
        }
    }

    /// Fills pixels each on its own: rows of the band, columns of the window.
    pub(super) fn one_by_one(
        &self,
        rows: Range<usize>,
        columns: Range<usize>,
        out: &mut Output<'_, N>,
    ) {
        for row in rows {
            for column in columns.clone() {
                self.one([column, row], out);
            }
        }
    }

    /// Fills one pixel: a column of the window, a row of the band.
    pub(super) fn one(&self, [column, row]: [usize; 2], out: &mut Output<'_, N>) {
        let worley = self.picture.worley;
        let place = self.picture.place(column, self.first + row);
        match out {
            Output::Values(values, rows) => values.put_one(worley, place, &mut rows[row][column]),
            Output::Gradients(tone, rows) => {
                let gradient = place.map(|place| tone.gradient_at(worley, place));
                rows[row][column] = gradient.unwrap_or([f32::NAN; N]);
            }
            Output::Features(features) => {
                let hits = place.map(|place| worley.hits::<LIMIT>(place));
                for (rank, features) in features.iter_mut().enumerate() {
                    let (distance, vector, id) =
                        hits.map_or((f32::NAN, [f32::NAN; N], 0), |hits| {
                            let Feature { distance, id, .. } = worley.feature(hits[rank]);
                            (distance, hits[rank].vector, id)
                        });
                    features.put([column, row], distance, vector, id);
                }
            }
        }
    }
}
