//! Rasters: the filters along rows and columns.

use crate::{Border, SplineFilter, WaveletError};
use dapple_raster::Raster;

impl SplineFilter {
    /// Equations 9 and 12: the nearest raster of half the size.
    ///
    /// # Errors
    ///
    /// As [`down_line`](Self::down_line).
    pub fn down(
        &self,
        fine: &Raster<f32>,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let _ = (fine, borders);
        todo!()
    }

    /// Equations 8 and 13: the same function on `fine_size` pixels.
    ///
    /// # Errors
    ///
    /// As [`up_line`](Self::up_line).
    pub fn up(
        &self,
        coarse: &Raster<f32>,
        fine_size: [u32; 2],
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let _ = (coarse, fine_size, borders);
        todo!()
    }

    /// Halves a raster `levels` times along each axis and doubles it again; zero levels give the raster itself.
    ///
    /// # Errors
    ///
    /// As [`down`](Self::down).
    pub fn project(
        &self,
        fine: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let _ = (fine, levels, borders);
        todo!()
    }
}
