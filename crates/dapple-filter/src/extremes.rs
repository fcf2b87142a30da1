//! Maximum and minimum over a disk, known as dilation and erosion.
//!
//! A row of the disk is a range of columns. Two overlapping ranges whose length is a power of two cover it, and a
//! table holds the maxima of these for each line (a sparse table: Michael Bender and Martin Farach-Colton, "The LCA
//! Problem Revisited", LATIN 2000). A maximum is exact, so the order of comparisons does not change a bit.

use crate::Part;
use crate::part::pixels_within;
use dapple_raster::parallel;
use glam::DVec2;

/// Returns the halo of a disk: the number of columns and rows within `radius`, in units of the plane.
#[must_use]
pub fn disk_halo(radius: f64, pixel: DVec2) -> [u32; 2] {
    [pixel.x, pixel.y].map(|pixel| pixels_within(radius, pixel))
}

/// Returns, for each pixel of a part, the maximum over the disk around it. The disk contains the pixels whose centers
/// are at most `radius` away, in units of the plane. NaN pixels are ignored.
///
/// # Panics
///
/// If `values` has fewer pixels than the part and its halo, which must equal [`disk_halo`].
#[must_use]
pub fn dilate(values: &[f32], part: &Part, radius: f64) -> Vec<f32> {
    extremes(values, part, radius, 1.0)
}

/// Returns, for each pixel of a part, the minimum over the disk around it; see [`dilate`].
///
/// # Panics
///
/// Same as [`dilate`].
#[must_use]
pub fn erode(values: &[f32], part: &Part, radius: f64) -> Vec<f32> {
    extremes(values, part, radius, -1.0)
}

/// Number of rows in a band. The sparse tables are computed for one band at a time.
const ROWS: usize = 32;

/// Returns, for each pixel of a part, the maximum over the disk if `sign` is 1, and the minimum if it is -1.
fn extremes(values: &[f32], part: &Part, radius: f64, sign: f32) -> Vec<f32> {
    let [width, height] = part.size.map(|side| side as usize);
    let [left, above] = part.halo.map(|side| side as usize);
    let wide = width + 2 * left;
    // For each row of the disk, from the topmost, the number of columns at each side of the middle.
    let rows = -i64::from(part.halo[1])..=i64::from(part.halo[1]);
    let spans: Vec<usize> = rows
        .map(|row| {
            let y = row as f64 * part.pixel.y;
            let half = (radius * radius * (1.0 + 2e-9) - y * y).max(0.0).sqrt();
            (pixels_within(half, part.pixel.x) as usize).min(left)
        })
        .collect();
    let mut found = vec![0.0; width * height];
    parallel::for_each_chunk(&mut found, ROWS * width, |chunk, found| {
        let first = chunk * ROWS;
        let n_lines = found.len() / width + 2 * above;
        let lines = &values[first * wide..][..n_lines * wide];
        let tables: Vec<_> = lines
            .chunks(wide)
            .map(|line| tables(line, left, sign))
            .collect();
        for (row, found) in found.chunks_mut(width).enumerate() {
            found.fill(f32::NEG_INFINITY);
            for (&span, tables) in spans.iter().zip(&tables[row..]) {
                // Two ranges of 2^level columns cover the columns of the span.
                let level = (2 * span + 1).ilog2();
                let table = &tables[level as usize];
                let [a, b] = [left - span, left + span + 1 - (1 << level)];
                let pairs = table[a..][..width].iter().zip(&table[b..][..width]);
                for (found, (&a, &b)) in found.iter_mut().zip(pairs) {
                    *found = larger(*found, larger(a, b));
                }
            }
            // Zero has one sign.
            found
                .iter_mut()
                .for_each(|found| *found = sign * *found + 0.0);
        }
    });
    found
}

/// Returns the sparse table of a line of pixels. Element `[k][x]` is the maximum of `sign` · value over the 2^k
/// columns starting at `x`.
fn tables(line: &[f32], left: usize, sign: f32) -> Vec<Vec<f32>> {
    // NaN is the maximum of nothing, and zero has one sign.
    let number = |&value: &f32| match value.is_nan() {
        true => f32::NEG_INFINITY,
        false => sign * value + 0.0,
    };
    let mut tables: Vec<Vec<f32>> = vec![line.iter().map(number).collect()];
    for level in 0..(2 * left + 1).ilog2() {
        let last = &tables[level as usize];
        let pairs = last.iter().zip(&last[1 << level..]);
        let next = pairs.map(|(&a, &b)| larger(a, b)).collect();
        tables.push(next);
    }
    tables
}

#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}
