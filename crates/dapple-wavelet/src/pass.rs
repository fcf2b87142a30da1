//! Filtering all lines of a raster, several at a time, on all cores.
//!
//! The lines of an array are contiguous, and the result has the axes exchanged: what was along the lines lies across them.
//! Two such passes filter a raster along both axes, three a volume along its three, and leave the axes in their order.

use crate::recursion::{Lanes, LineFilter};

/// How many lines are filtered side by side: four registers of the smallest SIMD level.
const LANES: usize = 8;

/// How many rows of the result are put together at a time, so that what they are made of is read in whole cache lines.
const ROWS: usize = 8;

/// Filters the lines of an array. Value `i` of line `l` is at `i * lines + l` of the result.
///
/// Values are rounded to `f32` once, as they are written.
pub(crate) fn filter_lines(filter: &LineFilter, values: &[f32]) -> Vec<f32> {
    let len = filter.source.len;
    let n_lines = values.len() / len;
    let groups = map_with(
        n_lines.div_ceil(LANES),
        Lanes::<LANES>::default,
        |lanes, group| {
            let first = group * LANES * len;
            let lines = &values[first..values.len().min(first + LANES * len)];
            let result = filter.run(lanes, |target| interleave(lines, target));
            result
                .as_flattened()
                .iter()
                .map(|&value| value as f32)
                .collect::<Vec<_>>()
        },
    );
    let mut result = vec![0.0; filter.target.len * n_lines];
    for_chunks(&mut result, ROWS * n_lines, |chunk, rows| {
        for (group_idx, group) in groups.iter().enumerate() {
            let column = group_idx * LANES;
            let width = LANES.min(n_lines - column);
            let parts = group.chunks_exact(LANES).skip(chunk * ROWS);
            for (row, part) in rows.chunks_exact_mut(n_lines).zip(parts) {
                row[column..column + width].copy_from_slice(&part[..width]);
            }
        }
    });
    result
}

/// Writes up to `LANES` lines side by side.
fn interleave(lines: &[f32], target: &mut [[f64; LANES]]) {
    for (lane, line) in lines.chunks_exact(target.len()).enumerate() {
        for (target, &value) in target.iter_mut().zip(line) {
            target[lane] = f64::from(value);
        }
    }
}

/// The results of `make` for `0..count`, on all cores where the feature `rayon` is on, with memory that it can use again.
pub(crate) fn map_with<S, T: Send>(
    count: usize,
    scratch: impl Fn() -> S + Sync + Send,
    make: impl Fn(&mut S, usize) -> T + Sync + Send,
) -> Vec<T> {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().map_init(scratch, make).collect()
    }
    #[cfg(not(feature = "rayon"))]
    {
        let mut scratch = scratch();
        (0..count).map(|index| make(&mut scratch, index)).collect()
    }
}

/// Has `fill` write every chunk of `size` values, on all cores where the feature `rayon` is on.
pub(crate) fn for_chunks(
    values: &mut [f32],
    size: usize,
    fill: impl Fn(usize, &mut [f32]) + Sync + Send,
) {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        values
            .par_chunks_mut(size)
            .enumerate()
            .for_each(|(chunk, values)| fill(chunk, values));
    }
    #[cfg(not(feature = "rayon"))]
    for (chunk, values) in values.chunks_mut(size).enumerate() {
        fill(chunk, values);
    }
}
