//! Rasters: the filters along rows and columns.
//!
//! Halving goes along rows and then along columns, doubling along columns and then along rows; in between values are rounded
//! to `f32`. All arithmetic is `f64`.

use crate::doubling::Doubling;
use crate::ends::lengths;
use crate::line::check_finite;
use crate::pass::filter_lines;
use crate::recursion::LineFilter;
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
        let [width, height] = fine.size().map(|side| side as usize);
        let along_rows = LineFilter::halving(*self, width, borders[0])?;
        let along_columns = LineFilter::halving(*self, height, borders[1])?;
        check_finite(fine.pixels())?;
        filter(fine, [&along_rows, &along_columns])
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
        let doubling = |axis: usize| {
            let [coarse_len, fine_len] = [coarse.size()[axis], fine_size[axis]];
            Doubling::new(*self, coarse_len as usize, fine_len as usize, borders[axis])
        };
        let [along_rows, along_columns] = [doubling(0)?, doubling(1)?];
        // Refuses a size that is too large before there is memory for it.
        Raster::filled(fine_size, ())?;
        check_finite(coarse.pixels())?;
        let mut fine = vec![0.0; along_rows.fine.len * along_columns.fine.len];
        along_columns.plane(&along_rows, coarse.pixels(), &mut fine);
        Ok(Raster::from_vec(fine_size, fine)?)
    }

    /// Halves a raster `levels` times along each axis and doubles it again; zero levels give the raster itself.
    ///
    /// # Errors
    ///
    /// As [`down`](Self::down), for each level; `Range` for more than 32 levels.
    pub fn project(
        &self,
        fine: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let sizes = self.sizes(fine.size(), levels, borders)?;
        check_finite(fine.pixels())?;
        let mut raster = fine.clone();
        for _ in 0..levels {
            raster = self.down(&raster, borders)?;
        }
        for &size in sizes[..levels as usize].iter().rev() {
            raster = self.up(&raster, size, borders)?;
        }
        Ok(raster)
    }

    /// The sizes of a raster that is halved `levels` times, from the first to the last.
    pub(crate) fn sizes(
        &self,
        size: [u32; 2],
        levels: u32,
        borders: [Border; 2],
    ) -> Result<Vec<[u32; 2]>, WaveletError> {
        let widths = lengths(*self, size[0] as usize, levels, borders[0])?;
        let heights = lengths(*self, size[1] as usize, levels, borders[1])?;
        let sizes = widths.iter().zip(&heights);
        Ok(sizes
            .map(|(&width, &height)| [width as u32, height as u32])
            .collect())
    }
}

/// The raster, filtered along its rows and then along its columns.
pub(crate) fn filter(
    raster: &Raster<f32>,
    [along_rows, along_columns]: [&LineFilter; 2],
) -> Result<Raster<f32>, WaveletError> {
    let size = [along_rows, along_columns].map(|filter| filter.target.len as u32);
    let columns = filter_lines(along_rows, raster.pixels());
    Ok(Raster::from_vec(
        size,
        filter_lines(along_columns, &columns),
    )?)
}

#[cfg(test)]
mod tests;
