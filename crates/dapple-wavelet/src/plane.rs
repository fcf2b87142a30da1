//! Filters of rasters along rows and columns.
//!
//! Halving goes along rows and then along columns, doubling along columns and then along rows; in between values are rounded
//! to `f32`. All arithmetic is `f64`.
//!
//! Reference: Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis",
//! equations 8, 9, 12 and 13.

use crate::doubling::Doubling;
use crate::ends::lengths;
use crate::line::check_finite;
use crate::pass::filter_lines_into;
use crate::recursion::LineFilter;
use crate::{Border, SplineFilter, WaveletError};
use dapple_raster::{Raster, simd};
use fearless_simd::Level;

/// Scratch memory of [`SplineFilter::down_into`], which is reused from raster to raster: about 2 bytes for each fine
/// pixel of the largest raster.
#[derive(Clone, Debug, Default)]
pub struct FilterMemory {
    columns: Vec<f32>,
    batch: Vec<f32>,
}

impl SplineFilter {
    /// Equations 9 and 12: the nearest raster of half the size.
    ///
    /// No absolute value of a pixel exceeds 14.6 times the largest of `fine`, or 5.4 times for degrees below the cubic.
    /// Pixels are finite up to `f32::MAX / 15`; beyond it some may be infinite or NaN.
    ///
    /// # Errors
    ///
    /// The errors of [`down_line`](Self::down_line).
    pub fn down(
        &self,
        fine: &Raster<f32>,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let [width, height] = self.sizes(fine.size(), 1, borders)?[1];
        let mut coarse = Raster::filled([width, height], 0.0)?;
        self.down_into(fine, borders, &mut coarse, &mut FilterMemory::default())?;
        Ok(coarse)
    }

    /// Halves a raster, as [`down`](Self::down) does, into one of half the size, with reusable scratch memory: for many
    /// rasters, and for large ones, where new memory costs more time than the filter.
    ///
    /// # Errors
    ///
    /// The errors of [`down`](Self::down), and `Raster` if `coarse` has another size than half of `fine`, as
    /// [`coarse_len`](Self::coarse_len) says.
    pub fn down_into(
        &self,
        fine: &Raster<f32>,
        borders: [Border; 2],
        coarse: &mut Raster<f32>,
        memory: &mut FilterMemory,
    ) -> Result<(), WaveletError> {
        let [width, height] = fine.size().map(|side| side as usize);
        let along_rows = LineFilter::halving(*self, width, borders[0])?;
        let along_columns = LineFilter::halving(*self, height, borders[1])?;
        let size = [&along_rows, &along_columns].map(|filter| filter.target.len as u32);
        coarse.check_same_size(size)?;
        check_finite(fine.pixels())?;
        memory.filter(
            simd::level(),
            fine,
            [&along_rows, &along_columns],
            coarse.pixels_mut(),
        );
        Ok(())
    }

    /// Equations 8 and 13: the same function on `fine_size` pixels.
    ///
    /// # Errors
    ///
    /// The errors of [`up_line`](Self::up_line).
    pub fn up(
        &self,
        coarse: &Raster<f32>,
        fine_size: [u32; 2],
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let doubled = |axis: usize| {
            self.doubling(coarse.size()[axis], fine_size[axis], borders[axis])
                .map(drop)
        };
        // This checks the size before its memory is allocated.
        doubled(0).and(doubled(1))?;
        let mut fine = Raster::filled(fine_size, 0.0)?;
        self.up_into(coarse, borders, &mut fine)?;
        Ok(fine)
    }

    /// Doubles a raster, as [`up`](Self::up) does, into an existing raster of the fine size.
    ///
    /// # Errors
    ///
    /// The errors of [`up`](Self::up).
    pub fn up_into(
        &self,
        coarse: &Raster<f32>,
        borders: [Border; 2],
        fine: &mut Raster<f32>,
    ) -> Result<(), WaveletError> {
        let doubling =
            |axis: usize| self.doubling(coarse.size()[axis], fine.size()[axis], borders[axis]);
        let [along_rows, along_columns] = [doubling(0)?, doubling(1)?];
        check_finite(coarse.pixels())?;
        along_columns.plane(
            simd::level(),
            &along_rows,
            coarse.pixels(),
            fine.pixels_mut(),
        );
        Ok(())
    }

    fn doubling(&self, coarse: u32, fine: u32, border: Border) -> Result<Doubling, WaveletError> {
        Doubling::new(*self, coarse as usize, fine as usize, border)
    }

    /// Halves a raster `levels` times along each axis and doubles it as often; zero levels return the raster itself.
    ///
    /// Each level mirrors its own lines anew: see [`Border::Mirror`].
    ///
    /// # Errors
    ///
    /// The errors of [`down`](Self::down), for each level: `NotFinite` also if a level has made infinite pixels from
    /// finite ones, which cannot happen up to `f32::MAX / 15^levels`. `Range` for more than 32 levels.
    pub fn project(
        &self,
        fine: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        let sizes = self.sizes(fine.size(), levels, borders)?;
        check_finite(fine.pixels())?;
        let mut memory = FilterMemory::default();
        let mut raster = fine.clone();
        for &size in &sizes[1..] {
            let mut coarse = Raster::filled(size, 0.0)?;
            self.down_into(&raster, borders, &mut coarse, &mut memory)?;
            raster = coarse;
        }
        for &size in sizes[..levels as usize].iter().rev() {
            raster = self.up(&raster, size, borders)?;
        }
        Ok(raster)
    }

    /// The sizes of a raster that is halved `levels` times, from its own to the last.
    ///
    /// # Errors
    ///
    /// `NotDivisible` with the side and all levels, `TooShort`; `Range` for more than 32 levels.
    pub fn sizes(
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
    filters: [&LineFilter; 2],
) -> Result<Raster<f32>, WaveletError> {
    let size = filters.map(|filter| filter.target.len as u32);
    let mut filtered = Raster::filled(size, 0.0)?;
    let pixels = filtered.pixels_mut();
    FilterMemory::default().filter(simd::level(), raster, filters, pixels);
    Ok(filtered)
}

impl FilterMemory {
    /// Filters a raster along its rows and then along its columns, at a SIMD level.
    fn filter(
        &mut self,
        level: Level,
        raster: &Raster<f32>,
        [along_rows, along_columns]: [&LineFilter; 2],
        filtered: &mut [f32],
    ) {
        let Self { columns, batch } = self;
        let n_values = along_rows.target.len * raster.height() as usize;
        if columns.len() < n_values {
            // New memory comes zeroed from the system; clearing would touch it once more.
            *columns = vec![0.0; n_values];
        }
        let columns = &mut columns[..n_values];
        filter_lines_into(level, along_rows, raster.pixels(), batch, columns);
        filter_lines_into(level, along_columns, columns, batch, filtered);
    }
}

#[cfg(test)]
mod tests;
