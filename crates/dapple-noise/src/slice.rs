//! Planes through noise of three or four dimensions.

use crate::GradientNoise;
use crate::lines::Lines;
use dapple_raster::{Field, RasterError, RasterViewMut, Window};
use glam::DVec2;

/// The plane through noise of three or four dimensions at fixed further coordinates, as a field of the plane.
///
/// # Examples
///
/// A texture that moves, and begins again after 6 cells of time:
///
/// ```
/// use dapple_noise::{GradientNoise3, hash::Seed, raster::{Field, Window}};
///
/// let noise = GradientNoise3::new(Seed(7)).with_period([None, None, Some(6)])?;
/// let window = Window::unit([64, 64])?;
/// let [first, last] = [0.5, 6.5].map(|time| noise.slice(time).to_raster(&window));
/// assert_eq!(first?, last?);
/// # Ok::<(), dapple_noise::raster::RasterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice<const N: usize, const REST: usize> {
    noise: GradientNoise<N>,
    rest: [f64; REST],
}

impl GradientNoise<3> {
    /// The plane at the depth (or time) `z`.
    #[must_use]
    pub const fn slice(self, z: f64) -> Slice<3, 1> {
        let rest = [z];
        Slice { noise: self, rest }
    }
}

impl GradientNoise<4> {
    /// The plane at the depth `z` and the time `w`.
    #[must_use]
    pub const fn slice(self, z: f64, w: f64) -> Slice<4, 2> {
        let rest = [z, w];
        Slice { noise: self, rest }
    }
}

/// Positions in cells; windows are filled on all cores where the feature `rayon` is on.
impl<const N: usize, const REST: usize> Field for Slice<N, REST> {
    fn sample(&self, position: DVec2) -> f32 {
        let mut whole = [position.x; N];
        whole[1] = position.y;
        whole[2..].copy_from_slice(&self.rest);
        self.noise.sample(whole)
    }

    fn sample_many(&self, positions: &[DVec2], values: &mut [f32]) -> Result<(), RasterError> {
        let whole = |position: &DVec2| {
            let mut whole = [position.x; N];
            whole[1] = position.y;
            whole[2..].copy_from_slice(&self.rest);
            whole
        };
        let positions: Vec<[f64; N]> = positions.iter().map(whole).collect();
        self.noise.sample_many(&positions, values)
    }

    fn render(&self, window: &Window, out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        Lines::new(&self.noise, window, self.rest).render(out)
    }

    fn period(&self) -> [Option<f64>; 2] {
        let periods = self.noise.periods();
        [periods[0], periods[1]].map(|cells| cells.map(f64::from))
    }
}
