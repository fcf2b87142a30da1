//! Many positions at once: a window of a plane.
//!
//! The window is cut into bands of rows, which threads share out, and blocks of columns. The feature points of a block
//! and its neighborhood are made once; then, for each tile of up to 16 × 16 pixels, those that matter to it are picked
//! out, and only those are compared at its pixels, sixteen side by side. Where a tile needs points further away than
//! its neighborhood reaches, the neighborhood grows; where that would not be exact, single positions are searched.

mod cull;
mod kernel;
mod table;

use crate::fixed::{Place, STEP, STEP_BITS, STEPS, split};
use crate::metric::{Norm, with_norm};
use crate::search::nearest;
use crate::sink::Values;
use crate::{Axes, Plane, Space, Worley, simd};
use cull::{Candidates, TileBox};
use dapple_raster::{RasterViewMut, Window};
use fearless_simd::{Level, dispatch, f32x16, i32x16, prelude::*};
use glam::DVec2;
use kernel::{RowTerms, TILE_ROWS, smallest};
use table::{CellBox, Table};

/// The pixels of a register.
pub(crate) const LANES: usize = 16;

/// The most rows of a band.
const BAND_ROWS: usize = 64;

/// The most columns of a block.
const BLOCK_COLUMNS: usize = 256;

/// The most cells of a block, with its neighborhood; where there are more, a pixel is larger than a cell.
const BLOCK_CELLS: u128 = 1 << 16;

/// How many cells a tile and its neighborhood may span, so that coordinates in it are exact in `f32`.
const SPAN: i32 = 8;

/// A window of a plane through the basis, and what is to be put into its pixels.
pub(crate) struct Picture<'a, const N: usize>
where
    Axes: Space<N>,
{
    pub(crate) worley: &'a Worley<N>,
    pub(crate) plane: &'a Plane<N>,
    pub(crate) window: &'a Window,
    /// What positions are multiplied by.
    pub(crate) frequency: f64,
    pub(crate) values: Values,
}

impl<const N: usize> Picture<'_, N>
where
    Axes: Space<N>,
{
    /// Fills the pixels, on all cores where the feature `rayon` is on. `out` has the size of the window.
    pub(crate) fn render(&self, out: RasterViewMut<'_, f32>) {
        self.render_at(simd::level(), out);
    }

    /// As [`render`](Self::render), at a given SIMD level.
    pub(crate) fn render_at(&self, level: Level, out: RasterViewMut<'_, f32>) {
        let columns = Line::new(self, 0, self.window.size[0], |column| {
            DVec2::new(self.window.column_x(column), 0.0)
        });
        let bands = out.bands(BAND_ROWS as u32).enumerate();
        let render = |memory: &mut Memory<N>, (band, mut out): (usize, RasterViewMut<'_, f32>)| {
            let mut rows: Vec<_> = out.rows_mut().collect();
            self.band(level, &columns, band * BAND_ROWS, &mut rows, memory);
        };
        #[cfg(feature = "rayon")]
        {
            use rayon::prelude::*;
            let bands: Vec<_> = bands.collect();
            bands.into_par_iter().for_each_init(Memory::new, render);
        }
        #[cfg(not(feature = "rayon"))]
        {
            let mut memory = Memory::new();
            bands.for_each(|band| render(&mut memory, band));
        }
    }

    /// Fills the rows of a band, which begins with row `first` of the window.
    fn band(
        &self,
        level: Level,
        columns: &Line,
        first: usize,
        out: &mut [&mut [f32]],
        memory: &mut Memory<N>,
    ) {
        let rows: [Line; N] = core::array::from_fn(|axis| {
            Line::new(self, axis, out.len() as u32, |row| {
                DVec2::new(0.0, self.window.row_y(first as u32 + row))
            })
        });
        let combination = self.values.tone.combination;
        for start in (0..columns.places.len()).step_by(BLOCK_COLUMNS) {
            let end = columns.places.len().min(start + BLOCK_COLUMNS);
            let block = Block { picture: self, columns, rows: &rows, first, start, end };
            with_norm!(self.worley.metric, norm => match combination.depth() {
                1 => dispatch!(level, simd => block.render::<_, _, 1>(simd, norm, out, memory)),
                2 => dispatch!(level, simd => block.render::<_, _, 2>(simd, norm, out, memory)),
                3 => dispatch!(level, simd => block.render::<_, _, 3>(simd, norm, out, memory)),
                _ => dispatch!(level, simd => block.render::<_, _, 4>(simd, norm, out, memory)),
            });
        }
    }

    /// The place of a pixel.
    fn place(&self, column: usize, row: usize) -> Option<Place<N>> {
        let position = self.window.position(column as u32, row as u32);
        Place::new(core::array::from_fn(|axis| {
            self.plane.coordinate(axis, position) * self.frequency
        }))
    }
}

