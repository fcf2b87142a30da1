//! The image beside its mirror image.

use crate::TileError;
use dapple_raster::Raster;

/// The tiles of all planes, twice as large along each axis that repeats.
pub(crate) fn tile(planes: &[Raster<f32>], axes: [bool; 2]) -> Result<Vec<Raster<f32>>, TileError> {
    let _ = (planes, axes);
    todo!()
}
