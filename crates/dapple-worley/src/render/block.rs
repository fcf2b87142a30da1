//! A block: a few columns of a band, whose feature points are made once.

use super::bins::Bins;
use super::sheet::Sheet;
use super::shortlist::Shortlist;
use super::sieve::{Keep, PixelBox, PointList, Points};
use super::splat::Splat;
use super::table::{CellBox, Table};
use super::thin::Rivals;
use super::tile::{Guess, Tile};
use super::{LANES, Line, Output, Picture};
use crate::fixed::{STEP, STEPS};
use crate::metric::{Norm as _, with_norm};
use crate::{Axes, Feature, LIMIT, Space};
use core::ops::Range;
use fearless_simd::{Level, dispatch};
use std::sync::Arc;

/// The most cells of a block, with its neighborhood; where there are more, a pixel is larger than a cell.
pub(super) const MOST_CELLS: u128 = 1 << 16;

/// The most cells along an axis, so that steps fit into 32 bits.
pub(super) const LONGEST_SIDE: usize = 1000;

/// The most columns and rows of a tile.
const LARGE_TILE: usize = 32;

/// Tiles of this many columns are large if they are not wider than this many steps.
const LARGE_TILE_STEPS: i32 = STEPS * 3 / 4;

/// A few columns of a band.
pub(super) struct Block<'a, const N: usize>
where
    Axes: Space<N>,
{
    pub(super) picture: &'a Picture<'a, N>,
    pub(super) level: Level,
    pub(super) columns: &'a Line,
    /// The rows of the band, along every axis.
    pub(super) rows: &'a [Arc<Line>; N],
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
    /// Those that matter to the squares about a tile, from the largest to the smallest, and the limit of their keys.
    pub(super) lists: [(PointList<N>, f32); SQUARES.len()],
    /// Those that matter to a tile.
    pub(super) list: PointList<N>,
    /// The same, thinned.
    pub(super) thinned: PointList<N>,
    pub(super) rivals: Rivals,
    pub(super) shortlist: Shortlist<N>,
    pub(super) sheet: Sheet,
    pub(super) near: Vec<f32>,
    pub(super) runs: Vec<Range<usize>>,
    /// The points in the order of the pixels that they are near to.
    pub(super) bins: Bins,
    /// The coordinates of the columns of the block, in steps from the lower corner of the table, and those of the rows
    /// of the band along the other axes; the last one is repeated to fill a register.
    pub(super) lines: [Vec<i32>; N],
}

impl<const N: usize> Memory<N> {
    pub(super) fn new() -> Self {
        Self {
            table: Table::new(),
            wide_table: Table::new(),
            lists: core::array::from_fn(|_| (PointList::new(), 0.0)),
            list: PointList::new(),
            thinned: PointList::new(),
            rivals: Rivals::new(),
            shortlist: Shortlist::new(),
            sheet: Sheet::new(),
            near: Vec::new(),
            runs: Vec::new(),
            bins: Bins::new(),
            lines: core::array::from_fn(|_| Vec::new()),
        }
    }

    /// Where the pixels of some columns of the block and rows of the band lie.
    pub(super) fn pixel_box(&self, columns: Range<usize>, rows: Range<usize>) -> PixelBox<N> {
        let mut pixels = PixelBox {
            low: [0; N],
            high: [0; N],
        };
        for (axis, line) in self.lines.iter().enumerate() {
            let range = if axis == 0 { &columns } else { &rows };
            let [a, b] = [line[range.start], line[range.end - 1]];
            (pixels.low[axis], pixels.high[axis]) = (a.min(b), a.max(b));
        }
        pixels
    }
}

/// The sides of the squares of pixels for which points are sifted before they are for a tile.
const SQUARES: [usize; 2] = [64, 32];

/// Squares are not wider than this many steps: in wider ones, almost all points matter.
const WIDEST_SQUARE: i32 = STEPS + STEPS / 4;

