//! Principal components of the rows, and rotation of rows and queries into them.
//!
//! The components are computed from a sample of the rows: the eigenvectors of its covariance with the largest
//! eigenvalues. The algorithm is orthogonal iteration with a Rayleigh-Ritz step (Golub and Van Loan, Matrix
//! Computations, 4th edition, sections 8.2 and 8.5), in `f64` and in a fixed order. Code and comments call a component
//! a direction.
//!
//! The search is exact for any matrix whose norm is known, so the accuracy of the components affects only the speed.
//! [`Basis::norm_sq`] bounds the norm of the matrix as it is stored.

use dapple_hash::{Seed, hash1, unit_f64};
use dapple_raster::parallel;
use dapple_raster::simd;
use dapple_raster::simd::dispatch;
use fearless_simd::{f32x16, prelude::*};

/// Number of directions that are rotated together: the number of lanes in a register.
pub(crate) const LANES: usize = 16;

/// Number of rows of the covariance matrix that are summed together, so that they stay in the cache.
const BAND: usize = 8;

/// Parameters that trade the accuracy of the directions against the time to compute them.
#[derive(Clone, Copy, Debug)]
struct Effort {
    /// Maximum number of directions.
    most: usize,
    /// Maximum number of rows in the sample.
    sample: usize,
    /// Number of steps of orthogonal iteration. Few suffice, since the spectrum of neighborhoods falls quickly.
    steps: usize,
}

impl Effort {
    /// Returns the stride of the sample in rows, at least 1.
    fn step(&self, dims: usize, rows: &[f32]) -> usize {
        (rows.len() / dims).div_ceil(self.sample).max(1)
    }
}

/// Effort for many rows. Additional directions would cost as much as the first 64, and capture almost none of the
/// variance.
const EFFORT: Effort = Effort {
    most: 64,
    sample: 2048,
    steps: 4,
};

/// Effort for fewer than [`FEW`] rows, where better directions cost more than they save in searches.
const LESS: Effort = Effort {
    most: 32,
    sample: 512,
    steps: 3,
};

/// Minimum number of rows for [`EFFORT`].
const FEW: usize = 20_000;

/// Seed for the initial directions of the iteration.
const START: Seed = Seed(2001);

/// Threshold for linear dependence: orthogonalization leaves at most this fraction of a vector's squared length.
const DEPENDENT: f64 = 1e-20;

/// Number of partial sums in a rotation. With several, an addition need not wait for the previous one.
const SUMS: usize = 4;

/// Directions, in order of decreasing variance.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    /// Mean of the sample, which is subtracted from rows and queries.
    mean: Vec<f32>,
    /// Matrix W, transposed in groups: for each group of [`LANES`] directions and each value of a row, the factors of
    /// all directions of the group.
    groups: Vec<[f32; LANES]>,
    /// Upper bound on the squared spectral norm of W.
    pub(crate) norm_sq: f64,
}

impl Basis {
    /// Computes the directions for a search among rows of `dims` finite values.
    pub(crate) fn new(dims: usize, rows: &[f32]) -> Self {
        let is_few = rows.len() < FEW * dims;
        let effort = if is_few { LESS } else { EFFORT };
        // Use an odd stride, or the sample could hold only a few columns of the image.
        Self::of(effort, effort.step(dims, rows) | 1, dims, rows)
    }

    /// Computes at most `most` directions of the rows, rounded up to a multiple of [`LANES`].
    pub(crate) fn with_most(most: usize, dims: usize, rows: &[f32]) -> Self {
        let effort = Effort { most, ..EFFORT };
        Self::of(effort, effort.step(dims, rows), dims, rows)
    }

    /// Computes the directions of every `step`th row.
    fn of(effort: Effort, step: usize, dims: usize, rows: &[f32]) -> Self {
        // Center the sample, and find its principal components.
        let sample: Vec<&[f32]> = rows.chunks_exact(dims).step_by(step).collect();
        let mean = mean(dims, &sample);
        let sample = centered(&sample, &mean);
        let n_directions = effort.most.min(dims).next_multiple_of(LANES);
        let directions = if sample.is_empty() {
            vec![0.0; dims * n_directions]
        } else {
            let matrix = covariance(dims, &sample);
            principal(dims, n_directions, &matrix, effort.steps)
        };
        // Store the directions as `f32`, transposed in groups.
        let mut groups = vec![[0.0; LANES]; dims * n_directions / LANES];
        for (direction, factors) in directions.chunks_exact(dims).enumerate() {
            let group = &mut groups[direction / LANES * dims..][..dims];
            for (lanes, &factor) in group.iter_mut().zip(factors) {
                lanes[direction % LANES] = factor as f32;
            }
        }
        let norm_sq = norm_sq(dims, &groups);
        Self {
            mean,
            groups,
            norm_sq,
        }
    }

