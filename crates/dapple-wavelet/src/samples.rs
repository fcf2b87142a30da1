//! Finds splines that interpolate given values, and evaluates splines.
//!
//! The filters interpret pixels as coefficients. If the pixels are samples of an image, [`SplineFilter::coefficients`]
//! first computes, by recursion, the spline that has them as its values at pixel centers, and
//! [`SplineFilter::samples`] converts back at the end. For degrees 0 and 1, coefficients and samples are equal.
//!
//! Reference: Michael Unser, "Splines: A Perfect Fit for Signal and Image Processing", IEEE Signal Processing Magazine 16(6),
//! 1999, <https://doi.org/10.1109/79.799930>.

use crate::ends::Line;
use crate::kernel::Kernel;
use crate::line::{check_finite, filter_line};
use crate::plane::filter;
use crate::recursion::LineFilter;
use crate::{Border, IsCancelled, SplineFilter, WaveletError, WaveletErrorKind};
use dapple_raster::Raster;

impl SplineFilter {
    /// Evaluates the spline with the given coefficients at `x` (equation 1). Coefficient `i` is centered on `i`.
    ///
    /// # Errors
    ///
    /// `Range` if `x` is not finite or beyond 2^52 in absolute value; `TooShort` without coefficients, or with a
    /// single one and a mirrored border; `NotFinite` if a coefficient is NaN or infinite.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_wavelet::{Border, SplineFilter};
    ///
    /// let value = SplineFilter::default().value_line(&[0.0, 1.0, 0.0, 0.0], 1.5, Border::Periodic)?;
    /// assert_eq!(value, 0.5);
    /// # Ok::<(), dapple_wavelet::WaveletError>(())
    /// ```
    pub fn value_line(
        &self,
        coefficients: &[f64],
        x: f64,
        border: Border,
    ) -> Result<f64, WaveletError> {
        // Below this limit, a position has a fraction and its integer part is an index.
        const FARTHEST: f64 = (1_u64 << 52) as f64;
        let line = Line::new(*self, coefficients.len(), border)?;
        if !(-FARTHEST..=FARTHEST).contains(&x) {
            return Err(WaveletError::new(WaveletErrorKind::Range {
                what: "position",
                value: x,
                range: "within 2^52 of 0",
            }));
        }
        check_finite(coefficients)?;
        let below = x.floor();
        let mut sum = 0.0;
        // Splines are at most 4 wide.
        for step in -1..=2 {
            let coefficient = coefficients[line.index(below as i64 + step)];
            sum += coefficient * self.degree.value(x - below - step as f64);
        }
        Ok(sum)
    }

    /// Computes the coefficients of the spline that takes the given values at integers.
    ///
    /// # Errors
    ///
    /// `TooShort` without values, or with a single one and a mirrored border; `NotFinite` if a value is NaN or
    /// infinite.
    pub fn coefficients_line(
        &self,
        samples: &[f64],
        border: Border,
    ) -> Result<Vec<f64>, WaveletError> {
        self.filter_samples(Kernel::coefficients(self.degree), samples, border)
    }

    /// Evaluates the spline with the given coefficients at all integers.
    ///
    /// # Errors
    ///
    /// Same as [`coefficients_line`](Self::coefficients_line).
    pub fn samples_line(
        &self,
        coefficients: &[f64],
        border: Border,
    ) -> Result<Vec<f64>, WaveletError> {
        self.filter_samples(Kernel::samples(self.degree), coefficients, border)
    }

    /// Computes the coefficients of the spline that takes the given values at pixel centers.
    ///
    /// # Errors
    ///
    /// Same as [`coefficients_line`](Self::coefficients_line).
    pub fn coefficients(
        &self,
        samples: &Raster<f32>,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        self.coefficients_cancellable(samples, borders, &|| false)
    }

    /// Computes coefficients like [`coefficients`](Self::coefficients), but fails if `is_cancelled` returns true. It is
    /// called before each batch of 256 lines.
    ///
    /// # Errors
    ///
    /// Same as [`coefficients`](Self::coefficients), plus `Cancelled`.
    pub fn coefficients_cancellable(
        &self,
        samples: &Raster<f32>,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, WaveletError> {
        let kernel = Kernel::coefficients(self.degree);
        self.filter_raster(&kernel, samples, borders, is_cancelled)
    }

    /// Evaluates the spline with the given coefficients at all pixel centers.
    ///
    /// # Errors
    ///
    /// Same as [`coefficients_line`](Self::coefficients_line).
    pub fn samples(
        &self,
        coefficients: &Raster<f32>,
        borders: [Border; 2],
    ) -> Result<Raster<f32>, WaveletError> {
        self.samples_cancellable(coefficients, borders, &|| false)
    }

    /// Evaluates a spline like [`samples`](Self::samples), but fails if `is_cancelled` returns true. It is called before
    /// each batch of 256 lines.
    ///
    /// # Errors
    ///
    /// Same as [`samples`](Self::samples), plus `Cancelled`.
    pub fn samples_cancellable(
        &self,
        coefficients: &Raster<f32>,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, WaveletError> {
        let kernel = Kernel::samples(self.degree);
        self.filter_raster(&kernel, coefficients, borders, is_cancelled)
    }

    fn filter_samples(
        &self,
        kernel: Kernel,
        values: &[f64],
        border: Border,
    ) -> Result<Vec<f64>, WaveletError> {
        let line = Line::new(*self, values.len(), border)?;
        check_finite(values)?;
        Ok(filter_line(&LineFilter::in_place(kernel, line), values))
    }

    fn filter_raster(
        &self,
        kernel: &Kernel,
        raster: &Raster<f32>,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, WaveletError> {
        let along = |axis: usize| {
            let line = Line::new(*self, raster.size()[axis] as usize, borders[axis])?;
            Ok::<_, WaveletError>(LineFilter::in_place(kernel.clone(), line))
        };
        let [along_rows, along_columns] = [along(0)?, along(1)?];
        check_finite(raster.pixels())?;
        filter(raster, [&along_rows, &along_columns], is_cancelled)
    }
}

#[cfg(test)]
mod tests;
