//! The discrete Fourier transform of any length, with the same bits everywhere.
//!
//! Reference: T. G. Stockham, "High-speed convolution and correlation", Spring Joint Computer Conference 1966, for the
//! passes that sort themselves (given in this form by P. N. Swarztrauber, "FFT algorithms for vector computers",
//! Parallel Computing 1, 1984); L. I. Bluestein, "A linear filtering approach to the computation of discrete Fourier
//! transform", IEEE Transactions on Audio and Electroacoustics 18, 1970, for all other lengths.
//!
//! Implemented: lengths whose prime factors are 2, 3, 5 and 7 in passes of radix 4, 2, 3, 5 and 7; other lengths as a
//! convolution with a chirp. Several lines are transformed side by side, so that the innermost loops run over
//! neighbors in memory that share a factor; a line has the same bits in whatever company. Two real lines travel as one
//! complex line. Everything is `f64`; sines and cosines come from `libm`, so that no platform's own are used.
//!
//! Convention: `F(k) = Σ f(x) exp(−2πi kx/n)`, and the way back is not divided by `n`.

mod bluestein;
mod lines;
mod passes;
mod power;

use bluestein::Chirp;
use core::f64::consts::TAU;
use passes::Pass;

pub(crate) use lines::{BAND, Element, LANES, map_columns, par_flat_map, times};
pub(crate) use power::power_spectrum;

/// A transform of one length, ready for many lines.
#[derive(Debug)]
pub(crate) struct Fourier {
    length: usize,
    route: Route,
}

/// The algorithm for a length.
#[derive(Debug)]
enum Route {
    /// Passes, one for each small factor of the length.
    Passes(Vec<Pass>),
    /// A convolution with a chirp.
    Chirp(Box<Chirp>),
}

impl Fourier {
    /// Prepares a transform; a length of 0 counts as 1.
    pub(crate) fn new(length: usize) -> Self {
        let length = length.max(1);
        let route = match passes::plan(length) {
            Some(passes) => Route::Passes(passes),
            None => Route::Chirp(Box::new(Chirp::new(length))),
        };
        Self { length, route }
    }

    /// The number of elements of a line.
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Transforms values to frequencies. The number of elements must be the length.
    pub(crate) fn forward(&self, lines: &mut Vec<Element>) {
        match &self.route {
            Route::Passes(passes) => passes::run(passes, lines),
            Route::Chirp(chirp) => chirp.forward(lines),
        }
    }

    /// Transforms frequencies to values that are `length` times as large.
    pub(crate) fn backward(&self, lines: &mut Vec<Element>) {
        exchange_parts(lines);
        self.forward(lines);
        exchange_parts(lines);
    }
}

/// Conjugates every number and multiplies it by i. Done before and after a transform, it reverses its direction.
fn exchange_parts(lines: &mut [Element]) {
    lines
        .iter_mut()
        .for_each(|element| element.rotate_left(LANES));
}

/// The root of unity `exp(−2πi step/n)`, as cosine and sine.
fn turn(step: u64, n: u64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(TAU * ((step % n) as f64 / n as f64));
    [cos, -sin]
}

#[cfg(test)]
mod tests;
