//! Blends in frequency bands, with sharper transitions for finer detail.
//!
//! A transition that is wide enough for the large features of two textures blurs their fine details into each other. A
//! transition that is narrow enough for the details cuts the large features. If the textures are decomposed into bands,
//! the transition can have a different width in each band.
//!
//! Bartlomiej Wronski, "GPU-Friendly Laplacian Texture Blending", Journal of Computer Graphics Techniques 14(1), 2025
//! (arXiv:2502.13945), blends the levels of a Laplacian pyramid by masks that are sharper at finer levels. Here the
//! bands come from the quadratic spline filter of `dapple-wavelet`, and the shares are halved by the same filter. The
//! sharpening is a power. In the band of level `l`, counted from 0 for the finest, the shares `w` become `w^p / Σ w^p`
//! with `p = 1 + sharpness · (levels - l) / levels`. The coarse remainder is blended with `p = 1`.

use crate::blend::linear;
use crate::error::filtered;
use crate::weighting::{normalize, zip};
use crate::{IsCancelled, TileError};
use dapple_raster::Raster;
use dapple_wavelet::{Bands, Border, SplineFilter};

/// Options for a weighted mean in frequency bands.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Pyramid {
    /// Number of bands, at most 30.
    ///
    /// With 0, the result is the plain mean. The default is 4.
    pub levels: u32,
    /// Sharpness of the transition in the finest band, at least 0.
    ///
    /// The shares of this band are raised to the power `1 + sharpness`. At 0 the result is nearly the plain mean. The
    /// default is 8.
    pub sharpness: f64,
    /// Extension beyond the edges, along x and y.
    ///
    /// The default is mirrored, which requires sides longer than 2^(levels - 1) pixels. Use periodic borders for tiles
    /// whose weights also repeat, with sides that are multiples of 2^levels.
    pub borders: [Border; 2],
}

impl Default for Pyramid {
    fn default() -> Self {
        Self {
            levels: 4,
            sharpness: 8.0,
            borders: [Border::Mirror; 2],
        }
    }
}

impl Pyramid {
    /// Computes the shares of each band from the shares of the pixels. The finest band is first, the coarse remainder
    /// last.
    pub(crate) fn shares(
        &self,
        finest: Vec<Raster<f32>>,
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Vec<Raster<f32>>>, TileError> {
        let (levels, sharpness) = (self.levels, self.sharpness);
        TileError::check(
            levels <= 30,
            "number of levels",
            levels.into(),
            "at most 30",
        )?;
        let holds = sharpness >= 0.0 && sharpness.is_finite();
        TileError::check(holds, "sharpness", sharpness, "at least 0 and finite")?;
        let filter = SplineFilter::default();
        let mut shares = finest;
        let mut bands = Vec::new();
        for level in 0..levels {
            // Sharpen the shares by a power, the largest for the finest band.
            let part = f64::from(levels - level) / f64::from(levels);
            bands.push(sharpen(&shares, 1.0 + sharpness * part, is_cancelled)?);
            let halved = shares
                .iter()
                .map(|share| filter.down_cancellable(share, self.borders, is_cancelled));
            let halved = halved.map(filtered);
            shares = halved.collect::<Result<_, _>>()?;
        }
        // The shares of the coarse remainder are not sharpened.
        bands.push(sharpen(&shares, 1.0, is_cancelled)?);
        Ok(bands)
    }

    /// Blends the planes of all layers by the shares of each band.
    pub(crate) fn mix(
        &self,
        planes: &[Raster<f32>],
        shares: &[Vec<Raster<f32>>],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, TileError> {
        let filter = SplineFilter::default();
        // Group the bands of all layers by band.
        let mut bands = vec![Vec::new(); shares.len()];
        for plane in planes {
            let Bands { details, coarse } = filtered(filter.analyze_cancellable(
                plane,
                self.levels,
                self.borders,
                is_cancelled,
            ))?;
            for (band, detail) in bands.iter_mut().zip(details.into_iter().chain([coarse])) {
                band.push(detail);
            }
        }
        let mixed = bands.iter().zip(shares);
        let mut details: Vec<_> = mixed
            .map(|(layers, shares)| linear(layers, shares, is_cancelled))
            .collect::<Result<_, _>>()?;
        // The last element is the coarse remainder: `shares` has one element more than there are levels.
        let coarse = details.swap_remove(self.levels as usize);
        let bands = Bands { details, coarse };
        filtered(filter.synthesize_cancellable(&bands, self.borders, is_cancelled))
    }
}

/// Raises shares to a power, and normalizes them to a sum of 1. Slightly negative shares, which filters may cause,
/// count as 0.
fn sharpen(
    shares: &[Raster<f32>],
    power: f64,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    // Find the largest share of each pixel.
    let mut most = shares[0].clone();
    for shares in &shares[1..] {
        most = zip(&most, shares, is_cancelled, |most, share| share.max(*most))?;
    }
    // Divide by the largest share, so that the power of at least one does not underflow.
    let power_of = |share: &f32, most: &f32| {
        let part = f64::from(share.max(0.0)) / f64::from(*most);
        libm::pow(part, power) as f32
    };
    let powers: Vec<_> = shares
        .iter()
        .map(|shares| zip(shares, &most, is_cancelled, power_of))
        .collect::<Result<_, _>>()?;
    normalize(&powers.iter().collect::<Vec<_>>(), is_cancelled)
}

#[cfg(test)]
mod tests;
