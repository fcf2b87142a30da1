//! Many positions at once: a window of a plane.
//!
//! The window is cut into bands of rows, which threads share out, and blocks of columns. The feature points of a block
//! and its neighborhood are made once ([`table`]); then, for each tile of up to 32 × 32 pixels, those that matter to it
//! are picked out ([`sieve`], then [`thin`]), and only those are compared at its pixels, sixteen side by side
//! ([`kernel`]; [`track`], where it matters which points they are). The most usual pictures go a shorter way through the
//! same stages ([`sheet`]). Where a tile needs points further away than its neighborhood reaches, the
//! neighborhood grows; where that would not be exact, single positions are searched. Where cells have few pixels, points
//! are sorted by the pixels near to them ([`bins`]), and compared at all of these ([`splat`]). Distances to the edges of
//! cells are a second pass over the nearest points ([`edge`]).
//!
//! What runs in registers are stages with nothing but memory between them, so that each is compiled only for what it
//! depends on.

mod bins;
mod block;
mod edge;
mod kernel;
mod sheet;
mod shortlist;
mod sieve;
mod splat;
mod table;
mod thin;
mod tile;
mod track;

use crate::features::FeatureRows;
use crate::fixed::{Place, split};
use crate::sink::{Tone, Values};
use crate::{Axes, Plane, Space, Worley};
use block::{Block, Memory};
use dapple_raster::{RasterViewMut, Window, simd};
use fearless_simd::Level;
use glam::DVec2;
use std::sync::Arc;

pub(crate) use edge::render_edges;

/// The pixels of a register.
pub(crate) const LANES: usize = 16;

/// The most rows of a band.
const BAND_ROWS: usize = 64;

/// The most columns of a block.
const BLOCK_COLUMNS: usize = 128;

/// A window of a plane through the basis.
#[derive(Clone, Copy)]
pub(crate) struct Picture<'a, const N: usize>
where
    Axes: Space<N>,
{
    pub(crate) worley: &'a Worley<N>,
    pub(crate) plane: &'a Plane<N>,
    pub(crate) window: &'a Window,
    /// What positions are multiplied by.
    pub(crate) frequency: f64,
}

