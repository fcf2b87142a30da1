//! Filters volumes along three axes.
//!
//! A volume is a slice of values in which x varies fastest, then y, then z. Halving filters along x, y and z,
//! doubling along z, y and x; values are rounded to `f32` in between. All arithmetic is `f64`.

use crate::doubling::{BLOCK, Doubling};
use crate::ends::lengths;
use crate::error::check;
use crate::line::check_finite;
use crate::pass::filter_lines;
use crate::recursion::LineFilter;
use crate::{Border, IsCancelled, SplineFilter, WaveletError, WaveletErrorKind};
use dapple_raster::{parallel, simd};

impl SplineFilter {
    /// Halves a volume to the nearest volume of half the size. [`coarse_len`](Self::coarse_len) gives the resulting
    /// length along each axis.
    ///
    /// Values are finite up to `f32::MAX / 56`; beyond that, some may be infinite or NaN.
    ///
    /// # Errors
    ///
    /// `Length` if the number of values does not match `size`, or any error from [`down_line`](Self::down_line).
    pub fn down_volume(
        &self,
        volume: &[f32],
        size: [u32; 3],
        borders: [Border; 3],
    ) -> Result<Vec<f32>, WaveletError> {
        self.halve_volume(volume, size, borders, &|| false)
    }

    fn halve_volume(
        &self,
        volume: &[f32],
        size: [u32; 3],
        borders: [Border; 3],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<f32>, WaveletError> {
        let halving = |axis: usize| LineFilter::halving(*self, size[axis] as usize, borders[axis]);
        let [x, y, z] = [halving(0)?, halving(1)?, halving(2)?];
        check_volume(volume, size)?;
        // Each pass brings the next axis to the front, so that three passes restore the order.
        let along_x = filter_lines(&x, volume, is_cancelled)?;
        let along_y = filter_lines(&y, &along_x, is_cancelled)?;
        filter_lines(&z, &along_y, is_cancelled)
    }

    /// Doubles a volume: represents the same function with `fine_size` values.
    ///
    /// # Errors
    ///
    /// `Length` if the number of values does not match the halved `fine_size`, or any error from
    /// [`up_line`](Self::up_line).
    pub fn up_volume(
        &self,
        coarse: &[f32],
        fine_size: [u32; 3],
        borders: [Border; 3],
    ) -> Result<Vec<f32>, WaveletError> {
        self.double_volume(coarse, fine_size, borders, &|| false)
    }

    fn double_volume(
        &self,
        coarse: &[f32],
        fine_size: [u32; 3],
        borders: [Border; 3],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<f32>, WaveletError> {
        let doubling = |axis: usize| {
            let fine_len = fine_size[axis] as usize;
            let coarse_len = self.coarse_len(fine_len, borders[axis])?;
            Doubling::new(*self, coarse_len, fine_len, borders[axis])
        };
        let [x, y, z] = [doubling(0)?, doubling(1)?, doubling(2)?];
        check_volume(coarse, [&x, &y, &z].map(|axis| axis.coarse.len as u32))?;
        let [coarse_slice, fine_slice] = [x.coarse.len * y.coarse.len, x.fine.len * y.fine.len];
        let mut fine = vec![0.0; fine_slice * z.fine.len];
        let scratch = || (vec![0.0; coarse_slice], vec![0.0; coarse_slice]);
        let n_slices = (BLOCK / fine_slice).max(1);
        let blocks = fine.chunks_mut(n_slices * fine_slice);
        for (slices, first) in blocks.zip((0..).step_by(n_slices)) {
            check(is_cancelled)?;
            parallel::for_each_chunk_with(
                slices,
                fine_slice,
                scratch,
                |(sums, slice), depth, fine| {
                    z.blend(first + depth, coarse, sums);
                    for (value, &sum) in slice.iter_mut().zip(&*sums) {
                        *value = sum as f32;
                    }
                    y.rows(simd::level(), &x, slice, (0, fine));
                },
            );
        }
        Ok(fine)
    }

    /// Halves a volume `levels` times along each axis and then doubles it `levels` times. Zero levels return the
    /// volume itself.
    ///
    /// # Errors
    ///
    /// Same as [`down_volume`](Self::down_volume) at each level. `NotFinite` also occurs if a level produces infinite
    /// values from finite ones, which cannot happen up to `f32::MAX / 56^levels`. `Range` for more than 32 levels.
    pub fn project_volume(
        &self,
        volume: &[f32],
        size: [u32; 3],
        levels: u32,
        borders: [Border; 3],
    ) -> Result<Vec<f32>, WaveletError> {
        self.project_volume_cancellable(volume, size, levels, borders, &|| false)
    }

    /// Projects a volume like [`project_volume`](Self::project_volume), but fails if `is_cancelled` returns true. It is
    /// called before each batch of 256 lines and once per 2^22 values.
    ///
    /// # Errors
    ///
    /// Same as [`project_volume`](Self::project_volume), plus `Cancelled`.
    pub fn project_volume_cancellable(
        &self,
        volume: &[f32],
        size: [u32; 3],
        levels: u32,
        borders: [Border; 3],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<f32>, WaveletError> {
        let sides = |axis: usize| lengths(*self, size[axis] as usize, levels, borders[axis]);
        let [x, y, z] = [sides(0)?, sides(1)?, sides(2)?];
        check_volume(volume, size)?;
        let size = |level: usize| [x[level], y[level], z[level]].map(|side| side as u32);
        let mut values = volume.to_vec();
        for level in 0..levels as usize {
            values = self.halve_volume(&values, size(level), borders, is_cancelled)?;
        }
        for level in (0..levels as usize).rev() {
            values = self.double_volume(&values, size(level), borders, is_cancelled)?;
        }
        Ok(values)
    }
}

/// Checks that a volume matches the given size, and that all values are finite.
fn check_volume(volume: &[f32], size: [u32; 3]) -> Result<(), WaveletError> {
    let needed = size.iter().fold(1_usize, |product, &side| {
        product.saturating_mul(side as usize)
    });
    if volume.len() != needed {
        return Err(WaveletError::new(WaveletErrorKind::Length {
            length: volume.len(),
            needed,
        }));
    }
    check_finite(volume)
}

#[cfg(test)]
mod tests;
