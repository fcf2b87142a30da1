//! Selects the candidates of a tile, and computes their key terms at its columns and rows.

use super::LANES;
use super::area::Area;
use super::block::Memory;
use super::cull::Cull;
use super::flat::{Cuboid, FlatPoints, PictureAxes};
use super::kernel::{Candidate, TILE};
use super::square::Square;
use crate::fixed::STEP;
use crate::levels::measured;
use crate::metric::Measure;
use fearless_simd::{Level, f32x16, i32x16, prelude::*};

impl Memory {
    /// Selects the candidates of a tile from the candidates of its square, and computes their key terms at the tile's
    /// pixels.
    pub(super) fn candidates(&mut self, level: Level, area: &Area, square: &Square) {
        let (plan, low) = (&square.plan, &square.pixels.low);
        // Remove dominated points from the candidates of the square.
        if plan.culls_dominated(level) {
            let cuboid = self.cuboid(area, square);
            let dominance = &mut self.dominance;
            self.tile
                .take_undominated(level, plan.metric, &self.square, &cuboid, dominance);
        } else {
            // Without dominance culling, cull by bounds, and project the remaining points to the image.
            let pixels = self.pixel_box(area);
            // Shift the tile's bounds to the coordinates of the table that the candidates come from.
            let mut moved = pixels;
            for axis in 0..pixels.n_axes {
                let by = self.low[axis] - low[axis];
                moved.low[axis] += by;
                moved.high[axis] += by;
            }
            // If the square is a single tile, its candidates are culled already.
            if square.is_tile {
                core::mem::swap(&mut self.list, &mut self.tile_list);
            } else {
                let cull = Cull {
                    metric: plan.metric,
                    pixels: &moved,
                    keep: plan.nearest(),
                };
                let run = 0..self.list.len;
                let points = self.list.points(&run, self.tile.wants_numbers);
                self.tile_list.cull(level, cull, points);
            }
            moved.low = self.low;
            let axes = PictureAxes {
                rows: plan.row_axis.unwrap_or(1),
                slices: None,
            };
            self.tile
                .flatten(level, plan.metric, &self.tile_list, &moved, axes);
        }
        if self.candidates.len() < self.tile.len {
            let none = Candidate {
                columns: [0.0; TILE],
                rows: [0.0; TILE],
            };
            let room = self.tile.len.next_power_of_two();
            self.candidates.resize(room, none);
        }
        self.terms(level, area, square, None);
    }

    /// Computes the key terms of a tile's candidates at the tile's columns and, for a single slice, at its rows.
    ///
    /// With `slice`, computes only the terms at the rows of this slice. It is the slice's coordinate, in steps from
    /// the lower corner of the square.
    pub(super) fn terms(&mut self, level: Level, area: &Area, square: &Square, slice: Option<i32>) {
        let plan = &square.plan;
        measured!(level, plan.metric, (simd, measure) => {
            if let Some(place) = slice {
                self.slice_terms(simd, measure, area, square, place);
                return;
            }
            self.column_terms(simd, measure, area, square);
            // With several slices, the terms at the rows are computed for one slice at a time.
            match plan.row_axis {
                Some(_) if plan.deep_axis.is_some() => {}
                Some(row_axis) => self.row_terms(simd, measure, area, square, row_axis),
                None => self.slanted_terms(simd, measure, area, square),
            }
        });
    }

    /// Returns the bounds of a tile's pixels, in cells from the lower corner of its square.
    fn cuboid(&self, area: &Area, square: &Square) -> Cuboid {
        let mut cuboid = square.cuboid;
        if square.is_tile {
            return cuboid;
        }
        let row_axis = square.plan.row_axis.unwrap_or(1);
        // Tighten the bounds along the axes of the columns and of the rows.
        for (index, axis, range) in [(0, 0, &area.columns), (1, row_axis, &area.rows)] {
            let line = &self.lines[axis];
            let [a, b] = [line[range.start], line[range.end - 1]];
            let corner = square.pixels.low[axis];
            cuboid.low[index] = (a.min(b) - corner) as f32 * STEP;
            cuboid.high[index] = (a.max(b) - corner) as f32 * STEP;
        }
        cuboid
    }

