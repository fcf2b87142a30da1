//! Renders the distance to the edge of the Voronoi cell.
//!
//! The cells with pixels in a block are drawn one by one. A bisecting plane lies halfway between the feature point of
//! a cell and each other point ([`planes`](super::planes)). The signed distance to such a plane, negative beyond it,
//! is linear along a row of pixels. The smallest of these distances is the distance to the edge, and is positive only
//! inside the cell. The nearest point of a pixel is therefore not needed in advance, and more pixels than the cell
//! contains may be drawn.
//!
//! For each cell, the nearest planes give an outline, and the outline gives a ball that contains the cell's pixels. A
//! plane is dropped if another plane is nearer to every position in the ball. The number of remaining planes is close
//! to the number of the cell's edges.
//!
//! Distances are computed in `f64`. A pixel is drawn only if their rounding error cannot change the `f32` nearest to
//! its value, and if no other point can be as near by the `f32` keys that [`Worley::edge_distance`] compares. The few
//! other pixels are searched individually.
//!
//! [`Worley::edge_distance`]: crate::Worley::edge_distance

use super::block::{Block, Memory};
use super::cull::lanes_before;
use super::planes::{Neighbors, Planes, SLACK};
use super::square::Guess;
use super::{BAND_ROWS, BLOCK_COLUMNS, LANES, Picture};
use crate::Metric;
use crate::fixed::{MOST_AXES, STEP, STEPS};
use core::ops::Range;
use dapple_raster::simd::dispatch;
use fearless_simd::{f32x16, f64x8, i32x16, prelude::*};

/// Number of values per row in memory: the maximum number of columns, plus a register as padding.
const STRIDE: usize = BLOCK_COLUMNS + LANES;

/// Radii within which a point's neighbors are searched, as multiples of the estimated distance to the nearest points.
/// The larger radius is used if the smaller one is not sufficient.
const REACHES: [f32; 2] = [1.7, 2.6];

/// Maximum length of a vector to a neighbor, in cells. Vectors up to one and a half times as long are exact in `f32`.
const LONGEST_REACH: f32 = 5.0;

/// Number of rings of cells around a block for which points are generated, as a multiple of [`Guess::ring`]. They
/// cover the distance from a pixel to its nearest point, and from there to the point's neighbors.
const RINGS: i32 = 4;

/// The coordinates of a block's pixels.
struct Pixels<'a> {
    n_rows: usize,
    n_columns: usize,
    /// Coordinates of the columns (first axis) and of the rows (other axes), in steps.
    lines: &'a [Vec<i32>; MOST_AXES],
    /// Number of columns per cell; negative if coordinates decrease from column to column.
    columns_per_cell: f32,
    /// Maximum offset of a column from its evenly spaced position, in columns.
    unevenness: f32,
    /// Coordinates of the first and the last column in ascending order, relative to the first column, in cells.
    ends: [f32; 2],
}

