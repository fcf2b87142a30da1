//! Spline projection with `rustfft`: lines are transformed, their frequencies are mixed, and the result is transformed
//! back.
//!
//! Projecting a line adds to each frequency its alias half the sampling rate away. With `H` the transform of the
//! refinement filter and `B` the transform of the Gram filter on the coarse line, frequency `k` becomes `H(k) (C(k)
//! G(k) + C(k + n/2) G(k + n/2))`, where `C = conj(H) · B(fine) / B(coarse) / 4`. The filters are real, so one complex
//! transform processes two lines. Columns are processed as rows of the transposed raster. Planner, scratch memory and
//! buffers are reused. The default planner uses the widest vector instructions of the machine.

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Projects square rasters; owns its buffers.
pub(crate) struct FourierProjection {
    side: usize,
    forward: Arc<dyn Fft<f32>>,
    backward: Arc<dyn Fft<f32>>,
    /// `C` for each frequency, as defined in the header. The field `up` holds `H / n`.
    down: Vec<Complex<f32>>,
    up: Vec<Complex<f32>>,
    line: Vec<Complex<f32>>,
    scratch: Vec<Complex<f32>>,
    transposed: Vec<f32>,
    /// Result of the last run.
    pub(crate) fine: Vec<f32>,
}

impl FourierProjection {
    /// Returns the projection for rasters of `side × side` pixels; `side` must be even.
    pub(crate) fn new(side: usize) -> Self {
        let mut planner = FftPlanner::new();
        let (forward, backward) = (
            planner.plan_fft_forward(side),
            planner.plan_fft_inverse(side),
        );
        let n_scratch = forward
            .get_inplace_scratch_len()
            .max(backward.get_inplace_scratch_len());
        let angle = |k: usize| TAU * k as f64 / side as f64;
        let as_f32 = |value: Complex<f64>| Complex::new(value.re as f32, value.im as f32);
        let down = (0..side).map(|k| {
            let weight = gram(angle(k)) / gram(2.0 * angle(k)) / 4.0;
            as_f32(refinement(angle(k)).conj() * weight)
        });
        let up = (0..side).map(|k| as_f32(refinement(angle(k)) / side as f64));
        Self {
            side,
            down: down.collect(),
            up: up.collect(),
            line: vec![Complex::default(); side],
            scratch: vec![Complex::default(); n_scratch],
            transposed: vec![0.0; side * side],
            fine: vec![0.0; side * side],
            forward,
            backward,
        }
    }

    /// Projects a raster along both axes.
    pub(crate) fn run(&mut self, raster: &[f32]) {
        self.fine.copy_from_slice(raster);
        for _ in 0..2 {
            for rows in 0..self.side / 2 {
                self.two_rows(2 * rows);
            }
            transpose(&self.fine, &mut self.transposed, self.side);
            std::mem::swap(&mut self.fine, &mut self.transposed);
        }
    }

    fn two_rows(&mut self, row: usize) {
        let (side, half) = (self.side, self.side / 2);
        let (first, second) = self.fine[row * side..][..2 * side].split_at_mut(side);
        for ((z, a), b) in self.line.iter_mut().zip(&*first).zip(&*second) {
            *z = Complex::new(*a, *b);
        }
        self.forward
            .process_with_scratch(&mut self.line, &mut self.scratch);
        for k in 0..half {
            let sum = self.down[k] * self.line[k] + self.down[k + half] * self.line[k + half];
            self.line[k] = self.up[k] * sum;
            self.line[k + half] = self.up[k + half] * sum;
        }
        self.backward
            .process_with_scratch(&mut self.line, &mut self.scratch);
        for ((z, a), b) in self.line.iter().zip(first).zip(second) {
            (*a, *b) = (z.re, z.im);
        }
    }
}

/// Returns the transform of `[1, 3, 3, 1] / 4` on pixels −1 to 2.
fn refinement(angle: f64) -> Complex<f64> {
    let tap = |weight: f64, at: f64| Complex::from_polar(weight, -angle * at);
    tap(0.25, -1.0) + tap(0.75, 0.0) + tap(0.75, 1.0) + tap(0.25, 2.0)
}

/// Returns the transform of `[1, 26, 66, 26, 1] / 120`.
#[expect(
    clippy::disallowed_methods,
    reason = "a peer's table, which no value of ours depends on"
)]
fn gram(angle: f64) -> f64 {
    (66.0 + 52.0 * angle.cos() + 2.0 * (2.0 * angle).cos()) / 120.0
}

/// Transposes a square raster in blocks that fit in the cache.
fn transpose(from: &[f32], to: &mut [f32], side: usize) {
    const BLOCK: usize = 16;
    for top in (0..side).step_by(BLOCK) {
        for left in (0..side).step_by(BLOCK) {
            for row in top..(top + BLOCK).min(side) {
                for column in left..(left + BLOCK).min(side) {
                    to[column * side + row] = from[row * side + column];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::FourierProjection;

    #[test]
    fn an_impulse_is_projected_as_by_the_exact_filter() {
        let mut raster = vec![0.0; 64];
        raster[0] = 1.0;
        let mut fourier = FourierProjection::new(8);
        fourier.run(&raster);
        let line = [
            1.0 / 2.0,
            453.0 / 1024.0,
            -13.0 / 1024.0,
            -41.0 / 256.0,
            0.0,
            59.0 / 1024.0,
            13.0 / 1024.0,
            41.0 / 256.0,
        ];
        for (at, &value) in fourier.fine.iter().enumerate() {
            let expected: f32 = line[at / 8] * line[at % 8];
            // Error of an `f32` transform with 8 values.
            assert!(
                (value - expected).abs() < 1e-6,
                "{value} and not {expected}"
            );
        }
    }
}
