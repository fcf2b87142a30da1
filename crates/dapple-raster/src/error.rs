//! Errors from rasters, windows and fields.

crate::error! {
    /// An error from an operation on rasters, windows or fields.
    RasterError,
    /// Cause of a [`RasterError`], with the limit and the value.
    RasterErrorKind with Range {
        /// A width or a height is zero.
        Empty {
            /// Size in pixels.
            size: [u32; 2],
        } => "a raster of {} × {} pixels is empty", size[0], size[1];
        /// The number of pixels exceeds the address space or the limit of 2^31.
        TooLarge {
            /// Size in pixels.
            size: [u32; 2],
        } => "a raster of {} × {} pixels is larger than the limit of 2^31 pixels", size[0], size[1];
        /// The number of values does not match the number of pixels.
        Length {
            /// Number of values.
            length: usize,
            /// Required number of values.
            needed: usize,
        } => "there are {length} values, but {needed} are needed";
        /// Two sizes that must be equal differ.
        SizeMismatch {
            /// Actual size in pixels.
            size: [u32; 2],
            /// Required size in pixels.
            needed: [u32; 2],
        } => "the raster has {} × {} pixels, but {} × {} are needed", size[0], size[1], needed[0], needed[1];
        /// A rectangle extends beyond the raster.
        OutOfBounds {
            /// First column and row of the rectangle.
            first: [u32; 2],
            /// Size of the rectangle in pixels.
            size: [u32; 2],
            /// Size of the raster in pixels.
            bounds: [u32; 2],
        } =>
            "the rectangle of {} × {} pixels at ({}, {}) leaves the raster of {} × {}",
            size[0], size[1], first[0], first[1], bounds[0], bounds[1];
        /// A field's tile was requested, but the field does not repeat along both axes.
        NoPeriod => "the field does not repeat along both axes, so that there is no tile of it";
        /// A number is not finite, or the size of a pixel is zero.
        NotFinite {
            /// Name of the invalid number, as in the message.
            what: &'static str,
            /// The invalid number.
            value: f64,
        } => "the {what} is {value}, but it must be finite and a pixel's size must not be zero";
    }
}

impl RasterError {
    /// Checks that a buffer's `length` equals the `needed` length. Intended for implementations of
    /// [`Field`](crate::Field).
    ///
    /// # Errors
    ///
    /// [`Length`](RasterErrorKind::Length) if the numbers differ.
    pub fn check_length(length: usize, needed: usize) -> Result<(), Self> {
        if length == needed {
            return Ok(());
        }
        Err(Self::new(RasterErrorKind::Length { length, needed }))
    }

    /// Checks that a number is in its range; `holds` is the result of the comparison. Intended for implementations of
    /// [`Field`](crate::Field).
    ///
    /// # Errors
    ///
    /// [`Range`](RasterErrorKind::Range) if `holds` is false.
    pub fn check_range(
        holds: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        Self::check(holds, what, value, range)
    }
}
