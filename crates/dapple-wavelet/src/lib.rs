//! Spline wavelets on rasters: exact down- and upsampling, periodic or mirrored, and wavelet noise.
//!
//! A [`SplineFilter`] reads samples as the coefficients of a B-spline and finds the nearest spline with half as many
//! coefficients ([`down_line`](SplineFilter::down_line)), and writes a spline exactly with twice as many
//! ([`up_line`](SplineFilter::up_line)).

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
pub use spline::{Border, Degree, Fit, Phase, SplineFilter};

pub use dapple_hash as hash;
pub use dapple_raster as raster;
