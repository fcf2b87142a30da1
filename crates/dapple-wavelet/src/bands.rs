//! A raster taken apart into bands of detail, and put together again.

use crate::{Border, SplineFilter, WaveletError};
use dapple_raster::Raster;

/// What a raster is made of: a detail for each level, finest first, and the coarse rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    /// `(I − P)` of each level: what is lost when it is halved. The first has the size of the raster.
    pub details: Vec<Raster<f32>>,
    /// What is left after the last level.
    pub coarse: Raster<f32>,
}

impl SplineFilter {
    /// Takes a raster apart into `levels` details and a coarse rest.
    ///
    /// # Errors
    ///
    /// As [`down`](Self::down).
    pub fn analyze(
        &self,
        raster: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
    ) -> Result<Bands, WaveletError> {
        let _ = (raster, levels, borders);
        todo!()
    }

    /// The raster that the bands are of.
    ///
    /// # Errors
    ///
    /// As [`up`](Self::up).
    pub fn synthesize(
        &self,
        bands: &Bands,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let _ = (bands, borders);
        todo!()
    }
}
