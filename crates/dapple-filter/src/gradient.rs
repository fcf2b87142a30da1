//! Differences of values along both axes.

use crate::Part;
use dapple_raster::parallel;
use glam::DVec2;

/// Returns a radius, in units of the plane, as a whole number of columns and rows, at least 1.
#[must_use]
pub fn difference_spans(radius: f64, pixel: DVec2) -> [u32; 2] {
    // The small term makes exact half pixels round up, whatever the rounding error of the pixel size.
    [pixel.x, pixel.y].map(|pixel| ((radius / pixel + 0.5 + 1e-9) as u32).max(1))
}

/// Computes a number for each pixel of a part from the length of the gradient times `scale`, in units of the plane. The
/// gradient is that of the differences along x and y between the values at both ends of the halo.
///
/// # Panics
///
/// If there are fewer values than in the part and its halo.
#[must_use]
pub fn gradients(
    values: &[f32],
    part: &Part,
    scale: f64,
    number: &(dyn Fn(f64) -> f32 + Sync),
) -> Vec<f32> {
    let [width, height] = part.size.map(|side| side as usize);
    let [left, above] = part.halo.map(|side| side as usize);
    let wide = width + 2 * left;
    let span = part.pixel * DVec2::from(part.halo.map(f64::from));
    let scale = scale / (2.0 * span);
    let mut numbers = vec![0.0; width * height];
    parallel::for_each_chunk(&mut numbers, width, |row, out| {
        let line = |row: usize, column: usize| &values[row * wide + column..][..width];
        let [before, after] = [line(row + above, 0), line(row + above, 2 * left)];
        let [over, under] = [line(row, left), line(row + 2 * above, left)];
        for (column, out) in out.iter_mut().enumerate() {
            let x = (f64::from(after[column]) - f64::from(before[column])) * scale.x;
            let y = (f64::from(under[column]) - f64::from(over[column])) * scale.y;
            *out = number((x * x + y * y).sqrt());
        }
    });
    numbers
}
