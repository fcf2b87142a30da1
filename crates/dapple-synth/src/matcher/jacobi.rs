//! Eigenvalues and eigenvectors of a small symmetric matrix, computed by cyclic Jacobi rotations.
//!
//! Reference: Golub and Van Loan, Matrix Computations, 4th edition, section 8.5. Computed in `f64`, in a fixed order.

/// Maximum number of sweeps over all pairs. The method converges quadratically, so fewer are needed.
const SWEEPS: usize = 12;

/// Convergence threshold: sum of squares off the diagonal, divided by the sum of squares on the diagonal.
const DONE: f64 = 1e-24;

/// Returns the eigenvalues in no particular order, and the unit eigenvectors in the same order, stored contiguously.
///
/// `matrix` is symmetric and has `n` rows of `n` values.
pub(crate) fn eigen(n: usize, mut matrix: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let mut vectors = vec![0.0; n * n];
    for i in 0..n {
        vectors[i * n + i] = 1.0;
    }
    for _ in 0..SWEEPS {
        if off_diagonal(n, &matrix) <= DONE * diagonal(n, &matrix) {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                // Zero the element at (p, q) by a rotation from both sides.
                let (cos, sin) = rotation(&matrix, n, p, q);
                if sin != 0.0 {
                    rotate_lines(&mut matrix, n, [p, q], [cos, sin]);
                    rotate_columns(&mut matrix, n, [p, q], [cos, sin]);
                    // Accumulate the rotations; their product has the eigenvectors as rows.
                    rotate_lines(&mut vectors, n, [p, q], [cos, sin]);
                }
            }
        }
    }
    let values = (0..n).map(|i| matrix[i * n + i]).collect();
    (values, vectors)
}

/// Returns the cosine and sine of the rotation that makes the element at (p, q) zero.
fn rotation(matrix: &[f64], n: usize, p: usize, q: usize) -> (f64, f64) {
    let off = matrix[p * n + q];
    if off == 0.0 {
        return (1.0, 0.0);
    }
    let tau = (matrix[q * n + q] - matrix[p * n + p]) / (2.0 * off);
    let root = (1.0 + tau * tau).sqrt();
    // Of the roots of tan² + 2 tau tan - 1 = 0, the smaller one rotates by at most an eighth of a turn.
    let tan = if tau < 0.0 {
        -1.0 / (root - tau)
    } else {
        1.0 / (root + tau)
    };
    let cos = 1.0 / (1.0 + tan * tan).sqrt();
    (cos, tan * cos)
}

fn rotate_lines(matrix: &mut [f64], n: usize, [p, q]: [usize; 2], [cos, sin]: [f64; 2]) {
    let (before, after) = matrix.split_at_mut(q * n);
    for (a, b) in before[p * n..][..n].iter_mut().zip(&mut after[..n]) {
        (*a, *b) = (cos * *a - sin * *b, sin * *a + cos * *b);
    }
}

fn rotate_columns(matrix: &mut [f64], n: usize, [p, q]: [usize; 2], [cos, sin]: [f64; 2]) {
    for line in matrix.chunks_exact_mut(n) {
        let (a, b) = (line[p], line[q]);
        line[p] = cos * a - sin * b;
        line[q] = sin * a + cos * b;
    }
}

fn off_diagonal(n: usize, matrix: &[f64]) -> f64 {
    let mut sum = 0.0;
    for p in 0..n {
        for q in p + 1..n {
            sum += matrix[p * n + q] * matrix[p * n + q];
        }
    }
    sum
}

fn diagonal(n: usize, matrix: &[f64]) -> f64 {
    (0..n).map(|i| matrix[i * n + i] * matrix[i * n + i]).sum()
}
