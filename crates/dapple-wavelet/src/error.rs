//! Errors of spline filters and wavelet noise.

use dapple_raster::RasterError;

dapple_raster::error! {
    /// An error of a filter or of a noise.
    WaveletError,
    /// The cause of a [`WaveletError`], with the limit and the value.
    WaveletErrorKind with Range {
        /// The length of a periodic side is not divisible by 2 as often as it is to be halved.
        NotDivisible {
            /// The length of the side.
            length: usize,
            /// The number of times it was to be halved.
            levels: u32,
        } => "a periodic side of {length} cannot be halved {levels} times; its length must be a multiple of 2^{levels}";
        /// A side is too short.
        TooShort {
            /// The length of the side.
            length: usize,
            /// The shortest allowed length.
            least: usize,
        } => "a side of {length} is too short; it must have at least {least}";
        /// The number of values is not the one needed.
        Length {
            /// The number of values.
            length: usize,
            /// The number of values needed.
            needed: usize,
        } => "there are {length} values, but {needed} are needed";
        /// A value is NaN or infinite.
        NotFinite {
            /// Its index, counted along rows from the first.
            index: usize,
            /// The value.
            value: f64,
        } => "value {index} is {value}, but all must be finite";
    }
    from {
        /// An error of the raster.
        Raster(RasterError),
    }
}
