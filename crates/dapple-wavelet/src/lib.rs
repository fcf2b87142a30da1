//! Spline wavelets on rasters: exact down- and upsampling, periodic or mirrored, and wavelet noise.
//!
//! A [`SplineFilter`] reads samples as the coefficients of a B-spline and finds the nearest spline with half as many
//! coefficients ([`down_line`](SplineFilter::down_line)), and writes a spline exactly with twice as many
//! ([`up_line`](SplineFilter::up_line)).
//!
//! What a halving loses is noise without low frequencies, if the samples were white. [`WaveletNoise2`] and
//! [`WaveletNoise3`] are that noise at any position, in one band or several; [`wavelet_tile`] sums bands of it, each made
//! at its own size, to a raster that repeats without a seam.
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
mod volume;

mod bands;

mod doubling;
mod ends;
mod kernel;
mod pass;
mod recursion;

#[cfg(test)]
mod oracle;

mod noise;
mod noise_tile;

pub use bands::Bands;
pub use error::{WaveletError, WaveletErrorKind};
pub use noise::{WaveletNoise, WaveletNoise2, WaveletNoise3};
pub use noise_tile::wavelet_tile;
pub use spline::{Border, Degree, Fit, Phase, SplineFilter};

pub use dapple_hash as hash;
pub use dapple_raster as raster;
