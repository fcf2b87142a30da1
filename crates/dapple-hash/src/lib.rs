//! Seeds, counter-based lattice hashes, random streams and Poisson counts.
//!
//! All randomness in dapple begins with a [`Seed`] that the caller passes. There are two ways to draw numbers from it:
//!
//! * **by place**: [`hash2`] and its siblings turn a cell of the integer lattice and a counter into 64 bits, without
//!   any state, so that a cell gives the same bits whoever asks for it and in whatever order;
//! * **one after another**: [`Seed::stream`] and [`CellHash::stream`] start a [`Pcg32`], a small sequential generator.
//!
//! Two uses never share bits: give each its own [`Seed::child`], by a name and a number.
//!
//! ```
//! use dapple_hash::{Seed, hash2, unit_f64};
//!
//! let jitter = Seed(7).child("jitter", 0);
//! let x = unit_f64(hash2(jitter, [3, -5], 0));
//! assert!((0.0..1.0).contains(&x));
//! ```
//!
//! With the feature `simd`, `CellHashes` does sixteen cells at once.
//!
//! All arithmetic is on integers, in 32-bit lanes where it is hot, so the bits are the same on every platform and
//! the same code fits SIMD lanes and a GPU.

#![forbid(unsafe_code)]

mod cell;
#[cfg(feature = "simd")]
mod lanes;
mod lattice;
mod mix;
mod poisson;
mod seed;
mod stream;
mod unit;

pub use cell::{CellHash, hash1, hash2, hash3, hash4};
#[cfg(feature = "simd")]
pub use lanes::{CellHashes, lattice_bits, lattice_part_pairs, lattice_parts, mix32_pairs};
pub use lattice::LatticeHash;
pub use mix::mix32;
pub use poisson::{PoissonCounts, PoissonError, PoissonErrorKind, poisson_count};
pub use rand_core;
pub use rand_pcg::Pcg32;
pub use seed::Seed;
pub use unit::{unit_f32, unit_f64};
