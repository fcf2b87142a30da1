//! Blocks of columns in a band. The feature points of a block are generated once.

use super::area::Area;
use super::bins::{Bins, PointLists};
use super::cull::{PixelBox, PointList};
use super::flat::{Dominance, FlatPoints, culls_dominated};
use super::kernel::Candidate;
use super::planes::{Neighbors, Planes};
use super::splat::Splat;
use super::square::{Guess, Plan};
use super::table::{CellBox, Table};
use super::track::Lookup;
use super::{Band, LANES, MANY_CELLS, Output, Picture};
use crate::MAX_NEAREST;
use crate::features::position;
use crate::fixed::{MOST_AXES, STEPS};
use crate::search::{Hit, PointId};
use crate::worley::cell_value;
use core::ops::Range;
use fearless_simd::Level;

/// Maximum number of cells in a block with its neighborhood. With more cells, a pixel is larger than a cell.
pub(super) const MOST_CELLS: u128 = 1 << 16;

/// Maximum number of cells along an axis, so that steps fit into 32 bits.
pub(super) const LONGEST_SIDE: usize = 1000;

/// Maximum distance between slices that are rendered together, in steps.
const DEEPEST: i32 = STEPS * 5 / 16;

/// A range of columns in a band, rendered with a shared table of feature points.
pub(super) struct Block<'a> {
    /// The block's band, or the bands of several slices with equal columns and rows.
    pub(super) bands: &'a [Band<'a>],
    pub(super) level: Level,
    /// The block's columns, in the window.
    pub(super) range: Range<usize>,
}

/// Per-thread scratch memory, reused from block to block.
pub(super) struct Memory {
    pub(super) table: Table,
    /// Table of the points around a square whose neighborhood had to grow.
    pub(super) wide_table: Table,
    /// Whether the candidates of the current square come from `wide_table`.
    pub(super) is_wide: bool,
    /// Candidates of a square, in space (`list`) and projected to the image (`square`).
    pub(super) list: PointList,
    pub(super) square: FlatPoints,
    /// Origin of the coordinates of `square`, in steps from the lower corner of the table.
    pub(super) low: [i32; MOST_AXES],
    /// Candidates of a tile, in space (`tile_list`) and projected to the image (`tile`).
    pub(super) tile_list: PointList,
    pub(super) tile: FlatPoints,
    pub(super) candidates: Vec<Candidate>,
    pub(super) lookup: Lookup,
    pub(super) dominance: Dominance,
    /// Areas of pixels that need points beyond their neighborhood.
    pub(super) unknown: Vec<Area>,
    /// Neighbors of a feature point, and the bisecting planes that bound its Voronoi cell.
    pub(super) neighbors: Neighbors,
    pub(super) planes: Planes,
    /// Distances to cell edges, computed so far.
    pub(super) values: Vec<f32>,
    pub(super) runs: Vec<Range<usize>>,
    /// Points sorted into bins of pixels, in the order of their cells.
    pub(super) bins: Bins,
    /// Points of `bins` in the order of their bins, with their key terms.
    pub(super) points: PointLists,
    /// Coordinates of the block's columns (first axis) and the band's rows (other axes), in steps from the lower
    /// corner of the table. The last coordinate is repeated to fill a register.
    pub(super) lines: [Vec<i32>; MOST_AXES],
    /// Coordinates of the slices along the axes orthogonal to them, in steps; empty for a single slice.
    pub(super) slices: Vec<[i32; MOST_AXES]>,
    n_axes: usize,
}

impl Memory {
    pub(super) fn new() -> Self {
        Self {
            table: Table::new(),
            wide_table: Table::new(),
            is_wide: false,
            list: PointList::new(),
            square: FlatPoints::new(),
            low: [0; MOST_AXES],
            tile_list: PointList::new(),
            tile: FlatPoints::new(),
            candidates: Vec::new(),
            lookup: Lookup::new(),
            dominance: Dominance::new(),
            unknown: Vec::new(),
            neighbors: Neighbors::new(),
            planes: Planes::new(),
            values: Vec::new(),
            runs: Vec::new(),
            bins: Bins::new(),
            points: PointLists::default(),
            lines: core::array::from_fn(|_| Vec::new()),
            slices: Vec::new(),
            n_axes: 0,
        }
    }

