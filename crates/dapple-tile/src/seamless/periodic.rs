//! Computes the periodic part of an image by Moisan's periodic plus smooth decomposition.
//!
//! Source: Lionel Moisan, "Periodic plus smooth image decomposition", Journal of Mathematical Imaging and Vision 39,
//! 2011, <https://doi.org/10.1007/s10851-010-0227-1>.
//!
//! An image is `u = p + s`. The smooth part solves `Δs = v` on the torus. `Δ` is the sum of the four neighbors minus
//! four times the pixel. `v` is zero except at the borders, where it is the jump to the pixel across the wrap. The mean
//! of `s` is zero, so `p = u − s` has the same mean as `u`. `p` also retains all detail, since `s` has none. `p` is the
//! image whose differences are nearest, by least squares, to those of `u` inside and to zero across the wrap.
//!
//! Differences from the paper: the jumps across x and the jumps across y are solved separately, and the solutions are
//! added. With frequencies along the border only, the solution across it is a difference of two powers,
//! `ρ^(n−1−x) − ρ^x`, which needs no second transform. Along an axis that does not repeat there are no jumps, and the
//! image is extended by its mirror image, which is the least-squares solution.
//!
//! All arithmetic is `f64` up to the pixels of the result.

use crate::error::map_cancellable;
use crate::fourier::{BAND, Element, Fourier, LANES, par_flat_map, times};
use crate::{IsCancelled, TileError};
use core::f64::consts::PI;
use dapple_raster::Raster;

/// Powers below this limit are replaced by zero. It is far below the rounding of all sums, and far above subnormal
/// numbers, which are slow.
const NEGLIGIBLE: f64 = 1e-40;

/// Computes the periodic parts of all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let tile = |plane| {
        let jump = |axis: usize| axes[axis].then(|| jumps(plane, axis));
        without_jumps(plane, &[jump(0), jump(1)], is_cancelled)
    };
    planes.iter().map(tile).collect()
}

/// Returns the jumps across the wrap of an axis: for each pixel of the first border, the pixel of the last border minus
/// it.
pub(crate) fn jumps(plane: &Raster<f32>, axis: usize) -> Vec<f64> {
    let last = border(plane, axis, plane.size()[axis] - 1);
    let differences = last.zip(border(plane, axis, 0));
    differences.map(|(last, first)| last - first).collect()
}

/// Iterates over the pixels of the column (axis 0) or row (axis 1) at `index`.
pub(crate) fn border(
    plane: &Raster<f32>,
    axis: usize,
    index: u32,
) -> impl Iterator<Item = f64> + '_ {
    let [width, index] = [plane.width() as usize, index as usize];
    // Pixels of a column are one row apart in memory, pixels of a row are adjacent.
    let (first, step) = [(index, width), (index * width, 1)][axis];
    let pixels = plane.pixels().iter().skip(first).step_by(step);
    let count = plane.size()[1 - axis] as usize;
    pixels.take(count).map(|&value| f64::from(value))
}

/// Subtracts the smooth part from a plane.
///
/// For each axis that repeats, `jumps` holds the jump at each pixel of the first border.
pub(crate) fn without_jumps(
    plane: &Raster<f32>,
    jumps: &[Option<Vec<f64>>; 2],
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    let [width, height] = plane.size().map(|length| length as usize);
    let smooth = Smooth::new([width, height], jumps, is_cancelled)?;
    // Subtract the smooth part, in bands of rows.
    let pixels = par_flat_map(height.div_ceil(BAND), is_cancelled, |band| {
        let values = plane.pixels()[band * BAND * width..].iter();
        let less = |(&value, smooth)| (f64::from(value) - smooth) as f32;
        values.zip(smooth.rows(band)).map(less).collect()
    })?;
    Ok(Raster::from_vec(plane.size(), pixels)?)
}

/// The smooth part: the image with mean zero whose Laplacian is zero except for the jumps at the first borders, and
/// their negatives at the last ones.
pub(crate) struct Smooth {
    size: [usize; 2],
    /// Part caused by the jumps across x, in bands of columns.
    across_x: Vec<Vec<Element>>,
    /// Part caused by the jumps across y.
    across_y: Option<Layer>,
}

