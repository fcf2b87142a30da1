//! Point sets on domains that wrap per axis: maximal Poisson disk, variable density, nested; and their statistics.
//!
//! A [`Domain`] is a rectangle whose left and right, and top and bottom, may be joined. A [`PointSet`] is a list of
//! positions in a domain; all functions that make points of a domain return one, and all that use points take one.
//! [`EndlessPoissonDisk`] has no domain: it makes the points of any window of the plane.
//!
//! Positions are `f64` in the units of the caller. Every set is a function of its options and its seed, the same on
//! every machine and for any number of threads.

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