    /// Returns the number of directions, a multiple of [`LANES`]. Some may be zero vectors.
    pub(crate) fn n_directions(&self) -> usize {
        self.groups.len() / self.mean.len() * LANES
    }

    /// Allocates the output of [`Self::rotate`].
    pub(crate) fn memory(&self) -> Vec<[f32; LANES]> {
        vec![[0.0; LANES]; self.n_directions() / LANES]
    }

    /// Subtracts the mean from `values`, in `f32`.
    #[inline(always)]
    pub(crate) fn center(&self, values: &[f32], centered: &mut Vec<f32>) {
        centered.clear();
        centered.extend(
            values
                .iter()
                .zip(&self.mean)
                .map(|(value, mean)| value - mean),
        );
    }

    /// Computes the components of a centered vector, one group of directions per element of `rotated`.
    ///
    /// Each component is a sum of `dims` products, whose terms are rounded at most [`Self::roundings`] times.
    #[inline(always)]
    pub(crate) fn rotate<S: Simd>(&self, simd: S, centered: &[f32], rotated: &mut [[f32; LANES]]) {
        for (rotated, factors) in rotated
            .iter_mut()
            .zip(self.groups.chunks_exact(self.mean.len()))
        {
            *rotated = rotate_group(simd, centered, factors).into();
        }
    }

    /// Returns the maximum number of times that a term of [`Self::rotate`] is rounded: by the subtraction of the mean,
    /// the product and the sums.
    pub(crate) fn roundings(&self) -> usize {
        2 + self.mean.len().div_ceil(SUMS) + 2
    }
}

