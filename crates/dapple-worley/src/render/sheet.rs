//! The most usual pictures: values with the Euclidean metric, in a plane along the first two axes.
//!
//! The other axes add the same to the keys of a point at all pixels, so the points are flat from here on. Those that
//! matter to a square are picked from the table once; for each tile of it they are thinned ([`thin`](super::thin)) and
//! compared. All of that happens in one piece, without going through memory or functions more than it must.

use super::block::{Block, Memory};
use super::kernel::Rows;
use super::shortlist::TILE_ROWS;
use super::sieve::{Keep, PointList, Points};
use super::thin::{FlatPoints, View};
use super::tile::{Guess, Neighborhood, Tile};
use super::{LANES, Output};
use crate::fixed::{STEP, STEPS};
use crate::metric::{Euclidean, Norm};
use crate::sink::Values;
use crate::{Axes, Metric, Space};
use core::ops::Range;
use fearless_simd::{dispatch, f32x16, i32x16, prelude::*};

/// What is worked with.
#[derive(Debug)]
pub(super) struct Sheet {
    /// The points that matter to a square, and those that do to a tile.
    square: FlatPoints,
    tile: FlatPoints,
    rivals: FlatPoints,
    row_terms: Vec<[f32; TILE_ROWS]>,
    /// Columns of the block and rows of the band that need points further away.
    unknown: Vec<[Range<usize>; 2]>,
}

/// The sides of the squares, and the columns and rows of their tiles.
const SIZES: [(usize, [usize; 2]); 3] = [(64, [32, 32]), (32, [32, 16]), (16, [16, 16])];