impl Block<'_> {
    /// Renders the distances from the block's pixels to the nearest edges of their cells.
    pub(super) fn edges(&self, out: &mut [&mut [f32]], memory: &mut Memory) {
        let Picture { basis, section, .. } = self.bands[0].picture;
        // An edge lies between two points.
        let guess = Guess::new(basis, self.middle(), section.n_axes, 2);
        let Some(cells) = self.cells(RINGS * guess.ring) else {
            for (row, out) in out.iter_mut().enumerate() {
                for column in self.range.clone() {
                    out[column] = self.edge(column, row);
                }
            }
            return;
        };
        // Generate the points, and draw the cells over values that mark unknown pixels.
        memory.take_lines(self, &cells);
        memory.table.wants_ids = false;
        memory.table.fill(self.level, basis.lattice(), cells);
        memory.values.clear();
        memory.values.resize(out.len() * STRIDE, -1.0);
        dispatch!(self.level, simd => self.draw_cells(simd, guess, memory));
        // Copy the values. Search pixels that are still marked (negative) on their own.
        for (row, (out, values)) in out.iter_mut().zip(memory.values.chunks(STRIDE)).enumerate() {
            let out = &mut out[self.range.clone()];
            out.copy_from_slice(&values[..out.len()]);
            let signs = out.iter().fold(0, |bits, value| bits | value.to_bits());
            if signs >> 31 == 0 {
                continue;
            }
            for (column, out) in self.range.clone().zip(out) {
                if *out < 0.0 {
                    *out = self.edge(column, row);
                }
            }
        }
    }

    /// Computes the edge distance of a single pixel by an individual search. `row` is a row of the band.
    #[cold]
    pub(super) fn edge(&self, column: usize, row: usize) -> f32 {
        let band = &self.bands[0];
        let place = band.picture.place(column, band.first + row);
        place.map_or(f32::NAN, |place| band.picture.basis.edge_distance(&place))
    }

    /// Draws the cells that can contain pixels of the block.
    #[inline(always)]
    fn draw_cells<S: Simd>(&self, simd: S, guess: Guess, memory: &mut Memory) {
        let whole = memory.pixel_box(&self.all());
        let Memory {
            table,
            lines,
            runs,
            neighbors,
            planes,
            values,
            ..
        } = memory;
        let pixels = Pixels::new(lines, [self.range.len(), self.bands[0].n_rows]);
        let mut around = Vec::new();
        table.runs(whole.cells(guess.ring), runs);
        for index in runs.iter().cloned().flatten() {
            let point = table.point(index);
            // Skip points that are too far away to have pixels.
            if whole.distance_sq(&point) > guess.distance * guess.distance {
                continue;
            }
            // Draw the cell from the neighbors within the smaller reach, or else within the larger one.
            for reach in REACHES {
                let reach = (reach * guess.distance).min(LONGEST_REACH);
                let steps = (reach / STEP) as i32;
                let Some(around) = table.around(&point, steps, &mut around) else {
                    break;
                };
                let is_alone = neighbors.find(simd, table, point, reach, around);
                // If two points coincide, all of their cell is at distance zero from an edge.
                if !is_alone || neighbors.hide(simd, &whole) {
                    break;
                }
                neighbors.make_planes(simd);
                if pixels.draw(simd, neighbors, planes, values) {
                    break;
                }
            }
        }
    }
}

impl<'a> Pixels<'a> {
    fn new(lines: &'a [Vec<i32>; MOST_AXES], [n_columns, n_rows]: [usize; 2]) -> Self {
        let columns = &lines[0][..n_columns];
        let extent = (columns[n_columns - 1] - columns[0]) as f32;
        // If all columns have the same coordinate, any of them may be in the cell.
        let [columns_per_step, mut unevenness] = match extent {
            0.0 => [0.0, n_columns as f32],
            _ => [(n_columns - 1) as f32 / extent, 0.0],
        };
        for (index, column) in columns.iter().enumerate() {
            let expected = (column - columns[0]) as f32 * columns_per_step;
            unevenness = (index as f32 - expected).abs().max(unevenness);
        }
        Self {
            n_rows,
            n_columns,
            lines,
            columns_per_cell: columns_per_step * STEPS as f32,
            unevenness,
            ends: [extent.min(0.0) * STEP, extent.max(0.0) * STEP],
        }
    }

