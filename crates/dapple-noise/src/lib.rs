//! Perlin's gradient noise in two to four dimensions for heights, caves, clouds and planets: exact periods, any
//! position, exact derivatives, and the same bits on every machine.
//!
//! [`GradientNoise`] is Perlin's improved noise (2002), which is what most programs call "Perlin noise". It is a
//! [`Field`](dapple_raster::Field), so that [`FieldExt`](dapple_raster::FieldExt) composes it.
//!
//! ```
//! use dapple_noise::GradientNoise2;
//! use dapple_noise::hash::Seed;
//! use dapple_noise::raster::{FractalShape, prelude::*};
//!
//! // A height with eight features along a side, in six octaves, that tiles exactly.
//! let noise = GradientNoise2::new(Seed(7)).with_period([Some(8), Some(8)])?;
//! let height = noise.fractal(6, 0.5, 2.0, FractalShape::Sum)?;
//! let tile = height.tile_raster([512, 512])?;
//! assert_eq!(tile.size(), [512, 512]);
//!
//! // Displaced by noise of other seeds, by up to half a cell.
//! let [x, y] = [1, 2].map(|seed| GradientNoise2::new(Seed(seed)));
//! let marble = noise.warp([x, y], 0.5).map(|value| 1.0 - value.abs());
//! assert!(marble.sample([0.3, 0.7]) <= 1.0);
//! # Ok::<(), dapple_noise::raster::RasterError>(())
//! ```
//!
//! # Ways to sample
//!
//! All ways give the same bits at the same position.
//!
//! | positions | call | cost of one octave |
//! |---|---|---|
//! | one | [`GradientNoise::sample`] | 20.5 ns in 2-D, 36.7 ns in 3-D |
//! | one, with exact derivatives | [`GradientNoise::sample_with_gradient`] | |
//! | many scattered | [`GradientNoise::sample_many`] | 5.5 ns in 2-D, 10.2 ns in 3-D, for each |
//! | a window | [`to_raster`](dapple_raster::Field::to_raster), [`render`](dapple_raster::Field::render) | 0.13 ns/pixel in 2-D with 64 pixels per cell, 0.37 with 8 |
//! | one period as a tile | [`tile_raster`](dapple_raster::Field::tile_raster) | as a window |
//! | a sphere, as an equirectangular image or a cube map | [`Equirectangular`], [`CubeMap`], then many positions | |
//! | a plane through space, or a moment of a loop | [`slice`](dapple_raster::FieldExt::slice), then a window | |
//!
//! Positions were timed on one thread of an AMD EPYC of family 25 without AVX-512, windows on one of family 26 with
//! AVX-512. A fractal sum ([`GradientNoise::fractal`]) costs one evaluation for each octave.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | fills windows on all cores; the bits do not change |
//! | `simd` | on | uses the widest vector instructions of the processor at hand; the bits do not change |
//! | `serde` | off | reads and writes noise as data |
//!
//! Without `simd`, `sample_many` is a loop of `sample`, and a clean build takes about half of the time.
//!
//! # Limits
//!
//! * One octave is 0 at all whole positions, for every seed. Sample between them, for example by multiplying block
//!   numbers by 0.1. The octaves of `fractal` have separate offsets, and are not 0 there.
//! * Values are within `BOUND`: 1 in 2-D, 1.0364 in 3-D and 1.5366 in 4-D. `VARIANCE` is the variance. Nothing is
//!   normalized.
//! * A fractal sum has 1 to 32 octaves, a gain from -1 to 1 and a lacunarity from 1 to 16. With a period, the
//!   lacunarity is a whole number.
//! * Periods are whole numbers of cells. Without a period the noise does not repeat.
//! * At a position that is not finite the value is NaN.
//! * Simplex noise and value noise are not included.
//! * The bits are the same on every platform, for every SIMD level and any number of threads.
//!
//! # Without std
//!
//! Not possible today, even without `rayon` and `simd`. `floor` of `f64` is a method of std, and `dapple-raster` has
//! locks of std.

#![forbid(unsafe_code)]
#![expect(
    clippy::needless_range_loop,
    reason = "ranges are unrolled, and closures of iterators are not inlined into SIMD code"
)]

mod directions;
mod gradient;
mod gradients;
mod lines;
#[cfg(feature = "simd")]
mod many;

pub use dapple_hash as hash;
pub use dapple_raster as raster;
pub use directions::{CubeFace, CubeMap, Equirectangular};
#[doc(alias("perlin", "perlin noise", "simplex", "fbm", "ridged", "turbulence"))]
pub use gradient::GradientNoise;
pub use gradient::{GradientNoise2, GradientNoise3, GradientNoise4};
