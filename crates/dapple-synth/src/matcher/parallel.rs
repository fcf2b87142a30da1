//! Work for each of several things, on all cores where the feature `rayon` is on.

/// What `make` gives for each number below `count`, in order.
pub(crate) fn par_map<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().map(make).collect()
    }
    #[cfg(not(feature = "rayon"))]
    {
        (0..count).map(make).collect()
    }
}
