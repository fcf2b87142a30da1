//! Finds the band of an image with the least detail.
//!
//! Reference: our own.

use super::quotient;
use dapple_raster::{Raster, Wrap};

/// Width of a band, in columns or rows.
const BAND: usize = 8;

/// Computes [`SeamReport::lowest_local_detail`](super::SeamReport::lowest_local_detail) of an image.
pub(super) fn lowest_detail(image: &Raster<f32>, wrap: [Wrap; 2]) -> f64 {
    let [columns, rows] = detail_powers(image, wrap);
    let mean = columns.iter().sum::<f64>() / columns.len() as f64;
    let lowest = lowest_band(&columns, wrap[0]).min(lowest_band(&rows, wrap[1]));
    // The sums have different orders, so the lowest may exceed the mean by rounding.
    quotient(lowest, mean).sqrt().min(1.0)
}

/// Computes the mean square of the detail in each column, and in each row.
fn detail_powers(image: &Raster<f32>, wrap: [Wrap; 2]) -> [Vec<f64>; 2] {
    let [width, height] = image.size();
    let beside = |axis: usize, index: u32, length: u32| {
        [-1, 0, 1].map(|offset| wrap[axis].index(i64::from(index) + offset, length))
    };
    let neighbors: Vec<[u32; 3]> = (0..width).map(|x| beside(0, x, width)).collect();
    let mut columns = vec![0.0; width as usize];
    let mut rows = Vec::with_capacity(height as usize);
    for y in 0..height {
        let [above, here, below] = beside(1, y, height).map(|row| image.row(row));
        // Compute the vertical mean over three rows, with weights 1 2 1.
        let down: Vec<f64> = (0..width as usize)
            .map(|x| mean_121([above[x], here[x], below[x]].map(f64::from)))
            .collect();
        let mut row = 0.0;
        // Subtract the mean of 3 × 3 pixels, with weights 1 2 1 along both axes.
        for (x, of) in neighbors.iter().enumerate() {
            let detail = f64::from(here[x]) - mean_121(of.map(|x| down[x as usize]));
            columns[x] += detail * detail;
            row += detail * detail;
        }
        rows.push(row / f64::from(width));
    }
    columns.iter_mut().for_each(|sum| *sum /= f64::from(height));
    [columns, rows]
}

/// Returns the mean of three numbers with weights 1 2 1, which is exact for equal numbers.
fn mean_121([before, here, after]: [f64; 3]) -> f64 {
    ((before + after) + 2.0 * here) / 4.0
}

/// Returns the lowest mean over the width of a band.
fn lowest_band(powers: &[f64], wrap: Wrap) -> f64 {
    let n = powers.len();
    let width = BAND.min(n);
    let n_bands = match wrap {
        Wrap::Repeat => n,
        _ => n + 1 - width,
    };
    let sum = |first: usize| {
        let band = first..first + width;
        band.map(|index| powers[index % n]).sum::<f64>()
    };
    (0..n_bands).map(sum).fold(f64::INFINITY, f64::min) / width as f64
}

#[cfg(test)]
mod tests;
