//! Filters rasters along rows and columns.
//!
//! Halving filters rows and then columns; doubling filters columns and then rows. Values are rounded to `f32` in
//! between. All arithmetic is `f64`.
//!
//! Reference: Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis",
//! equations 8, 9, 12 and 13.

use crate::doubling::Doubling;
use crate::ends::lengths;
use crate::line::check_finite;
use crate::pass::filter_lines_into;
use crate::recursion::LineFilter;
use crate::{Border, IsCancelled, SplineFilter, WaveletError};
use dapple_raster::{Raster, simd};
use fearless_simd::Level;

/// Reusable scratch memory for [`SplineFilter::down_into`]. It takes about 2 bytes per fine pixel of the largest
/// raster.
#[derive(Clone, Debug, Default)]
pub struct FilterMemory {
    columns: Vec<f32>,
    batch: Vec<f32>,
}

impl SplineFilter {
    /// Halves a raster to the nearest raster of half the size (equations 9 and 12).
    ///
    /// Absolute pixel values are at most 14.6 times the largest absolute value in `fine`, or 5.4 times for degrees
    /// below cubic. Pixels are finite up to `f32::MAX / 15`; beyond that, some may be infinite or NaN.
    ///
    /// # Errors
    ///
    /// Same as [`down_line`](Self::down_line).
    pub fn down(
        &self,
        fine: &Raster<f32>,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        self.down_cancellable(fine, borders, &|| false)
    }

    /// Halves a raster like [`down`](Self::down), but fails if `is_cancelled` returns true. It is called before each
    /// batch of 256 lines.
    ///
    /// # Errors
    ///
    /// Same as [`down`](Self::down), plus `Cancelled`.
    pub fn down_cancellable(
        &self,
        fine: &Raster<f32>,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, WaveletError> {
        let size = self.sizes(fine.size(), 1, borders)?[1];
        let mut coarse = Raster::filled(size, 0.0)?;
        let memory = &mut FilterMemory::default();
        self.halve(fine, borders, &mut coarse, memory, is_cancelled)?;
        Ok(coarse)
    }

    /// Halves a raster like [`down`](Self::down), into an existing raster and with reusable scratch memory. Use it for
    /// many or large rasters, where allocation takes more time than the filter.
    ///
    /// # Errors
    ///
    /// Same as [`down`](Self::down), and `Raster` if the size of `coarse` does not match, as defined by
    /// [`coarse_len`](Self::coarse_len).
    pub fn down_into(
        &self,
        fine: &Raster<f32>,
        borders: [Border; 2],
        coarse: &mut Raster<f32>,
        memory: &mut FilterMemory,
    ) -> Result<(), WaveletError> {
        self.halve(fine, borders, coarse, memory, &|| false)
    }

    fn halve(
        &self,
        fine: &Raster<f32>,
        borders: [Border; 2],
        coarse: &mut Raster<f32>,
        memory: &mut FilterMemory,
        is_cancelled: &IsCancelled,
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
            is_cancelled,
        )
    }

    /// Doubles a raster: represents the same function with `fine_size` pixels (equations 8 and 13).
    ///
    /// # Errors
    ///
    /// Same as [`up_line`](Self::up_line).
    pub fn up(
        &self,
        coarse: &Raster<f32>,
        fine_size: [u32; 2],
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        self.up_cancellable(coarse, fine_size, borders, &|| false)
    }

