//! The choice of the SIMD level, and tests of all levels.
//!
//! For crates that fill rasters with vector instructions: every level gives the same bits. Without the feature `simd`
//! there is one level, for which code is compiled as everything else is.

#[cfg(feature = "simd")]
mod levels;
#[cfg(not(feature = "simd"))]
mod one_level;

#[cfg(feature = "simd")]
pub use levels::{Level, baseline, dispatch, fearless_simd, for_every_level, level};
#[cfg(not(feature = "simd"))]
pub use one_level::{Level, dispatch, for_every_level, level};
