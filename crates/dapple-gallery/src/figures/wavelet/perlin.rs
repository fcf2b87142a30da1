//! Fractal Perlin noise as tiles whose opposite borders do not fit.
//!
//! The noise is that of the crate `noise-functions`: Ken Perlin's improved gradient noise ("Improving Noise", SIGGRAPH
//! 2002) with a set of gradients of its own. In the plane it needs nothing but arithmetic, so its bits are the same
//! everywhere, and it is maintained; the crate `noise` takes a power from the standard library.

use dapple_points::hash::Seed;
use dapple_raster::{Raster, RasterError, Window};
use glam::DVec2;
use noise_functions::{Noise as _, Perlin, Sample as _};

/// Where in the plane a tile begins, in cells: off the lattice, on whose corners Perlin noise is 0.
const ORIGIN: DVec2 = DVec2::new(11.37, 5.71);

/// A tile of Perlin noise from 0 to 1, `size` pixels wide, with `cells` lattice cells of the first octave across.
///
/// Each octave has twice the frequency of the one before and half its amplitude. The sum, from −1 to 1, becomes
/// `0.5 + 0.8 · sum`, clamped: it hardly ever goes past ±0.6.
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
