//! Renders weights, values and labels for all pixels of a window.
//!
//! The window is cut at the ends of periods, so that coordinates are monotonic within each piece, and then into bands
//! of rows. For every band, the control points whose supports intersect it are visited in order. Each adds its weights
//! to the pixels that its support can touch. Bands share only read-only data, so any number of threads can render
//! them.

use crate::line::{Line, runs};
use crate::net::{Instance, Net};
use crate::profile::{Cubic, Profile};
use crate::sink::{Planes, Sink};
use crate::splat::{Footprint, LANES, Member, ROWS, Splatter};
use crate::tile::Tiles;
use crate::weight::AxialWeight;
use core::ops::Range;
use dapple_raster::Window;
use dapple_raster::simd::dispatch;
use dapple_raster::{parallel, simd};
use fearless_simd::{Level, prelude::*};
use glam::DVec2;

/// Maximum number of floats in the sums of a band, so that they fit into the second-level cache of a core: 512 KiB.
const BAND_NUMBERS: usize = 1 << 17;

/// Maximum number of rows of a band. Bands are the units of work of threads.
const BAND_ROWS: usize = 64;

/// Renders the rows of a window. With the feature `rayon`, bands are rendered in parallel.
///
/// Each row has [`Sink::per_pixel`] values per pixel.
pub(crate) fn render<K: Sink>(net: &Net, window: &Window, sink: &K, rows: &mut [&mut [K::Value]]) {
    let level = simd::level();
    // Compute the coordinates, and cut them where a period ends.
    let xs: Vec<f64> = (0..window.size[0])
        .map(|column| net.local(0, window.column_x(column)))
        .collect();
    let ys: Vec<f64> = (0..window.size[1])
        .map(|row| net.local(1, window.row_y(row)))
        .collect();
    let columns: Vec<Lane> = runs(&xs)
        .into_iter()
        .map(|run| Lane::new(&xs, run, LANES))
        .collect();
    // Choose the height of a band so that its sums fit into the cache.
    let height = BAND_NUMBERS / Planes::<K>::per_row(xs.len());
    let height = height.clamp(ROWS, BAND_ROWS);
    // Collect the instances of each band, and split the rows.
    let mut bands = Vec::new();
    let mut rest = rows;
    for run in runs(&ys) {
        let members = band_members(net, &ys[run.clone()], height);
        for (first, members) in run.clone().step_by(height).zip(members) {
            let (rows, others) = rest.split_at_mut((run.end - first).min(height));
            rest = others;
            let ys = Lane::new(&ys, first..first + rows.len(), ROWS);
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
    // Render the bands. Each thread reuses its planes.
    parallel::consume_with(bands, Planes::default, |planes, _, band| {
        band.render(level, planes);
    });
}

/// A run of columns or rows whose coordinates are monotonic.
struct Lane {
    /// Range of the columns or rows in the window.
    range: Range<usize>,
    /// Coordinates, padded with the last one so that whole registers can be read.
    padded: Vec<f64>,
    line: Line,
}

impl Lane {
    fn new(coordinates: &[f64], range: Range<usize>, padding: usize) -> Self {
        let mut padded = coordinates[range.clone()].to_vec();
        padded.resize(range.len() + padding, coordinates[range.end - 1]);
        Self {
            line: Line::new(&padded[..range.len()]),
            range,
            padded,
        }
    }

    fn is_finite(&self) -> bool {
        self.padded[0].is_finite()
    }
}

/// A band of image rows, with the instances whose supports intersect it.
struct Band<'a, 'rows, K: Sink> {
    net: &'a Net,
    sink: &'a K,
    columns: &'a [Lane],
    /// Indices of the instances whose supports intersect the band, in ascending order.
    members: Vec<u32>,
    ys: Lane,
    rows: &'a mut [&'rows mut [K::Value]],
}

impl<K: Sink> Band<'_, '_, K> {
    /// Renders the band's rows; `planes` is scratch memory.
    fn render(mut self, level: Level, planes: &mut Planes<K>) {
        for columns in self.columns {
            // A coordinate that is not finite forms a separate run, so testing the first one is enough.
            if !columns.is_finite() || !self.ys.is_finite() {
                self.leave_undefined(&columns.range);
                continue;
            }
            // Sum the weights of all instances in the planes, then convert the sums to pixel values.
            planes.clear(columns.range.len(), self.ys.padded.len());
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

    /// Adds the weights of all the band's instances to `planes`.
    #[inline(always)]
    fn splat<S: Simd, P: Profile>(
        &self,
        simd: S,
        profile: P,
        columns: &Lane,
        planes: &mut Planes<K>,
    ) {
        let splatter = Splatter {
            profile,
            sink: self.sink,
            xs: &columns.padded,
            ys: &self.ys.padded,
        };
        let mut tiles = Tiles::default();
        for &member in &self.members {
            let instance = &self.net.instances[member as usize];
            let Instance { min, max, .. } = *instance;
            // Find the pixels that the support can touch.
            let rows = self.ys.line.touched(min.y, max.y);
            let columns = columns.line.touched(min.x, max.x);
            if rows.is_empty() || columns.is_empty() {
                continue;
            }
            // A window has fewer than 2^32 columns and rows.
            let footprint = Footprint {
                column: columns.start as u32,
                row: rows.start as u32,
                n_columns: columns.len() as u32,
                n_rows: rows.len() as u32,
            };
            let member = Member {
                instance,
                blocks: self.net.blocks(instance),
                exponents: self.net.exponents(instance),
                shift: self.net.shifts.get(instance.point as usize).copied(),
                footprint,
            };
            splatter.add(simd, member, &mut tiles, planes);
        }
    }

    /// Converts the sums of a run of columns to pixel values.
    #[inline(always)]
    fn resolve<S: Simd>(&mut self, simd: S, columns: &Lane, planes: &mut Planes<K>) {
        let Range { start, end } = columns.range;
        let per_pixel = self.sink.per_pixel();
        for (row, values) in self.rows.iter_mut().enumerate() {
            let values = &mut values[start * per_pixel..end * per_pixel];
            for (index, values) in values.chunks_mut(LANES * per_pixel).enumerate() {
                // The planes store the sums of a row in columns of `LANES` pixels.
                let (sums, _) = planes.rows(index * LANES, row, 1);
                let nearest = |pixel: usize| {
                    let x = columns.padded[index * LANES + pixel];
                    let position = DVec2::new(x, self.ys.padded[row]);
                    self.net.nearest(position)
                };
                self.sink.resolve(simd, sums, values, nearest);
            }
        }
    }

    /// Writes the sink's undefined value to pixels whose positions are not finite.
    fn leave_undefined(&mut self, columns: &Range<usize>) {
        let per_pixel = self.sink.per_pixel();
        for row in self.rows.iter_mut() {
            let values = &mut row[columns.start * per_pixel..columns.end * per_pixel];
            self.sink.leave_undefined(values);
        }
    }
}

/// Returns, for each band of `height` rows, the indices of the instances whose supports intersect it, in ascending
/// order.
fn band_members(net: &Net, ys: &[f64], height: usize) -> Vec<Vec<u32>> {
    let mut members = vec![Vec::new(); ys.len().div_ceil(height)];
    let line = Line::new(ys);
    // Instances are visited in ascending order, so every list is sorted.
    for (index, instance) in (0..).zip(&net.instances) {
        let rows = line.touched(instance.min.y, instance.max.y);
        if !rows.is_empty() {
            let bands = &mut members[rows.start / height..rows.end.div_ceil(height)];
            bands.iter_mut().for_each(|members| members.push(index));
        }
    }
    members
}
