//! Measures the power of an image in octaves of frequency.
//!
//! Reference: our own.

use super::quotient;
use crate::fourier::power_spectrum;
use core::f64::consts::TAU;
use dapple_raster::Raster;

/// Lowest frequency of a measured octave, in cycles per side. The peak of the Hann window at frequency 0 extends 2
/// cycles to either side, so it affects no octave.
const LEAST_CYCLES: u32 = 4;

/// Returns the tile's power in each octave as a multiple of the source's power, finest octave first.
pub(super) fn kept(source: &Raster<f32>, tile: &Raster<f32>) -> Vec<f64> {
    let sides = source.size().into_iter().chain(tile.size());
    let shortest = sides.min().unwrap_or(0);
    let n_octaves = (shortest / (2 * LEAST_CYCLES)).checked_ilog2().unwrap_or(0);
    let [kept, all] = [tile, source].map(|image| octave_powers(image, n_octaves as usize));
    let pairs = kept.into_iter().zip(all);
    pairs.map(|(kept, all)| quotient(kept, all)).collect()
}

/// Computes the mean square of an image in each octave, under the window.
fn octave_powers(image: &Raster<f32>, n_octaves: usize) -> Vec<f64> {
    let mut powers = vec![0.0; n_octaves];
    if n_octaves == 0 {
        return powers;
    }
    let [width, height] = image.size();
    let windows = [hann(width), hann(height)];
    let energy = windows
        .each_ref()
        .map(|of| of.iter().map(|w| w * w).sum::<f64>());
    let size = image.size().map(|side| side as usize);
    let spectrum = power_spectrum(&windowed(image, &windows), size);
    // Add each frequency to its octave: the finer of the octaves along x and y.
    let columns: Vec<usize> = (0..width).map(|index| octave(index, width)).collect();
    for (y, line) in spectrum.chunks_exact(width as usize).enumerate() {
        let row = octave(y as u32, height);
        for (power, &column) in line.iter().zip(&columns) {
            if let Some(sum) = powers.get_mut(row.min(column)) {
                *sum += power;
            }
        }
    }
    let scale = 1.0 / (f64::from(width) * f64::from(height) * energy[0] * energy[1]);
    powers.iter_mut().for_each(|sum| *sum *= scale);
    powers
}

/// Returns the pixels minus their mean, multiplied by the windows of columns and rows.
fn windowed(image: &Raster<f32>, [columns, rows]: &[Vec<f64>; 2]) -> Vec<f64> {
    // Subtract the first pixel, so that a flat image is exactly zero.
    let first = f64::from(image.pixels()[0]);
    let offset = |&value: &f32| f64::from(value) - first;
    let mean = image.pixels().iter().map(offset).sum::<f64>() / image.pixels().len() as f64;
    let mut values = Vec::with_capacity(image.pixels().len());
    for (line, row) in image.view().rows().zip(rows) {
        let line = line.iter().zip(columns);
        values.extend(line.map(|(value, column)| (offset(value) - mean) * (column * row)));
    }
    values
}

/// Returns the Hann window for a side of `n` pixels.
fn hann(n: u32) -> Vec<f64> {
    let turn = |index: u32| TAU * (f64::from(index) + 0.5) / f64::from(n);
    (0..n)
        .map(|index| 0.5 - 0.5 * libm::cos(turn(index)))
        .collect()
}

/// Returns the octave of a frequency: 0 above ¼ cycle per pixel, `usize::MAX` for the mean.
fn octave(index: u32, n: u32) -> usize {
    let cycles = u64::from(index.min(n - index));
    if cycles == 0 {
        return usize::MAX;
    }
    // The octave's frequencies are above 2^-(octave + 2) cycles per pixel.
    let exact = |octave: &usize| cycles << (octave + 2) > u64::from(n);
    (0..32).find(exact).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests;
