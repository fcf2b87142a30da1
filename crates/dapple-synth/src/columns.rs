//! Computes columns row by row, on all cores with the feature `rayon`. The bits do not depend on the number of cores.

use dapple_raster::parallel;

/// Minimum number of rows per task; smaller tasks would not pay for their overhead. Also the block length of [`sum`].
const BLOCK: usize = 1024;

/// Computes a column with the value `row(i)` in row i.
pub(crate) fn column<T: Send>(n_rows: usize, row: impl Fn(usize) -> T + Sync) -> Vec<T> {
    parallel::map_at_least(BLOCK, n_rows, row)
}

/// Applies `change` to every row of a column, with the index of the row.
pub(crate) fn update<T: Send>(column: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
    parallel::for_each_mut_at_least(BLOCK, column, change);
}

/// Applies `change` to every row of a column, with the index of the row, and collects the returned values.
pub(crate) fn map<T: Send, U: Send>(
    column: &mut [T],
    change: impl Fn(usize, &mut T) -> U + Sync,
) -> Vec<U> {
    parallel::map_mut_at_least(BLOCK, column, change)
}

/// Sums `row(i)` over all rows, first within blocks of fixed length and then over the blocks. The bits do not depend on
/// the number of cores.
pub(crate) fn sum(n_rows: usize, row: impl Fn(usize) -> f64 + Sync) -> f64 {
    let block = |block: usize| {
        let mut sum = 0.0;
        for at in block * BLOCK..((block + 1) * BLOCK).min(n_rows) {
            sum += row(at);
        }
        sum
    };
    // The blocks have a fixed size, so the order of additions does not depend on the number of cores.
    let sums = parallel::map(n_rows.div_ceil(BLOCK), block);
    sums.into_iter().sum()
}

/// Returns whether the predicate `row` is true for every row.
pub(crate) fn all(n_rows: usize, row: impl Fn(usize) -> bool + Sync) -> bool {
    let holds = parallel::map(n_rows.div_ceil(BLOCK), |block| {
        (block * BLOCK..((block + 1) * BLOCK).min(n_rows)).all(&row)
    });
    holds.into_iter().all(|holds| holds)
}
