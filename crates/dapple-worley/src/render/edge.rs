//! Pictures of the distance to the edge of the Voronoi cell.
//!
//! First the nearest point of every pixel is found, by the kernel that tells which points are the nearest. Its cell is a
//! convex polygon, so the pixels of a row with the same nearest point follow one another: a *run*. The edges that matter to
//! all pixels of a cell within a block are picked once, and the distance to each of them is linear along a run.
//!
//! The distances of a run are computed in `f64` with an error below [`ERROR`]. Where that leaves open which `f32` is the
//! nearest, the pixel is computed as [`Worley::edge_distance`] does: from whole numbers of steps, exactly up to the root
//! and the quotient.

use super::basis::first;
use super::block::{LONGEST_SIDE, MOST_CELLS};
use super::square::Guess;
use super::table::{CellBox, Table};
use super::{BAND_ROWS, BLOCK_COLUMNS, LANES, Line, Output, Picture};
use crate::features::{FeatureRows, flattened};
use crate::fixed::{MOST_AXES, STEP, STEP_BITS, STEPS, cells};
use core::ops::Range;
use dapple_raster::{Raster, RasterError, RasterViewMut, simd};
use fearless_simd::{dispatch, f32x16, f64x8, i32x16, prelude::*};
use std::sync::Arc;

/// The distances of a run are known to be this exact, in cells: a dozen products and sums of numbers below 8, each rounded
/// to 2⁻⁵³ of itself.
const ERROR: f64 = 1.0 / (1_u64 << 44) as f64;

/// Ways are shorter than this many cells along each axis, so that they are exact in `f32` and their squares in `f64`.
const FARTHEST: i32 = 4;

/// Fills a picture of a basis with `N` axes and the Euclidean metric with the distances to the edges of its cells, on all
/// cores where the feature `rayon` is on.
pub(super) fn render_edges<const N: usize>(
    picture: &Picture<'_>,
    out: RasterViewMut<'_, f32>,
) -> Result<(), RasterError> {
    let bands = out.bands(BAND_ROWS as u32).zip((0..).step_by(BAND_ROWS));
    let bands: Vec<_> = bands.collect();
    let fill = |memory: &mut Memory<N>, (mut out, first): (RasterViewMut<'_, f32>, i64)| {
        let window = picture.window.crop([0, first], out.size())?;
        let band = Band::new(Picture {
            window: &window,
            ..*picture
        })?;
        let mut rows: Vec<_> = out.rows_mut().collect();
        for start in (0..window.size[0] as usize).step_by(BLOCK_COLUMNS) {
            let end = (start + BLOCK_COLUMNS).min(window.size[0] as usize);
            band.fill(start..end, &mut rows, memory);
        }
        Ok(())
    };
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        bands.into_par_iter().map_init(Memory::new, fill).collect()
    }
    #[cfg(not(feature = "rayon"))]
    {
        let mut memory = Memory::new();
        bands
            .into_iter()
            .try_for_each(|band| fill(&mut memory, band))
    }
}

/// A band of rows, with the nearest point of each pixel.
struct Band<'a, const N: usize> {
    picture: Picture<'a>,
    columns: Arc<Line>,
    /// Along every axis.
    rows: [Arc<Line>; N],
    /// The ways from the nearest points to the pixels, in cells.
    ways: Raster<[f32; N]>,
}

/// Per-thread scratch memory.
struct Memory<const N: usize> {
    table: Table,
    /// The points of the table in a row of cells.
    found: Vec<Range<usize>>,
    /// The coordinates of the columns, and of the rows along the other axes, in steps from the corner of the table. After
    /// the last column there is room for a register.
    lines: [Vec<i32>; N],
    pieces: Vec<Piece<N>>,
    /// The piece of each point of the table, if it has one.
    piece_of: Vec<Option<u32>>,
    runs: Vec<Run>,
    edges: Vec<Edge<N>>,
}

