//! Renders fractal Perlin noise as tiles whose opposite borders do not match.
//!
//! The noise comes from the crate `noise-functions`: Ken Perlin's improved gradient noise ("Improving Noise",
//! SIGGRAPH 2002) with another set of gradients. In 2-D it uses only arithmetic, so its bits are the same on every
//! machine, and it is maintained; the crate `noise` calls a power function of the standard library.

use dapple_points::hash::Seed;
use dapple_raster::{Raster, RasterError, Window};
use glam::DVec2;
use noise_functions::{Noise as _, Perlin, Sample as _};

/// Corner of a tile in the plane, in cells. It is not on the lattice, since Perlin noise is 0 at lattice points.
const ORIGIN: DVec2 = DVec2::new(11.37, 5.71);

/// Renders a tile of Perlin noise from 0 to 1, `size` pixels wide, with `cells` lattice cells of the first octave
/// across.
///
/// Each octave has twice the frequency and half the amplitude of the previous one. The sum, from −1 to 1, is
/// converted to `0.5 + 0.8 · sum` and clamped; it rarely exceeds ±0.6.
pub(super) fn perlin(
    size: u32,
    cells: f64,
    octaves: u32,
    seed: Seed,
) -> Result<Raster<f32>, RasterError> {
    let noise = Perlin.fbm(octaves, 0.5, 2.0);
    let window = Window::new(ORIGIN, DVec2::splat(cells), [size; 2])?;
    let seed = (seed.child("perlin", 0).0 >> 32) as i32;
    Raster::from_window(&window, |at| {
        let sum = noise.sample_with_seed([at.x as f32, at.y as f32], seed);
        (0.5 + 0.8 * sum).clamp(0.0, 1.0)
    })
}
