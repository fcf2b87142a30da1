//! A margin laid over the opposite side, and a soft cut along the line of least difference.

use crate::TileError;
use dapple_raster::Raster;

/// How two sides are mixed where they lie over each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Crossfade {
    /// By weights that keep the variance, with the mean of each plane put aside.
    #[default]
    KeepVariance,
    /// By weights whose sum is one, which flattens what is mixed.
    Linear,
}

/// The tile is smaller than the image by the margin, along each axis that repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct SoftCut {
    /// How wide the two sides lie over each other, in pixels. By default 32.
    pub margin: u32,
    /// Half of the width over which the cut is softened, in pixels. By default 2.
    pub half_width: f32,
    /// How the sides are mixed there. By default the variance is kept.
    pub crossfade: Crossfade,
}

impl Default for SoftCut {
    fn default() -> Self {
        Self {
            margin: 32,
            half_width: 2.0,
            crossfade: Crossfade::KeepVariance,
        }
    }
}

/// The tiles of all planes, with the same cut.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    cut: &SoftCut,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    let _ = (planes, cut, axes);
    todo!()
}
