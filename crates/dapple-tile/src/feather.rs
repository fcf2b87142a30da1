//! Crossfades: the usual baselines.

use crate::{Crossfade, TileError};
use dapple_raster::Raster;

/// A crossfade between an image and itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Feather {
    /// With the image moved by half of its size, all the way to the middle; the size stays.
    #[default]
    HalfShift,
    /// Of the two ends over a margin, in pixels, by which the tile is smaller.
    Margin {
        /// The width of the crossfade, in pixels.
        margin: u32,
        /// How the two are mixed.
        crossfade: Crossfade,
    },
}

/// The tiles of all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    feather: &Feather,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    let _ = (planes, feather, axes);
    todo!()
}
