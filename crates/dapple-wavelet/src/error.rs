//! Why a line, a raster or a tile was refused.

use dapple_raster::RasterError;

dapple_raster::error! {
    /// Why a filter refused its input.
    WaveletError,
    /// The limit that was broken.
    WaveletErrorKind with Range {
        /// A periodic side that cannot be halved so often.
        NotDivisible {
            /// The length of the side.
            length: usize,
            /// How often it was to be halved.
            levels: u32,
        } => "a periodic side of {length} cannot be halved {levels} times; its length must be a multiple of 2^{levels}";
        /// A side is too short.
        TooShort {
            /// The length of the side.
            length: usize,
            /// The shortest that is allowed.
            least: usize,
        } => "a side of {length} is too short; it must have at least {least}";
        /// The number of values is not the one needed.
        Length {
            /// How many values there are.
            length: usize,
            /// How many were needed.
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
        /// The raster was refused.
        Raster(RasterError),
    }
}