/// The coordinates of columns or rows along one axis: cell, and steps within it.
struct Line {
    places: Vec<(i64, i32)>,
    /// Whether all of them have a place.
    is_finite: bool,
}

impl Line {
    fn new<const N: usize>(
        picture: &Picture<'_, N>,
        axis: usize,
        len: u32,
        position: impl Fn(u32) -> DVec2,
    ) -> Self
    where
        Axes: Space<N>,
    {
        let coordinate =
            |index| picture.plane.coordinate(axis, position(index)) * picture.frequency;
        let places: Vec<_> = (0..len).map_while(|index| split(coordinate(index))).collect();
        let is_finite = places.len() == len as usize;
        let mut places = places;
        places.resize(len as usize, (0, 0));
        Self { places, is_finite }
    }

    /// The first and the last cell of some of them.
    fn cells(&self, range: core::ops::Range<usize>) -> [i64; 2] {
        let [a, b] = [self.places[range.start].0, self.places[range.end - 1].0];
        [a.min(b), a.max(b)]
    }
}

/// What a thread works with, kept from band to band.
struct Memory<const N: usize> {
    table: Table<N>,
    /// The points about a tile whose neighborhood had to grow.
    wide_table: Table<N>,
    candidates: Candidates<N>,
    row_terms: RowTerms,
    /// The coordinates of the columns of a block, in steps from the lower corner of the table.
    columns: Vec<i32>,
    /// The same for the rows of the band, along every axis.
    rows: [Vec<i32>; N],
}

impl<const N: usize> Memory<N> {
    fn new() -> Self {
        Self {
            table: Table::new(),
            wide_table: Table::new(),
            candidates: Candidates::new(),
            row_terms: RowTerms::default(),
            columns: Vec::new(),
            rows: core::array::from_fn(|_| Vec::new()),
        }
    }
}

/// A few columns of a band.
struct Block<'a, const N: usize>
where
    Axes: Space<N>,
{
    picture: &'a Picture<'a, N>,
    columns: &'a Line,
    rows: &'a [Line; N],
    /// The first row of the band, in the window.
    first: usize,
    /// The first column, and the one after the last.
    start: usize,
    end: usize,
}

