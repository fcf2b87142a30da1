//! Lines in `f64`: halving by recursion, doubling, and both at once.

use crate::{Border, SplineFilter, WaveletError};

impl SplineFilter {
    /// How many coefficients a line of `length` has once halved: half as many where it is periodic.
    ///
    /// # Errors
    ///
    /// `NotDivisible` for an odd periodic length, `TooShort` below 2.
    pub fn coarse_len(&self, length: usize, border: Border) -> Result<usize, WaveletError> {
        let _ = (length, border);
        todo!()
    }

    /// Equation 7: the nearest line with half as many coefficients.
    ///
    /// # Errors
    ///
    /// As [`coarse_len`](Self::coarse_len), and `NotFinite`.
    pub fn down_line(&self, fine: &[f64], border: Border) -> Result<Vec<f64>, WaveletError> {
        let _ = (fine, border);
        todo!()
    }

    /// Equation 6: the same function with `fine_len` coefficients.
    ///
    /// # Errors
    ///
    /// `Length` if `coarse` has not the length that `fine_len` has once halved; as [`down_line`](Self::down_line).
    pub fn up_line(
        &self,
        coarse: &[f64],
        fine_len: usize,
        border: Border,
    ) -> Result<Vec<f64>, WaveletError> {
        let _ = (coarse, fine_len, border);
        todo!()
    }

    /// Halves a line `levels` times and doubles it again.
    ///
    /// # Errors
    ///
    /// As [`down_line`](Self::down_line).
    pub fn project_line(
        &self,
        fine: &[f64],
        levels: u32,
        border: Border,
    ) -> Result<Vec<f64>, WaveletError> {
        let _ = (fine, levels, border);
        todo!()
    }
}
