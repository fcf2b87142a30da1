//! The most usual pictures: values with the Euclidean or the Manhattan metric, in a plane along the first two axes.
//!
//! The other axes add the same to the keys of a point at all pixels, so the points are flat from here on. Those that
//! matter to a square are picked from the table once; for each tile of it they are thinned ([`thin`](super::thin)) and
//! compared. All of that happens in one piece, without going through memory or functions more than it must.

use super::block::{Block, Memory};
use super::kernel::Rows;
use super::shortlist::TILE_ROWS;
use super::sieve::{Keep, PixelBox, PointList, Points};
use super::thin::{FlatPoints, Rectangle, Rivals, Thinning};
use super::tile::{Guess, Neighborhood, Tile};
use super::{LANES, Output};
use crate::fixed::{STEP, STEPS};
use crate::metric::{Euclidean, Manhattan, Norm};
use crate::sink::Values;
use crate::{Axes, Metric, Space};
use core::ops::Range;
use fearless_simd::{Level, dispatch, f32x16, i32x16, prelude::*};

/// What is worked with.
#[derive(Debug)]
pub(super) struct Sheet {
    /// The points that matter to a square, and those that do to a tile.
    square: FlatPoints,
    tile: FlatPoints,
    row_terms: Vec<[f32; TILE_ROWS]>,
    /// Columns of the block and rows of the band that need points further away.
    unknown: Vec<[Range<usize>; 2]>,
}

/// The sides of the squares, and the columns and rows of their tiles.
const SIZES: [(usize, [usize; 2]); 3] = [(64, [32, 32]), (32, [32, 16]), (16, [16, 16])];

/// Squares are not wider than this many steps: in wider ones, almost all points matter.
const WIDEST_SQUARE: i32 = STEPS + STEPS / 2;

/// What is the same for all squares of a block.
#[derive(Clone, Copy, Debug)]
struct Job {
    /// The greatest n of `F_n` that is needed.
    depth: usize,
    guess: Guess,
    /// The columns and rows of a tile.
    size: [usize; 2],
}

