//! Wavelet noise at any position, in two and three dimensions.
//!
//! Robert L. Cook and Tony DeRose, "Wavelet Noise", ACM Transactions on Graphics 24(3) (SIGGRAPH 2005),
//! <https://doi.org/10.1145/1073204.1073264>: white noise minus the part that half as many coefficients can represent.
//! The difference is a quadratic B-spline with nearly all of its power in one octave. The pixels of an image therefore
//! either resolve it or do not show it at all.
//!
//! There are some differences from the paper. Halving is the exact recursion of [`SplineFilter`](crate::SplineFilter)
//! instead of 32 rounded taps. Coefficient `k` is at `k + ½`, the center of its cell. Bands are shifted by whole
//! cells, so that they are not copies of each other at the origin. The variance of a band is exact for tiles of any
//! size, and values are not divided by the weights. The projection of solid noise onto surfaces (section 3.3 of the
//! paper) is not implemented.
//!
//! Positions are in cells; a cell is the distance between adjacent coefficients.

mod band;
mod evaluate;
mod make;
mod place;
mod render;
mod scale;
mod shader;
mod tile;
mod white;

use crate::{WaveletError, WaveletErrorKind};
use band::Band;
use core::fmt;
use dapple_hash::Seed;
use place::Period;
use tile::Tile;

pub(crate) use scale::LineSums;
pub(crate) use white::white_raster;

/// Band-limited noise without low frequencies. A tile of B-spline coefficients is evaluated at any position, in one
/// or several bands.
///
/// A band has about 84 % of its power between ¼ and ½ cycles per cell, measured along the axis with the highest
/// frequency. About half of the remaining power is above this octave and half is below. Less than a ten-thousandth of
/// the power is below ⅛.
///
/// Values are nearly normally distributed. Over all positions and seeds, the mean is 0 and the variance 1. The
/// variance at a position depends on its offset from the coefficients: in the plane it is 0.31 at every other corner
/// of cells along each axis, and up to 1.38 within cells. Absolute values are at most [`bound`](Self::bound). There is
/// no other normalization.
///
/// The period along each axis is [`size`](Self::size), in cells; the noise has equal bits at two positions a period
/// apart if both are exact in `f64`. The noise and its gradient are continuous. At a position that is not finite, the
/// value is NaN.
///
/// A new noise has one band of weight 1; [`with_weights`](Self::with_weights) sets the weights of several bands.
///
#[cfg_attr(doc, doc = include_str!("../docs/wavelet-noise.md"))]
///
/// # Examples
///
/// ```
/// use dapple_wavelet::{WaveletNoise2, hash::Seed, raster::glam::DVec2};
///
/// let noise = WaveletNoise2::new(128, Seed(7))?.with_weights(&[1.0, 0.5, 0.25])?;
/// let position = DVec2::new(0.25, 1e9);
/// assert_eq!(noise.sample(position), noise.sample(position + 128.0));
/// # Ok::<(), dapple_wavelet::WaveletError>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct WaveletNoise<const N: usize> {
    size: [u32; N],
    periods: [Period; N],
    seed: Seed,
    tile: Tile<N>,
    bands: Vec<Band<N>>,
}

/// Wavelet noise in two dimensions.
pub type WaveletNoise2 = WaveletNoise<2>;

/// Wavelet noise in three dimensions.
pub type WaveletNoise3 = WaveletNoise<3>;

/// Maximum number of bands.
const MOST_BANDS: usize = 16;

/// Maximum absolute weight, chosen so that sums of weighted values do not overflow.
const LARGEST_WEIGHT: f32 = 1e30;

impl<const N: usize> WaveletNoise<N> {
    /// Sets the weights of the bands, coarsest first.
    ///
    /// Band `b` is the tile at `2^b` times the position, shifted by whole cells. Its power is between `2^b / 4` and
    /// `2^b / 2` cycles per cell, and it repeats `2^b` times in a period. Bands are nearly uncorrelated, so the
    /// variance of the noise is about the sum of the squared weights. Values are not divided by the weights.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/with-weights.md"))]
    ///
    /// # Errors
    ///
    /// [`WaveletErrorKind::Range`] unless there are 1 to 16 weights from -1e30 to 1e30,
    /// [`WaveletErrorKind::NotFinite`] if a weight is NaN or infinite.
    pub fn with_weights(mut self, weights: &[f32]) -> Result<Self, WaveletError> {
        check_weights(weights)?;
        self.bands = Band::all(weights, self.size, self.seed);
        Ok(self)
    }

    /// Returns the number of cells along each axis of the tile, which is the period.
    #[must_use]
    pub fn size(&self) -> [u32; N] {
        self.size
    }

    /// Returns an upper bound on absolute values: the largest absolute coefficient times the sum of the absolute
    /// weights.
    ///
    /// With several bands, values rarely come near the bound.
    #[must_use]
    pub fn bound(&self) -> f32 {
        let weights = self.bands.iter().map(|band| f64::from(band.weight.abs()));
        let weights: f64 = weights.sum();
        // The weights of a B-spline sum to 1 up to rounding, which the factor allows for.
        (f64::from(self.tile.largest()) * weights * (1.0 + 1e-5)) as f32
    }
}

impl<const N: usize> fmt::Debug for WaveletNoise<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("WaveletNoise")
            .field("size", &self.size)
            .field("seed", &self.seed)
            .field("bands", &self.bands)
            .finish_non_exhaustive()
    }
}

/// Checks that the weights are finite and in range, and that their number is allowed.
pub(crate) fn check_weights(weights: &[f32]) -> Result<(), WaveletError> {
    if weights.is_empty() || weights.len() > MOST_BANDS {
        return Err(WaveletError::new(WaveletErrorKind::Range {
            what: "number of weights",
            value: weights.len() as f64,
            range: "from 1 to 16",
        }));
    }
    for (index, &weight) in weights.iter().enumerate() {
        let value = f64::from(weight);
        if !value.is_finite() {
            return Err(WaveletError::new(WaveletErrorKind::NotFinite {
                index,
                value,
            }));
        }
        if weight.abs() > LARGEST_WEIGHT {
            return Err(WaveletError::new(WaveletErrorKind::Range {
                what: "weight",
                value,
                range: "from -1e30 to 1e30",
            }));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;

#[cfg(test)]
mod power;
