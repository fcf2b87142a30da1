//! The image whose gradients are nearest to those of the source, once around the torus.

use crate::TileError;
use dapple_raster::Raster;

/// The gradient that is wanted across the wrap, where the source has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum WrapGradient {
    /// None: the last pixel continues to the first.
    #[default]
    Zero,
    /// The mean of the gradients just inside of the two borders.
    Extrapolate,
}

/// The tiles of all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    wrap: WrapGradient,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    let _ = (planes, wrap, axes);
    todo!()
}