impl<const N: usize> Block<'_, N>
where
    Axes: Space<N>,
{
    /// Fills the pixels of the block, if its picture is one of these.
    pub(super) fn sheet(
        &self,
        (depth, guess): (usize, Guess),
        (out, memory): (&mut Output<'_, N>, &mut Memory<N>),
    ) -> bool {
        let fits = |&(side, _): &(usize, [usize; 2])| {
            let [columns, rows] = [self.range.len(), self.n_rows].map(|n| 0..n.min(side));
            let pixels = memory.pixel_box(columns, rows);
            (0..2).all(|axis| pixels.high[axis] - pixels.low[axis] <= WIDEST_SQUARE)
        };
        let is_flat = self.picture.plane.row_axis() == Some(1);
        let Some((side, size)) = SIZES.into_iter().find(fits).filter(|_| is_flat) else {
            return false;
        };
        let job = Job { depth, guess, size };
        match self.picture.worley.metric {
            Metric::Euclidean => self.squares_of_sheet(Euclidean, side, job, (out, memory)),
            Metric::Manhattan => self.squares_of_sheet(Manhattan, side, job, (out, memory)),
            _ => return false,
        }
        true
    }

    fn squares_of_sheet<M: Norm>(
        &self,
        norm: M,
        side: usize,
        job: Job,
        (out, memory): (&mut Output<'_, N>, &mut Memory<N>),
    ) {
        for row in (0..self.n_rows).step_by(side) {
            for column in (0..self.range.len()).step_by(side) {
                let columns = column..self.range.len().min(column + side);
                let rows = row..self.n_rows.min(row + side);
                self.square(norm, [columns, rows], job, (out, memory));
            }
        }
    }

    /// Fills the pixels of a square.
    fn square<M: Norm>(
        &self,
        norm: M,
        [columns, rows]: [Range<usize>; 2],
        job: Job,
        (out, memory): (&mut Output<'_, N>, &mut Memory<N>),
    ) {
        let pixels = memory.pixel_box(columns.clone(), rows.clone());
        let neighborhood = Neighborhood {
            ring: job.guess.ring,
            guess: None,
        };
        let Output::Values(values, out_rows) = &mut *out else {
            return;
        };
        let left = self.range.start;
        if !neighborhood.fits(&pixels) {
            self.one_by_one(rows, left + columns.start..left + columns.end, out);
            return;
        }
        let thinning = Thinning {
            depth: job.depth,
            distance: job.guess.distance,
        };
        let has_tiles = job.size[0] * job.size[1] < columns.len() * rows.len();
        let limit = self.pick(norm, &pixels, job, has_tiles.then_some(thinning), memory);
        let tiles = Tiles {
            columns,
            rows,
            size: job.size,
            left,
            lines: [&memory.lines[0], &memory.lines[1]],
            corner: [pixels.low[0], pixels.low[1]],
            limit,
            thinning,
            values,
        };
        let to = (&mut memory.sheet, &mut memory.rivals, &mut out_rows[..]);
        tiles.render(self.level, norm, to);
        while let Some([columns, rows]) = memory.sheet.unknown.pop() {
            let tile = Tile {
                block: self,
                depth: job.depth,
                rows,
                columns,
                guess: job.guess,
            };
            tile.render_further(out, memory);
        }
    }

    /// Picks the points that matter to a square; all keys below the limit that is returned are right.
    fn pick<M: Norm>(
        &self,
        norm: M,
        pixels: &PixelBox<N>,
        job: Job,
        thinning: Option<Thinning>,
        memory: &mut Memory<N>,
    ) -> f32 {
        let Memory {
            table,
            list,
            sheet,
            rivals,
            near,
            runs,
            ..
        } = memory;
        let cells = pixels.cells(job.guess.ring);
        table.runs(cells, runs);
        let points = Points {
            steps: &table.steps,
            numbers: None,
            runs,
            wants_numbers: false,
        };
        let rectangle = Rectangle {
            low: [0.0; 2],
            high: [0, 1].map(|axis| (pixels.high[axis] - pixels.low[axis]) as f32 * STEP),
        };
        dispatch!(self.level, simd => {
            list.sift(simd, norm, points, (pixels, Keep::Nearest(job.depth)), near);
            sheet.square.flatten(simd, norm, list, pixels.low);
            if let Some(thinning) = &thinning {
                let points = (&sheet.square, &rectangle);
                sheet.tile.thin(simd, norm, points, (thinning, rivals));
                core::mem::swap(&mut sheet.tile, &mut sheet.square);
            }
        });
        let border = pixels.border(cells) as f32 * STEP;
        norm.key_along_one_axis(border)
    }
}

/// The tiles of a square.
struct Tiles<'a> {
    /// Columns of the block and rows of the band.
    columns: Range<usize>,
    rows: Range<usize>,
    /// The columns and rows of a tile.
    size: [usize; 2],
    /// The first column of the block, in the window.
    left: usize,
    /// The coordinates of the columns and of the rows, in steps; those of the corner of the square.
    lines: [&'a [i32]; 2],
    corner: [i32; 2],
    /// Keys from here on may be wrong.
    limit: f32,
    thinning: Thinning,
    values: &'a Values,
}

impl Tiles<'_> {
    /// Fills the pixels.
    fn render<M: Norm>(
        &self,
        level: Level,
        norm: M,
        to: (&mut Sheet, &mut Rivals, &mut [&mut [f32]]),
    ) {
        match self.thinning.depth {
            1 => dispatch!(level, simd => self.render_with::<_, M, 1>(simd, norm, to)),
            2 => dispatch!(level, simd => self.render_with::<_, M, 2>(simd, norm, to)),
            _ => dispatch!(level, simd => self.render_with::<_, M, 4>(simd, norm, to)),
        }
    }

    #[inline(always)]
    fn render_with<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        (sheet, rivals, out): (&mut Sheet, &mut Rivals, &mut [&mut [f32]]),
    ) {
        let [width, height] = self.size;
        for row in self.rows.clone().step_by(height) {
            for column in self.columns.clone().step_by(width) {
                let rows = row..self.rows.end.min(row + height);
                let columns = column..self.columns.end.min(column + width);
                self.tile::<S, M, K>(simd, norm, [columns, rows], (sheet, rivals, out));
            }
        }
    }

    #[inline(always)]
    fn tile<S: Simd, M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        [columns, rows]: [Range<usize>; 2],
        (sheet, rivals, out): (&mut Sheet, &mut Rivals, &mut [&mut [f32]]),
    ) {
        let mut rectangle = Rectangle {
            low: [0.0; 2],
            high: [0.0; 2],
        };
        for (axis, range) in [&columns, &rows].into_iter().enumerate() {
            let line = self.lines[axis];
            let [a, b] = [line[range.start], line[range.end - 1]];
            rectangle.low[axis] = (a.min(b) - self.corner[axis]) as f32 * STEP;
            rectangle.high[axis] = (a.max(b) - self.corner[axis]) as f32 * STEP;
        }
        let Sheet {
            square,
            tile,
            row_terms,
            unknown,
        } = sheet;
        tile.thin(simd, norm, (square, &rectangle), (&self.thinning, rivals));
        if row_terms.len() < tile.len {
            row_terms.resize(tile.len.next_power_of_two(), [0.0; TILE_ROWS]);
        }
        let line = &self.lines[1][rows.start..];
        for first in (0..rows.len()).step_by(LANES) {
            let steps = i32x16::from_slice(simd, &line[first..first + LANES]) - self.corner[1];
            let places = steps.to_float::<f32x16<S>>() * STEP;
            let points = tile.y[..tile.len].iter().zip(&tile.rest[..tile.len]);
            for ((&y, &rest), terms) in points.zip(&mut *row_terms) {
                let key = norm.joins(norm.terms(places - y), f32x16::splat(simd, rest));
                key.store_slice(&mut terms[first..first + LANES]);
            }
        }
        let step = if columns.len() == 2 * LANES {
            columns.len()
        } else {
            LANES
        };
        for first in columns.clone().step_by(step) {
            let columns = first..columns.end.min(first + step);
            let part = Rows {
                rows: rows.clone(),
                columns: self.left + columns.start..self.left + columns.end,
                steps: &self.lines[0][first..],
                low: self.corner[0],
                points: &tile.x[..tile.len],
                row_terms,
                limit: self.limit,
                values: self.values,
            };
            let end = part.fill_with::<S, M, K>(simd, norm, out);
            if end < rows.end {
                unknown.push([columns, end..rows.end]);
            }
        }
    }
}

