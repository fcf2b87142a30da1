//! Renders noise windows row by row.
//!
//! The pixels of a row share all coordinates except the first. A column of corners is therefore blended along the
//! other axes once per row, and each pixel interpolates between two columns. Every corner is hashed once per band of
//! rows.

use crate::GradientNoise;
use crate::gradient::{Column, MOST_CORNERS, Place, corner, corners, fade};
use dapple_raster::simd::{self, dispatch};
use dapple_raster::{RasterError, RasterViewMut, Window};
use std::mem;
use std::ops::Range;

/// Number of pixel rows in a band, the unit of parallel work.
const ROWS: u32 = 32;

/// Minimum mean run length, in pixels, for rendering runs with the widest registers.
const LONG: usize = 24;

/// The data that all rows of a window share: cells, offsets and fade values of its columns of pixels.
pub(crate) struct Lines<'a, const N: usize> {
    noise: &'a GradientNoise<N>,
    window: &'a Window<N>,
    /// Coordinates that all pixels share along the axes after the second; the first two entries are unused.
    rest: [Place; N],
    /// First coordinates of the columns of corners.
    columns: Vec<i64>,
    /// Runs of pixels in the same column of cells, from left to right.
    runs: Vec<Run>,
    /// Offset of each pixel in its cell, from 0 to 1.
    offsets: Vec<f32>,
    fades: Vec<f32>,
}

struct Run {
    cell: i64,
    /// Whether the first coordinates of the pixels are finite.
    is_finite: bool,
    /// Indices into [`Lines::columns`] of the corners on the left and on the right.
    sides: [usize; 2],
    pixels: Range<usize>,
}

/// The corners around a row of cells, and scratch memory for a row of pixels.
struct Corners<const N: usize> {
    /// Coordinates of the row of cells; the first is unused.
    cell: [i64; N],
    /// Lines of corners, in the order of [`corner`].
    lines: Vec<Line<N>>,
    /// Columns of corners, blended for a row of pixels.
    columns: Vec<Column>,
}

/// The gradients along a line of the lattice.
struct Line<const N: usize> {
    /// Coordinates of the corners; the first is unused.
    at: [i64; N],
    gradients: Vec<[f32; N]>,
}

impl<'a, const N: usize> Lines<'a, N> {
    pub(crate) fn new(noise: &'a GradientNoise<N>, window: &'a Window<N>) -> Self {
        let mut columns = Vec::new();
        let mut runs: Vec<Run> = Vec::new();
        let mut offsets = Vec::with_capacity(window.size[0] as usize);
        for column in 0..window.size[0] {
            let place = Place::of(noise.moved(window.column_x(column), 0));
            match runs.last_mut() {
                Some(run) if run.holds(place) => run.pixels.end += 1,
                last => {
                    let run = Run::new(place, last.as_deref(), &mut columns, offsets.len());
                    runs.push(run);
                }
            }
            offsets.push(place.offset);
        }
        Self {
            noise,
            window,
            rest: core::array::from_fn(|axis| Place::of(noise.moved(window.depth(axis), axis))),
            columns,
            runs,
            fades: offsets.iter().map(|&offset| fade(offset)).collect(),
            offsets,
        }
    }

    /// Renders the window into `out`, on all cores if the feature `rayon` is enabled.
    pub(crate) fn render(&self, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        self.window.check_size(out.size())?;
        out.for_each_band(ROWS, |first, mut band| {
            let mut corners = Corners {
                cell: [0; N],
                lines: Vec::new(),
                columns: Vec::new(),
            };
            for (row, values) in (first..).zip(band.rows_mut()) {
                self.fill_row(row, values, &mut corners);
            }
        });
        Ok(())
    }

