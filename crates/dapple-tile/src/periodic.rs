//! The periodic part of an image: Moisan's periodic plus smooth decomposition.

use crate::TileError;
use dapple_raster::Raster;

/// The periodic parts of all planes.
pub(crate) fn tile(planes: &[Raster<f32>], axes: [bool; 2]) -> Result<Vec<Raster<f32>>, TileError> {
    let _ = (planes, axes);
    todo!()
}
