//! Spline wavelets on rasters: exact down- and upsampling, periodic or mirrored, and wavelet noise.
//!
//! Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", turn a tile into one that
//! repeats better by halving it and doubling it again. The filters are those of Robert L. Cook and Tony DeRose,
//! "Wavelet Noise", ACM Transactions on Graphics 24(3) (SIGGRAPH 2005), <https://doi.org/10.1145/1073204.1073264>.
//!
//! A [`SplineFilter`] reads pixels as the coefficients of a B-spline. It finds the nearest spline with half as many
//! coefficients ([`down`](SplineFilter::down)), and writes a spline exactly with twice as many
//! ([`up`](SplineFilter::up)). Both in turn are a projection ([`project`](SplineFilter::project)), which keeps the
//! detail that a half-size picture can show, and removes all other detail.
//!
//! ```
//! use dapple_wavelet::{Border, SplineFilter, raster::Raster};
//!
//! let picture = Raster::from_fn([64, 48], |x, y| (x * y % 7) as f32)?;
//! let filter = SplineFilter::default();
//! let periodic = [Border::Periodic; 2];
//!
//! let half = filter.down(&picture, periodic)?;
//! assert_eq!(half.size(), [32, 24]);
//! let smooth = filter.up(&half, [64, 48], periodic)?;
//!
//! // The details that are lost, and how to get the picture back.
//! let bands = filter.analyze(&picture, 1, periodic)?;
//! let again = filter.synthesize(&bands, periodic)?;
//! # let gap = |a: &Raster<f32>, b: &Raster<f32>| a.pixels().iter().zip(b.pixels()).fold(0.0, |m: f32, (a, b)| m.max((a - b).abs()));
//! # assert!(gap(&again, &picture) < 1e-5 && gap(&smooth, &picture) > 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Lines are `f64`. Rasters and volumes are `f32`, filtered in `f64` and rounded after each axis. All results have the same
//! bits on every platform and on any number of threads.
//!
//! # The paper's equations
//!
//! | equation | what it says | here |
//! |---|---|---|
//! | 1 | a function is a weighted sum of shifted splines | [`SplineFilter::value_line`] |
//! | 2, 3 | the spaces of such functions, coarse and fine | [`Degree::value`], its shifts, and those of half the width |
//! | 4 | a spline is a sum of splines of half the width | the weights `2^-d C(d + 1, k)` of [`Degree`] d, placed by [`Phase`] |
//! | 5, 6 | a coarse function is a fine one | [`SplineFilter::up_line`] |
//! | 7 | the coarse function nearest to a fine one | [`SplineFilter::down_line`] |
//! | 8, 13 | 6 along both axes | [`SplineFilter::up`] |
//! | 9, 12 | 7 along both axes | [`SplineFilter::down`] |
//! | 10, 11 | a raster and its half-size raster as functions | 1 along both axes |
//! | 12 and 13 | the blend tile | [`SplineFilter::project`] |
//!
//! The versions for volumes are [`SplineFilter::down_volume`], [`SplineFilter::up_volume`] and
//! [`SplineFilter::project_volume`].
//!
//! # What the paper leaves open
//!
//! * The filter of equation 7 has no end. Cook and DeRose cut it off after 32 taps, with an rms error of 1.2e-3 on white noise
//!   of variance 1; here it is exact, as a recursion, in linear time.
//! * Its indices wrap ([`Border::Periodic`]). The whole effect on the seam of a tile comes from that; [`Border::Mirror`] is
//!   for pictures that do not repeat.
//! * Where the coarse coefficients lie is [`Phase`], which spline is [`Degree`], and what nearest means is [`Fit`].
//! * Pixels are coefficients and not values of the function, as in the paper; [`SplineFilter::coefficients`] and
//!   [`SplineFilter::samples`] are the way from one to the other.
//!
//! # Wavelet noise
//!
//! The detail that white noise loses by halving is noise of one octave. [`WaveletNoise2`] and [`WaveletNoise3`]
//! evaluate this noise at any position, in one band or several, with its gradient and with a period. [`wavelet_tile`]
//! sums bands of it, each made at its own size, to a raster that repeats without a seam.
//!
//! ```
//! use dapple_wavelet::{WaveletNoise2, hash::Seed, raster::Field, raster::Window, raster::glam::DVec2};
//!
//! let noise = WaveletNoise2::new(64, Seed(7))?;
//! let window = Window::new(DVec2::ZERO, DVec2::splat(64.0), [256, 256])?;
//! let raster = noise.to_raster(&window)?;
//! assert!(raster.pixels().iter().all(|value| value.abs() <= noise.bound()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

mod error;
mod spline;

mod line;
mod plane;
mod samples;
mod volume;

mod bands;

mod doubling;
mod ends;
mod kernel;
mod pass;
mod recursion;

#[cfg(test)]
mod equations;
#[cfg(test)]
mod oracle;

mod noise;
mod noise_tile;

pub use bands::Bands;
pub use error::{WaveletError, WaveletErrorKind};
#[doc(alias("band-limited noise", "simplex"))]
pub use noise::WaveletNoise;
pub use noise::{WaveletNoise2, WaveletNoise3};
pub use noise_tile::wavelet_tile;
pub use plane::FilterMemory;
pub use spline::{Border, Degree, Fit, Phase, SplineFilter};

pub use dapple_hash as hash;
pub use dapple_raster as raster;