impl<const N: usize> Block<'_, N>
where
    Axes: Space<N>,
{
    /// Fills the pixels of the block; `out` has the rows of the band.
    pub(super) fn render(&self, out: &mut Output<'_, N>, memory: &mut Memory<N>) {
        let lattice = &self.picture.worley.lattice;
        // The inner loops know one, two and four; those that tell which points they are, two and four.
        let depth = match (&*out, out.depth()) {
            (Output::Values(..), 1) => 1,
            (_, ..=2) => 2,
            _ => 4,
        };
        let guess = Guess::new(lattice, self.middle(), depth);
        let splat = Splat::new(self, guess.distance).filter(|_| matches!(out, Output::Values(..)));
        let reach = splat.map_or(0, |splat| splat.reach.ceil() as i32);
        let ring = guess.ring.max(reach);
        let Some(cells) = self.cells(ring) else {
            self.one_by_one(0..self.n_rows, self.range.clone(), out);
            return;
        };
        memory.wide_table.wants_ids = out.wants_ids();
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
        let splat = splat.filter(|splat| splat.is_even(&memory.lines));
        if let (Output::Values(values, rows), Some(splat)) = (&mut *out, &splat) {
            splat.render(self, &cells, (values, rows), memory);
            return;
        }
        // The picture before may be of the same cells.
        if !memory.table.has(&cells, out.wants_ids()) {
            memory.table.wants_ids = out.wants_ids();
            dispatch!(self.level, simd => memory.table.fill(simd, lattice, cells));
        }
        if matches!(out, Output::Values(..)) && self.sheet((depth, guess), (out, memory)) {
            return;
        }
        let size = self.tile_size(&memory.lines[0]);
        let all = (0..self.range.len(), 0..self.n_rows);
        self.squares(all, (depth, guess, size), (out, memory), (0, None));
    }

    /// Fills the pixels of a rectangle, columns of the block and rows of the band, square by square, and the last ones
    /// tile by tile. `from` is the list with the points that matter, if there is one.
    fn squares(
        &self,
        (columns, rows): (Range<usize>, Range<usize>),
        (depth, guess, size): (usize, Guess, [usize; 2]),
        (out, memory): (&mut Output<'_, N>, &mut Memory<N>),
        (level, from): (usize, Option<usize>),
    ) {
        let Some(&side) = SQUARES.get(level) else {
            let [width, height] = size;
            for row in rows.clone().step_by(height) {
                for column in columns.clone().step_by(width) {
                    let tile = Tile {
                        block: self,
                        depth,
                        rows: row..rows.end.min(row + height),
                        columns: column..columns.end.min(column + width),
                        guess,
                    };
                    tile.render(out, memory, from);
                }
            }
            return;
        };
        let first = memory.pixel_box(
            columns.start..columns.end.min(columns.start + side),
            rows.start..rows.end.min(rows.start + side),
        );
        let is_wide = (0..N).any(|axis| first.high[axis] - first.low[axis] > WIDEST_SQUARE);
        if is_wide || side <= size[0] {
            let rectangle = (columns, rows);
            return self.squares(
                rectangle,
                (depth, guess, size),
                (out, memory),
                (level + 1, from),
            );
        }
        for row in rows.clone().step_by(side) {
            for column in columns.clone().step_by(side) {
                let columns = column..columns.end.min(column + side);
                let rows = row..rows.end.min(row + side);
                let pixels = memory.pixel_box(columns.clone(), rows.clone());
                self.sift(&pixels, (depth, guess), memory, (level, from));
                let next = (level + 1, Some(level));
                self.squares((columns, rows), (depth, guess, size), (out, memory), next);
            }
        }
    }

    /// Makes the list of a square.
    fn sift(
        &self,
        pixels: &PixelBox<N>,
        (depth, guess): (usize, Guess),
        memory: &mut Memory<N>,
        (level, from): (usize, Option<usize>),
    ) {
        let Memory {
            table,
            lists,
            near,
            runs,
            ..
        } = memory;
        let (larger, smaller) = lists.split_at_mut(level);
        let (list, limit) = &mut smaller[0];
        let norm_border;
        let run;
        let points = match from {
            Some(from) => {
                norm_border = None;
                run = 0..larger[from].0.len;
                *limit = larger[from].1;
                larger[from].0.points(&run, table.wants_ids)
            }
            None => {
                let cells = pixels.cells(guess.ring);
                norm_border = Some(pixels.border(cells) as f32 * STEP);
                table.runs(cells, runs);
                Points {
                    steps: &table.steps,
                    numbers: None,
                    runs,
                    wants_numbers: table.wants_ids,
                }
            }
        };
        with_norm!(self.picture.worley.metric, norm => {
            if let Some(border) = norm_border {
                *limit = norm.tightened(norm.key_along_one_axis(border));
            }
            dispatch!(self.level, simd => {
                list.sift(simd, norm, points, (pixels, Keep::Nearest(depth)), near);
            });
        });
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

    /// The columns and rows of a tile: fewer, where pixels are further apart.
    fn tile_size(&self, columns: &[i32]) -> [usize; 2] {
        let n = self.range.len();
        let width = |n_columns: usize| (columns[n_columns.min(n) - 1] - columns[0]).abs();
        if width(LARGE_TILE) <= LARGE_TILE_STEPS {
            return [LARGE_TILE; 2];
        }
        match width(LANES) as f32 * STEP {
            ..0.5 => [LANES, LANES],
            ..1.5 => [LANES, LANES / 2],
            _ => [LANES, LANES / 4],
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
