//! Errors from spline filters and wavelet noise.

use dapple_raster::RasterError;

/// Callback that returns whether the caller no longer needs the result. It may be called from any thread.
pub type IsCancelled<'a> = dyn Fn() -> bool + Sync + 'a;

/// Returns an error if the caller's callback cancels.
pub(crate) fn check(is_cancelled: &IsCancelled) -> Result<(), WaveletError> {
    match is_cancelled() {
        true => Err(cancelled()),
        false => Ok(()),
    }
}

/// Creates the error for work that the caller's callback canceled.
pub(crate) fn cancelled() -> WaveletError {
    WaveletError::new(WaveletErrorKind::Cancelled)
}

dapple_raster::error! {
    /// An error from a filter or from wavelet noise.
    WaveletError,
    /// Cause of a [`WaveletError`], with the limit and the value.
    WaveletErrorKind with Range {
        /// The length of a periodic side is not divisible by the required power of two.
        NotDivisible {
            /// Length of the side.
            length: usize,
            /// Number of times the side is halved.
            levels: u32,
        } => "a periodic side of {length} cannot be halved {levels} times; its length must be a multiple of 2^{levels}";
        /// A side is too short to be filtered.
        TooShort {
            /// Length of the side.
            length: usize,
            /// Minimum length.
            least: usize,
        } => "a side of {length} is too short; it must have at least {least}";
        /// The number of values is wrong.
        Length {
            /// Number of values.
            length: usize,
            /// Required number of values.
            needed: usize,
        } => "there are {length} values, but {needed} are needed";
        /// A value is NaN or infinite.
        NotFinite {
            /// Index of the value, row by row.
            index: usize,
            /// The value.
            value: f64,
        } => "value {index} is {value}, but all must be finite";
        /// Cancelled by the caller's callback.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// An error from creating or checking a raster.
        Raster(RasterError),
    }
}
