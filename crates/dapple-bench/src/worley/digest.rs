//! What two processes compare of their rasters, in the program `worley_raster` and in this one.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// A hash of the bits of all values.
pub(crate) fn digest(values: &[f32]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for value in values {
        value.to_bits().hash(&mut hasher);
    }
    hasher.finish()
}
