//! A tile: up to 16 × 16 pixels, and how far away the points are that they need.

use super::block::{Block, Memory};
use super::cull::{Find, TileBox};
use super::kernel::Rows;
use super::table::CellBox;
use super::track::{Found, TrackedRows};
use super::{LANES, Output};
use crate::fixed::{STEP, STEP_BITS, STEPS};
use crate::lattice::Lattice;
use crate::metric::{Chebyshev, Euclidean, Manhattan, Norm, with_norm};
use crate::{Axes, Metric, Space};
use core::ops::Range;
use fearless_simd::dispatch;

/// How many cells a tile and its neighborhood may span, so that coordinates in it are exact in `f32`.
const SPAN: i32 = 8;

/// Tiles narrower than this many steps take the bound that always holds, wider ones the guess.
const NARROW: i32 = STEPS / 2;

/// A distance that hardly any of the nearest points exceeds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guess {
    distance: f32,
    /// The cells that it reaches over.
    pub(super) ring: i32,
}

impl Guess {
    /// A ball of that size has so many points on average that fewer than `depth` are unlikely: about one in 250.
    pub(super) fn new<const N: usize>(lattice: &Lattice<N>, cell: [i64; N], depth: usize) -> Self {
        let density = match &lattice.density {
            None => lattice.counts.mean(),
            Some(density) => lattice.density_at(density, cell),
        };
        let points = [5.5, 7.8, 9.8, 11.6][depth - 1];
        // The volumes of the Euclidean unit balls, near enough for a guess.
        let ball = [1.0, 2.0, 3.14, 4.19, 4.93][N];
        let distance = libm::pow(points / (ball * density), 1.0 / N as f64);
        Self {
            distance: distance as f32,
            ring: (distance.ceil() as i32).max(1),
        }
    }
}

/// Up to 16 × 16 pixels of a block.
pub(super) struct Tile<'a, const N: usize>
where
    Axes: Space<N>,
{
    pub(super) block: &'a Block<'a, N>,
    /// The greatest n of F_n that is needed.
    pub(super) depth: usize,
    /// The rows, within the band.
    pub(super) rows: Range<usize>,
    /// The first column, within the block.
    pub(super) column: usize,
    pub(super) guess: Guess,
}

