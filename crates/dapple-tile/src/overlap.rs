//! Blends the two ends of a row where they overlap.

use crate::crossfade::Pair;
use crate::error::{check, rows_cancellable};
use crate::{Crossfade, IsCancelled, TileError, TileErrorKind};
use dapple_raster::Raster;

/// Checks that a margin is at least one pixel, and at most half of each side that repeats.
pub(crate) fn check_margin(
    planes: &[Raster<f32>],
    margin: u32,
    axes: [bool; 2],
) -> Result<(), TileError> {
    let sizes = planes.iter().map(Raster::size);
    let sides = sizes.flat_map(|size| [0, 1].map(|axis| (size[axis], axes[axis])));
    for (length, _) in sides.filter(|(_, repeats)| *repeats) {
        let most = length / 2;
        if margin > most {
            return Err(TileError::new(TileErrorKind::Margin {
                margin,
                length,
                most,
            }));
        }
    }
    let what = "margin";
    TileError::check(margin >= 1, what, margin.into(), "at least 1")
}

/// Returns the first and the last `margin` columns.
pub(crate) fn ends(plane: &Raster<f32>, margin: u32) -> Result<[Raster<f32>; 2], TileError> {
    let size = [margin, plane.height()];
    let last = plane.crop([plane.width() - margin, 0], size)?;
    Ok([plane.crop([0, 0], size)?, last])
}

/// Blends the last columns of the planes into the first ones, and drops the last ones.
///
/// `weights` are the weights of the first columns, from 0 to 1; their width is the margin.
pub(crate) fn overlap(
    planes: &[Raster<f32>],
    weights: &Raster<f64>,
    crossfade: Crossfade,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    planes
        .iter()
        .map(|plane| {
            check(is_cancelled)?;
            let margin = weights.width();
            // A weight of 0 shows the last columns, a weight of 1 the first ones.
            let [first, last] = ends(plane, margin)?;
            let pair = Pair {
                images: [&last, &first],
                means: [plane.statistics().mean; 2],
            };
            let mixed = crossfade.mix(pair, weights)?;
            check(is_cancelled)?;
            join(&mixed, plane, is_cancelled)
        })
        .collect()
}

/// Joins the blended columns and the columns outside of the overlap.
fn join(
    mixed: &Raster<f32>,
    plane: &Raster<f32>,
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    let margin = mixed.width();
    // Leave out the last columns, which are blended into the first ones.
    let rest = margin as usize..(plane.width() - margin) as usize;
    let size = [plane.width() - margin, plane.height()];
    rows_cancellable(size, is_cancelled, |row| {
        let middle = &plane.row(row)[rest.clone()];
        mixed.row(row).iter().chain(middle).copied()
    })
}