    /// Returns the bounds of an area's pixels, over all slices of the area.
    #[inline]
    pub(super) fn pixel_box(&self, area: &Area) -> PixelBox {
        let mut pixels = PixelBox {
            n_axes: self.n_axes,
            low: [0; MOST_AXES],
            high: [0; MOST_AXES],
        };
        // Coordinates are monotonic along a line, so the bounds are at the ends of each range.
        for axis in 0..self.n_axes {
            let line = &self.lines[axis];
            let range = if axis == 0 { &area.columns } else { &area.rows };
            let [a, b] = [line[range.start], line[range.end - 1]];
            (pixels.low[axis], pixels.high[axis]) = (a.min(b), a.max(b));
        }
        // Each slice is constant along the other axes.
        if let Some([first, others @ ..]) = self.slices.get(area.slices.clone()) {
            for axis in 2..self.n_axes {
                (pixels.low[axis], pixels.high[axis]) = (first[axis], first[axis]);
                for other in others {
                    pixels.low[axis] = pixels.low[axis].min(other[axis]);
                    pixels.high[axis] = pixels.high[axis].max(other[axis]);
                }
            }
        }
        pixels
    }

    /// Returns the axis along which several slices differ; `None` for a single slice.
    fn deep_axis(&self) -> Option<usize> {
        let (first, last) = (self.slices.first()?, self.slices.last()?);
        let axes = 2..self.n_axes;
        // Slices at the same position differ along no axis. The third axis is then as good as any other.
        Some(
            axes.clone()
                .find(|&axis| first[axis] != last[axis])
                .unwrap_or(axes.start),
        )
    }

    /// Stores the coordinates of a block's columns and its band's rows, in steps from the lower corner of `cells`.
    pub(super) fn take_lines(&mut self, block: &Block<'_>, cells: &CellBox) {
        self.n_axes = cells.n_axes;
        let band = &block.bands[0];
        let steps = |axis: usize, (cell, steps): (i64, i32)| {
            ((cell - cells.first[axis]) as i32) * STEPS + steps
        };
        self.slices.clear();
        // Record the coordinates of several slices along the axes that are orthogonal to them.
        if block.bands.len() > 1 {
            let slices = block.bands.iter().map(|band| {
                let mut slice = [0; MOST_AXES];
                for axis in 2..cells.n_axes {
                    slice[axis] = steps(axis, band.rows[axis].places[0]);
                }
                slice
            });
            self.slices.extend(slices);
        }
        // Convert the columns and rows to steps, and pad them by a register.
        for axis in 0..cells.n_axes {
            let places = match axis {
                0 => &band.columns.places[block.range.clone()],
                _ => &band.rows[axis].places,
            };
            let steps = places.iter().map(|&place| steps(axis, place));
            let line = &mut self.lines[axis];
            line.clear();
            line.extend(steps);
            let last = line.last().copied().unwrap_or(0);
            line.resize(line.len() + LANES, last);
        }
    }
}

