//! Decomposes rasters into frequency bands, and reconstructs them.

use crate::error::check;
use crate::line::check_finite;
use crate::{Border, IsCancelled, SplineFilter, WaveletError};
use dapple_raster::Raster;

/// A raster's frequency bands: one detail raster per level, finest first, and the coarse remainder.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// Detail that halving loses at each level: the raster minus its projection (halved and doubled again), `(I − P)`.
    /// The first element has the size of the original raster.
    pub details: Vec<Raster<f32>>,
    /// Coarse raster that remains after the last level.
    pub coarse: Raster<f32>,
}

impl SplineFilter {
    /// Decomposes a raster into `levels` details and a coarse remainder. With zero levels the remainder is the raster
    /// itself.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/analyze.md"))]
    ///
    /// # Errors
    ///
    /// Same as [`project`](Self::project).
    pub fn analyze(
        &self,
        raster: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
    ) -> Result<Bands, WaveletError> {
        self.analyze_cancellable(raster, levels, borders, &|| false)
    }

    /// Decomposes a raster like [`analyze`](Self::analyze), but fails if `is_cancelled` returns true. It is called as in
    /// [`project_cancellable`](Self::project_cancellable).
    ///
    /// # Errors
    ///
    /// Same as [`analyze`](Self::analyze), plus `Cancelled`.
    pub fn analyze_cancellable(
        &self,
        raster: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Bands, WaveletError> {
        let sizes = self.sizes(raster.size(), levels, borders)?;
        check_finite(raster.pixels())?;
        let mut coarse = raster.clone();
        let mut details = Vec::with_capacity(levels as usize);
        for &size in &sizes[..levels as usize] {
            let fine = coarse;
            coarse = self.down_cancellable(&fine, borders, is_cancelled)?;
            let kept = self.up_cancellable(&coarse, size, borders, is_cancelled)?;
            check(is_cancelled)?;
            details.push(fine.zip_map(&kept, |fine, kept| fine - kept)?);
        }
        Ok(Bands { details, coarse })
    }

    /// Reconstructs the raster from its bands, up to one rounding to `f32` per level.
    ///
    /// # Errors
    ///
    /// `Length` if the size of a detail raster does not match its level, or any error from [`up`](Self::up).
    pub fn synthesize(
        &self,
        bands: &Bands,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        self.synthesize_cancellable(bands, borders, &|| false)
    }

    /// Reconstructs a raster like [`synthesize`](Self::synthesize), but fails if `is_cancelled` returns true. It is
    /// called as in [`up_cancellable`](Self::up_cancellable).
    ///
    /// # Errors
    ///
    /// Same as [`synthesize`](Self::synthesize), plus `Cancelled`.
    pub fn synthesize_cancellable(
        &self,
        bands: &Bands,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, WaveletError> {
        check_finite(bands.coarse.pixels())?;
        let mut raster = bands.coarse.clone();
        for detail in bands.details.iter().rev() {
            check_finite(detail.pixels())?;
            raster = self.up_cancellable(&raster, detail.size(), borders, is_cancelled)?;
            check(is_cancelled)?;
            raster = raster.zip_map(detail, |kept, detail| kept + detail)?;
        }
        Ok(raster)
    }
}

#[cfg(test)]
mod tests;
