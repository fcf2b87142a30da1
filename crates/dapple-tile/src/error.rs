//! Why an image, a method or a blend was refused.

use dapple_color::ColorError;
use dapple_raster::RasterError;
use dapple_wavelet::WaveletError;

dapple_raster::error! {
    /// Why a tile could not be made.
    TileError,
    /// The limit that was broken.
    TileErrorKind with Range {
        /// A side is too short for what was asked.
        TooSmall {
            /// The length of the side, in pixels.
            length: u32,
            /// The shortest that is allowed.
            least: u32,
        } => "a side of {length} pixels is too short; it must have at least {least}";
        /// A margin, or the width of what changes along the borders, leaves too little of the image.
        Margin {
            /// The margin or the width that was asked for, in pixels.
            margin: u32,
            /// The length of the side, in pixels.
            length: u32,
            /// The largest margin that is allowed.
            most: u32,
        } => "a margin of {margin} pixels is too wide for a side of {length}; at most {most} are possible";
        /// There is nothing to work on, or there are more or fewer things than needed.
        Count {
            /// The name of what is counted.
            what: &'static str,
            /// How many there are.
            count: usize,
            /// How many were needed, as text.
            needed: &'static str,
        } => "there are {count} {what}, but {needed} are needed";
        /// Maps that belong together are of different kinds.
        KindMismatch {
            /// The index of the map.
            map: usize,
        } => "map {map} is of another kind than the one it belongs to";
        /// A pixel is NaN or infinite.
        NotFinite {
            /// Its column.
            column: u32,
            /// Its row.
            row: u32,
            /// Its value.
            value: f32,
        } => "the pixel in column {column} and row {row} is {value}, but all must be finite";
    }
    from {
        /// The wavelet filter refused the size: odd, or not divisible by 2^levels.
        Wavelet(WaveletError),
        /// The raster was refused, or two sizes differ.
        Raster(RasterError),
        /// The color crate refused its input.
        Color(ColorError),
    }
}