impl Block<'_> {
    /// Renders the pixels of the block. `outs` are the rows of its bands.
    pub(super) fn render(&self, outs: &mut [Output<'_>], memory: &mut Memory) {
        let mut first = 0;
        while first < self.bands.len() {
            let n = self.n_together(first, &outs[first]);
            let part = Block {
                bands: &self.bands[first..first + n],
                level: self.level,
                range: self.range.clone(),
            };
            part.render_together(&mut outs[first..first + n], memory);
            first += n;
        }
    }

    /// Returns the number of slices, starting at `first`, that can share one list of candidates.
    fn n_together(&self, first: usize, out: &Output<'_>) -> usize {
        if first + 1 == self.bands.len() {
            return 1;
        }
        let bands = &self.bands[first..];
        // Slices share candidates only for values, and only where dominated points are culled.
        let is_single = !matches!(out, Output::Values(..))
            || !culls_dominated(self.level, bands[0].picture.basis.metric())
            || self.splat(out, self.guess(out)).is_some();
        if is_single {
            return 1;
        }
        let place = |band: &Band<'_>, axis: usize| {
            let (cell, steps) = band.rows[axis].places[0];
            (cell as f64) * f64::from(STEPS) + f64::from(steps)
        };
        let axes = 2..bands[0].rows.len();
        let far = |band: &Band<'_>, axis: usize| (place(band, axis) - place(&bands[0], axis)).abs();
        // Slices may differ along one axis only.
        let next = bands.get(1).unwrap_or(&bands[0]);
        let deep = axes.clone().find(|&axis| far(next, axis) > 0.0);
        let is_near = |band: &&Band<'_>| {
            axes.clone().all(|axis| match far(band, axis) {
                far if Some(axis) == deep => far <= f64::from(DEEPEST),
                far => far == 0.0,
            }) && band.rows.iter().all(|rows| rows.is_finite)
        };
        bands.iter().take_while(is_near).count().max(1)
    }

    /// Returns the number of nearest points that the inner loops track: one, two or four for values, otherwise two or
    /// four.
    fn depth(out: &Output<'_>) -> usize {
        match (out, out.depth()) {
            (Output::Values(..), 1) => 1,
            (_, ..=2) => 2,
            _ => MAX_NEAREST,
        }
    }

    /// Estimates the distance to the nearest points of a pixel in the middle of the block.
    fn guess(&self, out: &Output<'_>) -> Guess {
        let Picture { basis, section, .. } = self.bands[0].picture;
        Guess::new(basis, self.middle(), section.n_axes, Self::depth(out))
    }

    /// Returns the parameters of the method for small cells; `None` if the method does not apply.
    fn splat(&self, out: &Output<'_>, guess: Guess) -> Option<Splat> {
        let is_values = matches!(out, Output::Values(..));
        Splat::new(self, Self::depth(out), guess.distance).filter(|_| is_values)
    }

    /// Renders one or several slices that share their candidates.
    fn render_together(&self, outs: &mut [Output<'_>], memory: &mut Memory) {
        if let Output::Edges(rows) = &mut outs[0] {
            self.edges(rows, memory);
            return;
        }
        let Picture { basis, section, .. } = self.bands[0].picture;
        let metric = basis.metric();
        let is_values = matches!(outs[0], Output::Values(..));
        let wants_ids = outs[0].wants_ids();
        let depth = Self::depth(&outs[0]);
        // Estimate the neighborhood that contains the nearest points.
        let guess = self.guess(&outs[0]);
        let splat = self.splat(&outs[0], guess);
        let reach = splat.map_or(0, |splat| splat.reach.ceil() as i32);
        // Powers are so slow that SIMD gains nothing, except for values.
        let is_single = !is_values && metric.is_slow();
        let cells = self.cells(guess.ring.max(reach));
        let Some(cells) = cells.filter(|_| !is_single) else {
            self.one_by_one(&self.all(), outs);
            return;
        };
        memory.take_lines(self, &cells);
        // Use the method for small cells if pixels are evenly spaced.
        let splat = splat.filter(|splat| splat.is_even(&memory.lines));
        if let (Output::Values(values, rows), Some(splat)) = (&mut outs[0], &splat) {
            splat.render(self, &cells, values, rows, memory);
            return;
        }
        // The table of the previous image may cover the same cells.
        if !memory.table.has(&cells, wants_ids) {
            memory.table.wants_ids = wants_ids;
            memory.table.fill(self.level, basis.lattice(), cells);
        }
        memory.square.wants_numbers = !is_values;
        memory.tile.wants_numbers = !is_values;
        // Without the method for small cells, select candidates for squares and tiles.
        let plan = Plan {
            depth,
            guess,
            metric,
            // The terms of the axes orthogonal to the image are accumulated before those of the rows.
            row_axis: section
                .row_axis()
                .filter(|&axis| section.n_axes < 4 || axis == 1),
            tile: [0; 2],
            deep_axis: memory.deep_axis(),
        };
        self.squares(plan, outs, memory);
    }

    /// Returns the area of all pixels of the block.
    pub(super) fn all(&self) -> Area {
        Area {
            columns: 0..self.range.len(),
            rows: 0..self.bands[0].n_rows,
            slices: 0..self.bands.len(),
        }
    }

    /// Returns the cell of the block's middle pixel.
    pub(super) fn middle(&self) -> [i64; MOST_AXES] {
        let mut middle = [0; MOST_AXES];
        let band = &self.bands[0];
        middle[0] = band.columns.places[self.range.start + self.range.len() / 2].0;
        for axis in 1..band.rows.len() {
            middle[axis] = band.rows[axis].places[band.n_rows / 2].0;
        }
        middle
    }

    /// Returns the cells of the block's pixels and `ring` cells around them; `None` if a table cannot hold them.
    pub(super) fn cells(&self, ring: i32) -> Option<CellBox> {
        let band = &self.bands[0];
        let is_finite = band.columns.is_finite && band.rows.iter().all(|rows| rows.is_finite);
        if !is_finite || !band.picture.section.is_upright() {
            return None;
        }
        let n_axes = band.rows.len();
        let mut cells = CellBox {
            n_axes,
            first: [0; MOST_AXES],
            last: [0; MOST_AXES],
        };
        // Find the cells of the first slice.
        for axis in 0..n_axes {
            [cells.first[axis], cells.last[axis]] = match axis {
                0 => band.columns.cells(self.range.clone()),
                _ => band.rows[axis].cells(0..band.n_rows),
            };
        }
        // Extend the box to the cells of the other slices.
        for slice in &self.bands[1..] {
            for axis in 2..n_axes {
                let (cell, _) = slice.rows[axis].places[0];
                cells.first[axis] = cells.first[axis].min(cell);
                cells.last[axis] = cells.last[axis].max(cell);
            }
        }
        // Add the rings of cells around the pixels.
        let cells = cells.widened(i64::from(ring));
        let is_small = cells.n_cells() <= MOST_CELLS
            && (0..n_axes).all(|axis| cells.side(axis) <= LONGEST_SIDE);
        is_small.then_some(cells)
    }

    /// Returns whether the block and its neighborhood have more cells than [`MANY_CELLS`].
    pub(super) fn has_many_cells(&self) -> bool {
        self.cells(1)
            .is_none_or(|cells| cells.n_cells() > MANY_CELLS)
    }

    /// Renders the pixels of an area with an individual search for each pixel.
    pub(super) fn one_by_one(&self, area: &Area, outs: &mut [Output<'_>]) {
        for slice in area.slices.clone() {
            for row in area.rows.clone() {
                for column in area.columns.clone() {
                    self.one(slice, self.range.start + column, row, &mut outs[slice]);
                }
            }
        }
    }

    /// Renders one pixel of a slice. `column` is a column of the window, `row` a row of the band.
    pub(super) fn one(&self, slice: usize, column: usize, row: usize, out: &mut Output<'_>) {
        let band = &self.bands[slice];
        let Picture { basis, section, .. } = band.picture;
        let place = band.picture.place(column, band.first + row);
        // Positions out of range have no nearest points.
        let nearest = |n: usize| {
            let mut hits = [Hit::NONE; MAX_NEAREST];
            if let Some(place) = &place {
                basis.nearest(place, &mut hits[..n]);
            } else {
                hits.fill(Hit::NOWHERE);
            }
            hits
        };
        let n = section.n_axes;
        match out {
            Output::Values(values, rows) => values.put_one(basis, place, &mut rows[row][column]),
            Output::Gradients(tone, rows) => {
                let vectors = nearest(tone.depth()).map(|hit| hit.vector);
                let gradient = tone.gradient(basis.metric(), &vectors);
                let gradient = place.map_or([f32::NAN; MOST_AXES], |_| gradient);
                rows[row][column * n..][..n].copy_from_slice(&gradient[..n]);
            }
            Output::Edges(rows) => rows[row][column] = self.edge(column, row),
            Output::Features(features) => {
                let hits = nearest(MAX_NEAREST);
                for (hit, features) in hits.iter().zip(features) {
                    let id = hit.name.map_or(0, PointId::id);
                    if let Some(out) = features.distance.get_mut(row) {
                        let distance = || basis.metric().distance(hit.key);
                        out[column] = place.map_or(f32::NAN, |_| distance());
                    }
                    if let Some(out) = features.vector.get_mut(row) {
                        out[column * n..][..n].copy_from_slice(&hit.vector[..n]);
                    }
                    if let Some(out) = features.position.get_mut(row) {
                        for (axis, out) in out[column * n..][..n].iter_mut().enumerate() {
                            *out = place.map_or(f64::NAN, |place| {
                                position((place.cell[axis], place.steps[axis]), hit.vector[axis])
                            });
                        }
                    }
                    if let Some(out) = features.id.get_mut(row) {
                        out[column] = id;
                    }
                    if let Some(out) = features.cell_value.get_mut(row) {
                        out[column] = place.map_or(f32::NAN, |_| cell_value(id));
                    }
                }
            }
        }
    }
}
