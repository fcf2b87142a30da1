//! Distance to a mask, up to a radius.
//!
//! The first pass finds the nearest mask pixel in each pixel's column. The second pass combines these distances along
//! each row, as in: Toyofumi Saito and Jun-ichiro Toriwaki, "New algorithms for Euclidean distance transformation of
//! an n-dimensional digitized picture with applications", Pattern Recognition 27(11), 1994. DOI
//! 10.1016/0031-3203(94)90133-3. Here both passes search only up to the radius.

use crate::Part;
use dapple_raster::parallel;

/// Returns the distance from each pixel of a part to the nearest pixel at which `mask` is above ½. Distances are
/// between pixel centers, in units of the plane, and clamped to `radius`.
///
/// # Panics
///
/// If `mask` has fewer pixels than the part and its halo, which must equal [`disk_halo`](crate::disk_halo).
#[must_use]
pub fn distances(mask: &[f32], part: &Part, radius: f32) -> Vec<f32> {
    let [width, height] = part.size.map(|side| side as usize);
    let [left, above] = part.halo.map(|side| side as usize);
    let wide = width + 2 * left;
    let squares = |axis: usize| -> Vec<f32> {
        let square = |pixels: u32| {
            let distance = f64::from(pixels) * part.pixel[axis];
            (distance * distance) as f32
        };
        (0..=part.halo[axis]).map(square).collect()
    };
    let [across, down] = [squares(0), squares(1)];
    // Count the rows from each pixel to the nearest one of the mask in its column: first above it, then below it, too.
    let far = part.halo[1].saturating_add(1);
    let n_lines = height + 2 * above;
    let mut rows = vec![far; wide * n_lines];
    for line in 0..n_lines {
        let (before, here) = rows.split_at_mut(line * wide);
        let last = before.rchunks(wide).next();
        for (column, here) in here[..wide].iter_mut().enumerate() {
            let above = last.map_or(far, |last| last[column]);
            let is_inside = mask[line * wide + column] > 0.5;
            *here = if is_inside { 0 } else { far.min(above + 1) };
        }
    }
    for line in (1..n_lines).rev() {
        let (above, here) = rows.split_at_mut(line * wide);
        let above = &mut above[(line - 1) * wide..];
        for (above, &here) in above.iter_mut().zip(&here[..wide]) {
            *above = (*above).min(here + 1);
        }
    }
    // Find the nearest of these pixels along each row.
    let mut found = vec![0.0; width * height];
    parallel::for_each_chunk(&mut found, width, |row, found| {
        let rows = &rows[(row + above) * wide..][..wide];
        let square = |&rows: &u32| down.get(rows as usize).copied().unwrap_or(f32::INFINITY);
        let column: Vec<f32> = rows.iter().map(square).collect();
        found.copy_from_slice(&column[left..][..width]);
        for (distance, &square) in across.iter().enumerate().skip(1) {
            let pairs = column[left - distance..]
                .iter()
                .zip(&column[left + distance..]);
            for (found, (&before, &after)) in found.iter_mut().zip(pairs) {
                let nearer = if after < before { after } else { before } + square;
                if nearer < *found {
                    *found = nearer;
                }
            }
        }
        for found in found {
            *found = found.sqrt().min(radius);
        }
    });
    found
}
