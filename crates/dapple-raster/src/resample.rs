//! Bilinear interpolation of rasters.

use crate::{Raster, Wrap};
use core::ops::{Add, Mul, Sub};
use glam::DVec2;

/// A value that can be interpolated: `f32`, or a vector of `f32`.
pub trait Texel: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self> {}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>> Texel for T {}

impl<T: Texel> Raster<T> {
    /// The value at `uv`, interpolated between the four nearest pixel centers.
    ///
    /// `(0, 0)` is the top left corner of the raster and `(1, 1)` the bottom right one; the center of pixel
    /// `[i, j]` is at `((i + ½) / width, (j + ½) / height)`, where the result is that pixel. `wrap` says, for each
    /// axis, what lies past the edge. A `uv` that is not finite reads the first pixel.
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
}

/// The whole-number part and the rest in `[0, 1)`. Past the range of `i64` the fraction is 0.
fn cell_and_fraction(coordinate: f64) -> (i64, f32) {
    let floor = coordinate.floor();
    let fraction = (coordinate - floor) as f32;
    // A fraction that rounds to 1 is the next cell.
    match fraction < 1.0 {
        true => (floor as i64, fraction),
        false => ((floor + 1.0) as i64, 0.0),
    }
}

/// Interpolates linearly; equal to `a` at 0, so that a raster is reproduced exactly at its pixel centers.
fn lerp<T: Texel>(a: T, b: T, t: f32) -> T {
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use crate::{Raster, Wrap};
    use glam::DVec2;

    #[test]
    fn a_raster_is_reproduced_at_its_pixel_centers_for_any_size() {
        // The center of a pixel comes out just below a whole number for many sizes that are not powers of 2.
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