impl Smooth {
    pub(crate) fn new(
        size: [usize; 2],
        jumps: &[Option<Vec<f64>>; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Self, TileError> {
        let layer = |axis: usize| {
            let repeats = jumps[1 - axis].is_some();
            let jumps = jumps[axis].as_ref()?;
            Some(Layer::new(jumps, repeats, size[axis]))
        };
        // Jumps across x are solved column by column. Every row needs all columns, so they are computed now.
        let n_bands = size[0].div_ceil(BAND);
        let bands = |layer: Layer| map_cancellable(n_bands, is_cancelled, |band| layer.band(band));
        Ok(Self {
            size,
            across_x: layer(0).map(bands).transpose()?.unwrap_or_default(),
            across_y: layer(1),
        })
    }

    /// Computes up to [`BAND`] rows, starting at row `band * BAND`.
    pub(crate) fn rows(&self, band: usize) -> Vec<f64> {
        let [width, height] = self.size;
        let rows = band * BAND..height.min((band + 1) * BAND);
        let mut smooth = vec![0.0; rows.len() * width];
        // Jumps across y are solved row by row, so only this band is computed.
        if let Some(layer) = &self.across_y {
            add_rows(&mut smooth, &layer.band(band));
        }
        for (column, elements) in self.across_x.iter().enumerate() {
            add_columns(&mut smooth, width, column * BAND, &elements[rows.clone()]);
        }
        smooth
    }
}

/// Adds a band of rows.
fn add_rows(rows: &mut [f64], elements: &[Element]) {
    for (line, row) in rows.chunks_exact_mut(elements.len()).enumerate() {
        for (value, element) in row.iter_mut().zip(elements) {
            *value += element[line];
        }
    }
}

/// Adds a band of columns, starting at column `first`.
fn add_columns(rows: &mut [f64], width: usize, first: usize, elements: &[Element]) {
    for (row, element) in rows.chunks_exact_mut(width).zip(elements) {
        for (value, line) in row[first..].iter_mut().zip(element) {
            *value += line;
        }
    }
}

/// The smooth image for the jumps across one axis.
struct Layer {
    /// Number of pixels perpendicular to the borders.
    across: usize,
    /// Number of pixels along a border.
    along: usize,
    fourier: Fourier,
    /// Mean of the jumps.
    mean: f64,
    /// Frequencies along the border, from 1 to the middle one.
    modes: Vec<Mode>,
}

/// One frequency along the border, with its decay across the image.
struct Mode {
    /// Decay ρ from one pixel to the next, away from the border.
    decay: f64,
    /// Complex amplitude of the mode.
    amplitude: [f64; 2],
}

impl Layer {
    /// Builds the layer for the jumps along a border that repeats, or that is mirrored at its ends.
    fn new(jumps: &[f64], repeats: bool, across: usize) -> Self {
        // Extend a border that does not repeat by its mirror image.
        let mirrored = jumps.iter().rev().filter(|_| !repeats);
        let line = jumps.iter().chain(mirrored);
        let mut spectrum: Vec<_> = line.map(|&jump| only_first(jump)).collect();
        let n = spectrum.len();
        let fourier = Fourier::new(n);
        fourier.forward(&mut spectrum);
        // Every frequency except 0 decays exponentially away from the borders.
        let mode = |k: usize| {
            let jump = [spectrum[k][0], spectrum[k][LANES]];
            Mode::new(k, n, jump, across)
        };
        Self {
            across,
            along: jumps.len(),
            fourier,
            mean: spectrum[0][0] / n as f64,
            modes: (1..=n / 2).map(mode).collect(),
        }
    }

    /// Computes [`BAND`] lines along the border, starting at line `band * BAND`. Lines beyond the last are unused.
    fn band(&self, band: usize) -> Vec<Element> {
        let n = self.fourier.length();
        let first = band * BAND;
        let mut elements = vec![[0.0; BAND]; n];
        // The mean jump is distributed linearly from border to border.
        elements[0] = ramp(first, self.across).map(|height| height * self.mean);
        for (k, mode) in (1..).zip(&self.modes) {
            let profile = mode.profile(first, self.across);
            if profile == [0.0; BAND] {
                // Higher frequencies decay even faster.
                break;
            }
            let [re, im] = mode.amplitude;
            // The line is real, so negative frequencies are the conjugates of positive ones.
            elements[k] = times(&profile, [re, im]);
            elements[n - k] = times(&profile, [re, -im]);
        }
        // Transform the frequencies along the border to pixels.
        self.fourier.backward(&mut elements);
        elements.truncate(self.along);
        elements
    }
}

impl Mode {
    /// Creates the mode of frequency `k` of `n` along the border. `jump` is the spectrum of the jumps at this
    /// frequency.
    ///
    /// Since `ρ + 1/ρ = 4 − 2 cos φ`, every `ρ^x` is a solution away from the borders. The scale makes the difference
    /// of `ρ^(across − 1 − x)` and `ρ^x` correct at the borders.
    fn new(k: usize, n: usize, jump: [f64; 2], across: usize) -> Self {
        let sine = libm::sin(PI * (k as f64 / n as f64));
        // Compute 1 − cos φ without cancellation.
        let rise = 2.0 * sine * sine;
        // ρ is the root below 1 of ρ + 1/ρ = 2 + 2 (1 − cos φ).
        let decay = 1.0 / (1.0 + rise + (rise * (2.0 + rise)).sqrt());
        let scale = decay / ((1.0 + decay) * (1.0 - power(decay, across)));
        Self {
            decay,
            amplitude: jump.map(|part| part * scale / n as f64),
        }
    }

    /// Returns the profile `ρ^(across − 1 − x) − ρ^x` for [`BAND`] positions, starting at `first`.
    fn profile(&self, first: usize, across: usize) -> Element {
        // Subtract ρ^x, which decays from the first border.
        let mut profile = [0.0; BAND];
        let mut near = power(self.decay, first);
        for value in &mut profile {
            *value -= near;
            near *= self.decay;
        }
        // Add ρ^(across − 1 − x), which decays from the last border.
        let last = (across - 1).min(first + BAND - 1);
        let mut far = power(self.decay, across - 1 - last);
        for value in profile[..=last - first].iter_mut().rev() {
            *value += far;
            far *= self.decay;
        }
        profile
    }
}

/// Returns the solution for a constant jump of 1 along the border. It is linear from border to border.
fn ramp(first: usize, across: usize) -> Element {
    let middle = 0.5 * (across - 1) as f64;
    core::array::from_fn(|at| ((first + at) as f64 - middle) / across as f64)
}

/// Returns an element with a real number in the first line and zeros in the others.
fn only_first(value: f64) -> Element {
    let mut element = [0.0; BAND];
    element[0] = value;
    element
}

/// Returns the power `base^exponent` for a base from 0 to 1, or 0 if it is below [`NEGLIGIBLE`].
fn power(base: f64, exponent: usize) -> f64 {
    // Compute the power by repeated squaring, until it is negligible.
    let (mut square, mut product, mut rest) = (base, 1.0, exponent);
    while rest > 0 && product > NEGLIGIBLE {
        if rest % 2 == 1 {
            product *= square;
        }
        square *= square;
        rest /= 2;
    }
    if product > NEGLIGIBLE { product } else { 0.0 }
}

#[cfg(test)]
mod tests;
