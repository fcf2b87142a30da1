//! Gradient noise: smooth noise with features of one size, in two to four dimensions.
//!
//! [`GradientNoise`] is Perlin's improved noise, which most programs mean by "Perlin noise". It repeats exactly with a
//! period, is the same on every machine, and draws windows at a fraction of a nanosecond per pixel. It is a
//! [`Field`](dapple_raster::Field), so that all of [`FieldExt`](dapple_raster::FieldExt) composes it.
//!
//! ```
//! use dapple_noise::{GradientNoise2, hash::Seed, raster::{Field, FractalShape}};
//!
//! // Eight features along each side of a tile, with five octaves.
//! let noise = GradientNoise2::new(Seed(7)).with_period([Some(8), Some(8)])?;
//! let tile = noise.fractal(5, 0.5, 2.0, FractalShape::Sum)?.tile_raster([256, 256])?;
//! assert_eq!(tile.size(), [256, 256]);
//! # Ok::<(), dapple_noise::raster::RasterError>(())
//! ```

#![forbid(unsafe_code)]
#![expect(
    clippy::needless_range_loop,
    reason = "ranges are unrolled, and closures of iterators are not inlined into SIMD code"
)]

mod gradient;
mod gradients;
mod lines;
#[cfg(feature = "simd")]
mod many;

pub use dapple_hash as hash;
pub use dapple_raster as raster;
#[doc(alias("perlin", "perlin noise", "simplex", "fbm", "ridged", "turbulence"))]
pub use gradient::GradientNoise;
pub use gradient::{GradientNoise2, GradientNoise3, GradientNoise4};
