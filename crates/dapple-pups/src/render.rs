//! Many positions at once: windows of the plane.
//!
//! The window is cut where it crosses a period, so that coordinates go one way within a piece, and then into bands of
//! [`ROWS`] rows. For every band, the control points that reach into it are taken in their order, and each adds its
//! weights to the tiles that its support can touch. Bands share nothing but what they read, so they can run on any
//! number of threads.

use crate::kernel::{Cubic, Profile, ROWS, Sink, Splat, TILE, TILE_PIXELS};
use crate::net::Net;
use crate::simd;
use crate::weight::AxialWeight;
use core::ops::Range;
use dapple_raster::Window;
use fearless_simd::{Level, dispatch, prelude::*};
use glam::DVec2;

/// Fills the rows of a window, on all cores where the feature `rayon` is on.
///
/// `rows` are those of the window, each with as many values as the sink makes of a pixel, times the width.
pub(crate) fn render<K: Sink>(net: &Net, window: &Window, sink: &K, rows: Vec<&mut [K::Value]>) {
    render_at(simd::level(), net, window, sink, rows);
}

/// As [`render`], at a given SIMD level.
pub(crate) fn render_at<K: Sink>(
    level: Level,
    net: &Net,
    window: &Window,
    sink: &K,
    mut rows: Vec<&mut [K::Value]>,
) {
    let xs: Vec<f64> = (0..window.size[0])
        .map(|column| net.local(0, window.column_x(column)))
        .collect();
    let ys: Vec<f64> = (0..window.size[1])
        .map(|row| net.local(1, window.row_y(row)))
        .collect();
    let columns: Vec<Columns> = runs(&xs)
        .into_iter()
        .map(|run| Columns::new(&xs, run))
        .collect();
    let mut bands = Vec::new();
    let mut rest = rows.as_mut_slice();
    for run in runs(&ys) {
        let members = band_members(net, &ys[run.clone()]);
        for (first, members) in run.clone().step_by(ROWS).zip(members) {
            let (rows, others) = rest.split_at_mut((run.end - first).min(ROWS));
            rest = others;
            let ys = &ys[first..first + rows.len()];
            bands.push(Band {
                net,
                sink,
                columns: &columns,
                members,
                ys,
                rows,
            });
        }
    }
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        bands
            .into_par_iter()
            .for_each_init(Vec::new, |planes, band| band.render(level, planes));
    }
    #[cfg(not(feature = "rayon"))]
    {
        let mut planes = Vec::new();
        bands
            .into_iter()
            .for_each(|band| band.render(level, &mut planes));
    }
}

/// A stretch of columns whose coordinates go one way.
struct Columns {
    /// Where it lies in the window.
    range: Range<usize>,
    /// The coordinates, filled up with the last one to whole tiles.
    xs: Vec<f64>,
    line: Line,
}

impl Columns {
    fn new(xs: &[f64], range: Range<usize>) -> Self {
        let mut padded = xs[range.clone()].to_vec();
        padded.resize(range.len().next_multiple_of(TILE), xs[range.end - 1]);
        Self {
            line: Line::new(&xs[range.clone()]),
            range,
            xs: padded,
        }
    }

    fn n_tiles(&self) -> usize {
        self.xs.len() / TILE
    }
}

/// A few rows of the picture, and what reaches into them.
struct Band<'a, 'rows, K: Sink> {
    net: &'a Net,
    sink: &'a K,
    columns: &'a [Columns],
    /// Indices of instances, in their order.
    members: Vec<u32>,
    ys: &'a [f64],
    rows: &'a mut [&'rows mut [K::Value]],
}

impl<K: Sink> Band<'_, '_, K> {
    /// Fills the rows; `planes` is memory to work in.
    fn render(mut self, level: Level, planes: &mut Vec<f32>) {
        for columns in self.columns {
            if !columns.xs[0].is_finite() || !self.ys[0].is_finite() {
                self.leave_undefined(&columns.range);
                continue;
            }
            planes.clear();
            planes.resize(columns.n_tiles() * self.sink.n_planes() * TILE_PIXELS, 0.0);
            match self.net.options.weight {
                AxialWeight::Cubic => {
                    dispatch!(level, simd => self.splat(simd, Cubic, columns, planes))
                }
                other => dispatch!(level, simd => self.splat(simd, other, columns, planes)),
            }
            dispatch!(level, simd => self.resolve(simd, columns, planes));
        }
    }

    /// Adds up the weights of all members.
    #[inline(always)]
    fn splat<S: Simd, P: Profile>(
        &self,
        simd: S,
        profile: P,
        columns: &Columns,
        planes: &mut [f32],
    ) {
        let last = self.ys.len() - 1;
        let ys = core::array::from_fn(|row| self.ys[row.min(last)]);
        for &member in &self.members {
            let instance = &self.net.instances[member as usize];
            let tiles = columns.line.touched(instance.min.x, instance.max.x, TILE);
            let blocks = self.net.blocks(instance.point);
            let shift = self.net.shifts.get(instance.point as usize).copied();
            let splat = Splat {
                profile,
                instance,
                blocks,
                shift,
            };
            splat.add_to(simd, self.sink, &columns.xs, &ys, tiles, planes);
        }
    }

