//! Errors of tiles, reports and blends.

use dapple_color::ColorError;
use dapple_raster::RasterError;
use dapple_wavelet::WaveletError;

/// A callback that returns whether the caller no longer needs the result. It is called on any thread.
pub type IsCancelled<'a> = dyn Fn() -> bool + Sync + 'a;

/// Fails if the caller asked to stop.
pub(crate) fn check(is_cancelled: &IsCancelled) -> Result<(), TileError> {
    match is_cancelled() {
        true => Err(TileError::new(TileErrorKind::Cancelled)),
        false => Ok(()),
    }
}

dapple_raster::error! {
    /// An error of making a tile, a report or a blend.
    TileError,
    /// The cause of a [`TileError`], with the limit and the value.
    TileErrorKind with Range {
        /// A side is too short for the operation.
        TooSmall {
            /// The length of the side, in pixels.
            length: u32,
            /// The shortest allowed length.
            least: u32,
        } => "a side of {length} pixels is too short; it must have at least {least}";
        /// A margin, or the width of the changed borders, leaves too little of the image.
        Margin {
            /// The margin or the width, in pixels.
            margin: u32,
            /// The length of the side, in pixels.
            length: u32,
            /// The largest allowed margin.
            most: u32,
        } => "a margin of {margin} pixels is too wide for a side of {length}; at most {most} are possible";
        /// The number of items is zero, or not the number needed.
        Count {
            /// The name of the items.
            what: &'static str,
            /// The number of items.
            count: usize,
            /// The number needed, as text.
            needed: &'static str,
        } => "there are {count} {what}, but {needed} are needed";
        /// Maps that belong together are of different kinds.
        KindMismatch {
            /// The index of the map.
            map: usize,
        } => "map {map} is of another kind than the one it belongs to";
        /// A pixel is NaN or infinite.
        NotFinite {
            /// The column of the pixel.
            column: u32,
            /// The row of the pixel.
            row: u32,
            /// The value of the pixel.
            value: f32,
        } => "the pixel in column {column} and row {row} is {value}, but all must be finite";
        /// The callback of the caller asked to stop.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// An error of the wavelet filter: an odd size, or one not divisible by 2^levels.
        Wavelet(WaveletError),
        /// An error of the raster, or two sizes differ.
        Raster(RasterError),
        /// An error of the color crate.
        Color(ColorError),
    }
}