    /// Draws the pixels of a cell. Returns whether the neighbors within reach were sufficient.
    #[inline(always)]
    fn draw<S: Simd>(
        &self,
        simd: S,
        neighbors: &Neighbors,
        planes: &mut Planes,
        values: &mut [f32],
    ) -> bool {
        // Find the columns of each row that the cell can contain.
        let mut outline = Outline {
            starts: [0; BAND_ROWS],
            ends: [0; BAND_ROWS],
            radius_sq: -1.0,
        };
        // The first row that can have pixels, and the one after the last.
        let mut rows = [self.n_rows, 0];
        for first in (0..self.n_rows).step_by(LANES) {
            if self.outline(simd, neighbors, first, &mut outline) {
                rows = [rows[0].min(first), self.n_rows.min(first + LANES)];
            }
        }
        if outline.radius_sq < 0.0 {
            return true;
        }
        // Select the planes that are relevant for these pixels, and draw the pixels row by row.
        neighbors.pick(simd, outline.radius_sq, planes);
        let sight = Sight::new(neighbors, planes, outline.radius_sq);
        let mut is_enough = true;
        for row in rows[0]..rows[1] {
            let columns = outline.starts[row] as usize..outline.ends[row] as usize;
            if !columns.is_empty() {
                let mut rest = [0.0; MOST_AXES];
                for axis in 1..planes.n_axes {
                    let steps = self.lines[axis][row] - neighbors.point[axis];
                    rest[axis] = f64::from(steps) * f64::from(STEP);
                }
                planes.take_row(simd, &rest);
                let rest = rest.map(|part| part as f32);
                let line = Along {
                    steps: &self.lines[0],
                    point: neighbors.point[0],
                    rest_sq: Metric::Euclidean.key(rest),
                    planes,
                    sight: &sight,
                };
                is_enough &= line.draw(simd, columns, &mut values[row * STRIDE..][..STRIDE]);
            }
        }
        is_enough
    }

    /// Finds the range of columns that can be in the cell, for sixteen rows starting at `first`, and extends the
    /// outline's radius accordingly. Returns whether any of the rows can contain pixels of the cell.
    #[inline(always)]
    fn outline<S: Simd>(
        &self,
        simd: S,
        neighbors: &Neighbors,
        first: usize,
        outline: &mut Outline,
    ) -> bool {
        let zero = f32x16::splat(simd, 0.0);
        let mut rest = [zero; MOST_AXES];
        let mut rest_sq = zero;
        // Compute the vector from the point to the rows, along all axes except the first.
        for axis in 1..neighbors.n_axes {
            let steps = i32x16::from_slice(simd, &self.lines[axis][first..first + LANES]);
            rest[axis] = (steps - neighbors.point[axis]).to_float::<f32x16<S>>() * STEP;
            rest_sq += rest[axis] * rest[axis];
        }
        let half = neighbors.reach / 2.0;
        if !rest_sq.simd_le(half * half).any_true() {
            return false;
        }
        // Clip the rows by the planes of the inner neighbors.
        let [mut low, mut high] = [zero - half, zero + half];
        for &plane in &neighbors.inner {
            let mut ahead = zero + (neighbors.distances[plane] + SLACK);
            for axis in 1..neighbors.n_axes {
                ahead += rest[axis] * neighbors.normals[axis][plane];
            }
            let normal = neighbors.normals[0][plane];
            // A plane parallel to the row needs an intersection, too. This change moves planes by less than the slack.
            let normal = normal.abs().max(SLACK / 8.0).copysign(normal);
            let crossing = ahead * (-1.0 / normal);
            let [at_low, at_high] = if normal > 0.0 {
                [0.0, f32::INFINITY]
            } else {
                [f32::NEG_INFINITY, 0.0]
            };
            low = low.max(crossing + at_low);
            high = high.min(crossing + at_high);
        }
        // Convert the ends to columns.
        let corner = (neighbors.point[0] - self.lines[0][0]) as f32 * STEP;
        let a = (low + corner) * self.columns_per_cell;
        let b = (high + corner) * self.columns_per_cell;
        let most = self.n_columns as f32;
        let start = (a.min(b) - self.unevenness).ceil().max(0.0).min(most);
        let end = (a.max(b) + self.unevenness).floor() + 1.0;
        let end = low.simd_le(high).select(end.max(0.0).min(most), zero);
        let to = first..first + LANES;
        (start.to_int::<i32x16<S>>()).store_slice(&mut outline.starts[to.clone()]);
        (end.to_int::<i32x16<S>>()).store_slice(&mut outline.ends[to]);
        // Extend the radius to the ends of the rows.
        let from = f32x16::splat(simd, self.ends[0] - corner);
        let (low, high) = (low.max(from), high.min(self.ends[1] - corner));
        let radius_sq = rest_sq + (low * low).max(high * high) + SLACK;
        let radius_sq = end.simd_gt(start).select(radius_sq, zero - 1.0);
        outline.radius_sq = outline.radius_sq.max(radius_sq.reduce_max());
        true
    }
}

