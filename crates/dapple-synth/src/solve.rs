//! Solving the averages of equations 4 and 5: conjugate gradients, as repeating the equations alone takes as many
//! sweeps as the square of the number of edges across the surface.
//!
//! Source: M. R. Hestenes, E. Stiefel, "Methods of Conjugate Gradients for Solving Linear Systems", Journal of Research
//! of the National Bureau of Standards 49 (6), 1952, <https://doi.org/10.6028/jres.049.044>; with the diagonal as the
//! preconditioner. Sums are added in a fixed order, so the bits do not depend on the cores.

use crate::columns;
use dapple_mesh::Blend;
use dapple_mesh::glam::DVec3;

/// A value of a column that is solved for.
pub(crate) trait Unknown: Blend + Send + Sync {
    /// The product that sums to the length squared of a column.
    fn dot(self, other: Self) -> f64;
}

impl Unknown for f64 {
    #[inline]
    fn dot(self, other: Self) -> f64 {
        self * other
    }
}

impl Unknown for DVec3 {
    #[inline]
    fn dot(self, other: Self) -> f64 {
        Self::dot(self, other)
    }
}

/// A symmetric system A x = b without negative eigenvalues, by its rows.
pub(crate) trait System<T>: Sync {
    /// A row of A x.
    fn row(&self, column: &[T], row: usize) -> T;

    /// The right side b of a row.
    fn right(&self, row: usize) -> T;

    /// The element of a row on the diagonal of A; 0 where the row is nothing but zeros.
    fn diagonal(&self, row: usize) -> f64;

    /// Whether a value is near enough if averaging once more would change it by `change`.
    fn is_near(&self, value: T, change: T) -> bool;
}

/// Improves x until every row is near enough or `n_most` steps are done, and says how many it took.
pub(crate) fn conjugate_gradients<T: Unknown>(
    system: &impl System<T>,
    x: &mut [T],
    n_most: usize,
) -> usize {
    let n_rows = x.len();
    let mut residual: Vec<T> = columns::column(n_rows, |row| {
        system.right(row).add_scaled(system.row(x, row), -1.0)
    });
    let change = |residual: &[T], row: usize| {
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
        // Rounding can leave a direction that the system does not see; NaN ends here too.
        if !(curvature > 0.0 && energy > 0.0) {
            return step;
        }
        let length = energy / curvature;
        columns::update(x, |row, value| {
            *value = value.add_scaled(direction[row], length);
        });
        columns::update(&mut residual, |row, value| {
            *value = value.add_scaled(image[row], -length);
        });
        let next = columns::sum(n_rows, |row| residual[row].dot(change(&residual, row)));
        let keep = next / energy;
        columns::update(&mut direction, |row, value| {
            *value = change(&residual, row).add_scaled(*value, keep);
        });
        energy = next;
    }
    n_most
}
