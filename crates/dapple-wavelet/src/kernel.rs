//! Filter kernels, given by their taps and poles.
//!
//! Halving is a least-squares fit. Let `h` be the two-scale coefficients of the spline, and `b` the inner products of
//! the spline with its integer shifts (a B-spline of degree `2d + 1` at integers). The coarse coefficients `c` of the
//! fine coefficients `g` solve `b * c = ↓2(q ⋆ g)` with `q = ½ h * b`, where `*` is convolution, `⋆` is correlation
//! and `↓2` keeps every other value. For least squares of the coefficients instead of the functions, `q` is `h`, and
//! `b` is the autocorrelation of `h` at even distances. In both cases `b` is symmetric. Its inverse is a chain of
//! first-order recursions, one pair for each pole inside the unit circle. The sum of `b` is 1, so the gain of the
//! chain is the product of all `(1 − pole)²`.
//!
//! Reference: Michael Unser, Akram Aldroubi and Murray Eden, "B-Spline Signal Processing: Part I, Theory", IEEE
//! Transactions on Signal Processing 41(2), 1993, for inverses by recursion.

use crate::{Degree, Fit, SplineFilter};

/// A filter for lines: a short weighted sum for each value, followed by recursions over the results.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    /// Offset of the first tap relative to the value.
    pub(crate) first: i64,
    /// Symmetric weights of the sum, multiplied by the gain of the recursions.
    pub(crate) taps: Vec<f64>,
    /// Poles of the recursions, each run forward and backward.
    pub(crate) poles: &'static [f64],
}

impl Kernel {
    /// Creates the halving filter. Offsets are relative to fine coefficient `2 i` of coarse coefficient `i`.
    pub(crate) fn halving(filter: SplineFilter) -> Self {
        let h = two_scale(filter.degree);
        let first = filter.first_tap();
        match filter.fit {
            Fit::Function => Self::new(
                first - filter.degree.order(),
                convolve(&h, gram(filter.degree)),
                function_poles(filter.degree),
            ),
            Fit::Coefficients => Self::new(first, h, coefficient_poles(filter.degree)),
        }
    }

    /// Creates the filter that evaluates a spline at the positions of its coefficients.
    pub(crate) fn samples(degree: Degree) -> Self {
        Self::new(-(degree.order() / 2), samples(degree).to_vec(), &[])
    }

    /// Creates the filter that computes the coefficients of the spline with given values.
    pub(crate) fn coefficients(degree: Degree) -> Self {
        Self::new(0, vec![1.0], sample_poles(degree))
    }

    /// Creates a kernel that preserves constants, by dividing the taps by their sum.
    fn new(first: i64, taps: Vec<f64>, poles: &'static [f64]) -> Self {
        let sum: f64 = taps.iter().sum();
        let gain = poles
            .iter()
            .fold(1.0, |gain, pole| gain * (1.0 - pole) * (1.0 - pole));
        Self {
            first,
            taps: taps.iter().map(|tap| tap / sum * gain).collect(),
            poles,
        }
    }

    /// Returns the number of steps after which the initial value of a recursion has a relative influence below 2^-58,
    /// less than a rounding error.
    pub(crate) fn reach(&self) -> usize {
        let slowest = self
            .poles
            .iter()
            .fold(0.0_f64, |most, pole| most.max(pole.abs()));
        let (mut left, mut steps) = (slowest, 0);
        while left > FORGOTTEN {
            left *= slowest;
            steps += 1;
        }
        steps
    }
}

/// Influence below which the initial value of a recursion is negligible: 2^-58.
const FORGOTTEN: f64 = 1.0 / (1_u64 << 58) as f64;

/// Returns the two-scale coefficients `2^-d C(d + 1, k)` of equation 4.
pub(crate) fn two_scale(degree: Degree) -> Vec<f64> {
    match degree {
        Degree::Constant => vec![1.0, 1.0],
        Degree::Linear => vec![0.5, 1.0, 0.5],
        Degree::Quadratic => vec![0.25, 0.75, 0.75, 0.25],
        Degree::Cubic => vec![0.125, 0.5, 0.75, 0.5, 0.125],
    }
}

/// Returns the inner products of the B-spline with its shifts by `-d ..= d`, scaled to the smallest integers.
pub(crate) fn gram(degree: Degree) -> &'static [f64] {
    match degree {
        Degree::Constant => &[1.0],
        Degree::Linear => &[1.0, 4.0, 1.0],
        Degree::Quadratic => &[1.0, 26.0, 66.0, 26.0, 1.0],
        Degree::Cubic => &[1.0, 120.0, 1191.0, 2416.0, 1191.0, 120.0, 1.0],
    }
}

/// Returns the values of the spline at integers, scaled to the smallest integers.
fn samples(degree: Degree) -> &'static [f64] {
    match degree {
        Degree::Constant | Degree::Linear => &[1.0],
        Degree::Quadratic => &[1.0, 6.0, 1.0],
        Degree::Cubic => &[1.0, 4.0, 1.0],
    }
}

/// Returns the poles of the inverse of [`gram`]: `z` with `z + 1/z = y`, where `y` is a root of `y + 4`, `y² + 26y +
/// 64` or `y³ + 120y² + 1188y + 2176`.
fn function_poles(degree: Degree) -> &'static [f64] {
    match degree {
        Degree::Constant => &[],
        Degree::Linear => &[SQRT_3_MINUS_2],
        Degree::Quadratic => &[-0.430_575_347_099_973_8, -0.043_096_288_203_264_65],
        Degree::Cubic => &[
            -0.535_280_430_796_438_2,
            -0.122_554_615_192_326_69,
            -0.009_148_694_809_608_277,
        ],
    }
}

/// Returns the poles of the inverse of `HᵀH`, where `H` is the doubling of a line. The rows of `HᵀH` are 1; 1 6 1; 6
/// 20 6; and 1 28 70 28 1 for degrees 0 to 3, up to a factor.
fn coefficient_poles(degree: Degree) -> &'static [f64] {
    match degree {
        Degree::Constant => &[],
        Degree::Linear => &[SQRT_8_MINUS_3],
        Degree::Quadratic => &[-1.0 / 3.0],
        Degree::Cubic => &[-0.446_462_692_171_689_55, -0.039_566_129_896_580_04],
    }
}

/// Returns the poles of the inverse of [`samples`].
fn sample_poles(degree: Degree) -> &'static [f64] {
    match degree {
        Degree::Constant | Degree::Linear => &[],
        Degree::Quadratic => &[SQRT_8_MINUS_3],
        Degree::Cubic => &[SQRT_3_MINUS_2],
    }
}

/// √3 − 2, the root of `z² + 4z + 1`.
const SQRT_3_MINUS_2: f64 = -0.267_949_192_431_122_7;

/// √8 − 3, the root of `z² + 6z + 1`.
const SQRT_8_MINUS_3: f64 = -0.171_572_875_253_809_9;

/// Returns the product of two polynomials.
fn convolve(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; a.len() + b.len() - 1];
    for (i, a) in a.iter().enumerate() {
        for (sum, b) in product[i..].iter_mut().zip(b) {
            *sum += a * b;
        }
    }
    product
}

#[cfg(test)]
mod tests;
