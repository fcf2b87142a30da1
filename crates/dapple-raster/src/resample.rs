//! Samples rasters with bilinear interpolation and area averages.

use crate::{Raster, Wrap};
use core::ops::{Add, Mul, Sub};
use glam::DVec2;

/// A value that can be interpolated: `f32`, or a vector of `f32`.
pub trait Texel: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self> {}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>> Texel for T {}

impl<T: Texel> Raster<T> {
    /// Samples the raster at `uv` with bilinear interpolation between the four nearest pixel centers.
    ///
    /// `(0, 0)` is the top left corner of the raster and `(1, 1)` the bottom right one. The center of pixel `[i, j]`
    /// is at `((i + ½) / width, (j + ½) / height)`, where the result equals the pixel. `wrap` is the wrap mode for
    /// each axis. If `uv` is not finite, the first pixel is returned.
    #[must_use]
    pub fn sample_bilinear(&self, uv: DVec2, wrap: [Wrap; 2]) -> T {
        let [width, height] = self.size();
        let (column, fx) = cell_and_fraction(uv.x * f64::from(width) - 0.5);
        let (row, fy) = cell_and_fraction(uv.y * f64::from(height) - 0.5);
        let at = |dx, dy| *self.at(column.saturating_add(dx), row.saturating_add(dy), wrap);
        let top = lerp(at(0, 0), at(1, 0), fx);
        let bottom = lerp(at(0, 1), at(1, 1), fx);
        lerp(top, bottom, fy)
    }

    /// Returns the average over a rectangle centered on `uv`, with the side lengths `area` in `uv` units.
    ///
    /// Each pixel is weighted by its overlap with the rectangle. Along an axis where the rectangle is at most one
    /// pixel long, the value is interpolated as in [`sample_bilinear`](Self::sample_bilinear); if this holds for both
    /// axes, the results are equal. Sides longer than the raster are clamped to its size.
    #[must_use]
    pub fn sample_area(&self, uv: DVec2, area: DVec2, wrap: [Wrap; 2]) -> T {
        let size = self.size().map(f64::from);
        let pixels = area * DVec2::from(size);
        // Rounding may make a rectangle of one pixel slightly longer.
        if !(pixels.x > ONE_PIXEL || pixels.y > ONE_PIXEL) {
            return self.sample_bilinear(uv, wrap);
        }
        let columns = shares(uv.x, pixels.x, size[0]);
        let rows = shares(uv.y, pixels.y, size[1]);
        let (first_row, across) = (rows.first, |row: i64| {
            let at = |column| *self.at(column, row, wrap);
            mean(columns.first, columns.weights(), at)
        });
        mean(first_row, rows.weights(), across)
    }
}

/// Maximum side of a rectangle, in pixels, at which values are interpolated.
const ONE_PIXEL: f64 = 1.0 + 1e-9;

/// The overlap of an interval with a row or column of pixels.
struct Shares {
    first: i64,
    /// Ends of the interval, in pixels relative to the first pixel.
    ends: [f64; 2],
}

/// Returns the overlap of an interval with a row or column of `size` pixels. An interval shorter than a pixel is
/// extended to one pixel, so its weights equal those of linear interpolation.
fn shares(middle: f64, length: f64, size: f64) -> Shares {
    let length = if length > ONE_PIXEL {
        length.min(size)
    } else {
        1.0
    };
    // Round the ends to 2^-20 of a pixel, so that pixel boundaries are matched despite rounding.
    let [from, end] = [-0.5, 0.5].map(|half| {
        let end = middle * size + half * length;
        (end * PARTS + 0.5).floor() / PARTS
    });
    let first = from.floor();
    Shares {
        first: first as i64,
        ends: [from - first, end - first],
    }
}

/// Resolution of interval ends, in steps per pixel.
const PARTS: f64 = (1 << 20) as f64;

impl Shares {
    /// Returns the weights of the overlapped pixels, starting with the first one. They sum to 1.
    fn weights(&self) -> impl Iterator<Item = f32> {
        let [from, end] = self.ends;
        let length = end - from;
        let n_pixels = end.ceil().max(1.0) as u32;
        (0..n_pixels).map(move |pixel| {
            let pixel = f64::from(pixel);
            let covered = (end.min(pixel + 1.0) - from.max(pixel)) / length;
            // A position that is not finite has no overlap, and reads the first pixel.
            if covered > 0.0 { covered as f32 } else { 0.0 }
        })
    }
}

/// Returns the weighted mean of the pixels starting at `first`; `weights` must sum to 1. It is exact if all pixels are
/// equal.
fn mean<T: Texel>(first: i64, weights: impl Iterator<Item = f32>, at: impl Fn(i64) -> T) -> T {
    let base = at(first);
    let mut sum = base;
    for (offset, weight) in (0..).zip(weights).skip(1) {
        sum = sum + (at(first.saturating_add(offset)) - base) * weight;
    }
    sum
}

/// Splits a coordinate into its integer part and a fraction in `[0, 1)`. Outside the range of `i64`, the fraction is
/// 0.
fn cell_and_fraction(coordinate: f64) -> (i64, f32) {
    let floor = coordinate.floor();
    let fraction = (coordinate - floor) as f32;
    // A fraction that rounds to 1 belongs to the next cell.
    match fraction < 1.0 {
        true => (floor as i64, fraction),
        false => ((floor + 1.0) as i64, 0.0),
    }
}

