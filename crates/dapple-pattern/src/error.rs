//! Errors of patterns.

use dapple_raster::{Range, RasterError};

dapple_raster::error! {
    /// An error of a pattern or of rendering it.
    PatternError,
    /// The cause of a [`PatternError`], with the limit and the value.
    PatternErrorKind with Range {}
    from {
        /// The raster or the window is invalid.
        Raster(RasterError),
    }
}

impl PatternError {
    /// Returns an error if `value` is not in `range`.
    pub(crate) fn check_in(range: Range, what: &'static str, value: f64) -> Result<(), Self> {
        Self::check(range.holds(value), what, value, range.text)
    }
}
