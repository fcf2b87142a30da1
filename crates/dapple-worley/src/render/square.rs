//! Renders squares of up to 64 × 64 pixels and their tiles of up to 32 × 32, from candidates to values.
//!
//! The candidates of a square are selected from the table, and the candidates of a tile from its square's. If the key
//! of a pixel reaches the border of the neighborhood that the candidates come from, pixels are rendered again with a
//! larger neighborhood.

use super::area::Area;
use super::block::{Block, Memory};
use super::cull::{Cull, Keep, PixelBox, Points};
use super::flat::{Cuboid, PictureAxes, culls_dominated};
use super::kernel::{Rows, TILE};
use super::track::{Found, TrackedRows};
use super::{Basis, LANES, Output};
use crate::fixed::{MOST_AXES, STEP, STEPS};
use crate::levels::{is_wide, wide};
use crate::metric::{Additive, Exact, General, Kernel, Longest, Squares};
use crate::sink::{Tone, Values};
use crate::{MAX_NEAREST, Metric};
use core::ops::Range;
use dapple_raster::simd::baseline;
use fearless_simd::Level;

/// An estimate of the distance from a pixel to its nearest points, which few pixels exceed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guess {
    /// The estimated distance, in cells.
    pub(super) distance: f32,
    /// The distance in whole cells, rounded up; at least 1.
    pub(super) ring: i32,
}

impl Guess {
    /// Estimates the distance to the `depth` nearest points. The estimate is the radius of a ball that holds fewer than
    /// `depth` points with a probability of about 1 in 250.
    pub(super) fn new(
        basis: &dyn Basis,
        middle: [i64; MOST_AXES],
        n_axes: usize,
        depth: usize,
    ) -> Self {
        // Mean of the Poisson distribution that is below `depth` with this probability.
        let points = [5.5, 7.8, 9.8, 11.6][depth - 1];
        // Volumes of the Euclidean unit balls, precise enough for an estimate.
        let ball = [1.0, 2.0, 3.1, 4.2, 4.9][n_axes];
        let distance = libm::pow(
            points / (ball * basis.lattice().mean(&middle)),
            1.0 / n_axes as f64,
        );
        Self {
            distance: distance as f32,
            ring: (distance.ceil() as i32).max(1),
        }
    }
}

/// The parameters for rendering a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Number of nearest points per pixel that the output needs.
    pub(super) depth: usize,
    pub(super) guess: Guess,
    pub(super) metric: Metric,
    /// Axis along which rows differ, if the key terms of all other axes can be accumulated before the terms of the
    /// rows; otherwise `None`.
    pub(super) row_axis: Option<usize>,
    /// Width and height of a tile, in pixels.
    pub(super) tile: [usize; 2],
    /// Axis along which slices differ; `None` for a single slice.
    pub(super) deep_axis: Option<usize>,
}

impl Plan {
    /// Returns the culling criterion for points that can be among the nearest.
    pub(super) fn nearest(&self) -> Keep {
        Keep::Nearest(self.depth, self.metric.rounding_slack())
    }

    /// Returns the bounds of an area of pixels along the axes of columns, rows and slices, in cells from the area's
    /// lower corner.
    fn cuboid(&self, pixels: &PixelBox) -> Cuboid {
        let mut high = [0.0; 3];
        for (high, axis) in high
            .iter_mut()
            .zip([Some(0), self.row_axis, self.deep_axis])
        {
            if let Some(axis) = axis {
                *high = (pixels.high[axis] - pixels.low[axis]) as f32 * STEP;
            }
        }
        Cuboid {
            low: [0.0; 3],
            high,
            is_deep: self.deep_axis.is_some(),
        }
    }

    /// Returns whether values are rendered by the kernel that processes two registers of columns at once.
    fn has_wide_kernel(&self, level: Level) -> bool {
        is_wide(level) && self.depth <= 2 && self.metric.is_exact_sum()
    }

    /// Returns whether dominated points are removed from the candidates.
    pub(super) fn culls_dominated(&self, level: Level) -> bool {
        self.row_axis.is_some() && culls_dominated(level, self.metric)
    }
}

/// A square of pixels whose candidates have been selected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    pub(super) pixels: PixelBox,
    /// Bounds of its pixels, in cells from its lower corner.
    pub(super) cuboid: Cuboid,
    /// Whether the square is a single tile.
    pub(super) is_tile: bool,
    /// Limit of reliable keys (see [`metric`](crate::metric)). A pixel whose key is at or above it may miss a nearer
    /// point.
    pub(super) limit: f32,
    pub(super) plan: Plan,
}

/// Sizes of squares and of their tiles, as columns and rows; largest first.
const SIZES: [[[usize; 2]; 2]; 3] = [
    [[64, 64], [32, 32]],
    [[32, 32], [32, 16]],
    [[16, 16], [16, 16]],
];

