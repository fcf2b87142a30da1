//! Solves for the fixed points of the averages in equations 4 and 5 by conjugate gradients. Repeating the equations
//! instead takes as many sweeps as the square of the number of edges across the surface.
//!
//! Reference: M. R. Hestenes, E. Stiefel, "Methods of Conjugate Gradients for Solving Linear Systems", Journal of
//! Research of the National Bureau of Standards 49 (6), 1952, <https://doi.org/10.6028/jres.049.044>. The
//! preconditioner is the diagonal (Jacobi). Sums are added in a fixed order, so the bits do not depend on the number of
//! cores.

use crate::{Blend, columns};
use glam::{DVec2, DVec3};

/// Type of the unknowns.
pub(crate) trait Unknown: Blend + Send + Sync {
    /// Returns the dot product of two values.
    fn dot(self, other: Self) -> f64;
}

impl Unknown for f64 {
    #[inline]
    fn dot(self, other: Self) -> f64 {
        self * other
    }
}

impl Unknown for DVec2 {
    #[inline]
    fn dot(self, other: Self) -> f64 {
        Self::dot(self, other)
    }
}

impl Unknown for DVec3 {
    #[inline]
    fn dot(self, other: Self) -> f64 {
        Self::dot(self, other)
    }
}

/// A symmetric positive semidefinite linear system A x = b, accessed row by row.
pub(crate) trait System<T>: Sync {
    /// Returns element `row` of A x, where `column` is x.
    fn row(&self, column: &[T], row: usize) -> T;

    /// Returns the right-hand side b of a row.
    fn right(&self, row: usize) -> T;

    /// Returns the diagonal element of a row of A; 0 if the whole row is zero.
    fn diagonal(&self, row: usize) -> f64;

    /// Returns whether a value has converged, where `change` is its change in one more averaging step.
    fn is_near(&self, value: T, change: T) -> bool;
}

/// Improves x until every row has converged, or for at most `n_most` steps. Returns the number of steps.
pub(crate) fn conjugate_gradients<T: Unknown>(
    system: &impl System<T>,
    x: &mut [T],
    n_most: usize,
) -> usize {
    let n_rows = x.len();
    // Residual b - A x.
    let mut residual: Vec<T> = columns::column(n_rows, |row| {
        system.right(row).add_scaled(system.row(x, row), -1.0)
    });
    let change = |residual: &[T], row: usize| {
        // Preconditioned residual: the change in one more averaging step.
        let diagonal = system.diagonal(row);
        if diagonal > 0.0 {
            T::ZERO.add_scaled(residual[row], 1.0 / diagonal)
        } else {
            T::ZERO
        }
    };
    let mut direction: Vec<T> = columns::column(n_rows, |row| change(&residual, row));
    let mut energy = columns::sum(n_rows, |row| residual[row].dot(direction[row]));
    for step in 0..n_most {
        if columns::all(n_rows, |row| system.is_near(x[row], change(&residual, row))) {
            return step;
        }
        let image: Vec<T> = columns::column(n_rows, |row| system.row(&direction, row));
        let curvature = columns::sum(n_rows, |row| direction[row].dot(image[row]));
        // Due to rounding, the direction can be in the null space of A. This also stops at NaN.
        if !(curvature > 0.0 && energy > 0.0) {
            return step;
        }
        let length = energy / curvature;
        // Step along the direction, and update the residual.
        columns::update(x, |row, value| {
            *value = value.add_scaled(direction[row], length);
        });
        columns::update(&mut residual, |row, value| {
            *value = value.add_scaled(image[row], -length);
        });
        let next = columns::sum(n_rows, |row| residual[row].dot(change(&residual, row)));
        // The next direction is conjugate to the previous ones.
        let keep = next / energy;
        columns::update(&mut direction, |row, value| {
            *value = change(&residual, row).add_scaled(*value, keep);
        });
        energy = next;
    }
    n_most
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of springs: every value is the mean of its neighbors and a step of 1 ahead of the one before it.
    struct Chain {
        n_rows: usize,
        tolerance: f64,
    }

    impl System<f64> for Chain {
        fn row(&self, column: &[f64], row: usize) -> f64 {
            let mut sum = 0.0;
            for other in [row.wrapping_sub(1), row + 1] {
                if other < self.n_rows {
                    sum += column[row] - column[other];
                }
            }
            sum
        }

        fn right(&self, row: usize) -> f64 {
            f64::from(u8::from(row > 0)) - f64::from(u8::from(row + 1 < self.n_rows))
        }

        fn diagonal(&self, row: usize) -> f64 {
            f64::from(u8::from(row > 0)) + f64::from(u8::from(row + 1 < self.n_rows))
        }

        fn is_near(&self, _value: f64, change: f64) -> bool {
            change.abs() <= self.tolerance
        }
    }

    #[test]
    fn conjugate_gradients_count_up_a_chain() {
        let chain = Chain {
            n_rows: 100,
            tolerance: 1e-12,
        };
        let mut column = vec![0.0; 100];
        let steps = conjugate_gradients(&chain, &mut column, 1000);
        // Without rounding it takes at most as many steps as rows.
        assert!(steps <= 110, "{steps} steps");
        for (row, value) in column.iter().enumerate() {
            let wanted = column[0] + row as f64;
            assert!(
                (value - wanted).abs() < 1e-9,
                "row {row}: {value} instead of {wanted}"
            );
        }
        assert_eq!(
            conjugate_gradients(&chain, &mut column, 1000),
            0,
            "it is solved"
        );
    }

    #[test]
    fn conjugate_gradients_end_at_the_limit_and_on_nothing() {
        let chain = |n_rows, tolerance| Chain { n_rows, tolerance };
        let mut column = vec![0.0; 100];
        assert_eq!(conjugate_gradients(&chain(100, 1e-12), &mut column, 7), 7);
        assert!(column.iter().all(|value| value.is_finite()), "{column:?}");
        assert_eq!(conjugate_gradients(&chain(0, 0.0), &mut [], 9), 0);
        let mut single = [3.5];
        assert_eq!(conjugate_gradients(&chain(1, 0.0), &mut single, 9), 0);
        assert_eq!(single, [3.5], "a row of zeros changes nothing");
        let mut unreal = vec![f64::NAN; 5];
        assert!(
            conjugate_gradients(&chain(5, 0.0), &mut unreal, 9) < 9,
            "NaN ends it"
        );
    }

    #[test]
    fn value_stability_conjugate_gradients() {
        let chain = Chain {
            n_rows: 5,
            tolerance: 0.0,
        };
        let mut column = vec![0.0, 0.1, 0.2, 0.3, 0.0];
        conjugate_gradients(&chain, &mut column, 2);
        assert_eq!(
            column,
            [
                -1.7550575482613726,
                -0.7520979233907802,
                0.010644905913159974,
                1.140795323061933,
                2.1563729370927467
            ]
        );
    }
}
