//! Filters all lines of an array, several at a time in SIMD lanes, on all cores.
//!
//! Lines are contiguous in memory. The result is transposed: its lines run across the original ones. Two passes filter
//! a raster along both axes, three passes a volume along its three axes, and restore the order of the axes. No pass
//! accesses single values with the stride of a row, which would cost more than the filter.

use crate::error::check;
use crate::recursion::{Lanes, LineFilter};
use crate::{IsCancelled, WaveletError};
use dapple_raster::simd::dispatch;
use dapple_raster::{parallel, simd};
use fearless_simd::{Level, f32x8, prelude::*};

/// Number of lines that are filtered in parallel lanes.
const LANES: usize = 8;

/// Number of groups of lines that are filtered before they are written to the result. A batch stays in the cache
/// until it is written.
const BATCH: usize = 32;

/// Number of rows of the result that are written at a time, so that their sources are read in whole cache lines.
const ROWS: usize = 8;

/// Filters the lines of an array, rounding the results to `f32`. Value `i` of line `l` is at `i * lines + l` of the
/// result.
pub(crate) fn filter_lines(
    filter: &LineFilter,
    values: &[f32],
    is_cancelled: &IsCancelled,
) -> Result<Vec<f32>, WaveletError> {
    let mut result = vec![0.0; values.len() / filter.source.len * filter.target.len];
    let batch = &mut Vec::new();
    filter_lines_into(
        simd::level(),
        filter,
        values,
        batch,
        &mut result,
        is_cancelled,
    )?;
    Ok(result)
}

/// Filters lines like [`filter_lines`], at a SIMD level, into an existing result. `batch` is scratch memory. The callback
/// is called before each batch of lines.
pub(crate) fn filter_lines_into(
    level: Level,
    filter: &LineFilter,
    values: &[f32],
    batch: &mut Vec<f32>,
    result: &mut [f32],
    is_cancelled: &IsCancelled,
) -> Result<(), WaveletError> {
    let [len, target_len] = [filter.source.len, filter.target.len];
    let n_lines = values.len() / len;
    let group_len = LANES * target_len;
    batch.resize(n_lines.div_ceil(LANES).min(BATCH) * group_len, 0.0);
    let batches = values
        .chunks(BATCH * LANES * len)
        .zip((0..n_lines).step_by(BATCH * LANES));
    for (values, first_line) in batches {
        check(is_cancelled)?;
        let n_groups = (values.len() / len).div_ceil(LANES);
        let groups = &mut batch[..n_groups * group_len];
        // Filter the groups of a batch.
        parallel::for_each_chunk_with(groups, group_len, Lanes::default, |lanes, group, target| {
            let lines = &values[group * LANES * len..];
            let lines = &lines[..lines.len().min(LANES * len)];
            dispatch!(level, simd => filter_group(simd, filter, lanes, lines, target));
        });
        // Transpose the batch into the result.
        parallel::for_each_chunk(result, ROWS * n_lines, |chunk, rows| {
            let parts = groups
                .chunks_exact(group_len)
                .map(|group| &group[chunk * ROWS * LANES..]);
            for (part, column) in parts.zip((first_line..).step_by(LANES)) {
                write_columns(part, rows, n_lines, column);
            }
        });
    }
    Ok(())
}

/// Filters up to `LANES` lines at a time, one in each lane, into `target`, where the lines are interleaved.
#[inline(always)]
fn filter_group<S: Simd>(
    simd: S,
    filter: &LineFilter,
    lanes: &mut Lanes<LANES>,
    lines: &[f32],
    target: &mut [f32],
) {
    let filtered = filter.run(lanes, |target| interleave(simd, lines, target));
    for (target, &filtered) in target.iter_mut().zip(filtered.as_flattened()) {
        *target = filtered as f32;
    }
}

/// Interleaves up to `LANES` lines: converts them from line after line to value after value. Square blocks of values
/// are transposed in registers, and the remaining values are copied one by one.
#[inline(always)]
fn interleave<S: Simd>(simd: S, lines: &[f32], target: &mut [[f64; LANES]]) {
    let len = target.len();
    let n_lines = lines.len() / len;
    // Only the last group can be incomplete.
    let n_squares = if n_lines == LANES { len / LANES } else { 0 };
    let (squares, rest) = target.split_at_mut(n_squares * LANES);
    for (square, target) in squares.chunks_exact_mut(LANES).enumerate() {
        transpose(simd, &lines[square * LANES..], len, target);
    }
    for (i, target) in (n_squares * LANES..).zip(rest) {
        for (line, target) in target[..n_lines].iter_mut().enumerate() {
            *target = f64::from(lines[line * len + i]);
        }
    }
}

/// Interleaves the first `LANES` values of `LANES` lines. Lines start `len` values apart.
///
/// A perfect shuffle of all 64 values rotates the six bits of their indices by one; three shuffles exchange the three
/// bits of the line index with the three bits of the position.
#[inline(always)]
fn transpose<S: Simd>(simd: S, lines: &[f32], len: usize, target: &mut [[f64; LANES]]) {
    let mut square = [f32x8::splat(simd, 0.0); LANES];
    for (line, values) in square.iter_mut().enumerate() {
        *values = f32x8::from_slice(simd, &lines[line * len..][..LANES]);
    }
    for _ in 0..3 {
        let before = square;
        for i in 0..LANES / 2 {
            square[2 * i] = before[i].zip_low(before[i + LANES / 2]);
            square[2 * i + 1] = before[i].zip_high(before[i + LANES / 2]);
        }
    }
    for (values, target) in square.into_iter().zip(target) {
        let values: [f32; LANES] = values.into();
        for lane in 0..LANES {
            target[lane] = f64::from(values[lane]);
        }
    }
}

/// Writes the values of up to `LANES` lines into consecutive columns, starting at `column`, of rows that are `width`
/// values long.
fn write_columns(values: &[f32], rows: &mut [f32], width: usize, column: usize) {
    let (parts, _) = values.as_chunks::<LANES>();
    for (row, part) in rows.chunks_exact_mut(width).zip(parts) {
        let row = &mut row[column..];
        // Only the last group can be incomplete.
        match row.first_chunk_mut::<LANES>() {
            Some(row) => *row = *part,
            None => row.copy_from_slice(&part[..row.len()]),
        }
    }
}
