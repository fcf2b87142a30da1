//! Verifies the nearest rows that the matcher found: compares every row with every query, independently of the matcher.
//!
//! A row is rejected as soon as its partial squared distance exceeds that of the matcher's row. The few remaining rows
//! are compared by `distance_sq` itself. Sixteen rows at a time are compared component by component, so that the
//! compiler uses vector registers. Blocks of rows stay in the cache while all queries are compared with them.

use dapple_synth::distance_sq;

/// Number of rows compared at once.
const LANES: usize = 16;

/// Number of row groups in a block: 176 KB for rows of 171 numbers.
const BLOCK: usize = 16;

/// Number of partial sums of a squared distance. After each of them, rows can be rejected.
const PARTS: usize = 16;

/// Sums of up to 1000 `f32` terms in two different orders differ by less than this factor: each term is rounded at
/// most 1003 times by 2^-24.
const MARGIN: f32 = 1.0 - 1.3e-4;

/// The rows to search, arranged in groups for comparison.
pub(super) struct BruteForce<'a> {
    dims: usize,
    rows: &'a [f32],
    /// The components of each group of rows, in the order of `terms`. Components past the last row are infinite.
    groups: Vec<[f32; LANES]>,
    /// Order in which components are compared, in steps of sixteen, so that the first ones sample the whole
    /// neighborhood.
    terms: Vec<usize>,
}

impl<'a> BruteForce<'a> {
    pub(super) fn new(dims: usize, rows: &'a [f32]) -> Self {
        let terms: Vec<usize> = (0..PARTS)
            .flat_map(|first| (first..dims).step_by(PARTS))
            .collect();
        let mut groups = Vec::with_capacity(rows.len().div_ceil(LANES));
        for group in rows.chunks(LANES * dims) {
            let number = |lane: usize, term: usize| group.get(lane * dims + term).copied();
            for &term in &terms {
                groups.push(core::array::from_fn(|lane| {
                    number(lane, term).unwrap_or(f32::INFINITY)
                }));
            }
        }
        Self {
            dims,
            rows,
            groups,
            terms,
        }
    }

    /// Returns the number of queries for which the matcher's row is wrong: another row is nearer, or equally near with
    /// a lower index.
    pub(super) fn n_wrong(&self, queries: &[&[f32]], found: &[u32]) -> usize {
        let limits: Vec<f32> = queries
            .iter()
            .zip(found)
            .map(|(query, &found)| distance_sq(query, self.row(found)))
            .collect();
        let sorted: Vec<Vec<f32>> = queries.iter().map(|query| self.sorted(query)).collect();
        let mut is_wrong = vec![false; queries.len()];
        for (block, groups) in self.groups.chunks(BLOCK * self.dims).enumerate() {
            for (index, query) in sorted.iter().enumerate() {
                for (group, rows) in groups.chunks_exact(self.dims).enumerate() {
                    let Some(sums) = compare(query, rows, limits[index]) else {
                        continue;
                    };
                    let first = (block * BLOCK + group) * LANES;
                    for (row, sum) in (first as u32..).zip(sums) {
                        is_wrong[index] |= sum * MARGIN <= limits[index]
                            && self.is_before(queries[index], row, (limits[index], found[index]));
                    }
                }
            }
        }
        is_wrong.into_iter().filter(|&is_wrong| is_wrong).count()
    }

    /// Returns whether a row is better than the row that was found: nearer, or equally near with a lower index. `limit`
    /// is the squared distance of the found row.
    fn is_before(&self, query: &[f32], row: u32, (limit, found): (f32, u32)) -> bool {
        let distance_sq = distance_sq(query, self.row(row));
        distance_sq < limit || distance_sq == limit && row < found
    }

    fn row(&self, row: u32) -> &[f32] {
        &self.rows[row as usize * self.dims..][..self.dims]
    }

    /// Returns the components of a query in the order of `terms`.
    fn sorted(&self, query: &[f32]) -> Vec<f32> {
        self.terms.iter().map(|&term| query[term]).collect()
    }
}

/// Returns the squared distances of a group of rows; `None` if the partial sums of all rows exceed the limit.
fn compare(query: &[f32], rows: &[[f32; LANES]], limit: f32) -> Option<[f32; LANES]> {
    let mut sums = [0.0_f32; LANES];
    let part = query.len().div_ceil(PARTS).max(1);
    for (query, rows) in query.chunks(part).zip(rows.chunks(part)) {
        for (&number, row) in query.iter().zip(rows) {
            for lane in 0..LANES {
                let difference = number - row[lane];
                sums[lane] += difference * difference;
            }
        }
        let mut least = sums;
        let mut n = LANES / 2;
        while n > 0 {
            for lane in 0..n {
                least[lane] = if least[lane + n] < least[lane] {
                    least[lane + n]
                } else {
                    least[lane]
                };
            }
            n /= 2;
        }
        if least[0] * MARGIN > limit {
            return None;
        }
    }
    Some(sums)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dapple_hash::{Seed, hash1};

    /// Returns numbers with few distinct values, so that many rows are equally near.
    fn numbers(seed: u64, count: usize) -> Vec<f32> {
        let number = |index: usize| (hash1(Seed(seed), [index as i64], 0) % 4) as f32;
        (0..count).map(number).collect()
    }

    #[test]
    fn only_the_first_of_the_nearest_rows_is_right() {
        for (dims, n_rows) in [(1, 1), (3, 50), (20, 333), (171, 17)] {
            let (rows, queries) = (numbers(1, dims * n_rows), numbers(2, dims * 20));
            let brute_force = BruteForce::new(dims, &rows);
            for query in queries.chunks_exact(dims) {
                let distances: Vec<f32> = rows
                    .chunks_exact(dims)
                    .map(|row| distance_sq(query, row))
                    .collect();
                let least = distances.iter().copied().fold(f32::INFINITY, f32::min);
                let first = distances.iter().position(|&distance| distance == least);
                for row in 0..n_rows {
                    let n_wrong = brute_force.n_wrong(&[query], &[row as u32]);
                    let expected = usize::from(Some(row) != first);
                    assert_eq!(n_wrong, expected, "row {row} of {n_rows}, {dims} numbers");
                }
            }
        }
    }
}
