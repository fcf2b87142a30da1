//! How alike two textures are, as numbers: the sliced Wasserstein distance of their colors and of their patches.
//!
//! Reference: Julien Rabin, Gabriel Peyré, Julie Delon and Marc Bernot, "Wasserstein Barycenter and Its Application to
//! Texture Mixing", SSVM 2011, DOI 10.1007/978-3-642-24785-9_37.
//!
//! Both sets of points are projected on 64 directions, the same ones for everyone. Along a line the distance of two sets
//! is the area between their sorted values (W1): what one set must be moved on the average to become the other. The
//! result is the mean over the directions, in the units of the values. Sets of different sizes are compared by their
//! quantiles.

use crate::error::{SynthError, SynthErrorKind};
use dapple_hash::{Seed, hash1, unit_f64};
use dapple_raster::Raster;

/// The number of directions.
const N_DIRECTIONS: usize = 64;

/// The side of a patch in pixels.
const PATCH: usize = 5;

/// How far the colors of two images are from each other, and their 5 × 5 patches.
///
/// In units of the values, root mean square per number: two images that differ by one constant in all channels have at
/// most that constant as either distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Likeness {
    /// The distance between the sets of colors: whether as much is there of each.
    pub colors: f64,
    /// The distance between the sets of patches: whether it is arranged in the same way.
    pub patches: f64,
}
