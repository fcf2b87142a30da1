//! Many positions at once: a window of a plane.
//!
//! The window is cut into bands of rows, which threads share out, and blocks of columns. The feature points of a block
//! and its neighborhood are made once; then, for each tile of up to 16 × 16 pixels, those that matter to it are picked
//! out, and only those are compared at its pixels, sixteen side by side. Where a tile needs points further away than
//! its neighborhood reaches, the neighborhood grows; where that would not be exact, single positions are searched.
//!
//! What runs in registers are three stages with nothing but memory between them ([`table`], [`cull`], [`kernel`]), so
//! that each is compiled only for what it depends on.

mod block;
mod cull;
mod kernel;
mod table;
mod tile;

use crate::fixed::{Place, split};
use crate::sink::Values;
use crate::{Axes, Plane, Space, Worley, simd};
use block::{Block, Memory};
use dapple_raster::{RasterViewMut, Window};
use fearless_simd::Level;
use glam::DVec2;

/// The pixels of a register.
pub(crate) const LANES: usize = 16;

/// The most rows of a band.
const BAND_ROWS: usize = 64;

/// The most columns of a block.
const BLOCK_COLUMNS: usize = 256;

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
        let columns = self.line(0, self.window.size[0], |column| {
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
            self.line(axis, out.len() as u32, |row| {
                DVec2::new(0.0, self.window.row_y(first as u32 + row))
            })
        });
        for start in (0..columns.places.len()).step_by(BLOCK_COLUMNS) {
            let end = columns.places.len().min(start + BLOCK_COLUMNS);
            let block = Block {
                picture: self,
                level,
                columns,
                rows: &rows,
                first,
                range: start..end,
            };
            block.render(out, memory);
        }
    }

    /// The coordinates of columns or rows along one axis. They are those of [`place`](Self::place) if the plane is
    /// upright, for then the other part of the position adds zero.
    fn line(&self, axis: usize, len: u32, position: impl Fn(u32) -> DVec2) -> Line {
        let coordinate = |index| self.plane.coordinate(axis, position(index)) * self.frequency;
        let mut places: Vec<_> = (0..len)
            .map_while(|index| split(coordinate(index)))
            .collect();
        let is_finite = places.len() == len as usize;
        places.resize(len as usize, (0, 0));
        Line { places, is_finite }
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
    /// The first and the last cell of some of them.
    fn cells(&self, range: core::ops::Range<usize>) -> [i64; 2] {
        let [a, b] = [self.places[range.start].0, self.places[range.end - 1].0];
        [a.min(b), a.max(b)]
    }
}
