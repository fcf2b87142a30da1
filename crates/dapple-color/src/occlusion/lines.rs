//! The heights that a row of pixels is compared with: one or two lines of heights for each sample of each ray.
//!
//! Samples are at whole pixels along an axis, so the heights for adjacent pixels of a register are contiguous.

use super::OcclusionOptions;
use super::rays::{Ray, Sample, reach};
use super::sky::COLUMNS;
use crate::{ColorError, plane};
use dapple_raster::{Raster, Wrap};

/// Heights, extended by columns on both sides according to the wrap, so that whole registers can be read around every
/// pixel.
pub(super) struct Heights {
    padded: Raster<f32>,
    wrap_y: Wrap,
    /// Number of columns to the left of the first computed pixel.
    left: i32,
    /// Number of computed columns, rounded up to whole registers.
    span: usize,
    /// Factors from the height difference of a pixel's two neighbors to a slope, along x and y.
    scale: [f32; 2],
}

/// The heights that a row of pixels is compared with, as slices whose element `i` is for pixel `i`.
pub(super) struct Lines<'a> {
    pub(super) here: &'a [f32],
    /// Lines of neighboring heights: left, right, above and below.
    pub(super) around: [&'a [f32]; 4],
    /// Factors from differences of `around` to slopes, along x and y.
    pub(super) scale: [f32; 2],
    /// Rays, each followed by the opposite one.
    pub(super) views: Vec<View<'a>>,
}

/// A ray of every pixel in a row.
pub(super) struct View<'a> {
    pub(super) direction: [f32; 2],
    pub(super) samples: Vec<Line<'a>>,
}

/// A sample of a ray, for every pixel in a row. The height is interpolated from `near` (at `part` 0) to `far` (at 1).
pub(super) struct Line<'a> {
    pub(super) near: &'a [f32],
    pub(super) far: &'a [f32],
    pub(super) part: f32,
    /// Factor from a height difference to a slope.
    pub(super) scale: f32,
    /// Weight of a slope that exceeds the slope of the tangent plane, from 0 to 1.
    pub(super) weight: f32,
}

impl Heights {
    /// Extends the heights of a part of a raster of `whole` pixels by columns on both sides, according to the wrap.
    /// The part has `margin` columns and rows at each side that are read but not computed; they take less than half of
    /// each side.
    ///
    /// # Errors
    ///
    /// [`Raster`](crate::ColorErrorKind::Raster) if the raster would become too large with the added columns.
    pub(super) fn new(
        height: &Raster<f32>,
        margin: [u32; 2],
        whole: [u32; 2],
        options: &OcclusionOptions,
        rays: &[Ray],
    ) -> Result<Self, ColorError> {
        let size = height.size();
        let left = reach(rays)[0].max(1);
        let span = (size[0] - 2 * margin[0]).next_multiple_of(COLUMNS as u32);
        let mut padded = Raster::filled([span.saturating_add(2 * left), size[1]], 0.0)?;
        let wrap_x = options.plane.wrap[0];
        plane::fill_rows(&mut padded, |row, values| {
            let source = height.row(row);
            let first = i64::from(margin[0]) - i64::from(left);
            for (column, value) in (first..).zip(values) {
                let height = source[plane::index(wrap_x, column, size[0])];
                // NaN never raises a horizon, while infinity would raise every one.
                *value = if height.is_finite() { height } else { f32::NAN };
            }
        });
        let slope = options.plane.strength / (2.0 * options.plane.pixel(whole));
        Ok(Self {
            padded,
            wrap_y: options.plane.wrap[1],
            left: left as i32,
            span: span as usize,
            scale: [slope.x as f32, slope.y as f32],
        })
    }

    /// Returns the heights at an offset, in columns and rows, from each pixel of a row.
    fn line(&self, row: u32, [x, y]: [i32; 2]) -> &[f32] {
        let row = i64::from(row) + i64::from(y);
        let row = plane::index(self.wrap_y, row, self.padded.height());
        let first = (self.left + x) as usize;
        &self.padded.row(row as u32)[first..first + self.span]
    }

    /// Returns all heights that a row of pixels is compared with.
    pub(super) fn lines(&self, row: u32, rays: &[Ray], strength: f64) -> Lines<'_> {
        let line = |sample: &Sample| Line {
            near: self.line(row, sample.near),
            far: self.line(row, sample.far),
            part: sample.part,
            scale: (strength / sample.distance) as f32,
            weight: sample.weight,
        };
        let view = |ray: &Ray| View {
            direction: [ray.direction.x as f32, ray.direction.y as f32],
            samples: ray.samples.iter().map(line).collect(),
        };
        Lines {
            here: self.line(row, [0, 0]),
            around: [[-1, 0], [1, 0], [0, -1], [0, 1]].map(|offset| self.line(row, offset)),
            scale: self.scale,
            views: rays.iter().map(view).collect(),
        }
    }
}
