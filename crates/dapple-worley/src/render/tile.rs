//! A tile: up to 32 × 32 pixels, and how far away the points are that they need.

use super::block::{Block, Memory};
use super::kernel::Rows;
use super::sieve::{Keep, PixelBox, Points};
use super::table::CellBox;
use super::thin::Thinning;
use super::track::{Found, TrackedRows};
use super::{LANES, Output};
use crate::fixed::{STEP, STEPS};
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
    pub(super) distance: f32,
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
        let ball = [1.0, 2.0, 3.1, 4.2, 4.9][N];
        let distance = libm::pow(points / (ball * density), 1.0 / N as f64);
        Self {
            distance: distance as f32,
            ring: (distance.ceil() as i32).max(1),
        }
    }
}

/// Up to 32 × 32 pixels of a block.
pub(super) struct Tile<'a, const N: usize>
where
    Axes: Space<N>,
{
    pub(super) block: &'a Block<'a, N>,
    /// The greatest n of `F_n` that is needed.
    pub(super) depth: usize,
    /// The rows, within the band.
    pub(super) rows: Range<usize>,
    /// The columns, within the block.
    pub(super) columns: Range<usize>,
    pub(super) guess: Guess,
}

impl<const N: usize> Tile<'_, N>
where
    Axes: Space<N>,
{
    /// Fills the pixels; `out` has the rows of the band. The points that matter are in list `level` of the memory, or,
    /// if there is none, in the table.
    pub(super) fn render(
        &self,
        out: &mut Output<'_, N>,
        memory: &mut Memory<N>,
        level: Option<usize>,
    ) {
        let pixels = memory.pixel_box(self.columns.clone(), self.rows.clone());
        let is_narrow = level.is_some() || pixels.high[0] - pixels.low[0] < NARROW;
        let mut neighborhood = Neighborhood {
            ring: self.guess.ring,
            guess: (!is_narrow).then_some(self.guess.distance),
        };
        if neighborhood.fits(&pixels) {
            let limit = match level {
                Some(level) => self.find_in_list(&pixels, memory, level),
                None => self.find(&neighborhood, &pixels, memory),
            };
            let mut rest = Vec::new();
            for first in self.columns.clone().step_by(LANES) {
                let columns = first..self.columns.end.min(first + LANES);
                let row = self.fill(columns.clone(), (pixels.low, limit), (out, memory));
                if row < self.rows.end {
                    rest.push(self.part(columns, row));
                }
            }
            neighborhood.grow();
            for part in rest {
                part.render_near(neighborhood, out, memory);
            }
        } else {
            self.one_by_one(out);
        }
    }

    /// Fills pixels for which the usual neighborhood is known to be too small.
    pub(super) fn render_further(&self, out: &mut Output<'_, N>, memory: &mut Memory<N>) {
        for first in self.columns.clone().step_by(LANES) {
            let columns = first..self.columns.end.min(first + LANES);
            let neighborhood = Neighborhood {
                ring: self.guess.ring + 1,
                guess: None,
            };
            let part = self.part(columns, self.rows.start);
            part.render_near(neighborhood, out, memory);
        }
    }

    /// Fills the pixels of a tile with one register's columns, from as many points as it takes.
    fn render_near(
        &self,
        mut neighborhood: Neighborhood,
        out: &mut Output<'_, N>,
        memory: &mut Memory<N>,
    ) {
        let pixels = memory.pixel_box(self.columns.clone(), self.rows.clone());
        if !neighborhood.fits(&pixels) {
            self.one_by_one(out);
            return;
        }
        let limit = self.find(&neighborhood, &pixels, memory);
        let row = self.fill(self.columns.clone(), (pixels.low, limit), (out, memory));
        if row < self.rows.end {
            neighborhood.grow();
            let rest = self.part(self.columns.clone(), row);
            rest.render_near(neighborhood, out, memory);
        }
    }

    /// Some columns, from a row on.
    fn part(&self, columns: Range<usize>, row: usize) -> Self {
        Self {
            block: self.block,
            depth: self.depth,
            rows: row..self.rows.end,
            columns,
            guess: self.guess,
        }
    }

    /// Fills pixels each on its own.
    fn one_by_one(&self, out: &mut Output<'_, N>) {
        let left = self.block.range.start;
        let columns = left + self.columns.start..left + self.columns.end;
        self.block.one_by_one(self.rows.clone(), columns, out);
    }

    /// Fills pixels from the shortlist, up to the first row with a key beyond the limit, which it returns.
    fn fill(
        &self,
        columns: Range<usize>,
        (low, limit): ([i32; N], f32),
        (out, memory): (&mut Output<'_, N>, &Memory<N>),
    ) -> usize {
        let left = self.block.range.start;
        let in_window = left + columns.start..left + columns.end;
        match out {
            Output::Values(values, out) => {
                let rows = Rows {
                    rows: self.rows.clone(),
                    columns: in_window,
                    steps: &memory.lines[0][columns.start..],
                    low: low[0],
                    points: &memory.shortlist.coordinates[0][..memory.shortlist.len],
                    row_terms: &memory.shortlist.row_terms,
                    limit,
                    values,
                };
                rows.fill(
                    self.block.level,
                    self.block.picture.worley.metric,
                    self.depth,
                    out,
                )
            }
            _ => {
                let rows = TrackedRows {
                    rows: self.rows.clone(),
                    columns: in_window,
                    first_column: columns.start,
                    lines: &memory.lines,
                    low,
                    shortlist: &memory.shortlist,
                    limit,
                };
                self.track(&rows, out)
            }
        }
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

    /// Finds the points that matter, in a list of those that matter to a larger box. All keys below the limit that is
    /// returned are right.
    fn find_in_list(&self, pixels: &PixelBox<N>, memory: &mut Memory<N>, level: usize) -> f32 {
        let Memory {
            lists,
            list,
            thinned,
            rivals,
            shortlist,
            near,
            table,
            lines,
            ..
        } = memory;
        let (larger, limit) = &lists[level];
        let limit = *limit;
        let run = 0..larger.len;
        let points = larger.points(&run, table.wants_ids);
        let row_axis = self.block.picture.plane.row_axis();
        let lines = core::array::from_fn(|axis| match axis {
            0 => &lines[0][..],
            _ => &lines[axis][self.rows.start..],
        });
        let rows = (self.rows.len(), lines, pixels.low);
        with_norm!(self.block.picture.worley.metric, norm => {
            dispatch!(self.block.level, simd => {
                list.sift(simd, norm, points, (pixels, Keep::Nearest(self.depth)), near);
                if let Some(row_axis) = row_axis.filter(|_| norm.is_sum()) {
                    let run = 0..list.len;
                    let points = list.points(&run, table.wants_ids);
                    let thinning = Thinning {
                        depth: self.depth,
                        distance: self.guess.distance,
                    };
                    let how = (&thinning, &mut *rivals);
                    thinned.thin(simd, norm, (points, pixels, row_axis), how);
                    core::mem::swap(thinned, list);
                }
                shortlist.fill(simd, norm, (&*list, pixels), rows);
            });
        });
        table.look_up_ids(list, &mut shortlist.ids);
        limit
    }

    /// The same among the points of the table.
    fn find(
        &self,
        neighborhood: &Neighborhood,
        pixels: &PixelBox<N>,
        memory: &mut Memory<N>,
    ) -> f32 {
        let block = self.block;
        let mut cells = pixels.cells(neighborhood.ring);
        let border = pixels.border(cells) as f32 * STEP;
        let Memory {
            list,
            shortlist,
            near,
            runs,
            lines,
            ..
        } = memory;
        let mut table = &mut memory.table;
        let mut moved = *pixels;
        if neighborhood.ring > self.guess.ring {
            let corner = table.cells.first;
            let [first, last] = cells
                .map(|cells| core::array::from_fn(|axis| corner[axis] + i64::from(cells[axis])));
            table = &mut memory.wide_table;
            let lattice = &block.picture.worley.lattice;
            let all = CellBox { first, last };
            dispatch!(block.level, simd => table.fill(simd, lattice, all));
            for axis in 0..N {
                moved.low[axis] -= cells[0][axis] * STEPS;
                moved.high[axis] -= cells[0][axis] * STEPS;
            }
            cells = moved.cells(neighborhood.ring);
        }
        table.runs(cells, runs);
        let points = Points {
            steps: &table.steps,
            numbers: None,
            runs,
            wants_numbers: table.wants_ids,
        };
        let lines = core::array::from_fn(|axis| match axis {
            0 => &lines[0][..],
            _ => &lines[axis][self.rows.start..],
        });
        let rows = (self.rows.len(), lines, pixels.low);
        let limit = with_norm!(block.picture.worley.metric, norm => {
            let guess = neighborhood.guess.map(|guess| norm.key_along_one_axis(guess));
            let keep = guess.map_or(Keep::Nearest(self.depth), Keep::Within);
            dispatch!(block.level, simd => {
                list.sift(simd, norm, points, (&moved, keep), near);
                shortlist.fill(simd, norm, (&*list, &moved), rows);
            });
            let border = norm.key_along_one_axis(border);
            norm.tightened(guess.map_or(border, |guess| guess.min(border)))
        });
        table.look_up_ids(list, &mut shortlist.ids);
        limit
    }
}

/// From where feature points are taken for a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighborhood {
    /// So many cells on every side of those that the tile touches.
    pub(super) ring: i32,
    /// How near to the tile points are looked for; all that could matter, if nothing.
    pub(super) guess: Option<f32>,
}

impl Neighborhood {
    /// Whether coordinates within it are exact.
    pub(super) fn fits<const N: usize>(&self, tile: &PixelBox<N>) -> bool {
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
