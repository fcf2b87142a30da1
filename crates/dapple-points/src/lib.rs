//! Point sets for scattering and sampling: maximal Poisson disk (blue noise), variable density, nested levels, and
//! endless sets for worlds in chunks. Opposite sides of a domain may be joined, so that points tile seamlessly.
//!
//! ```
//! use dapple_points::{Domain, EndlessPoissonDisk, glam::DVec2, hash::Seed, poisson_disk};
//!
//! // A unit square whose opposite sides are joined: points at least 0.05 apart, with no room for a further one.
//! let points = poisson_disk(Domain::torus(DVec2::ZERO, DVec2::ONE), 0.05, Seed(7))?;
//! for position in points.positions() {
//!     println!("{} {}", position.x, position.y);
//! }
//! assert!(points.minimum_distance().is_some_and(|distance| distance >= 0.05));
//!
//! // Trees at least 3 apart in one chunk of an endless world. Chunks agree at their borders.
//! for tree in EndlessPoissonDisk::new(3.0, Seed(7))?.points([64.0, -128.0], [128.0, -64.0])? {
//!     // 64 random bits that belong to this tree, in whatever chunk it is found.
//!     println!("{} {}", tree.position, 5.0 + 3.0 * (tree.id >> 40) as f64 / (1 << 24) as f64);
//! }
//! # Ok::<(), dapple_points::PointsError>(())
//! ```
//!
//! # Ways to make points
//!
//! | points | function | cost |
//! |---|---|---|
//! | maximal Poisson disk of a radius | [`poisson_disk`] | 392 ns/point for a million points |
//! | the same for many seeds | [`PoissonDisk`] | |
//! | about a given number | [`poisson_disk_about`] | as `poisson_disk` |
//! | around points of yours | [`extend_poisson_disk`] | |
//! | with a radius that varies | [`variable_poisson_disk`] | 2.8 times a fixed radius |
//! | in levels that contain each other | [`nested_poisson_disk`] | |
//! | of any window of the endless plane | [`EndlessPoissonDisk`] | four to five times a maximal set; nothing is stored |
//! | the same with a radius that varies | [`EndlessVariablePoissonDisk`] | up to five times a fixed radius of the lower bound |
//! | one in each cell of a grid | [`jittered_grid`] | |
//! | independent, uniform | [`white_noise`] | |
//!
//! Times are from one thread of a server processor (AMD EPYC). Functions named `…_cancellable` take a callback that
//! can cancel them.
//!
//! To measure a [`PointSet`]: [`PointSet::minimum_distance`], [`PointSet::largest_empty_circle`] and [`spectrum`]. For
//! triangles and Voronoi cells, use `dapple-graph`.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `poisson-disk` | on | makes all Poisson-disk sets; without it `fearless_simd` is not a dependency |
//! | `rayon` | on | makes points on all cores; the bits do not change |
//! | `serde` | off | reads and writes options and point sets as data; reading checks them |
//!
//! # Limits
//!
//! * Points are in the plane. Positions are `f64` in the units of the caller.
//! * A Poisson-disk set, or a window of an endless one, has at most about 2^26 points. Grids and uniform sets have at
//!   most 2^31.
//! * A joined side of a domain must be at least two radii long.
//! * An endless set has 0.92 of the density of a maximal set. Windows may be up to 2^39 radii from the origin.
//! * The radius of an endless variable set varies by a factor of at most 16.
//! * A set depends only on its options and its seed. It has the same bits on every machine and with any number of
//!   threads.
//!
//! # Without std
//!
//! Not possible today. `floor` and `sqrt` of `f64` are methods of std, `fearless_simd` detects the SIMD level with std,
//! and `dapple-raster` has threads and locks of std.

#![forbid(unsafe_code)]

mod cancel;
#[cfg(feature = "poisson-disk")]
mod disk;
mod domain;
#[cfg(feature = "poisson-disk")]
mod endless;
mod error;
#[cfg(feature = "poisson-disk")]
mod nested;
mod set;
mod statistics;
mod uniform;
#[cfg(feature = "poisson-disk")]
mod variable;

pub use cancel::{Cancel, IsCancelled};
pub use dapple_hash as hash;
pub use dapple_raster as raster;
#[cfg(feature = "poisson-disk")]
#[doc(alias("blue noise", "poisson disc", "poisson disk", "poisson sampling"))]
pub use disk::poisson_disk;
#[cfg(feature = "poisson-disk")]
pub use disk::{
    MAX_POISSON_DISK_POINTS, PoissonDisk, extend_poisson_disk, extend_poisson_disk_cancellable,
    poisson_disk_about, poisson_disk_cancellable, poisson_disk_radius,
};
pub use domain::Domain;
#[cfg(feature = "poisson-disk")]
#[doc(alias("chunk", "infinite", "scatter", "tile"))]
pub use endless::EndlessPoissonDisk;
#[cfg(feature = "poisson-disk")]
pub use endless::{EndlessPoint, EndlessVariablePoissonDisk};
pub use error::{PointsError, PointsErrorKind};
pub use glam;
#[cfg(feature = "poisson-disk")]
pub use nested::{NestedPointSet, nested_poisson_disk, nested_poisson_disk_cancellable};
pub use set::{PointIdx, PointSet};
pub use statistics::{
    EmptyCircle, Spectrum, SpectrumOptions, SpectrumRing, spectrum, spectrum_cancellable,
};
pub use uniform::{jittered_grid, white_noise};
#[cfg(feature = "poisson-disk")]
pub use variable::{
    DiskRule, RSA_DENSITY, VariablePoissonOptions, gentle_radius_for_count, radius_for_count,
    radius_from_density, variable_poisson_disk, variable_poisson_disk_cancellable,
};
