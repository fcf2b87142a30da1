//! Work on all cores where the feature `rayon` is on. Every piece is made on its own, so that the bits do not depend
//! on how many cores there are.

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// What `make` gives for each index below `count`, in order.
pub(crate) fn par_map<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync) -> Vec<T> {
    #[cfg(feature = "rayon")]
    return (0..count).into_par_iter().map(&make).collect();
    #[cfg(not(feature = "rayon"))]
    return (0..count).map(make).collect();
}

/// Sorts values of which no two are equal, so that there is one order only.
pub(crate) fn par_sort<T: Ord + Send>(values: &mut [T]) {
    #[cfg(feature = "rayon")]
    values.par_sort_unstable();
    #[cfg(not(feature = "rayon"))]
    values.sort_unstable();
}

/// Calls `change` with each chunk of so many values, the last one perhaps shorter, and its number.
pub(crate) fn par_chunks<T: Send>(
    values: &mut [T],
    size: usize,
    change: impl Fn(usize, &mut [T]) + Sync,
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
