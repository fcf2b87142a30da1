//! Selects the SIMD level, and helps to test all levels.
//!
//! Intended for crates that render rasters with vector instructions. Every level gives the same bits. Without the
//! feature `simd` there is a single level, compiled like other code.

#[cfg(feature = "simd")]
mod levels;
#[cfg(not(feature = "simd"))]
mod one_level;

#[cfg(feature = "simd")]
pub use levels::{Level, baseline, dispatch, fearless_simd, for_every_level, level};
#[cfg(not(feature = "simd"))]
pub use one_level::{Level, dispatch, for_every_level, level};
