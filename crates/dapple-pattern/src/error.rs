//! Errors of patterns.

use dapple_raster::RasterError;

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