impl<const N: usize> Block<'_, N>
where
    Axes: Space<N>,
{
    #[inline(always)]
    fn render<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
        memory: &mut Memory<N>,
    ) {
        let guess = Guess::new::<N, K>(&self.picture.worley.lattice);
        let Some(cells) = self.cells(out.len(), guess.ring) else {
            self.one_by_one::<S, M, K>(simd, norm, (0..out.len(), self.start..self.end), out);
            return;
        };
        memory.table.fill(simd, &self.picture.worley.lattice, cells);
        let from_corner = |axis: usize, &(cell, steps): &(i64, i32)| {
            ((cell - cells.first[axis]) as i32) * STEPS + steps
        };
        memory.columns.clear();
        let columns = self.columns.places[self.start..self.end].iter();
        memory.columns.extend(columns.map(|place| from_corner(0, place)));
        repeat_last(&mut memory.columns);
        for axis in 1..N {
            memory.rows[axis].clear();
            let rows = self.rows[axis].places.iter();
            memory.rows[axis].extend(rows.map(|place| from_corner(axis, place)));
            repeat_last(&mut memory.rows[axis]);
        }
        let height = self.tile_height(&memory.columns);
        for row in (0..out.len()).step_by(height) {
            let rows = row..out.len().min(row + height);
            for column in (0..self.end - self.start).step_by(LANES) {
                let tile = Tile { block: self, rows: rows.clone(), column, guess };
                tile.render::<S, M, K>(simd, norm, out, memory);
            }
        }
    }

    /// The cells that the block needs, if it can be filled from a table.
    fn cells(&self, n_rows: usize, ring: i32) -> Option<CellBox<N>> {
        let is_finite = self.columns.is_finite && self.rows.iter().all(|rows| rows.is_finite);
        if !is_finite || !self.picture.plane.is_upright() {
            return None;
        }
        let mut cells = CellBox { first: [0; N], last: [0; N] };
        for axis in 0..N {
            let [first, last] = match axis {
                0 => self.columns.cells(self.start..self.end),
                _ => self.rows[axis].cells(0..n_rows),
            };
            (cells.first[axis], cells.last[axis]) = (first, last);
        }
        let cells = cells.widened(i64::from(ring));
        (cells.n_cells() <= BLOCK_CELLS && (0..N).all(|axis| cells.side(axis) < 1000))
            .then_some(cells)
    }

    /// How many rows a tile has: fewer, where sixteen columns go further.
    fn tile_height(&self, columns: &[i32]) -> usize {
        let width = (columns[LANES.min(self.end - self.start) - 1] - columns[0]).unsigned_abs();
        match width as f32 * STEP {
            ..0.5 => TILE_ROWS,
            ..1.5 => TILE_ROWS / 2,
            _ => TILE_ROWS / 4,
        }
    }

    /// Fills pixels each on its own.
    #[inline(always)]
    fn one_by_one<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        (rows, columns): (core::ops::Range<usize>, core::ops::Range<usize>),
        out: &mut [&mut [f32]],
    ) {
        let picture = self.picture;
        for row in rows {
            for column in columns.clone() {
                let out = &mut out[row][column..=column];
                match picture.place(column, self.first + row) {
                    Some(place) => {
                        let hits: [_; K] = nearest(&picture.worley.lattice, norm, place);
                        let mut keys = [f32x16::splat(simd, 0.0); K];
                        for rank in 0..K {
                            keys[rank] = f32x16::splat(simd, hits[rank].key);
                        }
                        picture.values.put(norm, keys, out);
                    }
                    None => out[0] = f32::NAN,
                }
            }
        }
    }
}

/// Makes room for one register more, with the last number.
fn repeat_last(numbers: &mut Vec<i32>) {
    let last = numbers.last().copied().unwrap_or(0);
    numbers.resize(numbers.len() + LANES, last);
}

/// A distance that hardly any `K`-th nearest point exceeds.
#[derive(Clone, Copy, Debug)]
struct Guess {
    distance: f32,
    /// The cells that it reaches over.
    ring: i32,
}

impl Guess {
    /// A ball of that size has so many points on average that fewer than `K` are unlikely: about one in 250.
    fn new<const N: usize, const K: usize>(lattice: &crate::lattice::Lattice<N>) -> Self {
        let points = [5.5, 7.8, 9.8, 11.6][K - 1];
        let ball = [1.0, 2.0, 3.14, 4.19, 4.93][N];
        let volume = points / (ball * lattice.counts.mean());
        let distance = libm::pow(volume, 1.0 / N as f64) as f32;
        Self {
            distance,
            ring: (distance.ceil() as i32).max(1),
        }
    }
}

/// Up to 16 × 16 pixels of a block.
struct Tile<'a, const N: usize>
where
    Axes: Space<N>,
{
    block: &'a Block<'a, N>,
    /// The rows, within the band.
    rows: core::ops::Range<usize>,
    /// The first column, within the block.
    column: usize,
    guess: Guess,
}