/// Maximum width of a square, in steps. In a wider square, almost all points are candidates.
const WIDEST_SQUARE: i32 = STEPS + STEPS / 2;

/// Maximum number of cells that a square and its neighborhood span. Up to this limit, coordinates are exact in `f32`.
const SPAN: i32 = 8;

/// The region from which a square's feature points are taken.
#[derive(Clone, Copy, Debug)]
struct Neighborhood {
    /// Number of rings of cells around the cells that the square touches.
    ring: i32,
    /// Maximum distance of selected points from the square, in cells. `None` selects all points that can be among the
    /// nearest.
    guess: Option<f32>,
}

impl Neighborhood {
    /// Returns whether coordinates within the neighborhood are exact in `f32`.
    fn fits(&self, pixels: &PixelBox) -> bool {
        let [first, last] = pixels.cells(self.ring);
        (0..pixels.n_axes).all(|axis| last[axis] - first[axis] < SPAN)
    }

    /// Returns the next larger neighborhood: first without the distance estimate, then with one more ring of cells.
    fn grown(self) -> Self {
        Self {
            ring: self.ring + i32::from(self.guess.is_none()),
            guess: None,
        }
    }
}

impl Block<'_> {
    /// Renders the pixels of the block, square by square.
    pub(super) fn squares(&self, mut plan: Plan, outs: &mut [Output<'_>], memory: &mut Memory) {
        let all = self.all();
        let extent = |size: [usize; 2]| {
            let first = all.parts(size).next();
            first.map_or(0, |first| memory.pixel_box(&first).extent())
        };
        let fits = |[square, _]: &[[usize; 2]; 2]| extent(*square) <= WIDEST_SQUARE;
        // Choose the largest squares that are narrow enough.
        let mut neighborhood = Neighborhood {
            ring: plan.guess.ring,
            guess: None,
        };
        let square;
        [square, plan.tile] = SIZES.into_iter().find(fits).unwrap_or_else(|| {
            neighborhood.guess = Some(plan.guess.distance);
            // Wider squares use the estimate as the bound. Their tiles are less high if pixels are far apart.
            let is_widest = extent([LANES, 1]) as f32 * STEP >= 1.5;
            [[LANES, LANES / if is_widest { 4 } else { 2 }]; 2]
        });
        // If the kernel finds only one or two keys, more candidates cost less than more tiles.
        let is_short = plan.depth <= 2 && matches!(outs[0], Output::Values(..));
        if is_short && plan.deep_axis.is_none() && square == [TILE; 2] {
            plan.tile = square;
        }
        for area in all.parts(square) {
            self.square(&area, neighborhood, plan, outs, memory);
        }
    }

    /// Renders the pixels of a square.
    fn square(
        &self,
        area: &Area,
        neighborhood: Neighborhood,
        mut plan: Plan,
        outs: &mut [Output<'_>],
        memory: &mut Memory,
    ) {
        let pixels = memory.pixel_box(area);
        // Beyond this span, coordinates are not exact in `f32`, so each pixel is searched on its own.
        if !neighborhood.fits(&pixels) {
            self.one_by_one(area, outs);
            return;
        }
        let limit = self.pick(area, &pixels, neighborhood, plan, memory);
        let square = Square {
            pixels,
            cuboid: plan.cuboid(&pixels),
            is_tile: !area.is_larger(plan.tile),
            limit,
            plan,
        };
        for tile in area.parts(plan.tile) {
            self.tile(&tile, &square, outs, memory);
        }
        // Unknown pixels are rendered again in tiles of a single slice.
        plan.tile = [LANES, TILE];
        plan.deep_axis = None;
        if memory.unknown.is_empty() {
            return;
        }
        // Render the rows that need farther points again, using a larger neighborhood.
        for part in core::mem::take(&mut memory.unknown) {
            self.square(&part, neighborhood.grown(), plan, outs, memory);
        }
    }

    /// Selects the candidates of a square from a table. Returns the limit below which the pixels' keys are exact.
    fn pick(
        &self,
        area: &Area,
        pixels: &PixelBox,
        neighborhood: Neighborhood,
        plan: Plan,
        memory: &mut Memory,
    ) -> f32 {
        let metric = plan.metric;
        let cells = pixels.cells(neighborhood.ring);
        // Keys are exact up to the border of the neighborhood and up to the estimate.
        let border = metric.term(pixels.border(cells) as f32 * STEP);
        let guess = neighborhood.guess.map(|guess| metric.term(guess));
        let limit = metric.tightened(guess.map_or(border, |guess| guess.min(border)));
        let mut moved = *pixels;
        // Generate the points of a neighborhood that exceeds the table of the block.
        memory.is_wide = neighborhood.ring > plan.guess.ring;
        let table = if memory.is_wide {
            let corner = memory.table.cells;
            let mut all = corner;
            for axis in 0..pixels.n_axes {
                all.first[axis] = corner.first[axis] + i64::from(cells[0][axis]);
                all.last[axis] = corner.first[axis] + i64::from(cells[1][axis]);
                moved.low[axis] -= cells[0][axis] * STEPS;
                moved.high[axis] -= cells[0][axis] * STEPS;
            }
            memory.wide_table.wants_ids = memory.table.wants_ids;
            let lattice = self.bands[0].picture.basis.lattice();
            memory.wide_table.fill(self.level, lattice, all);
            &memory.wide_table
        } else {
            &memory.table
        };
        // Cull by bounds, then remove dominated points.
        memory.low = moved.low;
        table.runs(moved.cells(neighborhood.ring), &mut memory.runs);
        let points = Points {
            steps: &table.steps,
            numbers: None,
            runs: &memory.runs,
            wants_numbers: memory.square.wants_numbers,
        };
        let keep = guess.map_or(plan.nearest(), Keep::Within);
        let whole = plan.cuboid(&moved);
        let has_tiles = area.is_larger(plan.tile);
        let (list, square, tile) = (&mut memory.list, &mut memory.square, &mut memory.tile);
        let dominance = &mut memory.dominance;
        (dominance.depth, dominance.distance) = (plan.depth, plan.guess.distance);
        let cull = Cull {
            metric,
            pixels: &moved,
            keep,
        };
        list.cull(self.level, cull, points);
        if let Some(rows) = plan.row_axis.filter(|_| plan.culls_dominated(self.level)) {
            let slices = plan.deep_axis;
            square.flatten(
                self.level,
                metric,
                list,
                &moved,
                PictureAxes { rows, slices },
            );
            // For a square of a single tile, dominated points are removed when the tile is rendered.
            if has_tiles {
                tile.take_undominated(self.level, metric, square, &whole, dominance);
                core::mem::swap(tile, square);
            }
        }
        limit
    }

    /// Renders the pixels of a tile from the candidates of its square.
    fn tile(&self, area: &Area, square: &Square, outs: &mut [Output<'_>], memory: &mut Memory) {
        let plan = square.plan;
        memory.candidates(self.level, area, square);
        let is_values = matches!(outs[0], Output::Values(..));
        // Features and gradients look up the nearest candidates by index.
        if !is_values {
            let table = if memory.is_wide {
                &memory.wide_table
            } else {
                &memory.table
            };
            memory.lookup.fill(&memory.tile, table, memory.low);
        }
        // Render two registers of columns at once if the kernel supports it.
        let size = match area.columns.len() {
            TILE if is_values && plan.has_wide_kernel(self.level) => [TILE; 2],
            _ => [LANES, TILE],
        };
        // Render slice by slice. Rows that need farther points are collected in `unknown`.
        for slice in area.slices.clone() {
            if let Some(deep_axis) = plan.deep_axis {
                let place = memory.slices[slice][deep_axis] - square.pixels.low[deep_axis];
                memory.terms(self.level, area, square, Some(place));
            }
            for (register, area) in area.parts(size).enumerate() {
                let area = Area {
                    slices: slice..slice + 1,
                    ..area
                };
                let part = Part {
                    register,
                    area: &area,
                    square,
                };
                let end = self.fill_part(part, &mut outs[slice], memory);
                if end < area.rows.end {
                    memory.unknown.push(Area {
                        rows: end..area.rows.end,
                        ..area
                    });
                }
            }
        }
    }

    /// Renders one or two registers of a tile's columns. Returns the first row that has a key at or above the limit,
    /// or the end of the rows.
    fn fill_part(&self, part: Part<'_>, out: &mut Output<'_>, memory: &Memory) -> usize {
        match out {
            Output::Values(values, out) => {
                self.fill_values(part, &self.rows_of(part, values, memory), out)
            }
            _ => self.fill_tracked(part, out, memory),
        }
    }

    /// Renders values with the loop that is compiled for the metric and the number of nearest points.
    fn fill_values(&self, part: Part<'_>, rows: &Rows<'_>, out: &mut [&mut [f32]]) -> usize {
        let (level, Plan { metric, depth, .. }) = (self.level, part.square.plan);
        let (sum, exact) = (Additive(metric), Exact(metric));
        let end = match (metric.kernel(), depth) {
            (Kernel::Squares, 1) => {
                wide!(level, simd => rows.fill::<_, _, 1>(simd, Squares, 1, out))
            }
            (Kernel::Squares, 2) => {
                wide!(level, simd => rows.fill::<_, _, 2>(simd, Squares, 2, out))
            }
            (Kernel::Sum, 1) => wide!(level, simd => rows.fill::<_, _, 1>(simd, sum, 1, out)),
            (Kernel::Sum, 2) => wide!(level, simd => rows.fill::<_, _, 2>(simd, sum, 2, out)),
            (Kernel::Longest, ..=2) => {
                wide!(level, simd => rows.fill_register::<_, _, 2>(simd, Longest, depth, out))
            }
            (Kernel::General, _) => None,
            _ => {
                wide!(level, simd => rows.fill_register::<_, _, MAX_NEAREST>(simd, exact, depth, out))
            }
        };
        end.unwrap_or_else(|| {
            let any = General(metric);
            baseline!(simd => rows.fill_groups::<_, _, MAX_NEAREST, 1, 0>(simd, any, depth, out))
        })
    }

    /// Renders features or gradients, which need the identity of the nearest points.
    fn fill_tracked(&self, part: Part<'_>, out: &mut Output<'_>, memory: &Memory) -> usize {
        let (level, area) = (self.level, part.area);
        let Plan { metric, depth, .. } = part.square.plan;
        let mut lines = memory.lines.each_ref().map(|line| &line[..]);
        lines[0] = &lines[0][area.columns.start..];
        let rows = TrackedRows {
            rows: area.rows.clone(),
            columns: self.columns_of(area),
            register: part.register,
            lines,
            low: part.square.pixels.low,
            candidates: &memory.candidates[..memory.tile.len],
            lookup: &memory.lookup,
            limit: part.square.limit,
        };
        let mut put = |found: &Found| self.put(area.slices.start, found, out);
        let sum = Additive(metric);
        let end = match (metric.kernel(), depth) {
            (Kernel::Squares | Kernel::Sum, 2) => {
                wide!(level, simd => rows.fill::<_, _, 2>(simd, sum, 2, &mut put))
            }
            (Kernel::Squares | Kernel::Sum, _) => {
                wide!(level, simd => rows.fill::<_, _, MAX_NEAREST>(simd, sum, MAX_NEAREST, &mut put))
            }
            (Kernel::Longest, 2) => {
                wide!(level, simd => rows.fill::<_, _, 2>(simd, Longest, 2, &mut put))
            }
            _ => None,
        };
        end.unwrap_or_else(|| {
            let any = General(metric);
            baseline!(simd => rows.fill::<_, _, MAX_NEAREST>(simd, any, depth, &mut put))
        })
    }

    /// Returns the parameters of the value kernel for a part of a tile.
    fn rows_of<'a>(&self, part: Part<'_>, values: &'a Values, memory: &'a Memory) -> Rows<'a> {
        Rows {
            rows: part.area.rows.clone(),
            columns: self.columns_of(part.area),
            register: part.register,
            candidates: &memory.candidates[..memory.tile.len],
            limit: part.square.limit,
            values,
        }
    }

    /// Returns the columns of an area, in the window.
    fn columns_of(&self, area: &Area) -> Range<usize> {
        let left = self.range.start;
        left + area.columns.start..left + area.columns.end
    }

    /// Stores the nearest points of a row of pixels. Pixels whose points have an unknown order are searched
    /// individually.
    fn put(&self, slice: usize, found: &Found, out: &mut Output<'_>) {
        match out {
            Output::Features(features) => found.put(&self.bands[slice], features),
            Output::Gradients(tone, rows) => {
                let metric = self.bands[slice].picture.basis.metric();
                let n = found.n_axes;
                let out = &mut rows[found.row][found.columns.start * n..found.columns.end * n];
                match n {
                    2 => put_gradients::<2>(tone, metric, found, out),
                    3 => put_gradients::<3>(tone, metric, found, out),
                    _ => put_gradients::<4>(tone, metric, found, out),
                }
            }
            Output::Values(..) | Output::Edges(..) => {}
        }
        let mut unknown = found.unknown & u64::MAX >> (64 - found.columns.len());
        while unknown != 0 {
            let column = found.columns.start + unknown.trailing_zeros() as usize;
            unknown &= unknown - 1;
            self.one(slice, column, found.row, out);
        }
    }
}

/// Stores the gradients of adjacent pixels of a row, with interleaved components.
fn put_gradients<const N: usize>(tone: &Tone, metric: Metric, found: &Found, out: &mut [f32]) {
    for (lane, out) in out.as_chunks_mut::<N>().0.iter_mut().enumerate() {
        *out = tone.gradient(metric, &found.vectors::<N>(lane));
    }
}

/// One or two registers of a tile's columns.
#[derive(Clone, Copy)]
struct Part<'a> {
    area: &'a Area,
    /// Index of the part's first register among the tile's columns, 0 or 1.
    register: usize,
    square: &'a Square,
}
