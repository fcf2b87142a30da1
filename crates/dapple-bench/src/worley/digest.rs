//! Hashes rasters, so that this program can compare its results with those of the program `worley_raster`.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// Returns a hash of the bits of all values.
pub(crate) fn digest(values: &[f32]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for value in values {
        value.to_bits().hash(&mut hasher);
    }
    hasher.finish()
}