/// Squares are not wider than this many steps: in wider ones, almost all points matter.
const WIDEST_SQUARE: i32 = STEPS + STEPS / 2;

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
        let is_flat = {
            let v: [f64; N] = self.picture.plane.v.into();
            v[1] != 0.0 && v[2..].iter().all(|&part| part == 0.0)
        };
        let is_usual = is_flat && self.picture.worley.metric == Metric::Euclidean;
        let fits = |&(side, _): &(usize, [usize; 2])| {
            let [columns, rows] = [self.range.len(), self.n_rows].map(|n| 0..n.min(side));
            let pixels = memory.pixel_box(columns, rows);
            (0..2).all(|axis| pixels.high[axis] - pixels.low[axis] <= WIDEST_SQUARE)
        };
        let Some((side, size)) = SIZES.into_iter().find(fits).filter(|_| is_usual) else {
            return false;
        };
        for row in (0..self.n_rows).step_by(side) {
            for column in (0..self.range.len()).step_by(side) {
                let columns = column..self.range.len().min(column + side);
                let rows = row..self.n_rows.min(row + side);
                self.square([columns, rows], size, (depth, guess), (out, memory));
            }
        }
        true
    }

    /// Fills the pixels of a square.
    fn square(
        &self,
        [columns, rows]: [Range<usize>; 2],
        size: [usize; 2],
        (depth, guess): (usize, Guess),
        (out, memory): (&mut Output<'_, N>, &mut Memory<N>),
    ) {
        let pixels = memory.pixel_box(columns.clone(), rows.clone());
        let neighborhood = Neighborhood {
            ring: guess.ring,
            guess: None,
        };
        let left = self.range.start;
        if !neighborhood.fits(&pixels) {
            self.one_by_one(rows, left + columns.start..left + columns.end, out);
            return;
        }
        let cells = pixels.cells(guess.ring);
        let border = Euclidean.key_along_one_axis(pixels.border(cells) as f32 * STEP);
        let Memory {
            table,
            list,
            sheet,
            near,
            runs,
            lines,
            ..
        } = memory;
        table.runs(cells, runs);
        let points = Points {
            steps: &table.steps,
            numbers: None,
            runs,
            wants_numbers: false,
        };
        let nearby = guess.distance * guess.distance;
        dispatch!(self.level, simd => {
            list.sift(simd, Euclidean, points, (&pixels, Keep::Nearest(depth)), near);
            sheet.square.flatten(simd, list, pixels.low);
            if size[0] * size[1] < columns.len() * rows.len() {
                let sides = [0, 1].map(|axis| (pixels.high[axis] - pixels.low[axis]) as f32 * STEP);
                let view = View::new([[0.0; 2], sides], nearby);
                sheet.tile.thin(simd, &sheet.square, (&view, depth as u32), &mut sheet.rivals);
                core::mem::swap(&mut sheet.tile, &mut sheet.square);
            }
        });
        let Output::Values(values, out_rows) = &mut *out else {
            return;
        };
        let tiles = Tiles {
            columns,
            rows,
            size,
            left,
            lines: [&lines[0], &lines[1]],
            corner: [pixels.low[0], pixels.low[1]],
            limit: border,
            nearby,
            values,
        };
        match depth {
            1 => dispatch!(self.level, simd => tiles.render::<_, 1>(simd, sheet, out_rows)),
            2 => dispatch!(self.level, simd => tiles.render::<_, 2>(simd, sheet, out_rows)),
            _ => dispatch!(self.level, simd => tiles.render::<_, 4>(simd, sheet, out_rows)),
        }
        while let Some([columns, rows]) = memory.sheet.unknown.pop() {
            let tile = Tile {
                block: self,
                depth,
                rows,
                columns,
                guess,
            };
            tile.render_further(out, memory);
        }
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
    nearby: f32,
    values: &'a Values,
}

impl Tiles<'_> {
    /// Fills the pixels.
    #[inline(always)]
    fn render<S: Simd, const K: usize>(&self, simd: S, sheet: &mut Sheet, out: &mut [&mut [f32]]) {
        let [width, height] = self.size;
        for row in self.rows.clone().step_by(height) {
            for column in self.columns.clone().step_by(width) {
                let rows = row..self.rows.end.min(row + height);
                let columns = column..self.columns.end.min(column + width);
                self.tile::<S, K>(simd, [columns, rows], sheet, out);
            }
        }
    }

    #[inline(always)]
    fn tile<S: Simd, const K: usize>(
        &self,
        simd: S,
        [columns, rows]: [Range<usize>; 2],
        sheet: &mut Sheet,
        out: &mut [&mut [f32]],
    ) {
        let mut bounds = [[0.0; 2]; 2];
        for (axis, range) in [&columns, &rows].into_iter().enumerate() {
            let line = self.lines[axis];
            let [a, b] = [line[range.start], line[range.end - 1]];
            bounds[0][axis] = (a.min(b) - self.corner[axis]) as f32 * STEP;
            bounds[1][axis] = (a.max(b) - self.corner[axis]) as f32 * STEP;
        }
        let view = View::new(bounds, self.nearby);
        let Sheet {
            square,
            tile,
            rivals,
            row_terms,
            unknown,
            ..
        } = sheet;
        tile.thin(simd, square, (&view, K as u32), rivals);
        if row_terms.len() < tile.len {
            row_terms.resize(tile.len.next_power_of_two(), [0.0; TILE_ROWS]);
        }
        let line = &self.lines[1][rows.start..];
        for first in (0..rows.len()).step_by(LANES) {
            let steps = i32x16::from_slice(simd, &line[first..first + LANES]) - self.corner[1];
            let places = steps.to_float::<f32x16<S>>() * STEP;
            let points = tile.y[..tile.len].iter().zip(&tile.rest[..tile.len]);
            for ((&y, &rest), terms) in points.zip(&mut *row_terms) {
                let key = Euclidean.joins(Euclidean.terms(places - y), f32x16::splat(simd, rest));
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
            let end = part.fill_with::<S, _, K>(simd, Euclidean, out);
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
            rivals: FlatPoints::new(),
            row_terms: Vec::new(),
            unknown: Vec::new(),
        }
    }
}

impl FlatPoints {
    /// Takes all of a list; `corner` is the lower corner of the pixels.
    #[inline(always)]
    fn flatten<S: Simd, const N: usize>(
        &mut self,
        simd: S,
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
                rest = Euclidean.joins(Euclidean.terms(places[axis]), rest);
            }
            places[0].store_slice(&mut self.x[at.clone()]);
            places[1].store_slice(&mut self.y[at.clone()]);
            rest.store_slice(&mut self.rest[at]);
        }
    }
}