/// The pixels that may be in a cell.
struct Outline {
    /// For each row, the first column and the one after the last.
    starts: [i32; BAND_ROWS],
    ends: [i32; BAND_ROWS],
    /// Largest squared distance of the pixels from the point, in cells; negative if there are no pixels.
    radius_sq: f32,
}

/// A row of pixels in a cell, and the planes that bound the cell.
struct Along<'a> {
    /// Coordinates of the columns, in steps.
    steps: &'a [i32],
    /// Coordinate of the cell's feature point along the row, in steps.
    point: i32,
    /// Squared distance from the point to the row along all other axes, in cells.
    rest_sq: f32,
    planes: &'a Planes,
    sight: &'a Sight,
}

impl Along<'_> {
    /// Draws the pixels in `columns` of the row. Returns whether the planes were sufficient to determine them.
    #[inline(always)]
    fn draw<S: Simd>(&self, simd: S, columns: Range<usize>, values: &mut [f32]) -> bool {
        let (planes, sight) = (self.planes, self.sight);
        let normals = &planes.normals[0][..planes.len];
        let offsets = &planes.offsets[..planes.len];
        let mut is_enough = true;
        for start in columns.clone().step_by(LANES) {
            let at = start..start + LANES;
            // The smallest distance to a plane, in `f64`.
            let steps = i32x16::from_slice(simd, &self.steps[at.clone()]) - self.point;
            let ways = steps.to_float::<f32x16<S>>() * STEP;
            let (left, right) = ways.widen();
            let mut nearest = [f64x8::splat(simd, f64::INFINITY); 2];
            for (&normal, &offset) in normals.iter().zip(offsets) {
                nearest[0] = nearest[0].min(left * normal + offset);
                nearest[1] = nearest[1].min(right * normal + offset);
            }
            // Draw the pixels of the cell whose value is certain.
            let low = (nearest[0] - sight.error).narrow(nearest[1] - sight.error);
            let high = (nearest[0] + sight.error).narrow(nearest[1] + sight.error);
            let is_own = low.simd_gt(sight.least) & lanes_before(simd, columns.end - start);
            let spare = (sight.half - high).max(0.0);
            let is_seen =
                (ways * ways + self.rest_sq).simd_le((spare * spare).min(sight.radius_sq));
            is_enough &= !(is_own & !is_seen).any_true();
            let is_known = is_own & is_seen & low.simd_eq(high);
            let before = f32x16::from_slice(simd, &values[at.clone()]);
            is_known.select(low, before).store_slice(&mut values[at]);
        }
        is_enough
    }
}

/// The limits within which the computed edge distances of a cell are reliable. Lengths are in cells.
struct Sight {
    /// Maximum rounding error of a distance.
    error: f64,
    /// Minimum reliable edge distance. Below it, rounded keys may make another point the nearest.
    least: f32,
    /// Maximum reliable sum of a pixel's edge distance and its distance to the point. Above it, a plane beyond the
    /// search radius may be nearer.
    half: f32,
    /// Maximum reliable squared distance from a pixel to the point. Above it, a plane that was dropped may be nearer.
    radius_sq: f32,
}

impl Sight {
    /// Computes the limits for a cell. A distance to a plane is a dot product with the plane's normal, and a relevant
    /// one is at most half of the search radius. It takes fewer than sixteen roundings, including those in
    /// [`Worley::edge_distance`](crate::Worley::edge_distance), each with an error of at most 2⁻⁵³ of the distance.
    ///
    /// A search key is a squared distance with at most five roundings, each with an error of at most 2⁻²⁴ of the key.
    /// The squared distances to two points differ by twice the distance between the points, times the distance from
    /// their bisecting plane.
    fn new(neighbors: &Neighbors, planes: &Planes, radius_sq: f32) -> Self {
        let half = neighbors.reach / 2.0;
        let key_error = f64::from(half * half) / f64::from(1 << 20);
        Self {
            error: f64::from(half) / (1_u64 << 49) as f64,
            least: (key_error / (4.0 * planes.least())) as f32,
            half: half - SLACK,
            radius_sq,
        }
    }
}
