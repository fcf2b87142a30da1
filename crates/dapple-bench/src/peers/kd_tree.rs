//! Nearest-row search with the k-d tree of `kiddo`. The tree is not intended for hundreds of dimensions, so it stores
//! the rows projected to a few directions.
//!
//! A projection to orthogonal unit directions never lengthens a distance. Therefore the best of the few nearest
//! projected points gives a radius. The tree lists all points within it, and the nearest row is among them; these rows
//! are compared in full. The result is exact up to the rounding of the directions, for which the radius is enlarged by
//! a thousandth.
//!
//! The directions are the principal directions of the rows, computed by orthogonal iteration.

use anyhow::{Result, anyhow};
use dapple_synth::distance_sq;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use std::num::NonZero;

/// Maximum number of rows from which the directions are computed.
const MOST_ROWS: usize = 4096;

/// Number of orthogonal iterations. The directions need not be exact.
const N_ITERATIONS: usize = 60;

/// Number of nearest projected points that determine the search radius.
const FIRST: NonZero<usize> = NonZero::new(4).unwrap();

/// A few orthogonal unit vectors. They are stored by dimension: for each dimension, its component along every vector.
pub(crate) struct Directions<const N: usize> {
    mean: Vec<f32>,
    parts: Vec<[f32; N]>,
}

/// A k-d tree of projected rows.
pub(crate) struct KdTree<'a, const N: usize> {
    dims: usize,
    rows: &'a [f32],
    directions: Directions<N>,
    tree: ImmutableKdTree<f32, N>,
}

impl<'a, const N: usize> KdTree<'a, N> {
    pub(crate) fn new(dims: usize, rows: &'a [f32], directions: Directions<N>) -> Result<Self> {
        let points: Vec<[f32; N]> = rows
            .chunks_exact(dims)
            .map(|row| directions.along(row))
            .collect();
        let tree =
            ImmutableKdTree::new_from_slice(&points).map_err(|error| anyhow!("{error:?}"))?;
        Ok(Self {
            dims,
            rows,
            directions,
            tree,
        })
    }

    /// Returns the index of the row nearest to `query`, the first one if several have the same distance.
    pub(crate) fn nearest(&self, query: &[f32]) -> u32 {
        let at = self.directions.along(query);
        let mut best = (f32::INFINITY, u32::MAX);
        let mut compare = |item: u32| {
            let row = &self.rows[item as usize * self.dims..][..self.dims];
            let distance = distance_sq(query, row);
            if distance < best.0 || distance == best.0 && item < best.1 {
                best = (distance, item);
            }
            best.0
        };
        let mut radius = f32::INFINITY;
        let first = self
            .tree
            .query(&at)
            .nearest_n::<SquaredEuclidean<f32>>(FIRST);
        for point in first.execute() {
            radius = compare(point.item) * 1.001;
        }
        let within = self.tree.query(&at).within::<SquaredEuclidean<f32>>(radius);
        for point in within.unsorted().execute() {
            if point.distance <= radius {
                radius = compare(point.item) * 1.001;
            }
        }
        best.1
    }
}

impl<const N: usize> Directions<N> {
    /// Returns the directions in which the rows vary most.
    pub(crate) fn principal(dims: usize, rows: &[f32]) -> Self {
        let n_rows = rows.len() / dims;
        let sample: Vec<&[f32]> = rows
            .chunks_exact(dims)
            .step_by(n_rows.div_ceil(MOST_ROWS))
            .collect();
        let mut mean = vec![0.0_f64; dims];
        for row in &sample {
            for (sum, &value) in mean.iter_mut().zip(*row) {
                *sum += f64::from(value) / sample.len() as f64;
            }
        }
        let mut covariance = vec![0.0_f64; dims * dims];
        for row in &sample {
            let centered: Vec<f64> = row
                .iter()
                .zip(&mean)
                .map(|(&a, b)| f64::from(a) - b)
                .collect();
            for (line, a) in covariance.chunks_exact_mut(dims).zip(&centered) {
                for (sum, b) in line.iter_mut().zip(&centered) {
                    *sum += a * b;
                }
            }
        }
        let directions = iterate::<N>(dims, &covariance);
        Self {
            mean: mean.iter().map(|&value| value as f32).collect(),
            parts: (0..dims)
                .map(|dim| std::array::from_fn(|index| directions[index][dim] as f32))
                .collect(),
        }
    }

    /// Returns the projection of a row to the directions.
    #[inline]
    fn along(&self, row: &[f32]) -> [f32; N] {
        let mut sums = [0.0; N];
        for ((value, mean), parts) in row.iter().zip(&self.mean).zip(&self.parts) {
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum += (value - mean) * part;
            }
        }
        sums
    }
}

/// Returns approximate eigenvectors of a matrix for its largest eigenvalues.
fn iterate<const N: usize>(dims: usize, matrix: &[f64]) -> Vec<Vec<f64>> {
    // Start with rows of the matrix, which are all different.
    let mut vectors: Vec<Vec<f64>> = (0..N)
        .map(|index| matrix[index * dims / N * dims..][..dims].to_vec())
        .collect();
    for _ in 0..N_ITERATIONS {
        orthonormalize(&mut vectors);
        for vector in &mut vectors {
            let dot = |line: &[f64]| line.iter().zip(&*vector).map(|(a, b)| a * b).sum::<f64>();
            *vector = matrix.chunks_exact(dims).map(dot).collect();
        }
    }
    // The second pass removes the rounding errors of the first.
    orthonormalize(&mut vectors);
    orthonormalize(&mut vectors);
    vectors
}

/// Orthonormalizes the vectors, in order.
fn orthonormalize(vectors: &mut [Vec<f64>]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for index in 0..vectors.len() {
        let (before, rest) = vectors.split_at_mut(index);
        let vector = &mut rest[0];
        for other in before {
            let along = dot(vector, other);
            vector
                .iter_mut()
                .zip(other)
                .for_each(|(part, of)| *part -= along * *of);
        }
        let length = dot(vector, vector).sqrt().max(f64::MIN_POSITIVE);
        vector.iter_mut().for_each(|part| *part /= length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dapple_hash::{Seed, hash1, unit_f32};

    #[test]
    fn nearest_is_that_of_all_rows() {
        let dims = 24;
        let values = |n: i64, seed| -> Vec<f32> {
            (0..n)
                .map(|at| unit_f32(hash1(Seed(seed), [at], 0) as u32))
                .collect()
        };
        let (rows, queries) = (values(500 * 24, 1), values(40 * 24, 2));
        let tree = KdTree::new(dims, &rows, Directions::<8>::principal(dims, &rows)).unwrap();
        for query in queries.chunks_exact(dims) {
            let distances: Vec<f32> = rows
                .chunks_exact(dims)
                .map(|row| distance_sq(query, row))
                .collect();
            let found = distances[tree.nearest(query) as usize];
            assert!(
                distances.iter().all(|&distance| found <= distance),
                "{found} is not least"
            );
        }
    }

    #[test]
    fn directions_are_orthonormal() {
        let rows: Vec<f32> = (0..300 * 9)
            .map(|at| unit_f32(hash1(Seed(3), [at], 0) as u32))
            .collect();
        let directions = Directions::<8>::principal(9, &rows);
        for a in 0..8 {
            for b in 0..8 {
                let dot: f32 = directions
                    .parts
                    .iter()
                    .map(|parts| parts[a] * parts[b])
                    .sum();
                let expected = if a == b { 1.0 } else { 0.0 };
                // Components are rounded to `f32`.
                assert!((dot - expected).abs() < 1e-5, "{a} and {b}: {dot}");
            }
        }
    }
}
