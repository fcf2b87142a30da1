//! Rendering of windows of a plane.
//!
//! The window is cut into bands of rows, which are distributed over threads, and blocks of columns. The feature points
//! of a block and its neighborhood are generated once ([`table`]). Only these tables depend on the number of axes
//! ([`basis`]). For each square of up to 64 × 64 pixels, and then for each of its tiles ([`square`]), the points that
//! may be among the nearest are selected: the candidates ([`cull`], [`flat`], then [`candidates`]). Only these are
//! compared at the pixels of the tile, sixteen side by side ([`kernel`]; [`track`] also finds which points they are).
//! Slices of a volume that lie near one another share their candidates. Where a tile needs points further away than its
//! neighborhood reaches, the neighborhood grows; where that would not be exact, single positions are searched. Where
//! cells have few pixels, points are sorted by the pixels near to them ([`bins`]), and compared at all of these
//! ([`splat`]). For the distance to the edge of the Voronoi cell, the cells are drawn one by one ([`edge`]).
//!
//! The parts that run in registers are stages with only memory between them, so that each is compiled only for the
//! parameters it depends on, and once: most for any metric, the inner loops for the usual ones and their usual depths
//! ([`levels`](crate::levels)).

mod area;
mod basis;
mod bins;
mod block;
mod candidates;
mod cull;
mod edge;
mod flat;
mod kernel;
mod planes;
mod splat;
mod square;
mod table;
mod track;

use crate::features::FeatureRows;
use crate::fixed::{FlatPlace, MOST_AXES, split};
use crate::plane::Section;
use crate::sink::{Tone, Values};
use block::{Block, Memory};
use dapple_raster::{RasterViewMut, Window, parallel, simd};
use fearless_simd::Level;
use std::sync::Arc;

pub(crate) use basis::Basis;

/// The number of pixels in a register.
pub(crate) const LANES: usize = 16;

/// The number of `f64` in a register.
const F64_LANES: usize = LANES / 2;

/// The largest number of rows of a band.
const BAND_ROWS: usize = 64;

/// The largest number of columns of a block: the wider blocks are, the less is done twice at their borders.
const BLOCK_COLUMNS: usize = 512;

/// The smallest number of columns of a block that has more cells than [`MANY_CELLS`].
const FEW_COLUMNS: usize = BLOCK_COLUMNS / 4;

/// The number of cells of a block and around it from which on wide blocks lose more than they gain: the points of so
/// many fill the second cache of a core.
const MANY_CELLS: u128 = 1 << 12;

/// A window of a plane through the basis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture<'a> {
    pub(crate) basis: &'a dyn Basis,
    pub(crate) section: Section,
    pub(crate) window: &'a Window,
    /// The factor by which positions are multiplied.
    pub(crate) frequency: f64,
}

