//! Renders images from a function that returns a color for every position.

use dapple_raster::{Raster, RasterError, Texel, Window, glam::DVec2};

/// Renders the unit square, with row 0 at `y = 0`. Every pixel is the mean of `side` × `side` samples of `value`.
///
/// # Errors
///
/// If a side of `size` is zero, or there are too many samples.
pub fn sampled<T: Texel + Send>(
    size: [u32; 2],
    side: u32,
    value: impl Fn(DVec2) -> T + Sync,
) -> Result<Raster<T>, RasterError> {
    let side = side.max(1);
    let fine = Window::unit(size.map(|pixels| pixels.saturating_mul(side)))?;
    let share = 1.0 / (side * side) as f32;
    let mean = |column: u32, row: u32| {
        let mut sum: Option<T> = None;
        for y in row * side..(row + 1) * side {
            for x in column * side..(column + 1) * side {
                let sample = value(fine.position(x, y).into());
                sum = Some(sum.map_or(sample, |sum| sum + sample));
            }
        }
        // There is a first sample, so the sum exists.
        sum.unwrap_or_else(|| value(fine.position(column, row).into())) * share
    };
    let mean = &mean;
    Raster::from_rows(size, |row| {
        (0..size[0]).map(move |column| mean(column, row))
    })
}

/// Returns a smooth step from 0 at `from` to 1 at `to`.
#[must_use]
pub fn smooth_step(from: f64, to: f64, value: f64) -> f64 {
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::sampled;

    #[test]
    fn sampled_pixels_are_means_of_their_samples() {
        let ramp = sampled([2, 2], 4, |at| at.x as f32).unwrap();
        assert_eq!(ramp.pixels(), [0.25, 0.75, 0.25, 0.75]);
        let edge = sampled([1, 1], 8, |at| if at.y < 0.25 { 1.0 } else { 0.0 }).unwrap();
        assert_eq!(edge.pixels(), [0.25], "a quarter of the pixel");
    }

    #[test]
    fn sampled_without_pixels_or_with_too_many_samples_is_refused() {
        assert!(sampled([0, 1], 4, |_| 0.0).is_err(), "no pixel");
        assert!(sampled([u32::MAX; 2], 8, |_| 0.0).is_err(), "too many");
    }
}