    /// Doubles a raster like [`up`](Self::up), but fails if `is_cancelled` returns true. It is called once per 2^22
    /// pixels.
    ///
    /// # Errors
    ///
    /// Same as [`up`](Self::up), plus `Cancelled`.
    pub fn up_cancellable(
        &self,
        coarse: &Raster<f32>,
        fine_size: [u32; 2],
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, WaveletError> {
        let doubled = |axis: usize| {
            self.doubling(coarse.size()[axis], fine_size[axis], borders[axis])
                .map(drop)
        };
        // Check the size before allocating memory.
        doubled(0).and(doubled(1))?;
        let mut fine = Raster::filled(fine_size, 0.0)?;
        self.double(coarse, borders, &mut fine, is_cancelled)?;
        Ok(fine)
    }

    /// Doubles a raster like [`up`](Self::up), into the existing raster `fine`, whose size selects the result's size.
    ///
    /// # Errors
    ///
    /// Same as [`up`](Self::up).
    pub fn up_into(
        &self,
        coarse: &Raster<f32>,
        borders: [Border; 2],
        fine: &mut Raster<f32>,
    ) -> Result<(), WaveletError> {
        self.double(coarse, borders, fine, &|| false)
    }

    fn double(
        &self,
        coarse: &Raster<f32>,
        borders: [Border; 2],
        fine: &mut Raster<f32>,
        is_cancelled: &IsCancelled,
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
            is_cancelled,
        )
    }

    fn doubling(&self, coarse: u32, fine: u32, border: Border) -> Result<Doubling, WaveletError> {
        Doubling::new(*self, coarse as usize, fine as usize, border)
    }

    /// Halves a raster `levels` times along each axis and then doubles it `levels` times. Zero levels return the
    /// raster itself.
    ///
    /// With a mirrored border, each level mirrors its own lines; see [`Border::Mirror`].
    ///
    /// # Errors
    ///
    /// Same as [`down`](Self::down) at each level. `NotFinite` also occurs if a level produces infinite pixels from
    /// finite ones, which cannot happen up to `f32::MAX / 15^levels`. `Range` for more than 32 levels.
    pub fn project(
        &self,
        fine: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        self.project_cancellable(fine, levels, borders, &|| false)
    }

    /// Projects a raster like [`project`](Self::project), but fails if `is_cancelled` returns true. It is called as in
    /// [`down_cancellable`](Self::down_cancellable) and [`up_cancellable`](Self::up_cancellable).
    ///
    /// # Errors
    ///
    /// Same as [`project`](Self::project), plus `Cancelled`.
    pub fn project_cancellable(
        &self,
        fine: &Raster<f32>,
        levels: u32,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, WaveletError> {
        let sizes = self.sizes(fine.size(), levels, borders)?;
        check_finite(fine.pixels())?;
        let mut memory = FilterMemory::default();
        let mut raster = fine.clone();
        for &size in &sizes[1..] {
            let mut coarse = Raster::filled(size, 0.0)?;
            self.halve(&raster, borders, &mut coarse, &mut memory, is_cancelled)?;
            raster = coarse;
        }
        for &size in sizes[..levels as usize].iter().rev() {
            raster = self.up_cancellable(&raster, size, borders, is_cancelled)?;
        }
        Ok(raster)
    }

    /// Returns the sizes of a raster as it is halved `levels` times, from its original size to the last.
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

/// Filters a raster along its rows and then along its columns.
pub(crate) fn filter(
    raster: &Raster<f32>,
    filters: [&LineFilter; 2],
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, WaveletError> {
    let size = filters.map(|filter| filter.target.len as u32);
    let mut filtered = Raster::filled(size, 0.0)?;
    let pixels = filtered.pixels_mut();
    FilterMemory::default().filter(simd::level(), raster, filters, pixels, is_cancelled)?;
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
        is_cancelled: &IsCancelled,
    ) -> Result<(), WaveletError> {
        let Self { columns, batch } = self;
        let n_values = along_rows.target.len * raster.height() as usize;
        if columns.len() < n_values {
            // Allocate zeroed memory instead of clearing, which would touch the memory once more.
            *columns = vec![0.0; n_values];
        }
        let columns = &mut columns[..n_values];
        let rows = raster.pixels();
        filter_lines_into(level, along_rows, rows, batch, columns, is_cancelled)?;
        filter_lines_into(level, along_columns, columns, batch, filtered, is_cancelled)
    }
}

#[cfg(test)]
mod tests;
