//! The periodic Fourier projector, which halves and doubles a plane with sines and cosines.
//!
//! Du, Wang and Meng name sines as other functions for a tile, and leave open how sines are refined. Here a coarse line
//! of `m` samples represents the function that has these samples and consists of the sines and cosines below the
//! frequency `m/2`. For an even `m`, it also has the cosine at `m/2` whose extremes are at the samples. To halve a
//! line, the nearest such function is fitted by least squares over the pixels, and sampled. To double a line, the
//! function is evaluated at the pixels. Halving a doubled line restores the line and its function.
//!
//! A line that does not repeat is extended by its mirror image, with repeated end pixels. Its functions are the cosines
//! of the discrete cosine transform. Coarse samples are then at the centers of the pixels that they replace, whatever
//! the phase, since only there the samples are mirrored as well.

use crate::fourier::{BAND, Element, Fourier, map_columns, times};
use crate::{IsCancelled, TileError};
use core::f64::consts::TAU;
use dapple_raster::Raster;
use dapple_wavelet::Phase;

/// Lengths of a line before and after halving, and the position of the coarse samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    /// Number of pixels in the line.
    pub(crate) fine: u32,
    /// Number of coarse samples, which is less than the number of pixels.
    pub(crate) coarse: u32,
    /// Whether the line repeats; otherwise it is mirrored.
    pub(crate) repeats: bool,
    /// Position of the first coarse sample, if the line repeats. It is at the center of the pixels that become one
    /// sample, or one fine pixel earlier for each halving.
    pub(crate) phase: Phase,
}

/// Fits functions to the columns and rows of a plane, and samples them.
pub(crate) fn coarse(
    plane: &Raster<f32>,
    axes: [Axis; 2],
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    change(plane, axes.map(|axis| axis.coarse), is_cancelled, |axis| {
        let sampling = Sampling::new(&axes[axis]);
        move |line| sampling.coarse(line)
    })
}

/// Evaluates the functions of the columns and rows of a coarse plane at the pixels.
pub(crate) fn refine(
    plane: &Raster<f32>,
    axes: [Axis; 2],
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    change(plane, axes.map(|axis| axis.fine), is_cancelled, |axis| {
        let sampling = Sampling::new(&axes[axis]);
        move |line| sampling.refine(line)
    })
}

/// Applies a function to all columns, and then to all rows.
fn change<C: Fn(Vec<Element>) -> Vec<Element> + Sync>(
    plane: &Raster<f32>,
    size: [u32; 2],
    is_cancelled: &IsCancelled,
    along: impl Fn(usize) -> C,
) -> Result<Raster<f32>, TileError> {
    let values: Vec<_> = plane.pixels().iter().map(|&value| value.into()).collect();
    // Process the columns. The result is transposed, so the rows are the next columns.
    let width = plane.width() as usize;
    let turned = map_columns(&values, width, is_cancelled, along(1))?;
    let values = map_columns(&turned, size[1] as usize, is_cancelled, along(0))?;
    let pixels = values.into_iter().map(|value| value as f32).collect();
    Ok(Raster::from_vec(size, pixels)?)
}

/// The transforms of a fine and a coarse line.
struct Sampling {
    fine: Fourier,
    coarse: Fourier,
    /// Whether lines are mirrored, which doubles the length of the transforms.
    mirrored: bool,
    /// Phase shifts from the first pixel to the first coarse sample, as cosine and sine, for each frequency up to the
    /// coarse line's highest.
    turns: Vec<[f64; 2]>,
}

impl Sampling {
    fn new(axis: &Axis) -> Self {
        // A line that does not repeat is followed by its mirror image.
        let mirrored = !axis.repeats;
        let copies = if mirrored { 2 } else { 1 };
        let [fine, coarse] = [axis.fine, axis.coarse].map(|length| copies * length as usize);
        // Offset of the first coarse sample from the first pixel, in pixels, for centered samples.
        let middle = 0.5 * (f64::from(axis.fine) / f64::from(axis.coarse) - 1.0);
        let first_sample = match axis.phase {
            Phase::CookDeRose if axis.repeats => -middle,
            _ => middle,
        };
        // Phase of frequency k at the first coarse sample.
        let turn = |k: usize| {
            let (sin, cos) = libm::sincos(TAU * (k as f64 * first_sample / fine as f64));
            [cos, sin]
        };
        Self {
            fine: Fourier::new(fine),
            coarse: Fourier::new(coarse),
            mirrored,
            turns: (0..=coarse / 2).map(turn).collect(),
        }
    }

    /// Fits the nearest functions, and samples them.
    fn coarse(&self, mut line: Vec<Element>) -> Vec<Element> {
        let [n_fine, n_coarse] = [self.fine.length(), self.coarse.length()];
        self.mirror(&mut line);
        self.fine.forward(&mut line);
        // Evaluate the low frequencies at the coarse samples, and drop the others.
        let mut spectrum = vec![[0.0; BAND]; n_coarse];
        let scale = 1.0 / n_fine as f64;
        for (k, &[cos, sin]) in self.turns.iter().enumerate() {
            let [cos, sin] = [cos * scale, sin * scale];
            add(&mut spectrum[k], times(&line[k], [cos, sin]));
            if k > 0 {
                // At the highest frequency of an even line, both indices are the same.
                add(
                    &mut spectrum[n_coarse - k],
                    times(&line[n_fine - k], [cos, -sin]),
                );
            }
        }
        self.coarse.backward(&mut spectrum);
        self.halve_mirrored(spectrum)
    }

    /// Evaluates the functions at the pixels.
    fn refine(&self, mut line: Vec<Element>) -> Vec<Element> {
        let [n_fine, n_coarse] = [self.fine.length(), self.coarse.length()];
        self.mirror(&mut line);
        self.coarse.forward(&mut line);
        // Evaluate the frequencies of the coarse line at the pixels.
        let mut spectrum = vec![[0.0; BAND]; n_fine];
        for (k, &[cos, sin]) in self.turns.iter().enumerate() {
            // The highest frequency of an even line is split between both signs.
            let share = if 2 * k == n_coarse { 0.5 } else { 1.0 };
            let [cos, sin] = [cos, sin].map(|part| part * share / n_coarse as f64);
            spectrum[k] = times(&line[k], [cos, -sin]);
            if k > 0 {
                spectrum[n_fine - k] = times(&line[n_coarse - k], [cos, sin]);
            }
        }
        self.fine.backward(&mut spectrum);
        self.halve_mirrored(spectrum)
    }

    /// Appends the mirror image of a line that does not repeat.
    fn mirror(&self, line: &mut Vec<Element>) {
        if self.mirrored {
            line.extend_from_within(..);
            let middle = line.len() / 2;
            line[middle..].reverse();
        }
    }

    /// Removes the mirror image.
    fn halve_mirrored(&self, mut line: Vec<Element>) -> Vec<Element> {
        if self.mirrored {
            line.truncate(line.len() / 2);
        }
        line
    }
}

fn add(sum: &mut Element, element: Element) {
    for (sum, value) in sum.iter_mut().zip(element) {
        *sum += value;
    }
}

#[cfg(test)]
mod tests;
