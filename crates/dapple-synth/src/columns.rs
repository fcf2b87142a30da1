//! Columns computed row by row, on all cores where the feature `rayon` is on; the bits do not depend on the cores.

use dapple_raster::parallel;

/// Rows that one task takes at least: less would not pay for handing it over. Also the length of the blocks in which
/// [`sum`] adds.
const BLOCK: usize = 1024;

/// The column whose rows are those of `row`.
pub(crate) fn column<T: Send>(n_rows: usize, row: impl Fn(usize) -> T + Sync) -> Vec<T> {
    parallel::map_at_least(BLOCK, n_rows, row)
}

/// Changes every row of a column, given its number.
pub(crate) fn update<T: Send>(column: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
    parallel::for_each_mut_at_least(BLOCK, column, change);
}

/// Changes every row of a column, given its number, and gathers what `change` returns.
pub(crate) fn map<T: Send, U: Send>(
    column: &mut [T],
    change: impl Fn(usize, &mut T) -> U + Sync,
) -> Vec<U> {
    parallel::map_mut_at_least(BLOCK, column, change)
}

/// The sum of a number for every row, added within blocks and then block by block, whatever the number of cores.
pub(crate) fn sum(n_rows: usize, row: impl Fn(usize) -> f64 + Sync) -> f64 {
    let block = |block: usize| {
        let mut sum = 0.0;
        for at in block * BLOCK..((block + 1) * BLOCK).min(n_rows) {
            sum += row(at);
        }
        sum
    };
    let sums = parallel::map(n_rows.div_ceil(BLOCK), block);
    sums.into_iter().sum()
}

/// Whether something holds for every row.
pub(crate) fn all(n_rows: usize, row: impl Fn(usize) -> bool + Sync) -> bool {
    let holds = parallel::map(n_rows.div_ceil(BLOCK), |block| {
        (block * BLOCK..((block + 1) * BLOCK).min(n_rows)).all(&row)
    });
    holds.into_iter().all(|holds| holds)
}
