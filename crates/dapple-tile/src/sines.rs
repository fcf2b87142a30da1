//! The periodic Fourier projector: a plane halved and doubled again with sines and cosines.
//!
//! Du, Wang and Meng name sines as other functions for a tile, and leave open how sines are refined. Here a coarse line
//! of `m` samples stands for the function with these samples that consists of the sines and cosines below the frequency
//! `m/2` and, for an even `m`, of the cosine at `m/2` that has its crests and troughs on the samples. A line is halved
//! by finding the nearest such function, by least squares over the pixels, and sampling it. It is doubled by evaluating
//! that function at the pixels. A doubled line that is halved again is the same, and so is the function.
//!
//! A line that does not repeat is continued by its mirror image, with its end pixels twice; its functions are the
//! cosines of the discrete cosine transform. Coarse samples then lie in the middles of the parts that they stand for,
//! whatever the phase: only there they are mirrored as well.

use crate::TileError;
use crate::fourier::{BAND, Element, Fourier, map_columns, times};
use core::f64::consts::TAU;
use dapple_raster::Raster;
use dapple_wavelet::Phase;

/// The lengths of a line before and after, and the position of the coarse samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    /// The number of pixels.
    pub(crate) fine: u32,
    /// The number of coarse samples, fewer than there are pixels.
    pub(crate) coarse: u32,
    /// Whether the line repeats, or is mirrored.
    pub(crate) repeats: bool,
    /// The place of the first coarse sample, if the line repeats: in the middle of the pixels that become one, or one
    /// fine pixel earlier for each halving.
    pub(crate) phase: Phase,
}

/// Samples the nearest functions of the columns and rows of a plane.
pub(crate) fn coarse(plane: &Raster<f32>, axes: [Axis; 2]) -> Result<Raster<f32>, TileError> {
    change(plane, axes.map(|axis| axis.coarse), |axis| {
        let sampling = Sampling::new(&axes[axis]);
        move |line| sampling.coarse(line)
    })
}

/// Evaluates the functions of the columns and rows of a coarse plane at the pixels.
pub(crate) fn refine(plane: &Raster<f32>, axes: [Axis; 2]) -> Result<Raster<f32>, TileError> {
    change(plane, axes.map(|axis| axis.fine), |axis| {
        let sampling = Sampling::new(&axes[axis]);
        move |line| sampling.refine(line)
    })
}

/// Changes all columns and then all rows.
fn change<C: Fn(Vec<Element>) -> Vec<Element> + Sync>(
    plane: &Raster<f32>,
    size: [u32; 2],
    along: impl Fn(usize) -> C,
) -> Result<Raster<f32>, TileError> {
    let values: Vec<_> = plane.pixels().iter().map(|&value| value.into()).collect();
    let turned = map_columns(&values, plane.width() as usize, along(1));
    let values = map_columns(&turned, size[1] as usize, along(0));
    let pixels = values.into_iter().map(|value| value as f32).collect();
    Ok(Raster::from_vec(size, pixels)?)
}

/// The two transforms of a line.
struct Sampling {
    fine: Fourier,
    coarse: Fourier,
    /// Whether the lines are mirrored, so that the transforms are twice as long.
    mirrored: bool,
    /// For each frequency up to the coarse line's last: its turn from the first pixel to the first coarse sample.
    turns: Vec<[f64; 2]>,
}

impl Sampling {
    fn new(axis: &Axis) -> Self {
        let mirrored = !axis.repeats;
        let copies = if mirrored { 2 } else { 1 };
        let [fine, coarse] = [axis.fine, axis.coarse].map(|length| copies * length as usize);
        let middle = 0.5 * (f64::from(axis.fine) / f64::from(axis.coarse) - 1.0);
        let first_sample = match axis.phase {
            Phase::CookDeRose if axis.repeats => -middle,
            _ => middle,
        };
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

    /// Samples the nearest functions.
    fn coarse(&self, mut line: Vec<Element>) -> Vec<Element> {
        let [n_fine, n_coarse] = [self.fine.length(), self.coarse.length()];
        self.mirror(&mut line);
        self.fine.forward(&mut line);
        let mut spectrum = vec![[0.0; BAND]; n_coarse];
        let scale = 1.0 / n_fine as f64;
        for (k, &[cos, sin]) in self.turns.iter().enumerate() {
            let [cos, sin] = [cos * scale, sin * scale];
            add(&mut spectrum[k], times(&line[k], [cos, sin]));
            if k > 0 {
                // At the highest frequency of an even line, this is the same place.
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
        let mut spectrum = vec![[0.0; BAND]; n_fine];
        for (k, &[cos, sin]) in self.turns.iter().enumerate() {
            // The highest frequency of an even line is shared by both signs.
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

    /// Removes the mirror image again.
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