/// The part of a Voronoi cell that lies in a block.
#[derive(Clone, Debug)]
struct Piece<const N: usize> {
    /// The feature point, in steps from the corner of the table.
    point: [i32; N],
    /// The smallest and the largest coordinates of its pixels.
    low: [i32; N],
    high: [i32; N],
    /// Its edges; none where those of single pixels must be searched.
    edges: Option<Range<usize>>,
}

/// Pixels next to one another in a row, of one piece.
#[derive(Clone, Debug)]
struct Run {
    row: usize,
    /// Columns of the block.
    columns: Range<usize>,
    piece: usize,
}

/// A plane halfway between a feature point and another: its distance from a place that is `way` from the first point is
/// `way · normal + half`.
#[derive(Clone, Copy, Debug)]
struct Edge<const N: usize> {
    /// The way from the other point to the first, in steps.
    between: [f64; N],
    /// The same as a unit vector.
    normal: [f64; N],
    /// Half of its length, in cells.
    half: f64,
}

impl<'a, const N: usize> Band<'a, N> {
    fn new(picture: Picture<'a>) -> Result<Self, RasterError> {
        let mut ways = Raster::filled(picture.window.size, [0.0; N])?;
        let bands = picture.bands(Some(ways.view_mut())).map(|rows| {
            Output::Features(vec![FeatureRows {
                vector: flattened(rows),
                ..FeatureRows::default()
            }])
        });
        picture.render(bands.collect());
        let n_rows = picture.window.size[1] as usize;
        Ok(Self {
            columns: picture.columns(None),
            rows: core::array::from_fn(|axis| picture.rows(axis, 0, n_rows, None)),
            picture,
            ways,
        })
    }

    /// Fills some columns.
    fn fill(&self, range: Range<usize>, out: &mut [&mut [f32]], memory: &mut Memory<N>) {
        let mut middle = [0; MOST_AXES];
        for axis in 0..N {
            middle[axis] = match axis {
                0 => self.columns.places[range.start + range.len() / 2].0,
                _ => self.rows[axis].places[out.len() / 2].0,
            };
        }
        let basis = self.picture.basis;
        // The nearest point is hardly ever further away than the guess, nor an edge that matters from it than twice that.
        let ring = Guess::new(basis, middle, N, 2).ring;
        let Some(cells) = self.cells(&range, 3 * ring + 1) else {
            for row in 0..out.len() {
                self.one_by_one(row, range.clone(), out);
            }
            return;
        };
        memory.take_lines(&cells, &self.columns.places[range.clone()], &self.rows);
        memory.table.wants_ids = false;
        basis.fill(simd::level(), &mut memory.table, cells);
        self.find_runs(&range, out, memory);
        for piece in 0..memory.pieces.len() {
            memory.find_edges(piece);
        }
        dispatch!(simd::level(), simd => self.fill_runs(simd, &range, out, memory));
    }

    /// The cells that a block and its neighborhood need, if it can be filled from a table.
    fn cells(&self, range: &Range<usize>, ring: i32) -> Option<CellBox> {
        let is_finite = self.columns.is_finite && self.rows.iter().all(|rows| rows.is_finite);
        if !is_finite || !self.picture.section.is_upright() {
            return None;
        }
        let mut cells = CellBox {
            n_axes: N,
            first: [0; MOST_AXES],
            last: [0; MOST_AXES],
        };
        for axis in 0..N {
            [cells.first[axis], cells.last[axis]] = match axis {
                0 => self.columns.cells(range.clone()),
                _ => self.rows[axis].cells(0..self.rows[axis].places.len()),
            };
        }
        let cells = cells.widened(i64::from(ring));
        let is_small =
            cells.n_cells() <= MOST_CELLS && (0..N).all(|axis| cells.side(axis) <= LONGEST_SIDE);
        is_small.then_some(cells)
    }

    /// Finds the pieces and their runs; pixels without one are filled.
    fn find_runs(&self, range: &Range<usize>, out: &mut [&mut [f32]], memory: &mut Memory<N>) {
        memory.clear_pieces();
        for row in 0..out.len() {
            let ways = &self.ways.row(row as u32)[range.clone()];
            let mut start = 0;
            while start < ways.len() {
                let way = ways[start];
                let end = memory.end_of_run(ways, start);
                match memory.piece(way, row, start..end) {
                    Some(piece) => memory.runs.push(Run {
                        row,
                        columns: start..end,
                        piece,
                    }),
                    None => self.one_by_one(row, range.start + start..range.start + end, out),
                }
                start = end;
            }
        }
    }