/// Computes sixteen dot products, with [`SUMS`] partial sums for each lane.
#[inline(always)]
fn rotate_group<S: Simd>(simd: S, values: &[f32], factors: &[[f32; LANES]]) -> f32x16<S> {
    let mut sums = [f32x16::splat(simd, 0.0); SUMS];
    let (values_4, values) = values.as_chunks::<SUMS>();
    let (factors_4, factors) = factors.as_chunks::<SUMS>();
    for (values, factors) in values_4.iter().zip(factors_4) {
        for i in 0..SUMS {
            sums[i] += f32x16::simd_from(simd, factors[i]) * values[i];
        }
    }
    // Add the remaining terms. The order of additions is fixed, so all SIMD levels give the same bits.
    for ((sum, &value), &factors) in sums.iter_mut().zip(values).zip(factors) {
        *sum += f32x16::simd_from(simd, factors) * value;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Returns the mean of the rows, rounded to `f32`. The search is exact for any center, so rounding does no harm.
fn mean(dims: usize, rows: &[&[f32]]) -> Vec<f32> {
    let mut sums = vec![0.0_f64; dims];
    for row in rows {
        for (sum, &value) in sums.iter_mut().zip(*row) {
            *sum += f64::from(value);
        }
    }
    let n_rows = rows.len() as f64;
    sums.iter().map(|sum| (sum / n_rows) as f32).collect()
}

/// Returns the rows minus the mean, divided by the largest magnitude so that squares do not overflow. Empty if all are
/// zero.
fn centered(rows: &[&[f32]], mean: &[f32]) -> Vec<f64> {
    let less_mean = |row: &&[f32]| -> Vec<f64> {
        let pairs = row.iter().zip(mean);
        pairs.map(|(&a, &b)| f64::from(a) - f64::from(b)).collect()
    };
    let mut values: Vec<f64> = rows.iter().flat_map(less_mean).collect();
    let largest = values
        .iter()
        .fold(0.0_f64, |max, value| max.max(value.abs()));
    if largest == 0.0 {
        return Vec::new();
    }
    for value in &mut values {
        *value /= largest;
    }
    values
}

/// Returns the covariance matrix of the centered rows, up to a constant factor: sums of products.
fn covariance(dims: usize, sample: &[f64]) -> Vec<f64> {
    let level = simd::level();
    let bands = parallel::map(dims.div_ceil(BAND), |band| {
        let mut sums = vec![0.0; BAND.min(dims - band * BAND) * dims];
        dispatch!(level, _simd => add_products(dims, band * BAND, sample, &mut sums));
        sums
    });
    // Mirror the upper triangle.
    let mut matrix = bands.concat();
    for line in 0..dims {
        for column in 0..line {
            matrix[line * dims + column] = matrix[column * dims + line];
        }
    }
    matrix
}

/// Adds the products of each row's values to a band of the matrix that begins at row and column `first`.
#[inline(always)]
fn add_products(dims: usize, first: usize, sample: &[f64], sums: &mut [f64]) {
    for row in sample.chunks_exact(dims) {
        let row = &row[first..];
        for (&factor, sums) in row.iter().zip(sums.chunks_exact_mut(dims)) {
            // Columns before the band are in the lower triangle, which is mirrored later.
            for (sum, value) in sums[first..].iter_mut().zip(row) {
                *sum += factor * value;
            }
        }
    }
}

/// Returns the unit eigenvectors with the largest eigenvalues, stored contiguously. If there are fewer than
/// `n_directions`, the rest are zero vectors.
fn principal(dims: usize, n_directions: usize, matrix: &[f64], n_steps: usize) -> Vec<f64> {
    // Start with random directions.
    let mut directions: Vec<f64> = (0..(dims * n_directions) as i64)
        .map(|i| unit_f64(hash1(START, [i], 0)) - 0.5)
        .collect();
    // Orthogonal iteration.
    for _ in 0..n_steps {
        // A product stretches directions toward eigenvectors with large eigenvalues; orthonormalization separates them.
        directions = times(dims, &directions, matrix);
        orthonormalize(dims, &mut directions);
    }
    // Rayleigh-Ritz step: diagonalize the matrix in the subspace of the directions.
    let images = times(dims, &directions, matrix);
    let mut small: Vec<f64> = Vec::with_capacity(n_directions * n_directions);
    for direction in directions.chunks_exact(dims) {
        small.extend(images.chunks_exact(dims).map(|image| dot(direction, image)));
    }
    let (values, vectors) = super::jacobi::eigen(n_directions, small);
    // Rotate the directions to the eigenvectors, the largest eigenvalue first.
    let mut order: Vec<usize> = (0..n_directions).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let mut sorted = Vec::with_capacity(directions.len());
    for i in order {
        let mut sum = vec![0.0; dims];
        for (&factor, direction) in vectors[i * n_directions..][..n_directions]
            .iter()
            .zip(directions.chunks_exact(dims))
        {
            for (sum, value) in sum.iter_mut().zip(direction) {
                *sum += factor * value;
            }
        }
        sorted.extend(sum);
    }
    sorted
}

/// Returns an upper bound on the squared spectral norm of W: the largest row sum of magnitudes in W times its
/// transpose.
///
/// The products are exact in `f64`, and the added constant exceeds the rounding error of their sums.
fn norm_sq(dims: usize, groups: &[[f32; LANES]]) -> f64 {
    let mut directions = Vec::with_capacity(groups.len() * LANES);
    for group in groups.chunks_exact(dims) {
        for lane in 0..LANES {
            directions.extend(group.iter().map(|factors| f64::from(factors[lane])));
        }
    }
    // By Gershgorin's theorem, no eigenvalue of W Wᵀ is larger than its largest row sum of magnitudes.
    let mut largest = 0.0_f64;
    for direction in directions.chunks_exact(dims) {
        let products = directions
            .chunks_exact(dims)
            .map(|other| dot(direction, other).abs());
        largest = largest.max(products.sum());
    }
    largest + 1e-9
}

/// Multiplies each direction by a symmetric matrix.
fn times(dims: usize, directions: &[f64], matrix: &[f64]) -> Vec<f64> {
    let level = simd::level();
    let images = parallel::map(directions.len() / dims, |i| {
        let mut image = vec![0.0; dims];
        let direction = &directions[i * dims..][..dims];
        dispatch!(level, _simd => add_lines(direction, matrix, &mut image));
        image
    });
    images.concat()
}

/// Adds the rows of a matrix, each multiplied by its factor.
#[inline(always)]
fn add_lines(factors: &[f64], lines: &[f64], sums: &mut [f64]) {
    for (&factor, line) in factors.iter().zip(lines.chunks_exact(sums.len())) {
        for (sum, value) in sums.iter_mut().zip(line) {
            *sum += factor * value;
        }
    }
}

/// Orthonormalizes directions (modified Gram-Schmidt). A direction that depends linearly on earlier ones becomes zero.
fn orthonormalize(dims: usize, directions: &mut [f64]) {
    for i in 0..directions.len() / dims {
        let (before, rest) = directions.split_at_mut(i * dims);
        let direction = &mut rest[..dims];
        // Subtract the projections on earlier directions.
        let length_sq = dot(direction, direction);
        for other in before.chunks_exact(dims) {
            let along = dot(direction, other);
            for (value, other) in direction.iter_mut().zip(other) {
                *value -= along * other;
            }
        }
        // Normalize, or set to zero if almost nothing remains.
        let left_sq = dot(direction, direction);
        let factor = if left_sq > DEPENDENT * length_sq {
            1.0 / left_sq.sqrt()
        } else {
            0.0
        };
        for value in direction {
            *value *= factor;
        }
    }
}

/// Returns the dot product, computed with eight partial sums.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_8, a) = a.as_chunks::<8>();
    let (b_8, b) = b.as_chunks::<8>();
    for (a, b) in a_8.iter().zip(b_8) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
        *sum += a * b;
    }
    sums.iter().sum()
}
