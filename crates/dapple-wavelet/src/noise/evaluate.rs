//! Evaluates noise at a position, as the sum of its bands.

use super::WaveletNoise;
use super::band::Band;
use super::place::{Period, Place};
use super::render::render;
use dapple_raster::{Field, FieldParts, Gradient, RasterError, RasterViewMut, Window};
use glam::{DVec2, DVec3};

impl WaveletNoise<2> {
    /// Returns the value at a position in cells.
    #[must_use]
    #[inline]
    pub fn sample(&self, position: impl Into<[f64; 2]>) -> f32 {
        self.sum(position.into(), |places| self.tile.value(places))
    }

    /// Returns the value at a position in cells, equal to [`sample`](Self::sample), and its gradient in value per
    /// cell.
    ///
    /// The gradient is the analytic derivative of the spline; it is NaN if a coordinate is not finite.
    #[must_use]
    #[inline]
    pub fn sample_with_gradient(&self, position: impl Into<[f64; 2]>) -> (f32, DVec2) {
        let tile = &self.tile;
        let (value, gradient) =
            self.sum_with_gradient(position.into(), |places| tile.value_with_gradient(places));
        (value, gradient.into())
    }
}

/// Positions are in cells. Windows are rendered on all cores if the feature `rayon` is enabled.
impl Field for WaveletNoise<2> {
    fn parts(&self) -> FieldParts<'_> {
        FieldParts::Generator(self)
    }

    #[inline]
    fn value(&self, position: [f64; 2]) -> f32 {
        self.sample(position)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        let bands: Vec<_> = self.bands.iter().map(|band| (band, &self.tile)).collect();
        render(&bands, self.periods, window, out)
    }

    fn period(&self) -> [Option<f64>; 2] {
        self.size().map(|cells| Some(f64::from(cells)))
    }
}

impl WaveletNoise<3> {
    /// Returns the value at a position in cells.
    #[must_use]
    #[inline]
    pub fn sample(&self, position: impl Into<[f64; 3]>) -> f32 {
        self.sum(position.into(), |places| self.tile.value(places))
    }

    /// Returns the value at a position in cells, equal to [`sample`](Self::sample), and its gradient in value per
    /// cell.
    ///
    /// The gradient is the analytic derivative of the spline; it is NaN if a coordinate is not finite.
    #[must_use]
    #[inline]
    pub fn sample_with_gradient(&self, position: impl Into<[f64; 3]>) -> (f32, DVec3) {
        let tile = &self.tile;
        let (value, gradient) =
            self.sum_with_gradient(position.into(), |places| tile.value_with_gradient(places));
        (value, gradient.into())
    }
}

/// Positions are in cells. Rendering a window first computes a whole 2-D slice of the tile for each band, which is
/// inefficient for windows much smaller than a slice.
impl Field<3> for WaveletNoise<3> {
    #[inline]
    fn value(&self, position: [f64; 3]) -> f32 {
        self.sample(position)
    }

    fn render(
        &self,
        window: &Window<3>,
        mut out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let [x_period, y_period, z_period] = self.periods;
        let Some(z) = z_period.place_of(window.depth(2)) else {
            out.fill(f32::NAN);
            return Ok(());
        };
        let slice = |band: &Band<3>| self.tile.slice(band.place(z_period, z, 2));
        let slices: Vec<_> = self.bands.iter().map(slice).collect();
        let bands: Vec<_> = self.bands.iter().zip(&slices).collect();
        render(&bands, [x_period, y_period], &window.in_plane(), out)
    }

    fn period(&self) -> [Option<f64>; 3] {
        self.size().map(|cells| Some(f64::from(cells)))
    }
}

impl Gradient for WaveletNoise<2> {
    fn value_and_gradient(&self, position: [f64; 2]) -> (f32, [f32; 2]) {
        let (value, gradient) = self.sample_with_gradient(position);
        (value, gradient.to_array().map(|part| part as f32))
    }
}

impl Gradient<3> for WaveletNoise<3> {
    fn value_and_gradient(&self, position: [f64; 3]) -> (f32, [f32; 3]) {
        let (value, gradient) = self.sample_with_gradient(position);
        (value, gradient.to_array().map(|part| part as f32))
    }
}

impl<const N: usize> WaveletNoise<N> {
    /// Returns the weighted sum of the bands, in order.
    #[inline(always)]
    fn sum(&self, position: [f64; N], value: impl Fn([Place; N]) -> f32) -> f32 {
        let Some(places) = Period::places(self.periods, position) else {
            return f32::NAN;
        };
        let mut sum = 0.0;
        for band in &self.bands {
            sum += band.weight * value(band.places(self.periods, places));
        }
        sum
    }

    #[inline(always)]
    fn sum_with_gradient(
        &self,
        position: [f64; N],
        value: impl Fn([Place; N]) -> (f32, [f32; N]),
    ) -> (f32, [f64; N]) {
        let Some(places) = Period::places(self.periods, position) else {
            return (f32::NAN, [f64::NAN; N]);
        };
        let (mut sum, mut gradient) = (0.0, [0.0; N]);
        for band in &self.bands {
            let (value, slopes) = value(band.places(self.periods, places));
            sum += band.weight * value;
            for axis in 0..N {
                gradient[axis] += f64::from(band.weight) * band.frequency * f64::from(slopes[axis]);
            }
        }
        (sum, gradient)
    }
}
