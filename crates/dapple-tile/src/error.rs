//! Errors of tiles, reports and blends.

use core::sync::atomic::{AtomicBool, Ordering::Relaxed};
use dapple_color::ColorError;
use dapple_raster::{Raster, RasterError, parallel};
use dapple_wavelet::{WaveletError, WaveletErrorKind};

/// Callback that returns whether the caller no longer needs the result. It may be called from any thread.
pub type IsCancelled<'a> = dyn Fn() -> bool + Sync + 'a;

/// Creates the error for work that the caller's callback canceled.
fn cancelled() -> TileError {
    TileError::new(TileErrorKind::Cancelled)
}

/// Returns an error if the caller's callback cancels.
pub(crate) fn check(is_cancelled: &IsCancelled) -> Result<(), TileError> {
    match is_cancelled() {
        true => Err(cancelled()),
        false => Ok(()),
    }
}

/// Converts the result of a wavelet filter; a canceled filter gives [`TileErrorKind::Cancelled`].
pub(crate) fn filtered<T>(made: Result<T, WaveletError>) -> Result<T, TileError> {
    made.map_err(|error| match error.kind() {
        WaveletErrorKind::Cancelled => cancelled(),
        _ => error.into(),
    })
}

/// Creates a raster from rows, unless the caller's callback, which is called once per 65,536 pixels, cancels.
pub(crate) fn rows_cancellable<T: Send, I: IntoIterator<Item = T>>(
    size: [u32; 2],
    is_cancelled: &IsCancelled,
    row: impl Fn(u32) -> I + Sync,
) -> Result<Raster<T>, TileError> {
    Raster::from_rows_cancellable(size, is_cancelled, row)?.ok_or_else(cancelled)
}

/// Collects the results of `make` for the numbers below `count`, in order, unless the caller's callback, which is called
/// before each of them, cancels.
pub(crate) fn map_cancellable<T: Send>(
    count: usize,
    is_cancelled: &IsCancelled,
    make: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, TileError> {
    let is_over = AtomicBool::new(false);
    let made = parallel::map(count, |index| {
        if !is_over.load(Relaxed) && is_cancelled() {
            is_over.store(true, Relaxed);
        }
        (!is_over.load(Relaxed)).then(|| make(index))
    });
    made.into_iter()
        .collect::<Option<_>>()
        .ok_or_else(cancelled)
}

dapple_raster::error! {
    /// An error in computing a tile, a report or a blend.
    TileError,
    /// The cause of a [`TileError`], with the limit and the value.
    TileErrorKind with Range {
        /// A side is too short for the operation.
        TooSmall {
            /// Length of the side, in pixels.
            length: u32,
            /// Minimum length.
            least: u32,
        } => "a side of {length} pixels is too short; it must have at least {least}";
        /// A margin, or the width of the changed borders, is too large for the image.
        Margin {
            /// Margin or width given, in pixels.
            margin: u32,
            /// Length of the side, in pixels.
            length: u32,
            /// Maximum margin.
            most: u32,
        } => "a margin of {margin} pixels is too wide for a side of {length}; at most {most} are possible";
        /// The number of items is zero, or not the number needed.
        Count {
            /// Kind of the items.
            what: &'static str,
            /// Number of items given.
            count: usize,
            /// Required number, as text.
            needed: &'static str,
        } => "there are {count} {what}, but {needed} are needed";
        /// Corresponding maps are of different kinds.
        KindMismatch {
            /// Index of the map.
            map: usize,
        } => "map {map} is of another kind than the one it belongs to";
        /// A pixel is NaN or infinite.
        NotFinite {
            /// Column of the pixel.
            column: u32,
            /// Row of the pixel.
            row: u32,
            /// Value of the pixel.
            value: f32,
        } => "the pixel in column {column} and row {row} is {value}, but all must be finite";
        /// A corner of a quadrilateral is outside of the image.
        CornerOutside {
            /// Number of the corner, from 1.
            corner: u32,
            /// Position in pixels, x first.
            position: [f64; 2],
            /// Size of the image in pixels.
            size: [u32; 2],
        } =>
            "corner {corner} at ({}, {}) is outside of the image of {} × {} pixels",
            position[0], position[1], size[0], size[1];
        /// The corners of a quadrilateral are not in clockwise order around a convex shape.
        NotConvex {
            /// Number of the corner where the shape is not convex, from 1.
            corner: u32,
            /// Cross product of the sides at the corner, in square pixels; positive for a clockwise turn.
            turn: f64,
        } =>
            "the corners must go clockwise around a convex quadrilateral, but the cross product of the sides at corner \
             {corner} is {turn}; at least 1 is needed";
        /// Normals were given to an operation that changes the perspective.
        NormalsInPerspective =>
            "normals cannot be rectified, since their slopes depend on the view; rectify the heights, and compute normals \
             from them";
        /// Cancelled by the caller's callback.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// The wavelet filter failed, because a size is odd or not divisible by 2^levels.
        Wavelet(WaveletError),
        /// A raster is invalid, or sizes differ.
        Raster(RasterError),
        /// An error from `dapple-color`.
        Color(ColorError),
    }
}