    /// Fills the pixels of all runs.
    #[inline(always)]
    fn fill_runs<S: Simd>(
        &self,
        simd: S,
        range: &Range<usize>,
        out: &mut [&mut [f32]],
        memory: &Memory<N>,
    ) {
        for run in &memory.runs {
            let piece = &memory.pieces[run.piece];
            let columns = range.start + run.columns.start..range.start + run.columns.end;
            let Some(edges) = &piece.edges else {
                self.one_by_one(run.row, columns, out);
                continue;
            };
            let line = Along {
                edges: &memory.edges[edges.clone()],
                steps: &memory.lines[0][run.columns.start..],
                point: piece.point[0],
                rest: core::array::from_fn(|axis| match axis {
                    0 => 0,
                    _ => memory.lines[axis][run.row] - piece.point[axis],
                }),
            };
            line.fill(simd, &mut out[run.row][columns]);
        }
    }

    /// Fills some columns of a row, each pixel on its own.
    #[cold]
    fn one_by_one(&self, row: usize, columns: Range<usize>, out: &mut [&mut [f32]]) {
        let Picture {
            basis,
            section,
            window,
            ..
        } = self.picture;
        for column in columns {
            let position = window.position(column as u32, row as u32);
            let position = core::array::from_fn(|axis| section.coordinate(axis, position));
            out[row][column] = basis.edge_distance(position);
        }
    }
}

