//! Discrete Fourier transforms of any length, with the same bits everywhere.
//!
//! Reference: T. G. Stockham, "High-speed convolution and correlation", Spring Joint Computer Conference 1966, for
//! self-sorting passes (given in this form by P. N. Swarztrauber, "FFT algorithms for vector computers", Parallel
//! Computing 1, 1984); L. I. Bluestein, "A linear filtering approach to the computation of discrete Fourier transform",
//! IEEE Transactions on Audio and Electroacoustics 18, 1970, for all other lengths.
//!
//! Implementation: lengths with the prime factors 2, 3, 5 and 7 are transformed in passes of radix 4, 2, 3, 5 and 7,
//! other lengths as a convolution with a chirp. Several lines are transformed together. So the innermost loops run over
//! contiguous elements that share a factor. The bits of a line do not depend on the other lines. Two real lines are
//! packed into one complex line. Everything is `f64`. Sines and cosines come from `libm`, so they do not depend on the
//! platform.
//!
//! Convention: `F(k) = Σ f(x) exp(−2πi kx/n)`; the inverse transform is not divided by `n`.

mod bluestein;
mod lines;
mod passes;
mod power;

use bluestein::Chirp;
use core::f64::consts::TAU;
use passes::Pass;

pub(crate) use lines::{BAND, Element, LANES, map_columns, par_flat_map, times};
pub(crate) use power::power_spectrum;

/// A transform of one length, set up once for any number of lines.
#[derive(Debug)]
pub(crate) struct Fourier {
    length: usize,
    route: Route,
}

/// The algorithm used for a length.
#[derive(Debug)]
enum Route {
    /// Passes, one for each small prime factor of the length.
    Passes(Vec<Pass>),
    /// A convolution with a chirp.
    Chirp(Box<Chirp>),
}

impl Fourier {
    /// Sets up a transform. A length of 0 counts as 1.
    pub(crate) fn new(length: usize) -> Self {
        let length = length.max(1);
        let route = match passes::plan(length) {
            Some(passes) => Route::Passes(passes),
            None => Route::Chirp(Box::new(Chirp::new(length))),
        };
        Self { length, route }
    }

    /// Returns the number of elements in a line.
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Transforms values to frequencies, in place. `lines` must have [`length`](Self::length) elements.
    pub(crate) fn forward(&self, lines: &mut Vec<Element>) {
        match &self.route {
            Route::Passes(passes) => passes::run(passes, lines),
            Route::Chirp(chirp) => chirp.forward(lines),
        }
    }

    /// Transforms frequencies to values, in place. The values are not divided by the length.
    pub(crate) fn backward(&self, lines: &mut Vec<Element>) {
        exchange_parts(lines);
        self.forward(lines);
        exchange_parts(lines);
    }
}

/// Swaps the real and the imaginary parts, which conjugates every number and multiplies it by i. Swapping before and
/// after a transform reverses its direction.
fn exchange_parts(lines: &mut [Element]) {
    lines
        .iter_mut()
        .for_each(|element| element.rotate_left(LANES));
}

/// Returns the root of unity `exp(−2πi step/n)`, as cosine and sine.
fn turn(step: u64, n: u64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(TAU * ((step % n) as f64 / n as f64));
    [cos, -sin]
}

#[cfg(test)]
mod tests;