    /// Computes the candidates' key terms at the columns of a tile.
    #[inline(always)]
    fn column_terms<S: Simd, M: Measure>(
        &mut self,
        simd: S,
        measure: M,
        area: &Area,
        square: &Square,
    ) {
        let line = &self.lines[0][area.columns.start..];
        for first in (0..area.columns.len()).step_by(LANES) {
            let places = places(simd, &line[first..], square.pixels.low[0]);
            let points = self.tile.x[..self.tile.len].iter();
            for (&x, candidate) in points.zip(&mut self.candidates) {
                let [terms] = measure.terms([places - x]);
                terms.store_slice(&mut candidate.columns[first..first + LANES]);
            }
        }
    }

    /// Computes the candidates' key terms at the rows of a tile in one slice. Rows differ along the second axis, and
    /// `place` is the slice's coordinate, in steps from the lower corner of the square.
    #[inline(always)]
    fn slice_terms<S: Simd, M: Measure>(
        &mut self,
        simd: S,
        measure: M,
        area: &Area,
        square: &Square,
        place: i32,
    ) {
        let place = f32x16::splat(simd, place as f32 * STEP);
        let line = &self.lines[1][area.rows.start..];
        let FlatPoints { y, z, rest, .. } = &self.tile;
        for start in (0..self.tile.len).step_by(LANES) {
            let at = start..start + LANES;
            // Add the terms of the slice to the terms of the other axes, for sixteen candidates.
            let [terms] = measure.terms([place - f32x16::from_slice(simd, &z[at.clone()])]);
            let rest = measure.accumulate(terms, f32x16::from_slice(simd, &rest[at.clone()]));
            let mut rests = [0.0; LANES];
            rest.store_slice(&mut rests);
            let n = LANES.min(self.tile.len - start);
            // Add the terms of the rows.
            for first in (0..area.rows.len()).step_by(LANES) {
                let places = places(simd, &line[first..], square.pixels.low[1]);
                let points = y[at.clone()][..n].iter().zip(&rests);
                for ((&y, &rest), candidate) in points.zip(&mut self.candidates[start..]) {
                    let [terms] = measure.terms([places - y]);
                    let terms = measure.accumulate(terms, f32x16::splat(simd, rest));
                    terms.store_slice(&mut candidate.rows[first..first + LANES]);
                }
            }
        }
    }

    /// Computes the candidates' key terms at the rows of a tile whose rows differ along one axis.
    #[inline(always)]
    fn row_terms<S: Simd, M: Measure>(
        &mut self,
        simd: S,
        measure: M,
        area: &Area,
        square: &Square,
        row_axis: usize,
    ) {
        let line = &self.lines[row_axis][area.rows.start..];
        for first in (0..area.rows.len()).step_by(LANES) {
            let places = places(simd, &line[first..], square.pixels.low[row_axis]);
            let FlatPoints { y, rest, len, .. } = &self.tile;
            let points = y[..*len].iter().zip(&rest[..*len]);
            for ((&y, &rest), candidate) in points.zip(&mut self.candidates) {
                // Accumulate the terms of the row after the terms of the axes that are orthogonal to the image.
                let [terms] = measure.terms([places - y]);
                let terms = measure.accumulate(terms, f32x16::splat(simd, rest));
                terms.store_slice(&mut candidate.rows[first..first + LANES]);
            }
        }
    }

    /// Computes the candidates' key terms at the rows of a tile whose rows differ along several axes.
    #[inline(always)]
    fn slanted_terms<S: Simd, M: Measure>(
        &mut self,
        simd: S,
        measure: M,
        area: &Area,
        square: &Square,
    ) {
        for first in (0..area.rows.len()).step_by(LANES) {
            for (index, candidate) in self.candidates[..self.tile.len].iter_mut().enumerate() {
                // Accumulate the terms of all axes except the first, from the last axis on.
                let mut keys = f32x16::splat(simd, 0.0);
                for axis in (1..square.pixels.n_axes).rev() {
                    let line = &self.lines[axis][area.rows.start + first..];
                    let point = (self.tile_list.steps[axis][index] - self.low[axis]) as f32 * STEP;
                    let [terms] =
                        measure.terms([places(simd, line, square.pixels.low[axis]) - point]);
                    keys = measure.accumulate(terms, keys);
                }
                keys.store_slice(&mut candidate.rows[first..first + LANES]);
            }
        }
    }
}

/// Returns sixteen coordinates of `line`, in cells from `low`, the lower corner of a square.
#[inline(always)]
fn places<S: Simd>(simd: S, line: &[i32], low: i32) -> f32x16<S> {
    (i32x16::from_slice(simd, &line[..LANES]) - low).to_float::<f32x16<S>>() * STEP
}