impl<const N: usize> Memory<N> {
    fn new() -> Self {
        Self {
            table: Table::new(),
            found: Vec::new(),
            lines: core::array::from_fn(|_| Vec::new()),
            pieces: Vec::new(),
            piece_of: Vec::new(),
            runs: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// Takes down where the columns and the rows are.
    fn take_lines(&mut self, cells: &CellBox, columns: &[(i64, i32)], rows: &[Arc<Line>; N]) {
        for (axis, line) in self.lines.iter_mut().enumerate() {
            let places = if axis == 0 {
                columns
            } else {
                &rows[axis].places
            };
            let steps = places
                .iter()
                .map(|&(cell, steps)| ((cell - cells.first[axis]) as i32) * STEPS + steps);
            line.clear();
            line.extend(steps);
        }
        let columns = &mut self.lines[0];
        let last = columns.last().copied().unwrap_or(0);
        columns.resize(columns.len() + LANES, last);
    }

    fn clear_pieces(&mut self) {
        self.pieces.clear();
        self.runs.clear();
        self.edges.clear();
        self.piece_of.clear();
        self.piece_of.resize(self.table.n_points(), None);
    }

    /// Where the pixels that have the nearest point of `start` end. Their ways differ by no more than their columns do.
    fn end_of_run(&self, ways: &[[f32; N]], start: usize) -> usize {
        let columns = &self.lines[0];
        let first = ways[start];
        let Some(point) = steps(first[0]).map(|steps| columns[start] - steps) else {
            return start + 1;
        };
        let goes_on = |(way, &column): (&[f32; N], &i32)| {
            way[1..] == first[1..] && way[0] == cells(i64::from(column - point))
        };
        let others = ways[start + 1..].iter().zip(&columns[start + 1..]);
        let n_others = others.take_while(|&pixel| goes_on(pixel)).count();
        start + 1 + n_others
    }

    /// The piece of the point at the end of a way, which now has some more pixels; none if it is not in the table.
    fn piece(&mut self, way: [f32; N], row: usize, columns: Range<usize>) -> Option<usize> {
        let mut low: [i32; N] = core::array::from_fn(|axis| match axis {
            0 => self.lines[0][columns.start],
            _ => self.lines[axis][row],
        });
        let mut high = low;
        let mut point = low;
        for axis in 0..N {
            point[axis] -= steps(way[axis])?;
        }
        let last = self.lines[0][columns.end - 1];
        (low[0], high[0]) = (low[0].min(last), high[0].max(last));
        let mut cell = [0; MOST_AXES];
        for axis in 0..N {
            cell[axis] = point[axis] >> STEP_BITS;
        }
        if !self.table.has_cells([cell; 2]) {
            return None;
        }
        self.table.runs([cell; 2], &mut self.found);
        let mut found = self.found.iter().cloned().flatten();
        let index = found.find(|&index| first(self.table.point(index)) == point)?;
        let piece = *self.piece_of[index].get_or_insert_with(|| {
            self.pieces.push(Piece {
                point,
                low,
                high,
                edges: None,
            });
            // A block has fewer pixels than 2^32.
            self.pieces.len() as u32 - 1
        });
        let known = &mut self.pieces[piece as usize];
        for axis in 0..N {
            known.low[axis] = known.low[axis].min(low[axis]);
            known.high[axis] = known.high[axis].max(high[axis]);
        }
        Some(piece as usize)
    }

    /// Picks the edges that matter to a piece, if the table has all of them.
    fn find_edges(&mut self, index: usize) {
        let piece = &self.pieces[index];
        let corners = Corners::new(piece);
        // The largest distance that the nearest edge can have from any of the pixels.
        let mut bound = f64::INFINITY;
        let mut ring = 0;
        while bound == f64::INFINITY && ring < FARTHEST {
            ring += 1;
            let Some(found) = self.table.around(&piece.point, ring, &mut self.found) else {
                return;
            };
            for other in found.iter().cloned().flatten() {
                if let Some(edge) = Edge::new(piece.point, first(self.table.point(other))) {
                    bound = bound.min(corners.farthest(&edge));
                }
            }
        }
        // The edge towards a point that is further away than this is at no pixel the nearest.
        let reach = 2.0 * (bound + corners.longest) + ERROR;
        if reach >= f64::from(FARTHEST) {
            return;
        }
        ring = ring.max(reach as i32 + 1);
        let Some(found) = self.table.around(&piece.point, ring, &mut self.found) else {
            return;
        };
        let start = self.edges.len();
        // A whole number of steps that is no less.
        let reach = (reach / f64::from(STEP)) as i64 + 1;
        let mut n_there = 0;
        for other in found.iter().cloned().flatten() {
            let other = first(self.table.point(other));
            if distance_sq(piece.point, other) > reach * reach {
                continue;
            }
            match Edge::new(piece.point, other) {
                Some(edge) if corners.nearest(&edge) <= bound + ERROR => self.edges.push(edge),
                Some(_) => {}
                None => n_there += 1,
            }
        }
        if n_there > 1 {
            // Another point in the same place: the edge between them is everywhere.
            self.edges.push(Edge::NOWHERE);
        }
        self.pieces[index].edges = Some(start..self.edges.len());
    }
}

/// The box about the pixels of a piece, as seen from its point.
struct Corners<const N: usize> {
    low: [f64; N],
    high: [f64; N],
    /// The longest way to a corner.
    longest: f64,
}

impl<const N: usize> Corners<N> {
    fn new(piece: &Piece<N>) -> Self {
        let way = |to: [i32; N]| {
            core::array::from_fn(|axis| f64::from(to[axis] - piece.point[axis]) * f64::from(STEP))
        };
        let [low, high]: [[f64; N]; 2] = [way(piece.low), way(piece.high)];
        let far = low
            .iter()
            .zip(high)
            .map(|(low, high)| low.abs().max(high.abs()));
        let longest = libm::sqrt(far.map(|far| far * far).sum());
        Self { low, high, longest }
    }

    /// The smallest distance of an edge from any place of the box.
    fn nearest(&self, edge: &Edge<N>) -> f64 {
        let axes = self.low.iter().zip(self.high).zip(edge.normal);
        let sum = axes.map(|((low, high), normal)| (low * normal).min(high * normal));
        edge.half + sum.sum::<f64>()
    }

    /// The largest distance of an edge from any place of the box.
    fn farthest(&self, edge: &Edge<N>) -> f64 {
        let axes = self.low.iter().zip(self.high).zip(edge.normal);
        let sum = axes.map(|((low, high), normal)| (low * normal).max(high * normal));
        edge.half + sum.sum::<f64>()
    }
}

impl<const N: usize> Edge<N> {
    /// Where two points are in the same place.
    const NOWHERE: Self = Self {
        between: [0.0; N],
        normal: [0.0; N],
        half: 0.0,
    };

    /// The edge between two points, if they are not in the same place.
    fn new(point: [i32; N], other: [i32; N]) -> Option<Self> {
        let between = core::array::from_fn(|axis| f64::from(point[axis] - other[axis]));
        let length = libm::sqrt(between.iter().map(|part| part * part).sum());
        let per_length = 1.0 / length;
        (length > 0.0).then(|| Self {
            between,
            normal: between.map(|part| part * per_length),
            half: 0.5 * length * f64::from(STEP),
        })
    }

    /// The distance from a place, given its way from the point in steps, as [`Worley::edge_distance`] has it.
    fn distance(&self, way: &[f64; N]) -> f64 {
        let [mut product, mut length_sq] = [0.0; 2];
        for axis in 0..N {
            product += way[axis] * self.between[axis];
            length_sq += self.between[axis] * self.between[axis];
        }
        if length_sq == 0.0 {
            return 0.0;
        }
        (2.0 * product + length_sq) / (2.0 * libm::sqrt(length_sq)) * f64::from(STEP)
    }
}

/// A run and its edges.
struct Along<'a, const N: usize> {
    edges: &'a [Edge<N>],
    /// The coordinates of the columns, and the point's, in steps.
    steps: &'a [i32],
    point: i32,
    /// The way from the point along the other axes, in steps.
    rest: [i32; N],
}

impl<const N: usize> Along<'_, N> {
    #[inline(always)]
    fn fill<S: Simd>(&self, simd: S, out: &mut [f32]) {
        for (index, out) in out.chunks_mut(LANES).enumerate() {
            let first = index * LANES;
            let steps = i32x16::from_slice(simd, &self.steps[first..first + LANES]) - self.point;
            let (left, right) = (steps.to_float::<f32x16<S>>() * STEP).widen();
            let mut nearest = [f64x8::splat(simd, f64::INFINITY); 2];
            for edge in self.edges {
                let mut rest = edge.half;
                for axis in 1..N {
                    rest += f64::from(self.rest[axis]) * f64::from(STEP) * edge.normal[axis];
                }
                nearest[0] = nearest[0].min(left * edge.normal[0] + rest);
                nearest[1] = nearest[1].min(right * edge.normal[0] + rest);
            }
            let low = (nearest[0] - ERROR).narrow(nearest[1] - ERROR);
            let high = (nearest[0] + ERROR).narrow(nearest[1] + ERROR);
            let mut values = [0.0; LANES];
            low.max(f32x16::splat(simd, 0.0)).store_slice(&mut values);
            let mut unknown = !low.simd_eq(high).to_bitmask() & (u64::MAX >> (64 - out.len()));
            while unknown != 0 {
                let lane = unknown.trailing_zeros() as usize;
                values[lane] = self.one(first + lane);
                unknown &= unknown - 1;
            }
            out.copy_from_slice(&values[..out.len()]);
        }
    }

    /// The value of one pixel.
    #[inline(never)]
    fn one(&self, index: usize) -> f32 {
        let mut way = self.rest.map(f64::from);
        way[0] = f64::from(self.steps[index] - self.point);
        let distances = self.edges.iter().map(|edge| edge.distance(&way));
        distances.fold(f64::INFINITY, f64::min).max(0.0) as f32
    }
}

/// The steps of a part of a way, if it is short.
fn steps(part: f32) -> Option<i32> {
    let is_short = part.abs() < FARTHEST as f32;
    is_short.then(|| (part / STEP) as i32)
}

fn distance_sq<const N: usize>(a: [i32; N], b: [i32; N]) -> i64 {
    let parts = a.iter().zip(b).map(|(a, b)| i64::from(a - b));
    parts.map(|part| part * part).sum()
}