impl<const N: usize> Tile<'_, N>
where
    Axes: Space<N>,
{
    #[inline(always)]
    fn render<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
        memory: &mut Memory<N>,
    ) {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if simd.level().as_avx512().is_some() {
            return self.groups::<S, M, K, 8>(simd, norm, out, memory);
        }
        self.groups::<S, M, K, 2>(simd, norm, out, memory);
    }

    /// Fills the pixels, `R` rows at once.
    #[inline(always)]
    fn groups<S: Simd, M: Norm, const K: usize, const R: usize>(
        &self,
        simd: S,
        norm: M,
        out: &mut [&mut [f32]],
        memory: &mut Memory<N>,
    ) {
        let left = self.block.start + self.column;
        let width = LANES.min(self.block.end - left);
        let tile = self.tile_box(width, memory);
        let columns = i32x16::from_slice(simd, &memory.columns[self.column..][..LANES]) - tile.low[0];
        let columns = columns.to_float::<f32x16<S>>() * STEP;
        let mut rows = [columns; N];
        for axis in 1..N {
            let steps = i32x16::from_slice(simd, &memory.rows[axis][self.rows.start..][..LANES]);
            rows[axis] = (steps - tile.low[axis]).to_float::<f32x16<S>>() * STEP;
        }

        let is_small = tile.high[0] - tile.low[0] < STEPS / 2;
        let mut neighborhood = Neighborhood {
            ring: self.guess.ring,
            guess: (!is_small).then_some(self.guess.distance),
        };
        let mut row = 0;
        while neighborhood.fits(&tile) {
            let limit = neighborhood.find::<S, M, N, K>(simd, norm, self, &tile, memory);
            memory.row_terms.fill(norm, &rows, &memory.candidates);
            while row < self.rows.len() {
                let (keys, worst) = smallest::<S, M, N, K, R>(
                    norm,
                    columns,
                    &memory.candidates,
                    &memory.row_terms,
                    row,
                );
                if !worst.simd_lt(limit).all_true() {
                    break;
                }
                for (keys, out) in keys.into_iter().zip(&mut out[self.rows.start + row..self.rows.end]) {
                    self.block.picture.values.put(norm, keys, &mut out[left..left + width]);
                }
                row += R;
            }
            if row >= self.rows.len() {
                return;
            }
            neighborhood.grow();
        }
        let rest = self.rows.start + row..self.rows.end;
        self.block.one_by_one::<S, M, K>(simd, norm, (rest, left..left + width), out);
    }

    /// Where the pixels lie.
    #[inline(always)]
    fn tile_box(&self, width: usize, memory: &Memory<N>) -> TileBox<N> {
        let mut tile = TileBox { low: [0; N], high: [0; N] };
        for axis in 0..N {
            let [a, b] = match axis {
                0 => [memory.columns[self.column], memory.columns[self.column + width - 1]],
                _ => [memory.rows[axis][self.rows.start], memory.rows[axis][self.rows.end - 1]],
            };
            (tile.low[axis], tile.high[axis]) = (a.min(b), a.max(b));
        }
        tile
    }
}

/// From where feature points are taken for a tile.
#[derive(Clone, Copy, Debug)]
struct Neighborhood {
    /// So many cells on every side of those that the tile touches.
    ring: i32,
    /// How near to the tile points are looked for; all that could matter, if nothing.
    guess: Option<f32>,
}

impl Neighborhood {
    /// Whether coordinates within it are exact.
    #[inline(always)]
    fn fits<const N: usize>(&self, tile: &TileBox<N>) -> bool {
        let [first, last] = tile.cells(self.ring);
        (0..N).all(|axis| last[axis] - first[axis] < SPAN)
    }

    /// Finds the points for a tile. All keys below the limit that is returned are right.
    #[inline(always)]
    fn find<S: Simd, M: Norm, const N: usize, const K: usize>(
        &self,
        simd: S,
        norm: M,
        owner: &Tile<'_, N>,
        tile: &TileBox<N>,
        memory: &mut Memory<N>,
    ) -> f32
    where
        Axes: Space<N>,
    {
        let key_along_one_axis = |distance: f32| {
            let mut vector = [0.0; N];
            vector[0] = distance;
            norm.key(vector)
        };
        let cells = tile.cells(self.ring);
        let border = key_along_one_axis(tile.border(cells) as f32 * STEP);
        let guess = self.guess.map(key_along_one_axis);
        let limit = guess.map_or(border, |guess| guess.min(border)) / M::LOOSE;
        if self.ring == owner.guess.ring {
            memory.candidates.find::<S, M, K>(simd, norm, &memory.table, (tile, cells), guess);
        } else {
            let corner = memory.table.cells.first;
            let [first, last] = cells.map(|cells| {
                core::array::from_fn(|axis| corner[axis] + i64::from(cells[axis]))
            });
            memory.wide_table.fill(
                simd,
                &owner.block.picture.worley.lattice,
                CellBox { first, last },
            );
            let shift = cells[0].map(|cell| cell << STEP_BITS);
            let shifted = |corner: [i32; N]| core::array::from_fn(|axis| corner[axis] - shift[axis]);
            let tile = TileBox { low: shifted(tile.low), high: shifted(tile.high) };
            let all = tile.cells(self.ring);
            memory.candidates.find::<S, M, K>(simd, norm, &memory.wide_table, (&tile, all), guess);
        }
        limit
    }

    /// Looks at more points.
    fn grow(&mut self) {
        if self.guess.take().is_none() {
            self.ring += 1;
        }
    }
}
