//! Tests for the parts of the search: quantization, bounds, eigenvectors and directions.

use super::*;
use dapple_raster::simd::dispatch;

#[test]
fn sums_of_squares_never_exceed_the_threshold() {
    for scale in [1e-38, 1e-30, 1e-3, 1.0, 1e9, 1e12] {
        let (dims, mut rows, mut queries) = exemplar(12, 30);
        queries.extend(rows.chunks_exact(dims).step_by(31).map(<[f32]>::to_vec));
        for value in rows.iter_mut().chain(queries.iter_mut().flatten()) {
            *value *= scale;
        }
        // One row and one query are far outside the ball.
        rows[..dims].fill(30.0 * scale);
        queries[0].fill(-50.0 * scale);
        let index =
            Index::new(dims, &rows, tree::every_row(dims, &rows)).expect("the rows are finite");
        let memory = &mut MatcherMemory::default();
        let level = Level::baseline();
        for query in &queries {
            let error = dispatch!(level, simd => index.place(simd, query, memory));
            let error = error.expect("the query is finite");
            for (rows_16, leaf) in index.tree.rows.iter().zip(0..) {
                for (lane, &row) in rows_16.iter().enumerate() {
                    let sum: i64 = (0..index.tree.steps.len())
                        .flat_map(|step| {
                            index.tree.steps[step][leaf].iter().zip(memory.placed[step])
                        })
                        .flat_map(|(pairs, placed)| {
                            (0..2).map(move |i| (pairs[2 * lane + i], placed[i]))
                        })
                        .map(|(a, b)| (i64::from(a) - i64::from(b)).pow(2))
                        .sum();
                    let distance_sq = distance_sq(query, &rows[row as usize * dims..][..dims]);
                    let threshold = index.margin.threshold(distance_sq, error);
                    assert!(
                        sum <= i64::from(threshold),
                        "{sum} > {threshold} at {scale}"
                    );
                }
            }
        }
    }
}

#[test]
fn distance_of_padded_rows_is_the_same_bit_for_bit() {
    for dims in [1, 7, 16, 31, 171] {
        let numbers: Vec<f32> = (0..2 * dims).map(|i| random(i, dims) - 0.5).collect();
        let (a, b) = numbers.split_at(dims);
        let rows = PaddedRows::new(dims, b);
        let mut padded = Vec::new();
        distance::pad(a, &mut padded);
        for_every_level(|level| {
            let found = dispatch!(level, simd => rows.distance_sq(simd, &padded, 0));
            assert_eq!(
                found.to_bits(),
                distance_sq(a, b).to_bits(),
                "{dims} at {level:?}"
            );
        });
    }
}

#[test]
fn jacobi_gives_eigenvectors() {
    let n = 12;
    let entry = |i: usize| random((i / n).min(i % n), (i / n).max(i % n)) - 0.5;
    let matrix: Vec<f64> = (0..n * n).map(|i| f64::from(entry(i))).collect();
    let (values, vectors) = eigen(n, matrix.clone());
    for (value, vector) in values.iter().zip(vectors.chunks_exact(n)) {
        for (line, own) in matrix.chunks_exact(n).zip(vector) {
            let image: f64 = line.iter().zip(vector).map(|(a, b)| a * b).sum();
            // The sweeps end when the off-diagonal elements are 1e-12 of the diagonal.
            assert!(
                (image - value * own).abs() < 1e-11,
                "{image} is not {value} times {own}"
            );
        }
    }
}

#[test]
fn directions_hold_all_of_rows_in_a_plane() {
    let dims = 40;
    let plane =
        |i: usize, j: usize| random(i, 0) * random(1, j) + 0.1 * random(i, 2) * random(3, j);
    let rows: Vec<f32> = (0..100 * dims).map(|i| plane(i / dims, i % dims)).collect();
    let basis = Basis::new(dims, &rows);
    // Rounding W to 24 bits changes its norm by less than this.
    assert!((basis.norm_sq - 1.0).abs() < 1e-5, "{}", basis.norm_sq);
    let level = Level::baseline();
    let mut centered = Vec::new();
    let mut rotated = vec![[0.0; LANES]; basis.n_directions() / LANES];
    for row in rows.chunks_exact(dims) {
        basis.center(row, &mut centered);
        dispatch!(level, simd => basis.rotate(simd, &centered, &mut rotated));
        let [whole, part] = [margin::length(&centered), margin::length(&rotated[0][..2])];
        // Coordinates are about 1 and have 24 bits.
        assert!((whole - part).abs() < 1e-5, "{part} of {whole}");
    }
}
