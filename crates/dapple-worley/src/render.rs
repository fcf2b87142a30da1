//! Renders windows of a plane.
//!
//! The window is cut into bands of rows, which are distributed over threads, and each band into blocks of columns. The
//! feature points of a block and its neighborhood are generated once and stored in a table ([`table`]). Only these
//! tables depend on the number of axes ([`basis`]).
//!
//! A block is divided into squares of up to 64 × 64 pixels, and a square into tiles ([`square`]). For each square, and
//! then for each of its tiles, points that cannot be among the nearest are culled ([`cull`], [`flat`], then
//! [`candidates`]); the rest are the candidates. The pixels of a tile are compared with its candidates only, sixteen
//! adjacent pixels at once ([`kernel`]; [`track`] also identifies the nearest points). Neighboring slices of a volume
//! share their candidates. If a tile needs points beyond its neighborhood, the neighborhood grows. If coordinates in
//! it would no longer be exact, each pixel is searched individually.
//!
//! Where cells have few pixels, points are sorted into bins of pixels ([`bins`]), and each tile is compared with all
//! points of the bins around it ([`splat`]). For the distance to the edge of the Voronoi cell, the cells are drawn one
//! by one ([`edge`]).
//!
//! SIMD code is split into stages that communicate through memory. Each stage is compiled once for each parameter that
//! it depends on. Most stages support any metric, and the inner loops are compiled for the common metrics and numbers
//! of nearest points ([`levels`](crate::levels)).

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

/// Number of pixels (`f32`) in one register.
pub(crate) const LANES: usize = 16;

/// Number of `f64` in one register.
const F64_LANES: usize = LANES / 2;

/// Maximum number of rows in a band.
const BAND_ROWS: usize = 64;

/// Maximum number of columns in a block. With wider blocks, less work is repeated at their borders.
const BLOCK_COLUMNS: usize = 512;

/// Minimum number of columns in a block with more cells than [`MANY_CELLS`].
const FEW_COLUMNS: usize = BLOCK_COLUMNS / 4;

/// Number of cells in a block and its neighborhood above which narrower blocks are faster, because the points no longer
/// fit into a core's second-level cache.
const MANY_CELLS: u128 = 1 << 12;

/// A window to render, in a plane that cuts through the cells of the basis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture<'a> {
    pub(crate) basis: &'a dyn Basis,
    pub(crate) section: Section,
    pub(crate) window: &'a Window,
    /// Factor that converts window positions to cells.
    pub(crate) frequency: f64,
}