    fn fill_row(&self, row: u32, values: &mut [f32], corners: &mut Corners<N>) {
        let mut places = self.rest;
        places[..2].fill(Place::of(self.noise.moved(self.window.row_y(row), 1)));
        if places.iter().any(|place| !place.offset.is_finite()) {
            values.fill(f32::NAN);
            return;
        }
        corners.move_to(places.map(|place| place.cell), &self.columns, self.noise);
        corners.blend(&places.map(|place| place.offset), self.columns.len());
        if values.len() >= LONG * self.runs.len() {
            dispatch!(simd::level(), _simd => self.fill_runs(values, &corners.columns));
        } else {
            self.fill_runs(values, &corners.columns);
        }
    }

    /// Interpolates the values of a row of pixels between the blended columns of corners.
    #[inline(always)]
    fn fill_runs(&self, values: &mut [f32], columns: &[Column]) {
        for run in &self.runs {
            let pixels = run.pixels.clone();
            let sides = run.sides.map(|side| columns[side]);
            let (offsets, fades) = (&self.offsets[pixels.clone()], &self.fades[pixels.clone()]);
            let values = &mut values[pixels];
            if !run.is_finite {
                values.fill(f32::NAN);
                continue;
            }
            for ((value, &t), &by) in values.iter_mut().zip(offsets).zip(fades) {
                *value = Column::between(sides, t, by);
            }
        }
    }
}

impl Run {
    /// Starts a run at `pixel`. Columns of corners that the previous run does not share are appended to `columns`.
    fn new(place: Place, before: Option<&Self>, columns: &mut Vec<i64>, pixel: usize) -> Self {
        let cell = place.cell;
        let mut add = |column| {
            columns.push(column);
            columns.len() - 1
        };
        let sides = match before {
            Some(before) if before.cell.wrapping_add(1) == cell => {
                [before.sides[1], add(cell.wrapping_add(1))]
            }
            Some(before) if before.cell.wrapping_sub(1) == cell => [add(cell), before.sides[0]],
            _ => [add(cell), add(cell.wrapping_add(1))],
        };
        Self {
            cell,
            is_finite: place.offset.is_finite(),
            sides,
            pixels: pixel..pixel + 1,
        }
    }

    fn holds(&self, place: Place) -> bool {
        self.cell == place.cell && self.is_finite == place.offset.is_finite()
    }
}

impl<const N: usize> Corners<N> {
    /// Moves to the row of cells that contains `cell`. Lines of corners that both rows share are reused.
    fn move_to(&mut self, mut cell: [i64; N], columns: &[i64], noise: &GradientNoise<N>) {
        cell[0] = 0;
        if self.cell == cell && !self.lines.is_empty() {
            return;
        }
        let mut before = mem::take(&mut self.lines);
        self.cell = cell;
        let level = simd::level();
        self.lines = (0..corners(N))
            .map(|index| {
                let at = corner(cell, index);
                match before.iter().position(|line| line.at == at) {
                    Some(known) => before.swap_remove(known),
                    None => Line {
                        at,
                        gradients: noise.line(level, at, columns),
                    },
                }
            })
            .collect();
    }

    /// Blends the columns for a row of pixels with the given offsets within their cells; the first offset is unused.
    fn blend(&mut self, offsets: &[f32; N], count: usize) {
        let mut lines: [&[[f32; N]]; MOST_CORNERS] = [&[]; MOST_CORNERS];
        for (line, known) in lines.iter_mut().zip(&self.lines) {
            *line = &known.gradients;
        }
        self.columns.resize(count, Column::default());
        let columns = &mut self.columns[..count];
        dispatch!(simd::level(), _simd => blend(lines, offsets, columns));
    }
}

/// Blends the gradients along lines of corners; each line is at least as long as `columns`.
#[inline(always)]
fn blend<const N: usize>(
    mut lines: [&[[f32; N]]; MOST_CORNERS],
    offsets: &[f32; N],
    columns: &mut [Column],
) {
    // Equal lengths allow the compiler to drop bounds checks.
    for line in &mut lines[..corners(N)] {
        *line = &line[..columns.len()];
    }
    for index in 0..columns.len() {
        let mut corner = [Column::default(); MOST_CORNERS];
        for line in 0..corners(N) {
            corner[line] = Column::of(lines[line][index], line, offsets);
        }
        columns[index] = Column::blend(corner, offsets);
    }
}
