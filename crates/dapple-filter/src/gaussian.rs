//! Gaussian blur in all directions.
//!
//! The blur is separable: rows first, then columns. Weights are samples of the Gaussian at the pixel centers, up to three
//! standard deviations, divided by their sum. Each pass adds weighted differences from the center in a fixed order, from
//! near pixels to far ones. A constant therefore stays the same, bit for bit.
//!
//! Running sums and recursive filters would be faster for large radii, but their rounding depends on the first pixel
//! of a part.

use crate::Part;
use crate::extremes::disk_halo;
use dapple_raster::parallel;
use glam::DVec2;

/// Returns the halo of a Gaussian blur: the pixels within three standard deviations `radius`, in units of the plane.
#[must_use]
pub fn gaussian_halo(radius: f64, pixel: DVec2) -> [u32; 2] {
    disk_halo(3.0 * radius, pixel)
}

/// Returns the Gaussian weights at distances of 1 to `reach` pixels on one side. They are normalized: the weights on
/// all `sides` sides and the center weight sum to 1.
pub(crate) fn weights(radius: f64, pixel: f64, reach: u32, sides: f64) -> Vec<f32> {
    let weight = |distance: u32| {
        let part = f64::from(distance) * pixel / radius;
        libm::exp(-0.5 * part * part)
    };
    let weights: Vec<f64> = (1..=reach).map(weight).collect();
    let sum = 1.0 + sides * weights.iter().sum::<f64>();
    weights.iter().map(|weight| (weight / sum) as f32).collect()
}

/// Blurs a part of a raster with a Gaussian of the standard deviation `radius`, in units of the plane.
///
/// # Panics
///
/// If `values` has fewer pixels than the part and its halo, which must equal [`gaussian_halo`].
#[must_use]
pub fn gaussian(values: &[f32], part: &Part, radius: f64) -> Vec<f32> {
    let ([width, height], halo) = (part.size.map(|side| side as usize), part.halo);
    let [across, down] = [0, 1].map(|axis| weights(radius, part.pixel[axis], halo[axis], 2.0));
    let [left, above] = halo.map(|side| side as usize);
    // Blur along the rows of the window and its halo.
    let mut rows = vec![0.0; width * (height + 2 * above)];
    parallel::for_each_chunk(&mut rows, width, |row, out| {
        let line = &values[row * (width + 2 * left)..][..width + 2 * left];
        let from = |first: usize| &line[first..first + width];
        out.copy_from_slice(from(left));
        for (tap, &weight) in (1..).zip(&across) {
            add_pair(
                out,
                from(left),
                [from(left - tap), from(left + tap)],
                weight,
            );
        }
    });
    // Blur along the columns.
    let mut blurred = vec![0.0; width * height];
    parallel::for_each_chunk(&mut blurred, width, |row, out| {
        let line = |row: usize| &rows[row * width..][..width];
        let here = row + above;
        out.copy_from_slice(line(here));
        for (tap, &weight) in (1..).zip(&down) {
            add_pair(
                out,
                line(here),
                [line(here - tap), line(here + tap)],
                weight,
            );
        }
    });
    blurred
}

/// Adds two taps of a filter: the weighted differences of the lines `before` and `after` from the center line `here`.
fn add_pair(out: &mut [f32], here: &[f32], [before, after]: [&[f32]; 2], weight: f32) {
    let pairs = before.iter().zip(after);
    for ((out, &here), (&before, &after)) in out.iter_mut().zip(here).zip(pairs) {
        *out += weight * (before + after - (here + here));
    }
}
