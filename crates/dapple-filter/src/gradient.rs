//! Gradient lengths by central differences.

use crate::Part;
use dapple_raster::parallel;
use glam::DVec2;

/// Returns the halo of a central difference: `radius`, in units of the plane, in whole columns and rows, at least 1.
#[must_use]
pub fn difference_spans(radius: f64, pixel: DVec2) -> [u32; 2] {
    // The small term makes exact half pixels round up, whatever the rounding error of the pixel size.
    [pixel.x, pixel.y].map(|pixel| ((radius / pixel + 0.5 + 1e-9) as u32).max(1))
}

/// Returns `number(length · scale)` for each pixel of a part, where `length` is the length of the gradient per unit of
/// the plane. The gradient consists of central differences along x and y, between the values at both ends of the halo.
///
/// # Panics
///
/// If `values` has fewer pixels than the part and its halo.
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
