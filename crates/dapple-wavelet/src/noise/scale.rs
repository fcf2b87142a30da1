//! Computes the exact mean square of noise over all seeds, for tiles of any size, in order to normalize it.
//!
//! The noise is `(I − P) R`, where `R` is white noise and `P` is the projection along every axis. A mean square is a
//! quadratic form with a matrix `M`, here a product of one matrix per axis. Its mean over all seeds is the trace
//! `tr((I − P)ᵀ M (I − P))` divided by the number of coefficients. This equals `Π whole − 2 Π cross + Π low` over the
//! axes, with three traces per axis ([`LineSums`]). A single impulse suffices to compute them, because shifting it by
//! two cells gives the same traces and shifting it by one cell gives their mirror images.

use crate::kernel::gram;
use crate::{Border, Degree, SplineFilter, WaveletError};

/// Traces along one axis, each divided by the number of coefficients: `P` is the projection of a line (halved and
/// doubled again), and `M` the matrix of the mean square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineSums {
    /// `tr M`: mean square of white noise.
    whole: f64,
    /// `tr M P`: mean product of white noise and its projection.
    cross: f64,
    /// `tr Pᵀ M P`: mean square of the projection.
    low: f64,
}

impl LineSums {
    /// Computes the traces for the mean square of a periodic spline with `length` coefficients, over all positions.
    pub(crate) fn of_values(length: usize) -> Result<Self, WaveletError> {
        let [impulse, low] = impulses(length)?;
        Ok(Self {
            whole: inner(&impulse, &impulse),
            cross: inner(&impulse, &low),
            low: inner(&low, &low),
        })
    }

    /// Computes the traces for the mean square of the coefficients, after doubling a line `levels` times.
    pub(crate) fn of_coefficients(length: usize, levels: u32) -> Result<Self, WaveletError> {
        let [mut impulse, mut low] = impulses(length)?;
        for _ in 0..levels {
            let filter = SplineFilter::default();
            let double = |line: &[f64]| filter.up_line(line, 2 * line.len(), Border::Periodic);
            [impulse, low] = [double(&impulse)?, double(&low)?];
        }
        let doublings = (impulse.len() / length) as f64;
        let sum = |a: &[f64], b: &[f64]| {
            let products = a.iter().zip(b).map(|(a, b)| a * b);
            products.sum::<f64>() / doublings
        };
        Ok(Self {
            whole: sum(&impulse, &impulse),
            cross: sum(&impulse, &low),
            low: sum(&low, &low),
        })
    }

    /// Returns the factor that normalizes noise with these traces to a mean square of 1.
    pub(crate) fn factor<const N: usize>(axes: [Self; N]) -> f64 {
        let product = |part: fn(&Self) -> f64| axes.iter().map(part).product::<f64>();
        let mean_square = product(|sums| sums.whole) - 2.0 * product(|sums| sums.cross)
            + product(|sums| sums.low);
        1.0 / mean_square.sqrt()
    }
}

/// Returns a line with a single 1, and its projection.
fn impulses(length: usize) -> Result<[Vec<f64>; 2], WaveletError> {
    let impulse: Vec<f64> = (0..length).map(|at| f64::from(u8::from(at == 0))).collect();
    let low = SplineFilter::default().project_line(&impulse, 1, Border::Periodic)?;
    Ok([impulse, low])
}

/// Returns the integral of the product of two periodic quadratic splines, given their coefficients.
fn inner(a: &[f64], b: &[f64]) -> f64 {
    // Integrals of products of a B-spline with copies 2, 1 and 0 cells away, all times their sum
    let overlaps = gram(Degree::Quadratic);
    let sum: f64 = overlaps.iter().sum();
    let [far_overlap, near_overlap, overlap] = [0, 1, 2].map(|i| overlaps[i] / sum);
    let n = a.len();
    let products = a.iter().enumerate().map(|(i, a)| {
        let near = b[(i + 1) % n] + b[(i + n - 1) % n];
        let far = b[(i + 2) % n] + b[(i + n - 2) % n];
        a * (overlap * b[i] + near_overlap * near + far_overlap * far)
    });
    products.sum()
}

#[cfg(test)]
mod tests {
    use super::LineSums;

    #[test]
    fn mean_squares_equal_those_of_the_dense_matrices() {
        // Computed from dense matrices in another program: traces of 256 × 256 matrices.
        let values = LineSums::of_values(256).unwrap();
        let coefficients = LineSums::of_coefficients(256, 0).unwrap();
        for (sums, expected) in [
            (LineSums::factor([values; 2]), 0.1349676016810735),
            (LineSums::factor([values; 3]), 0.09780278019861238),
            (LineSums::factor([coefficients; 1]), 0.5028134249),
            (LineSums::factor([coefficients; 2]), 0.7528213402),
            (LineSums::factor([coefficients; 3]), 0.8771219640),
        ] {
            let mean_square = 1.0 / (sums * sums);
            // The last three are given to ten digits.
            assert!(
                (mean_square - expected).abs() < 1e-10,
                "{mean_square} {expected}"
            );
        }
    }

    #[test]
    fn doubled_coefficients_come_near_to_values() {
        let [values, coefficients] = [
            LineSums::of_values(16).unwrap(),
            LineSums::of_coefficients(16, 8).unwrap(),
        ];
        let [values, coefficients] = [[values; 2], [coefficients; 2]].map(LineSums::factor);
        // Each level brings the coefficients four times closer to the function.
        assert!(
            (values / coefficients - 1.0).abs() < 1e-3,
            "{values} {coefficients}"
        );
    }
}
