//! Columns computed row by row, and other tasks, on all cores where the feature `rayon` is on; the bits do not depend
//! on the cores.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// Rows that one task takes at least: less would not pay for handing it over. Also the length of the blocks in which
/// [`sum`] adds.
const BLOCK: usize = 1024;

/// The values of `make` for each number below `count`, in order; each is worth a task of its own.
pub(crate) fn tasks<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "rayon")]
    return (0..count).into_par_iter().map(make).collect();
    #[cfg(not(feature = "rayon"))]
    return (0..count).map(make).collect();
}

/// The number of threads that can work at once.
pub(crate) fn n_threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    return 1;
}

/// Lets all workers work at once, as far as there are threads: `work` takes the number of a worker and the worker.
///
/// A thread that comes late may find that the others have done all of it.
pub(crate) fn together<W: Send>(workers: &mut [W], work: impl Fn(usize, &mut W) + Sync) {
    #[cfg(feature = "rayon")]
    if workers.len() > 1 {
        let work = &work;
        rayon::scope(|scope| {
            for (number, worker) in workers.iter_mut().enumerate() {
                scope.spawn(move |_| work(number, worker));
            }
        });
        return;
    }
    for (number, worker) in workers.iter_mut().enumerate() {
        work(number, worker);
    }
}

/// The column whose rows are those of `row`.
pub(crate) fn column<T: Send>(n_rows: usize, row: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "rayon")]
    return (0..n_rows)
        .into_par_iter()
        .with_min_len(BLOCK)
        .map(row)
        .collect();
    #[cfg(not(feature = "rayon"))]
    return (0..n_rows).map(row).collect();
}

/// Changes every row of a column, given its number.
pub(crate) fn update<T: Send>(column: &mut [T], change: impl Fn(usize, &mut T) + Sync + Send) {
    #[cfg(feature = "rayon")]
    column
        .par_iter_mut()
        .with_min_len(BLOCK)
        .enumerate()
        .for_each(|(row, value)| change(row, value));
    #[cfg(not(feature = "rayon"))]
    for (row, value) in column.iter_mut().enumerate() {
        change(row, value);
    }
}

/// Changes every row of a column, given its number, and gathers what `change` returns.
pub(crate) fn map<T: Send, U: Send>(
    column: &mut [T],
    change: impl Fn(usize, &mut T) -> U + Sync + Send,
) -> Vec<U> {
    #[cfg(feature = "rayon")]
    return column
        .par_iter_mut()
        .with_min_len(BLOCK)
        .enumerate()
        .map(|(row, value)| change(row, value))
        .collect();
    #[cfg(not(feature = "rayon"))]
    return column
        .iter_mut()
        .enumerate()
        .map(|(row, value)| change(row, value))
        .collect();
}

/// Calls `change` with each run of `size` values, the last one perhaps shorter, and the number of the run.
pub(crate) fn chunks<T: Send>(
    values: &mut [T],
    size: usize,
    change: impl Fn(usize, &mut [T]) + Sync + Send,
) {
    #[cfg(feature = "rayon")]
    values
        .par_chunks_mut(size)
        .enumerate()
        .for_each(|(chunk, values)| change(chunk, values));
    #[cfg(not(feature = "rayon"))]
    for (chunk, values) in values.chunks_mut(size).enumerate() {
        change(chunk, values);
    }
}

/// Sorts keys of which no two are equal, so that there is one order only.
pub(crate) fn sort_keys<T: Ord + Send>(keys: &mut [T]) {
    #[cfg(feature = "rayon")]
    keys.par_sort_unstable();
    #[cfg(not(feature = "rayon"))]
    keys.sort_unstable();
}

/// The sum of a number for every row, added within blocks and then block by block, whatever the number of cores.
pub(crate) fn sum(n_rows: usize, row: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
    let block = |block: usize| {
        let mut sum = 0.0;
        for at in block * BLOCK..((block + 1) * BLOCK).min(n_rows) {
            sum += row(at);
        }
        sum
    };
    tasks(n_rows.div_ceil(BLOCK), block).into_iter().sum()
}

/// Whether something holds for every row.
pub(crate) fn all(n_rows: usize, row: impl Fn(usize) -> bool + Sync + Send) -> bool {
    #[cfg(feature = "rayon")]
    return (0..n_rows).into_par_iter().with_min_len(BLOCK).all(row);
    #[cfg(not(feature = "rayon"))]
    return (0..n_rows).all(row);
}