/// Interpolates linearly from `a` (at `t` = 0) to `b` (at `t` = 1). The result is exactly `a` at 0, so that pixel
/// centers reproduce the raster.
fn lerp<T: Texel>(a: T, b: T, t: f32) -> T {
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use crate::{Raster, Wrap};
    use glam::DVec2;

    #[test]
    fn a_raster_is_reproduced_at_its_pixel_centers_for_any_size() {
        // For many sizes that are not powers of 2, the center of a pixel is computed just below an integer.
        for size in [3, 7, 49, 85, 100, 255] {
            let raster = Raster::from_fn([size, 1], |x, _| x as f32).unwrap();
            for column in 0..size {
                let uv = DVec2::new((f64::from(column) + 0.5) * (1.0 / f64::from(size)), 0.5);
                let value = raster.sample_bilinear(uv, [Wrap::Repeat; 2]);
                assert_eq!(value, column as f32, "of {size}");
            }
        }
    }

    #[test]
    fn an_area_has_the_mean_of_the_pixels_under_it() {
        let raster = Raster::from_fn([12, 8], |x, y| ((x * 37 + y * 101) % 17) as f32).unwrap();
        let mean = |first: [u32; 2], size: [u32; 2]| {
            let values = (first[1]..first[1] + size[1]).flat_map(|y| {
                (first[0]..first[0] + size[0]).map(move |x| ((x % 12) * 37 + (y % 8) * 101) % 17)
            });
            f64::from(values.sum::<u32>()) / f64::from(size[0] * size[1])
        };
        for (first, size) in [
            ([0, 0], [3, 2]),
            ([4, 5], [2, 3]),
            ([10, 7], [4, 5]),
            ([0, 0], [12, 8]),
            ([2, 3], [1, 2]),
        ] {
            let at = [0, 1].map(|axis| f64::from(2 * first[axis] + size[axis]) / 2.0);
            let uv = DVec2::from(at) / DVec2::new(12.0, 8.0);
            let area = DVec2::from(size.map(f64::from)) / DVec2::new(12.0, 8.0);
            let sampled = raster.sample_area(uv, area, [Wrap::Repeat; 2]);
            // Tolerance: `f32`, and ends rounded to 2^-20 of a pixel.
            let error = (f64::from(sampled) - mean(first, size)).abs();
            assert!(error < 1e-4, "{first:?} {size:?}: {sampled}");
        }
    }

    #[test]
    fn an_area_of_at_most_a_pixel_is_interpolated_and_larger_ones_go_on_from_there() {
        let raster = Raster::from_fn([12, 8], |x, y| ((x * 37 + y * 101) % 17) as f32).unwrap();
        for step in 0..50 {
            let uv = DVec2::new(f64::from(step) / 31.0, f64::from(step) / 17.0);
            let point = raster.sample_bilinear(uv, [Wrap::Mirror; 2]);
            let sampled = |length: f64| {
                let area = DVec2::splat(length) / DVec2::new(12.0, 8.0);
                raster.sample_area(uv, area, [Wrap::Mirror; 2])
            };
            assert_eq!(sampled(0.0).to_bits(), point.to_bits());
            assert_eq!(sampled(1.0).to_bits(), point.to_bits());
            // A millionth of a pixel more changes values up to 16 by as much; ends are rounded to 2^-20.
            assert!((sampled(1.000_001) - point).abs() < 1e-4);
        }
    }

    #[test]
    fn areas_of_constants_are_exact_and_of_any_place_finite() {
        let flat = Raster::filled([7, 5], 0.1_f32).unwrap();
        for place in [0.3, -41.7, 1e300, f64::NAN, f64::INFINITY] {
            for length in [0.0, 0.31, 1.0, 1e9, f64::INFINITY, f64::NAN] {
                let uv = DVec2::new(place, 0.2);
                let area = DVec2::new(length, 0.4);
                let value = flat.sample_area(uv, area, [Wrap::Repeat, Wrap::Clamp]);
                assert_eq!(value, 0.1, "{place} {length}");
            }
        }
    }

    #[test]
    fn pixel_centers_give_the_pixels() {
        let raster = Raster::from_fn([4, 2], |x, y| (x + 10 * y) as f32).unwrap();
        for (x, y) in [(0, 0), (3, 0), (1, 1), (3, 1)] {
            let uv = DVec2::new((f64::from(x) + 0.5) / 4.0, (f64::from(y) + 0.5) / 2.0);
            assert_eq!(
                raster.sample_bilinear(uv, [Wrap::Repeat; 2]),
                (x + 10 * y) as f32
            );
        }
    }

    #[test]
    fn the_edge_is_interpolated_with_what_wrap_says() {
        let raster = Raster::from_vec([2, 1], vec![0.0_f32, 1.0]).unwrap();
        let at_edge = |wrap| raster.sample_bilinear(DVec2::new(1.0, 0.5), [wrap, Wrap::Clamp]);
        assert_eq!(
            [
                at_edge(Wrap::Repeat),
                at_edge(Wrap::Clamp),
                at_edge(Wrap::Mirror)
            ],
            [0.5, 1.0, 1.0]
        );
    }

    #[test]
    fn positions_that_are_not_finite_read_a_pixel() {
        let raster = Raster::filled([3, 3], 2.0_f32).unwrap();
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300] {
            assert_eq!(
                raster.sample_bilinear(DVec2::splat(bad), [Wrap::Repeat; 2]),
                2.0
            );
        }
    }
}