impl Sheet {
    pub(super) fn new() -> Self {
        Self {
            square: FlatPoints::new(),
            tile: FlatPoints::new(),
            row_terms: Vec::new(),
            unknown: Vec::new(),
        }
    }
}

impl FlatPoints {
    /// Takes all of a list; `corner` is the lower corner of the pixels.
    #[inline(always)]
    fn flatten<S: Simd, M: Norm, const N: usize>(
        &mut self,
        simd: S,
        norm: M,
        points: &PointList<N>,
        corner: [i32; N],
    ) {
        self.clear(points.len);
        self.len = points.len;
        for start in (0..points.len).step_by(LANES) {
            let at = start..start + LANES;
            let mut places = [f32x16::splat(simd, 0.0); N];
            for axis in 0..N {
                let steps = i32x16::from_slice(simd, &points.steps[axis][at.clone()]);
                places[axis] = (steps - corner[axis]).to_float::<f32x16<S>>() * STEP;
            }
            let mut rest = f32x16::splat(simd, 0.0);
            for axis in (2..N).rev() {
                rest = norm.joins(norm.terms(places[axis]), rest);
            }
            places[0].store_slice(&mut self.x[at.clone()]);
            places[1].store_slice(&mut self.y[at.clone()]);
            rest.store_slice(&mut self.rest[at]);
        }
    }
}