/// The rows of a band, and what is to be put into them.
pub(crate) enum Output<'a, const N: usize> {
    /// Values of a texture.
    Values(Values, Vec<&'a mut [f32]>),
    /// The nearest points, as many as there are members.
    Features(Vec<FeatureRows<'a, N>>),
    /// Gradients of a texture.
    Gradients(Tone, Vec<&'a mut [[f32; N]]>),
}

impl<const N: usize> Output<'_, N> {
    /// The greatest n of `F_n` that is needed.
    fn depth(&self) -> usize {
        match self {
            Self::Values(Values { tone, .. }, _) | Self::Gradients(tone, _) => tone.depth(),
            Self::Features(features) => features.len(),
        }
    }

    /// Whether ids are needed.
    fn wants_ids(&self) -> bool {
        match self {
            Self::Features(features) => features.iter().any(|rows| !rows.id.is_empty()),
            _ => false,
        }
    }
}

impl<const N: usize> Picture<'_, N>
where
    Axes: Space<N>,
{
    /// How many bands the window has.
    pub(crate) fn n_bands(&self) -> usize {
        self.window.size[1].div_ceil(BAND_ROWS as u32) as usize
    }

    /// The rows of each band of a view; no bands, if there is no view.
    pub(crate) fn bands<'v, T>(
        &self,
        view: Option<RasterViewMut<'v, T>>,
    ) -> impl Iterator<Item = Vec<&'v mut [T]>> {
        let bands = view
            .into_iter()
            .flat_map(|view| view.bands(BAND_ROWS as u32));
        bands.map(|band| band.into_rows().collect())
    }

    /// Fills the bands of the window, on all cores where the feature `rayon` is on.
    pub(crate) fn render(&self, bands: Vec<Output<'_, N>>) {
        self.render_at(simd::level(), bands);
    }

    /// As [`render`](Self::render), at a given SIMD level.
    pub(crate) fn render_at(&self, level: Level, bands: Vec<Output<'_, N>>) {
        render_stack(level, vec![(*self, bands)]);
    }

    /// The coordinates of the columns; those of the picture before, if they are the same.
    fn columns(&self, before: Option<(&Self, &Arc<Line>)>) -> Arc<Line> {
        match before {
            Some((before, columns)) if before.plane.is_same_along(0, self.plane) => columns.clone(),
            _ => Arc::new(self.line(0, self.window.size[0], |column| {
                DVec2::new(self.window.column_x(column), 0.0)
            })),
        }
    }

    /// The coordinates of `n` rows from `first` on; along each axis those of the picture before, if they are the same.
    fn rows(&self, [first, n]: [usize; 2], before: Option<&Shelf<'_, N>>) -> [Arc<Line>; N] {
        core::array::from_fn(|axis| match before {
            Some(before) if before.picture.plane.is_same_along(axis, self.plane) => {
                before.rows[axis].clone()
            }
            _ => {
                // Where all rows are at the same place, the first one does for all. (Zero times infinity is no place.)
                let last = self.window.row_y((first + n) as u32 - 1);
                let is_level = self.plane.v.into()[axis] == 0.0 && last.is_finite();
                let mut line = self.line(axis, if is_level { 1 } else { n as u32 }, |row| {
                    DVec2::new(0.0, self.window.row_y(first as u32 + row))
                });
                line.places.resize(n, line.places[0]);
                Arc::new(line)
            }
        })
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

/// So many pictures of a stack are filled by one thread, so that they can share what they look at.
const STACK: usize = 16;

/// Fills the bands of pictures of the same basis, frequency and window, on all cores where the feature `rayon` is on.
pub(crate) fn render_stack<'a, const N: usize>(
    level: Level,
    stack: Vec<(Picture<'a, N>, Vec<Output<'a, N>>)>,
) where
    Axes: Space<N>,
{
    let mut pictures: Vec<(Picture<'a, N>, Arc<Line>, Vec<Output<'a, N>>)> = Vec::new();
    for (picture, bands) in stack {
        let before = pictures.last();
        let columns = picture.columns(before.map(|(before, columns, _)| (before, columns)));
        pictures.push((picture, columns, bands));
    }
    let mut jobs = Vec::new();
    for pictures in pictures.chunks_mut(STACK) {
        for band in (0..pictures[0].0.n_bands()).rev() {
            let bands = pictures.iter_mut().filter_map(|(picture, columns, bands)| {
                let out = bands.pop()?;
                Some((*picture, columns.clone(), out))
            });
            jobs.push((band, bands.collect()));
        }
    }
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        use std::sync::{Mutex, PoisonError};
        // Memory goes from job to job, since it takes time to be had anew.
        let pool = Mutex::new(Vec::new());
        let lock = || pool.lock().unwrap_or_else(PoisonError::into_inner);
        jobs.into_par_iter().for_each(|(band, pictures)| {
            let mut memory = lock().pop().unwrap_or_else(Memory::new);
            render_band(level, band, pictures, &mut memory);
            lock().push(memory);
        });
    }
    #[cfg(not(feature = "rayon"))]
    {
        let mut memory = Memory::new();
        for (band, pictures) in jobs {
            render_band(level, band, pictures, &mut memory);
        }
    }
}

/// Fills the same band of several pictures, each with its columns.
fn render_band<const N: usize>(
    level: Level,
    band: usize,
    pictures: Vec<(Picture<'_, N>, Arc<Line>, Output<'_, N>)>,
    memory: &mut Memory<N>,
) where
    Axes: Space<N>,
{
    let first = band * BAND_ROWS;
    let mut shelves: Vec<Shelf<'_, N>> = Vec::with_capacity(pictures.len());
    for (picture, columns, out) in pictures {
        let n_rows = BAND_ROWS.min(picture.window.size[1] as usize - first);
        shelves.push(Shelf {
            columns,
            rows: picture.rows([first, n_rows], shelves.last()),
            picture,
            out,
        });
    }
    let n_columns = shelves[0].columns.places.len();
    for start in (0..n_columns).step_by(BLOCK_COLUMNS) {
        for shelf in &mut shelves {
            let block = Block {
                picture: &shelf.picture,
                level,
                columns: &shelf.columns,
                rows: &shelf.rows,
                n_rows: shelf.rows[0].places.len(),
                first,
                range: start..n_columns.min(start + BLOCK_COLUMNS),
            };
            block.render(&mut shelf.out, memory);
        }
    }
}

/// A band of a picture.
struct Shelf<'a, const N: usize>
where
    Axes: Space<N>,
{
    picture: Picture<'a, N>,
    out: Output<'a, N>,
    columns: Arc<Line>,
    /// Along every axis.
    rows: [Arc<Line>; N],
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