impl<const N: usize> Tile<'_, N>
where
    Axes: Space<N>,
{
    /// Fills the pixels; `out` has the rows of the band.
    pub(super) fn render(&self, out: &mut Output<'_, N>, memory: &mut Memory<N>) {
        let picture = self.block.picture;
        let left = self.block.range.start + self.column;
        let columns = left..self.block.range.end.min(left + LANES);
        let tile = self.tile_box(columns.len(), memory);
        let is_narrow = tile.high[0] - tile.low[0] < NARROW;
        let mut neighborhood = Neighborhood {
            ring: self.guess.ring,
            guess: (!is_narrow).then_some(self.guess.distance),
        };
        let mut row = self.rows.start;
        while neighborhood.fits(&tile) {
            let limit = self.find(&neighborhood, &tile, memory);
            let rest = row..self.rows.end;
            row = match out {
                Output::Values(values, out) => {
                    let rows = Rows {
                        rows: rest,
                        first: self.rows.start,
                        columns: columns.clone(),
                        steps: &memory.lines[0][self.column..],
                        low: tile.low[0],
                        shortlist: memory.candidates.shortlist(),
                        limit,
                        values,
                    };
                    rows.fill(self.block.level, picture.worley.metric, self.depth, out)
                }
                _ => {
                    let rows = TrackedRows {
                        rows: rest,
                        columns: columns.clone(),
                        first_column: self.column,
                        lines: &memory.lines,
                        low: tile.low,
                        first_row: self.rows.start,
                        candidates: &memory.candidates,
                        limit,
                    };
                    self.track(&rows, out)
                }
            };
            if row == self.rows.end {
                return;
            }
            neighborhood.grow();
        }
        self.block.one_by_one(row..self.rows.end, columns, out);
    }

    /// Fills pixels that show which points are the nearest.
    fn track(&self, rows: &TrackedRows<'_, N>, out: &mut Output<'_, N>) -> usize {
        match self.block.picture.worley.metric {
            Metric::Euclidean => self.track_by(rows, Euclidean, out),
            Metric::Manhattan => self.track_by(rows, Manhattan, out),
            Metric::Chebyshev => self.track_by(rows, Chebyshev, out),
            // Powers take so long that nothing is gained side by side.
            Metric::Minkowski(_) => {
                let columns = rows.columns.clone();
                self.block.one_by_one(rows.rows.clone(), columns, out);
                rows.rows.end
            }
        }
    }

    fn track_by<M: Norm>(
        &self,
        rows: &TrackedRows<'_, N>,
        norm: M,
        out: &mut Output<'_, N>,
    ) -> usize {
        if self.depth <= 2 {
            self.track_depth::<M, 2>(rows, norm, out)
        } else {
            self.track_depth::<M, 4>(rows, norm, out)
        }
    }

    fn track_depth<M: Norm, const K: usize>(
        &self,
        rows: &TrackedRows<'_, N>,
        norm: M,
        out: &mut Output<'_, N>,
    ) -> usize {
        let mut put = |found: &Found<N, K>| self.put(found, out);
        dispatch!(self.block.level, simd => rows.fill::<_, M, K>(simd, norm, &mut put))
    }

    /// Puts what was found in a row.
    fn put<const K: usize>(&self, found: &Found<N, K>, out: &mut Output<'_, N>) {
        let metric = self.block.picture.worley.metric;
        match out {
            Output::Features(features) => found.put(features),
            Output::Gradients(tone, rows) => {
                let out = &mut rows[found.row][found.columns.clone()];
                for (lane, out) in out.iter_mut().enumerate() {
                    *out = tone.gradient(metric, &found.vectors.map(|vectors| vectors[lane]));
                }
            }
            Output::Values(..) => {}
        }
        for (lane, column) in found.columns.clone().enumerate() {
            if found.unknown >> lane & 1 == 1 {
                self.block.one([column, found.row], out);
            }
        }
    }

    /// Where the pixels lie.
    fn tile_box(&self, width: usize, memory: &Memory<N>) -> TileBox<N> {
        let mut tile = TileBox {
            low: [0; N],
            high: [0; N],
        };
        for (axis, line) in memory.lines.iter().enumerate() {
            let [a, b] = match axis {
                0 => [line[self.column], line[self.column + width - 1]],
                _ => [line[self.rows.start], line[self.rows.end - 1]],
            };
            (tile.low[axis], tile.high[axis]) = (a.min(b), a.max(b));
        }
        tile
    }

    /// Finds the points that matter. All keys below the limit that is returned are right.
    fn find(&self, neighborhood: &Neighborhood, tile: &TileBox<N>, memory: &mut Memory<N>) -> f32 {
        let block = self.block;
        let metric = block.picture.worley.metric;
        let cells = tile.cells(neighborhood.ring);
        let mut find = Find {
            table: &memory.table,
            tile: *tile,
            cells,
            lines: &memory.lines,
            line_low: tile.low,
            first_row: self.rows.start,
            depth: self.depth,
            guess: None,
        };
        if neighborhood.ring > self.guess.ring {
            let corner = memory.table.cells.first;
            let [first, last] = cells
                .map(|cells| core::array::from_fn(|axis| corner[axis] + i64::from(cells[axis])));
            let cells = CellBox { first, last };
            let lattice = &block.picture.worley.lattice;
            dispatch!(block.level, simd => memory.wide_table.fill(simd, lattice, cells));
            find.move_to(&memory.wide_table);
        }
        let border = tile.border(cells) as f32 * STEP;
        with_norm!(metric, norm => {
            find.guess = neighborhood.guess.map(|guess| norm.key_along_one_axis(guess));
            dispatch!(block.level, simd => memory.candidates.find(simd, norm, &find));
            let border = norm.key_along_one_axis(border);
            norm.tightened(find.guess.map_or(border, |guess| guess.min(border)))
        })
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
    fn fits<const N: usize>(&self, tile: &TileBox<N>) -> bool {
        let [first, last] = tile.cells(self.ring);
        (0..N).all(|axis| last[axis] - first[axis] < SPAN)
    }

    /// Looks at more points.
    fn grow(&mut self) {
        if self.guess.take().is_none() {
            self.ring += 1;
        }
    }
}

impl<const N: usize> TileBox<N> {
    /// The cells of the table within `ring` cells of those that the tile touches, as the first and the last along each
    /// axis. May reach past the table.
    fn cells(&self, ring: i32) -> [[i32; N]; 2] {
        [
            self.low.map(|low| (low >> STEP_BITS) - ring),
            self.high.map(|high| (high >> STEP_BITS) + ring),
        ]
    }

    /// How far it is from the tile to the nearest place outside of these cells, in steps.
    fn border(&self, [first, last]: [[i32; N]; 2]) -> i32 {
        let mut border = i32::MAX;
        for axis in 0..N {
            border = border
                .min(self.low[axis] - first[axis] * STEPS)
                .min((last[axis] + 1) * STEPS - self.high[axis]);
        }
        border
    }
}
