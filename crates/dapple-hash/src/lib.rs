//! Seeds, counter-based lattice hashes, random streams and Poisson counts, for anything procedural that must be the same
//! on every machine.
//!
//! All randomness starts from a [`Seed`] that the caller passes. A hash turns a seed, a cell of the integer lattice
//! and a counter into random bits without any state, so a cell has the same bits regardless of the order in which
//! cells are visited.
//!
//! ```
//! use dapple_hash::{PoissonCounts, Seed, hash2, rand_core::Rng, unit_f64};
//!
//! // Each use of randomness has its own seed, named after the use. Two uses never share bits.
//! let world = Seed(7);
//! let jitter = world.child("jitter", 0);
//!
//! // A position in cell (3, -5), at most one cell from its corner: counters 0 and 1 are the two axes.
//! let position = [0, 1].map(|axis| unit_f64(hash2(jitter, [3, -5], axis)));
//! assert!(position.iter().all(|x| (0.0..1.0).contains(x)));
//!
//! // The number of trees in the same cell: 2 on average, at most 6.
//! let counts = PoissonCounts::new(2.0, 0..=6)?;
//! let n_trees = counts.count((hash2(world.child("trees", 0), [3, -5], 0) >> 32) as u32);
//! assert!(n_trees <= 6);
//!
//! // A sequential generator, for shuffles and the like.
//! let mut stream = world.child("shuffle", 0).stream();
//! let card = stream.next_u32() % 52;
//! # assert!(card < 52);
//! # Ok::<(), dapple_hash::PoissonError>(())
//! ```
//!
//! # Ways to draw numbers
//!
//! | to draw | use | cost |
//! |---|---|---|
//! | 64 bits for a cell and a counter | [`hash1`], [`hash2`], [`hash3`], [`hash4`] | one hash of seed, cell and counter |
//! | several numbers for one cell | [`CellHash::at`] | seed and cell are absorbed once |
//! | cells along a row | [`CellHash::axis`] | the slower axes are absorbed once per row |
//! | 32 bits for a corner of a lattice | [`LatticeHash`] | less than a `CellHash`: each coordinate is hashed once for all corners |
//! | sixteen cells at once | `CellHashes` (feature `simd`) | SIMD lanes |
//! | a sequence | [`Seed::stream`], [`CellHash::stream`] | a [`Pcg32`] generator, started by two hashes |
//! | a number from 0 to 1 | [`unit_f32`], [`unit_f64`] of random bits | |
//! | a count with a Poisson distribution | [`PoissonCounts`], or [`poisson_count`] for a mean that is used once | a table, or one exponential per call |
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `serde` | off | reads and writes a [`Seed`] as a plain number |
//! | `simd` | off | adds `CellHashes` and lattice hashes of sixteen lanes, with `fearless_simd` |
//!
//! # Limits
//!
//! * The hashes are not cryptographic.
//! * Coordinates are `i64`. No period is built in: wrap coordinates before hashing to repeat.
//! * The mean of a Poisson count is above 0 and at most 64. Other means give a [`PoissonError`].
//! * Hashes and streams use integers only. Poisson tables use `f64` and `libm`. All results have the same bits on every
//!   platform.
//!
//! # Without std
//!
//! The crate is `no_std` and needs `alloc` for the tables of [`PoissonCounts`]. Both features link std through their
//! dependencies.

#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

extern crate alloc;

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
