//! Transforms lengths with large prime factors by a convolution with a chirp.

use super::passes::{self, Pass};
use super::{BAND, Element, LANES, exchange_parts, times, turn};

/// A transform by convolution. Since `jk = (j² + k² − (k − j)²) / 2`, it is a convolution with `exp(πi j²/n)`,
/// multiplied by the conjugate before and after.
#[derive(Debug)]
pub(super) struct Chirp {
    /// The chirp `exp(−πi j²/n)`, as cosine and sine.
    chirp: Vec<[f64; 2]>,
    /// Transform of the conjugate chirp, padded for a circular convolution, divided by the padded length.
    kernel: Vec<[f64; 2]>,
    /// Passes for the padded length.
    passes: Vec<Pass>,
}

impl Chirp {
    pub(super) fn new(length: usize) -> Self {
        let n = length as u64;
        // Compute j² modulo 2n without overflow, by (j + 1)² = j² + 2j + 1.
        let squares = (0..n).scan(0, |square, j| {
            let now = *square;
            *square = (now + 2 * j + 1) % (2 * n);
            Some(now)
        });
        let chirp: Vec<_> = squares.map(|square| turn(square, 2 * n)).collect();
        // Transform the conjugate chirp, which is symmetric around index 0.
        let circle = (2 * length - 1).next_power_of_two();
        let mut kernel = vec![[0.0; BAND]; circle];
        for (j, [cos, sin]) in chirp.iter().enumerate() {
            for at in [j, (circle - j) % circle] {
                kernel[at][0] = cos / circle as f64;
                kernel[at][LANES] = -sin / circle as f64;
            }
        }
        let passes = passes::plan(circle).unwrap_or_default();
        passes::run(&passes, &mut kernel);
        Self {
            chirp,
            kernel: kernel
                .iter()
                .map(|element| [element[0], element[LANES]])
                .collect(),
            passes,
        }
    }

    pub(super) fn forward(&self, lines: &mut [Element]) {
        // Multiply by the chirp, convolve with its conjugate, and multiply by the chirp again.
        let mut circle = vec![[0.0; BAND]; self.kernel.len()];
        circle[..lines.len()].copy_from_slice(lines);
        multiply(&mut circle, &self.chirp);
        passes::run(&self.passes, &mut circle);
        multiply(&mut circle, &self.kernel);
        exchange_parts(&mut circle);
        passes::run(&self.passes, &mut circle);
        exchange_parts(&mut circle);
        multiply(&mut circle, &self.chirp);
        lines.copy_from_slice(&circle[..lines.len()]);
    }
}

/// Multiplies all lines, element by element, by complex factors.
fn multiply(lines: &mut [Element], factors: &[[f64; 2]]) {
    for (element, factor) in lines.iter_mut().zip(factors) {
        *element = times(element, *factor);
    }
}