/// The rows of a band, by the kind of their contents.
pub(crate) enum Output<'a> {
    /// The values of a texture.
    Values(Values, Vec<&'a mut [f32]>),
    /// The nearest points; the number of elements is the number of points.
    Features(Vec<FeatureRows<'a>>),
    /// The gradients of a texture, their components one after the other.
    Gradients(Tone, Vec<&'a mut [f32]>),
    /// The distances to the edges of Voronoi cells.
    Edges(Vec<&'a mut [f32]>),
}

impl Output<'_> {
    /// The greatest n for which `F_n` is needed.
    fn depth(&self) -> usize {
        match self {
            Self::Values(Values { tone, .. }, _) | Self::Gradients(tone, _) => tone.depth(),
            Self::Features(features) => features.len(),
            Self::Edges(_) => 2,
        }
    }

    /// Whether ids are needed.
    fn wants_ids(&self) -> bool {
        match self {
            Self::Features(features) => features.iter().any(FeatureRows::wants_ids),
            _ => false,
        }
    }
}

impl Picture<'_> {
    /// The number of bands of the window.
    pub(crate) fn n_bands(&self) -> usize {
        self.window.size[1].div_ceil(BAND_ROWS as u32) as usize
    }

    /// The rows of each band of a view; no bands without a view.
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
    pub(crate) fn render(&self, bands: Vec<Output<'_>>) {
        render_stack(vec![(*self, bands)]);
    }

    /// The coordinates of the columns; shared with the picture before, if they are the same.
    fn columns(&self, before: Option<(&Self, &Arc<Line>)>) -> Arc<Line> {
        match before {
            Some((before, columns)) if before.section.is_same_along(0, &self.section) => {
                columns.clone()
            }
            _ => Arc::new(self.line(0, self.window.size[0], |column| {
                [self.window.column_x(column), 0.0]
            })),
        }
    }

    /// The coordinates of `n` rows from `first` on along an axis; shared with the picture before, if they are the same.
    fn rows(&self, axis: usize, first: usize, n: usize, before: Option<&Band<'_>>) -> Arc<Line> {
        match before {
            Some(before) if before.picture.section.is_same_along(axis, &self.section) => {
                before.rows[axis].clone()
            }
            _ => {
                // Where all rows are at the same place, one row is enough. (Zero times infinity is no place.)
                let last = self.window.row_y((first + n) as u32 - 1);
                let is_level = self.section.v[axis] == 0.0 && last.is_finite();
                let mut line = self.line(axis, if is_level { 1 } else { n as u32 }, |row| {
                    [0.0, self.window.row_y(first as u32 + row)]
                });
                line.places.resize(n, line.places[0]);
                Arc::new(line)
            }
        }
    }

    /// The coordinates of columns or rows along one axis. They equal those of [`place`](Self::place) if the plane is
    /// upright, since the other part of the position then adds zero.
    fn line(&self, axis: usize, len: u32, position: impl Fn(u32) -> [f64; 2]) -> Line {
        let coordinate = |index| self.section.coordinate(axis, position(index)) * self.frequency;
        let mut places: Vec<_> = (0..len)
            .map_while(|index| split(coordinate(index)))
            .collect();
        let is_finite = places.len() == len as usize;
        places.resize(len as usize, (0, 0));
        Line { places, is_finite }
    }

    /// The place of a pixel.
    fn place(&self, column: usize, row: usize) -> Option<FlatPlace> {
        let position = self.window.position(column as u32, row as u32);
        let mut place = FlatPlace {
            cell: [0; MOST_AXES],
            steps: [0; MOST_AXES],
        };
        for axis in 0..self.section.n_axes {
            let coordinate = self.section.coordinate(axis, position) * self.frequency;
            (place.cell[axis], place.steps[axis]) = split(coordinate)?;
        }
        Some(place)
    }
}

/// The number of pictures of a stack that one thread fills, so that they share tables and candidates.
const STACK: usize = 16;

/// Renders several pictures of the same basis, frequency and window, on all cores where the feature `rayon` is on.
pub(crate) fn render_stack<'a>(stack: Vec<(Picture<'a>, Vec<Output<'a>>)>) {
    let mut pictures: Vec<(Picture<'a>, Arc<Line>, Vec<Output<'a>>)> = Vec::new();
    for (picture, bands) in stack {
        let before = pictures.last();
        let columns = picture.columns(before.map(|(before, columns, _)| (before, columns)));
        pictures.push((picture, columns, bands));
    }
    let mut jobs = Vec::new();
    for pictures in pictures.chunks_mut(STACK) {
        for index in (0..pictures[0].0.n_bands()).rev() {
            let (mut bands, mut outs): (Vec<Band<'a>>, _) = (Vec::new(), Vec::new());
            for (picture, columns, rest) in &mut *pictures {
                if let Some(out) = rest.pop() {
                    bands.push(Band::new(*picture, index, columns.clone(), bands.last()));
                    outs.push(out);
                }
            }
            jobs.push((bands, outs));
        }
    }
    let level = simd::level();
    parallel::consume_with(jobs, Memory::new, |memory, _, (bands, outs)| {
        render_bands(level, &bands, outs, memory);
    });
}

/// Fills the same band of several pictures. Neighbors that are slices of a volume are filled together.
fn render_bands(
    level: Level,
    mut bands: &[Band<'_>],
    mut outs: Vec<Output<'_>>,
    memory: &mut Memory,
) {
    let mut outs = &mut outs[..];
    while let Some(first) = bands.first() {
        let n = bands
            .iter()
            .take_while(|band| first.is_slice(band))
            .count()
            .max(1);
        let (together, others) = bands.split_at(n);
        let (out, others_out) = outs.split_at_mut(n);
        let n_columns = first.columns.places.len();
        let block = |start: usize, width: usize| Block {
            bands: together,
            level,
            range: start..n_columns.min(start + width),
        };
        let mut width = BLOCK_COLUMNS;
        while width > FEW_COLUMNS && block(0, width).has_many_cells() {
            width /= 2;
        }
        for start in (0..n_columns).step_by(width) {
            block(start, width).render(out, memory);
        }
        (bands, outs) = (others, others_out);
    }
}

/// A band of rows of a picture, with the coordinates of its rows and columns.
struct Band<'a> {
    picture: Picture<'a>,
    /// The first row of the band, in the window.
    first: usize,
    n_rows: usize,
    columns: Arc<Line>,
    /// The coordinates of the rows along every axis.
    rows: Vec<Arc<Line>>,
}

impl<'a> Band<'a> {
    /// The band with this index; `before` is the band of another picture, with which coordinates are shared.
    fn new(picture: Picture<'a>, index: usize, columns: Arc<Line>, before: Option<&Self>) -> Self {
        let first = index * BAND_ROWS;
        let n_rows = BAND_ROWS.min(picture.window.size[1] as usize - first);
        let axes = 0..picture.section.n_axes;
        let rows = axes.map(|axis| picture.rows(axis, first, n_rows, before));
        Self {
            first,
            n_rows,
            rows: rows.collect(),
            columns,
            picture,
        }
    }

    /// Whether this band and another one are slices along the first two axes with the same columns and rows.
    fn is_slice(&self, other: &Self) -> bool {
        let is_flat = |band: &Self| band.picture.section.row_axis() == Some(1);
        is_flat(self)
            && is_flat(other)
            && Arc::ptr_eq(&self.columns, &other.columns)
            && (0..2).all(|axis| Arc::ptr_eq(&self.rows[axis], &other.rows[axis]))
    }
}

/// The coordinates of columns or rows along one axis: the cell, and the steps within it.
struct Line {
    places: Vec<(i64, i32)>,
    /// Whether all coordinates have a place.
    is_finite: bool,
}

impl Line {
    /// The first and the last cell of a range of coordinates.
    fn cells(&self, range: core::ops::Range<usize>) -> [i64; 2] {
        let [a, b] = [self.places[range.start].0, self.places[range.end - 1].0];
        [a.min(b), a.max(b)]
    }
}
