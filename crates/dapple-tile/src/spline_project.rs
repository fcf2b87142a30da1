//! The paper's blend tile: an image halved and doubled again by filters that wrap around.

use crate::TileError;
use dapple_raster::Raster;
use dapple_wavelet::{Degree, Phase};

/// The functions that a tile is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Basis {
    /// B-splines.
    Spline(Degree),
    /// Sines and cosines: the periodic Fourier projector, the paper's other refinable functions.
    Sines,
}

/// What the pixels of the image are to the spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Pixels {
    /// Its coefficients, as in the paper.
    #[default]
    Coefficients,
    /// Its values at the pixel centers; coefficients come from a prefilter.
    Samples,
}

/// The blend tile of Du, Wang and Meng.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
pub struct SplineProject {
    /// How often the image is halved. By default 1.
    pub levels: u32,
    /// Where coarse coefficients lie. By default centered.
    pub phase: Phase,
    /// What the tile is made of. By default quadratic B-splines.
    pub basis: Basis,
    /// What pixels are. By default coefficients.
    pub pixels: Pixels,
}

impl Default for SplineProject {
    fn default() -> Self {
        Self {
            levels: 1,
            phase: Phase::Centered,
            basis: Basis::Spline(Degree::Quadratic),
            pixels: Pixels::Coefficients,
        }
    }
}

/// The tiles of all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    project: &SplineProject,
    axes: [bool; 2],
) -> Result<Vec<Raster<f32>>, TileError> {
    let _ = (planes, project, axes);
    todo!()
}
