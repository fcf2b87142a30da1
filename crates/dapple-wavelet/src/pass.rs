//! Filtering all lines of an array, several side by side, on all cores.
//!
//! The lines of an array are contiguous, and the result has the axes exchanged: what was along the lines lies across them.
//! Two passes so filter a raster along both axes, three a volume along its three, and leave the axes in their order. No
//! pass reads or writes single values with the stride of a row, which would cost more than the filter.

use crate::recursion::{Lanes, LineFilter};

/// How many lines are filtered side by side: four registers of the smallest SIMD level.
const LANES: usize = 8;

/// How many groups of lines are filtered before they are written to the result: they stay in the cache until then.
const BATCH: usize = 32;

/// How many values of a line are read at a time: what they are written to stays in the nearest cache.
const BLOCK: usize = 64;

/// How many rows of the result are written at a time: what they are made of is read in whole cache lines.
const ROWS: usize = 8;

/// Filters the lines of an array, and rounds to `f32`. Value `i` of line `l` is at `i * lines + l` of the result.
pub(crate) fn filter_lines(filter: &LineFilter, values: &[f32]) -> Vec<f32> {
    let [len, target_len] = [filter.source.len, filter.target.len];
    let n_lines = values.len() / len;
    let group_len = LANES * target_len;
    let mut result = vec![0.0; n_lines * target_len];
    let mut batch = vec![0.0; n_lines.div_ceil(LANES).min(BATCH) * group_len];
    let batches = values
        .chunks(BATCH * LANES * len)
        .zip((0..n_lines).step_by(BATCH * LANES));
    for (values, first_line) in batches {
        let n_groups = (values.len() / len).div_ceil(LANES);
        let groups = &mut batch[..n_groups * group_len];
        fill_chunks(groups, group_len, Lanes::default, |lanes, group, target| {
            let lines = &values[group * LANES * len..];
            let lines = &lines[..lines.len().min(LANES * len)];
            let filtered = filter.run(lanes, |target| interleave(lines, target));
            for (target, &filtered) in target.iter_mut().zip(filtered.as_flattened()) {
                *target = filtered as f32;
            }
        });
        fill_chunks(
            &mut result,
            ROWS * n_lines,
            || (),
            |(), chunk, rows| {
                let parts = groups
                    .chunks_exact(group_len)
                    .map(|group| &group[chunk * ROWS * LANES..]);
                for (part, column) in parts.zip((first_line..).step_by(LANES)) {
                    write_columns(part, rows, n_lines, column);
                }
            },
        );
    }
    result
}

/// Writes up to `LANES` lines side by side, two at a time, which is faster than one.
fn interleave(lines: &[f32], target: &mut [[f64; LANES]]) {
    let len = target.len();
    for (block, target) in target.chunks_mut(BLOCK).enumerate() {
        for (pair, lines) in lines.chunks(2 * len).enumerate() {
            let (a, b) = lines.split_at(len);
            // The last line of an odd number goes beside itself.
            let b = if b.is_empty() { a } else { b };
            let [a, b] = [a, b].map(|line| &line[block * BLOCK..][..target.len()]);
            for ((target, &a), &b) in target.iter_mut().zip(a).zip(b) {
                let (pairs, _) = target.as_chunks_mut::<2>();
                pairs[pair] = [f64::from(a), f64::from(b)];
            }
        }
    }
}

/// Writes the values of up to `LANES` lines into the columns from `column` on, one in each row of `width`.
fn write_columns(values: &[f32], rows: &mut [f32], width: usize, column: usize) {
    let (parts, _) = values.as_chunks::<LANES>();
    for (row, part) in rows.chunks_exact_mut(width).zip(parts) {
        let row = &mut row[column..];
        // A group that is not full is the last one.
        match row.first_chunk_mut::<LANES>() {
            Some(row) => *row = *part,
            None => row.copy_from_slice(&part[..row.len()]),
        }
    }
}

/// Has `fill` write every chunk of `size` values, on all cores where the feature `rayon` is on, with memory that it can use
/// again.
pub(crate) fn fill_chunks<S>(
    values: &mut [f32],
    size: usize,
    scratch: impl Fn() -> S + Sync + Send,
    fill: impl Fn(&mut S, usize, &mut [f32]) + Sync + Send,
) {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        values.par_chunks_mut(size).enumerate().for_each_init(
            scratch,
            |scratch, (chunk, values)| {
                fill(scratch, chunk, values);
            },
        );
    }
    #[cfg(not(feature = "rayon"))]
    {
        let mut scratch = scratch();
        for (chunk, values) in values.chunks_mut(size).enumerate() {
            fill(&mut scratch, chunk, values);
        }
    }
}