    /// Turns sums into values.
    #[inline(always)]
    fn resolve<S: Simd>(&mut self, simd: S, columns: &Columns, planes: &[f32]) {
        let per_pixel = self.sink.per_pixel();
        let tiles = planes.chunks_exact(self.sink.n_planes() * TILE_PIXELS);
        for (tile, planes) in tiles.enumerate() {
            let start = columns.range.start + tile * TILE;
            let end = (start + TILE).min(columns.range.end);
            for (row, values) in self.rows.iter_mut().enumerate() {
                let values = &mut values[start * per_pixel..end * per_pixel];
                let nearest = |pixel: usize| {
                    let position = DVec2::new(columns.xs[tile * TILE + pixel], self.ys[row]);
                    self.net.nearest(position).point
                };
                self.sink
                    .resolve(simd, &planes[row * TILE..], values, nearest);
            }
        }
    }

    /// Marks pixels whose positions are not finite.
    fn leave_undefined(&mut self, columns: &Range<usize>) {
        let per_pixel = self.sink.per_pixel();
        for row in self.rows.iter_mut() {
            row[columns.start * per_pixel..columns.end * per_pixel].fill(self.sink.undefined());
        }
    }
}

/// The longest stretches in which coordinates go one way, as they do until a period ends. What is not finite stands by
/// itself.
fn runs(coordinates: &[f64]) -> Vec<Range<usize>> {
    let descends = coordinates.len() > 1 && coordinates[1] < coordinates[0];
    let goes_on = |last: f64, next: f64| if descends { next <= last } else { next >= last };
    let mut runs = Vec::new();
    let mut start = 0;
    for index in 1..=coordinates.len() {
        if index == coordinates.len() || !goes_on(coordinates[index - 1], coordinates[index]) {
            runs.push(start..index);
            start = index;
        }
    }
    runs
}

/// The instances that reach into each band of rows, in their order.
fn band_members(net: &Net, ys: &[f64]) -> Vec<Vec<u32>> {
    let mut members = vec![Vec::new(); ys.len().div_ceil(ROWS)];
    let line = Line::new(ys);
    for (index, instance) in (0..).zip(&net.instances) {
        for band in line.touched(instance.min.y, instance.max.y, ROWS) {
            members[band].push(index);
        }
    }
    members
}

/// Coordinates that go evenly from the first to the last.
struct Line {
    first: f64,
    /// Coordinates per unit of length; negative where they descend, nothing where they are not even.
    per_unit: Option<f64>,
    count: usize,
}

impl Line {
    fn new(coordinates: &[f64]) -> Self {
        let (first, count) = (coordinates[0], coordinates.len());
        let last = coordinates[count - 1];
        // Coordinates that are out of range were all brought to the same place, at either end.
        let goes = |index: usize| coordinates[index] != coordinates[index - 1];
        let even = count > 1 && goes(1) && goes(count - 1);
        Self {
            first,
            per_unit: even.then(|| (count - 1) as f64 / (last - first)),
            count,
        }
    }

    /// The groups of `group` coordinates that an interval touches, or may touch.
    #[inline(always)]
    fn touched(&self, min: f64, max: f64, group: usize) -> Range<usize> {
        let Some(per_unit) = self.per_unit else {
            return 0..self.count.div_ceil(group);
        };
        let [a, b] = [(min - self.first) * per_unit, (max - self.first) * per_unit];
        // One more on either side, for the rounding of the coordinates; as an index, a negative number becomes zero.
        let start = (a.min(b) - 1.0) as usize;
        let end = ((a.max(b) + 3.0) as usize).min(self.count);
        if start < end {
            start / group..end.div_ceil(group)
        } else {
            0..0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Line, runs};

    #[test]
    fn runs_end_where_a_period_ends_or_a_coordinate_is_lost() {
        assert_eq!(runs(&[0.5, 0.75, 0.0, 0.25, 0.5]), [0..2, 2..5]);
        assert_eq!(runs(&[0.5, 0.25, 0.0, 0.75]), [0..3, 3..4]);
        assert_eq!(runs(&[f64::NAN, 0.0, 1.0, f64::NAN]), [0..1, 1..3, 3..4]);
        assert_eq!(runs(&[1.0]), [0..1]);
    }

    #[test]
    fn touched_groups_never_miss_a_coordinate() {
        for (first, last, count) in [
            (0.0, 9.9, 100),
            (5.0, -5.0, 37),
            (2.0, 2.0, 1),
            (1e9, 1e9 + 1.0, 50),
        ] {
            let coordinate =
                |index: usize| first + (last - first) * index as f64 / (count.max(2) - 1) as f64;
            for (min, max) in [
                (-1.0, 3.05),
                (2.0, 2.0),
                (-9.0, -8.0),
                (4.0, f64::INFINITY),
                (1e9 + 0.5, 1e9 + 0.6),
            ] {
                let coordinates: Vec<f64> = (0..count).map(coordinate).collect();
                let groups = Line::new(&coordinates).touched(min, max, 8);
                for index in (0..count).filter(|&index| (min..=max).contains(&coordinate(index))) {
                    assert!(
                        groups.contains(&(index / 8)),
                        "{min}..{max} misses {index} in {first}..{last}"
                    );
                }
            }
        }
    }
}
