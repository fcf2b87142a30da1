//! Values of noise: the sum of its bands at a position.

use super::WaveletNoise;
use super::band::Band;
use super::place::{Period, Place};
use super::render::render;
use dapple_raster::{Field, RasterError, RasterViewMut, Window};
use glam::{DVec2, DVec3};

impl WaveletNoise<2> {
    /// The value at a position in cells.
    #[must_use]
    #[inline]
    pub fn sample(&self, position: DVec2) -> f32 {
        self.sum(position.to_array(), |places| self.tile.value(places))
    }

    /// The value at a position in cells, equal to that of [`sample`](Self::sample), and its gradient per cell.
    ///
    /// The gradient is the spline's own, not a difference; where a coordinate is not finite it is NaN.
    #[must_use]
    #[inline]
    pub fn sample_with_gradient(&self, position: DVec2) -> (f32, DVec2) {
        let tile = &self.tile;
        let (value, gradient) = self.sum_with_gradient(position.to_array(), |places| {
            tile.value_with_gradient(places)
        });
        (value, gradient.into())
    }
}

/// Positions in cells; windows are filled on all cores where the feature `rayon` is on.
impl Field for WaveletNoise<2> {
    #[inline]
    fn sample(&self, position: DVec2) -> f32 {
        Self::sample(self, position)
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
    /// The value at a position in cells.
    #[must_use]
    #[inline]
    pub fn sample(&self, position: DVec3) -> f32 {
        self.sum(position.to_array(), |places| self.tile.value(places))
    }

    /// The value at a position in cells, equal to that of [`sample`](Self::sample), and its gradient per cell.
    ///
    /// The gradient is the spline's own, not a difference; where a coordinate is not finite it is NaN.
    #[must_use]
    #[inline]
    pub fn sample_with_gradient(&self, position: DVec3) -> (f32, DVec3) {
        let tile = &self.tile;
        let (value, gradient) = self.sum_with_gradient(position.to_array(), |places| {
            tile.value_with_gradient(places)
        });
        (value, gradient.into())
    }

    /// The values at the pixel centers of a window that lies at the depth `z`, into memory of its size.
    ///
    /// They equal those of [`sample`](Self::sample) to the last bit. The whole slice of the tile is computed first,
    /// once for each band, which does not pay for windows much smaller than a slice.
    ///
    /// # Errors
    ///
    /// [`RasterErrorKind::SizeMismatch`](dapple_raster::RasterErrorKind::SizeMismatch) if `out` has another size than
    /// the window.
    pub fn render_slice(
        &self,
        z: f64,
        window: &Window,
        mut out: RasterViewMut<'_, f32>,
    ) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let [x_period, y_period, z_period] = self.periods;
        let Some(z) = z_period.place_of(z) else {
            out.fill(f32::NAN);
            return Ok(());
        };
        let slice = |band: &Band<3>| self.tile.slice(band.place(z_period, z, 2));
        let slices: Vec<_> = self.bands.iter().map(slice).collect();
        let bands: Vec<_> = self.bands.iter().zip(&slices).collect();
        render(&bands, [x_period, y_period], window, out)
    }
}

impl<const N: usize> WaveletNoise<N> {
    /// The weighted values of the bands, summed in their order.
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
