//! Many positions at once: windows of the plane.
//!
//! The window is cut where it crosses a period, so that coordinates go one way within a piece, and then into bands of
//! [`ROWS`] rows. For every band, the control points that reach into it are taken in their order, and each adds its
//! weights to the pixels that its support can touch. Bands share nothing but what they read, so they can run on any
//! number of threads.

use crate::line::{Line, runs};
use crate::net::Net;
use crate::profile::{Cubic, Profile};
use crate::simd;
use crate::sink::{Planes, Sink};
use crate::splat::{Member, ROWS, Splatter, TILE};
use crate::tile::Tile;
use crate::weight::AxialWeight;
use core::ops::Range;
use dapple_raster::Window;
use fearless_simd::{Level, dispatch, prelude::*};
use glam::DVec2;

/// Pixels to a control point below which registers of 8 lanes are faster than those of 16 (measured).
const FEW_PIXELS: f64 = 0.0;

/// Fills the rows of a window, on all cores where the feature `rayon` is on.
///
/// `rows` are those of the window, each with as many values as the sink makes of a pixel, times the width.
pub(crate) fn render<K: Sink>(net: &Net, window: &Window, sink: &K, rows: Vec<&mut [K::Value]>) {
    let level = simd::level();
    // Supports of a few pixels would leave most of 16 lanes without work.
    let area = net.domain.area() / net.n_points() as f64 / (window.pixel.x * window.pixel.y).abs();
    let level = if area < FEW_PIXELS {
        simd::narrower(level)
    } else {
        level
    };
    render_at(level, net, window, sink, rows);
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
            .for_each_init(Planes::default, |planes, band| band.render(level, planes));
    }
    #[cfg(not(feature = "rayon"))]
    {
        let mut planes = Planes::default();
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
    fn render(mut self, level: Level, planes: &mut Planes) {
        for columns in self.columns {
            if !columns.xs[0].is_finite() || !self.ys[0].is_finite() {
                self.leave_undefined(&columns.range);
                continue;
            }
            planes.clear(self.sink.n_planes(), columns.range.len());
            match self.net.options.weight {
                AxialWeight::Cubic => {
                    dispatch!(level, simd => self.splat(simd, Cubic, columns, planes));
                }
                other => {
                    dispatch!(level, simd => self.splat(simd, other, columns, planes));
                }
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
        planes: &mut Planes,
    ) {
        let last = self.ys.len() - 1;
        let ys = core::array::from_fn(|row| self.ys[row.min(last)]);
        let Columns { xs, line, .. } = columns;
        let splatter = Splatter {
            profile,
            sink: self.sink,
            xs,
            line,
            ys,
        };
        let mut tile = Tile::default();
        for &member in &self.members {
            let instance = &self.net.instances[member as usize];
            let blocks = self.net.blocks(instance);
            let shift = self.net.shifts.get(instance.point as usize).copied();
            splatter.add(
                simd,
                Member {
                    instance,
                    blocks,
                    shift,
                },
                &mut tile,
                planes,
            );
        }
    }

    /// Turns sums into values.
    #[inline(always)]
    fn resolve<S: Simd>(&mut self, simd: S, columns: &Columns, planes: &Planes) {
        let per_pixel = self.sink.per_pixel();
        let Range { start, end } = columns.range;
        for (row, values) in self.rows.iter_mut().enumerate() {
            let values = &mut values[start * per_pixel..end * per_pixel];
            let plane = |plane| planes.row(plane, row, end - start);
            let nearest = |pixel: usize| {
                let position = DVec2::new(columns.xs[pixel], self.ys[row]);
                self.net.nearest(position).point
            };
            self.sink.resolve(simd, plane, values, nearest);
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

/// The instances that reach into each band of rows, in their order.
fn band_members(net: &Net, ys: &[f64]) -> Vec<Vec<u32>> {
    let mut members = vec![Vec::new(); ys.len().div_ceil(ROWS)];
    let line = Line::new(ys);
    for (index, instance) in (0..).zip(&net.instances) {
        let rows = line.touched(instance.min.y, instance.max.y);
        if !rows.is_empty() {
            let bands = &mut members[rows.start / ROWS..rows.end.div_ceil(ROWS)];
            bands.iter_mut().for_each(|members| members.push(index));
        }
    }
    members
}