/// Output rows of a band. The variant is the quantity to compute.
pub(crate) enum Output<'a> {
    /// Values of a scalar texture.
    Values(Values, Vec<&'a mut [f32]>),
    /// Nearest points, one element for each rank: F1, F2, and so on.
    Features(Vec<FeatureRows<'a>>),
    /// Gradients of a texture, with interleaved components.
    Gradients(Tone, Vec<&'a mut [f32]>),
    /// Distances to the nearest edge of the Voronoi cell.
    Edges(Vec<&'a mut [f32]>),
}

impl Output<'_> {
    /// Returns the number of nearest points per pixel that the output needs.
    fn depth(&self) -> usize {
        match self {
            Self::Values(Values { tone, .. }, _) | Self::Gradients(tone, _) => tone.depth(),
            Self::Features(features) => features.len(),
            Self::Edges(_) => 2,
        }
    }

    /// Returns whether point ids are needed.
    fn wants_ids(&self) -> bool {
        match self {
            Self::Features(features) => features.iter().any(FeatureRows::wants_ids),
            _ => false,
        }
    }
}

impl Picture<'_> {
    /// Returns the number of bands in the window.
    pub(crate) fn n_bands(&self) -> usize {
        self.window.size[1].div_ceil(BAND_ROWS as u32) as usize
    }

    /// Iterates over the bands of a view, as lists of rows. There are no bands if there is no view.
    pub(crate) fn bands<'v, T>(
        &self,
        view: Option<RasterViewMut<'v, T>>,
    ) -> impl Iterator<Item = Vec<&'v mut [T]>> {
        let bands = view
            .into_iter()
            .flat_map(|view| view.bands(BAND_ROWS as u32));
        bands.map(|band| band.into_rows().collect())
    }

    /// Renders the bands of the window. With the feature `rayon`, they are rendered in parallel.
    pub(crate) fn render(&self, bands: Vec<Output<'_>>) {
        render_stack(vec![(*self, bands)]);
    }

    /// Returns the fixed-point coordinates of the columns. They are shared with the preceding image if equal.
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

    /// Returns the fixed-point coordinates along an axis of `n` rows, starting at row `first`. They are shared with
    /// the preceding image if equal.
    fn rows(&self, axis: usize, first: usize, n: usize, before: Option<&Band<'_>>) -> Arc<Line> {
        match before {
            Some(before) if before.picture.section.is_same_along(axis, &self.section) => {
                before.rows[axis].clone()
            }
            _ => {
                // Where all rows have the same coordinate, compute it once. (Zero times infinity is not a coordinate.)
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

    /// Returns the fixed-point coordinates of `len` columns or rows along one axis. For an upright plane, they equal
    /// the result of [`place`](Self::place), since the other component of the position then adds zero.
    fn line(&self, axis: usize, len: u32, position: impl Fn(u32) -> [f64; 2]) -> Line {
        let coordinate = |index| self.section.coordinate(axis, position(index)) * self.frequency;
        // Stop at the first coordinate that is not finite or out of range.
        let mut places: Vec<_> = (0..len)
            .map_while(|index| split(coordinate(index)))
            .collect();
        let is_finite = places.len() == len as usize;
        places.resize(len as usize, (0, 0));
        Line { places, is_finite }
    }

    /// Returns the fixed-point position of a pixel; `None` if it is not finite or out of range.
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

/// Maximum number of images of a stack that one thread renders together, with shared tables and candidates.
const STACK: usize = 16;

/// Renders several images with the same basis, frequency and window. With the feature `rayon`, they are rendered in
/// parallel.
pub(crate) fn render_stack<'a>(stack: Vec<(Picture<'a>, Vec<Output<'a>>)>) {
    // Share the column coordinates of equal images.
    let mut pictures: Vec<(Picture<'a>, Arc<Line>, Vec<Output<'a>>)> = Vec::new();
    for (picture, bands) in stack {
        let before = pictures.last();
        let columns = picture.columns(before.map(|(before, columns, _)| (before, columns)));
        pictures.push((picture, columns, bands));
    }
    // Create one job for each band of up to `STACK` images. Bands are popped from the end, so the last band comes
    // first.
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
    // Render the jobs. Each thread reuses its scratch memory.
    parallel::consume_with(jobs, Memory::new, |memory, _, (bands, outs)| {
        render_bands(level, &bands, outs, memory);
    });
}

/// Renders one band of several images. Bands of consecutive slices of a volume are rendered together.
fn render_bands(
    level: Level,
    mut bands: &[Band<'_>],
    mut outs: Vec<Output<'_>>,
    memory: &mut Memory,
) {
    let mut outs = &mut outs[..];
    while let Some(first) = bands.first() {
        // Take the longest run of bands that are slices of a volume.
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
        // Halve the blocks until the points of one fit into the cache.
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

/// A band of rows of an image, with the coordinates of its rows and columns.
struct Band<'a> {
    picture: Picture<'a>,
    /// The band's first row, in the window.
    first: usize,
    n_rows: usize,
    columns: Arc<Line>,
    /// The coordinates of the rows along every axis.
    rows: Vec<Arc<Line>>,
}

impl<'a> Band<'a> {
    /// Builds the band with this index. Coordinates are shared with `before`, the same band of the preceding image.
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

    /// Returns whether both bands are slices along the first two axes with the same columns and rows.
    fn is_slice(&self, other: &Self) -> bool {
        // Rows of a slice differ along the second axis only.
        let is_flat = |band: &Self| band.picture.section.row_axis() == Some(1);
        is_flat(self)
            && is_flat(other)
            && Arc::ptr_eq(&self.columns, &other.columns)
            && (0..2).all(|axis| Arc::ptr_eq(&self.rows[axis], &other.rows[axis]))
    }
}

/// The fixed-point coordinates of columns or rows along one axis: a cell, and steps within it.
struct Line {
    places: Vec<(i64, i32)>,
    /// Whether all coordinates are finite and in range.
    is_finite: bool,
}

impl Line {
    /// Returns the smallest and the largest cell of a range of coordinates.
    fn cells(&self, range: core::ops::Range<usize>) -> [i64; 2] {
        let [a, b] = [self.places[range.start].0, self.places[range.end - 1].0];
        [a.min(b), a.max(b)]
    }
}
