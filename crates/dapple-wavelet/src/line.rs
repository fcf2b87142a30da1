//! Filters for `f64` lines: halving by recursion, doubling, and projection, which does both.
//!
//! Reference: Robert L. Cook and Tony DeRose, "Wavelet Noise", ACM Transactions on Graphics 24(3) (SIGGRAPH 2005),
//! <https://doi.org/10.1145/1073204.1073264>, for the filter pair of equations 6 and 7 of Du, Wang and Meng.
//!
//! Cook and DeRose truncate the filter `a` to 32 taps. Here it is applied in full; see `recursion.rs`.

use crate::doubling::Doubling;
use crate::ends::{Halving, lengths};
use crate::recursion::{Lanes, LineFilter};
use crate::{Border, SplineFilter, WaveletError, WaveletErrorKind};
use core::ops::Mul;

impl SplineFilter {
    /// Returns the number of coefficients after halving a line of `length` coefficients. For a periodic line it is
    /// half of `length`; for a mirrored line, see [`Border::Mirror`].
    ///
    /// # Errors
    ///
    /// `NotDivisible` for an odd periodic length; `TooShort` for a line that would not get shorter, that is, for a
    /// length below 2, or below 3 for a mirrored line with an even degree and
    /// [`Phase::CookDeRose`](crate::Phase::CookDeRose); `Range` for a length above 2^40.
    pub fn coarse_len(&self, length: usize, border: Border) -> Result<usize, WaveletError> {
        Ok(Halving::new(*self, length, border)?.coarse.len)
    }

    /// Halves a line to the nearest line with half as many coefficients (equation 7).
    ///
    /// Absolute values in the result are at most 3.82 times the largest absolute value in `fine`, or 2.33 times for
    /// degrees below cubic. Values are finite up to `f64::MAX / 4`; beyond that, some may be infinite or NaN.
    ///
    /// # Errors
    ///
    /// Same as [`coarse_len`](Self::coarse_len), and `NotFinite`.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_wavelet::{Border, SplineFilter};
    ///
    /// let filter = SplineFilter::default();
    /// let coarse = filter.down_line(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], Border::Periodic)?;
    /// assert!((coarse[0] - 343.0 / 512.0).abs() < 1e-12);
    /// # Ok::<(), dapple_wavelet::WaveletError>(())
    /// ```
    pub fn down_line(&self, fine: &[f64], border: Border) -> Result<Vec<f64>, WaveletError> {
        let halving = LineFilter::halving(*self, fine.len(), border)?;
        check_finite(fine)?;
        Ok(filter_line(&halving, fine))
    }

    /// Doubles a line: represents the same function with `fine_len` coefficients (equation 6).
    ///
    /// # Errors
    ///
    /// `Length` if the length of `coarse` does not match `fine_len`, as defined by [`coarse_len`](Self::coarse_len),
    /// or any error from [`down_line`](Self::down_line).
    pub fn up_line(
        &self,
        coarse: &[f64],
        fine_len: usize,
        border: Border,
    ) -> Result<Vec<f64>, WaveletError> {
        let doubling = Doubling::new(*self, coarse.len(), fine_len, border)?;
        check_finite(coarse)?;
        Ok(doubling.line(coarse))
    }

    /// Halves a line `levels` times and then doubles it `levels` times. Zero levels return the line itself.
    ///
    /// Each level mirrors its own line, which may differ from mirroring the fine line: see [`Border::Mirror`]. Values
    /// are finite up to `f64::MAX / 4^levels`; beyond that, some may be infinite or NaN.
    ///
    /// # Errors
    ///
    /// Same as [`down_line`](Self::down_line) at each level; `Range` for more than 32 levels.
    pub fn project_line(
        &self,
        fine: &[f64],
        levels: u32,
        border: Border,
    ) -> Result<Vec<f64>, WaveletError> {
        let lengths = lengths(*self, fine.len(), levels, border)?;
        check_finite(fine)?;
        let mut line = fine.to_vec();
        for &len in &lengths[..levels as usize] {
            line = filter_line(&LineFilter::halving(*self, len, border)?, &line);
        }
        for &len in lengths[..levels as usize].iter().rev() {
            line = Doubling::new(*self, line.len(), len, border)?.line(&line);
        }
        Ok(line)
    }
}

/// Applies a filter to a line.
pub(crate) fn filter_line(filter: &LineFilter, line: &[f64]) -> Vec<f64> {
    let mut lanes = Lanes::<1>::default();
    let load = |values: &mut [[f64; 1]]| values.as_flattened_mut().copy_from_slice(line);
    filter.run(&mut lanes, load).as_flattened().to_vec()
}

/// Fails with the first value that is not finite.
pub(crate) fn check_finite<T>(values: &[T]) -> Result<(), WaveletError>
where
    T: Copy + Default + PartialEq + Mul<Output = T> + Into<f64>,
{
    // The product of zero and a value that is not finite is not zero. An early exit would be slower.
    let is_finite = |value: T| value * T::default() == T::default();
    if values
        .iter()
        .fold(true, |all, &value| all & is_finite(value))
    {
        return Ok(());
    }
    let index = values
        .iter()
        .position(|&value| !is_finite(value))
        .unwrap_or_default();
    Err(WaveletError::new(WaveletErrorKind::NotFinite {
        index,
        value: values[index].into(),
    }))
}

#[cfg(test)]
mod tests;
