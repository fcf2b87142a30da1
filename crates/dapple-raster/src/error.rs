//! Errors of rasters, windows and fields.

crate::error! {
    /// An error of an operation on rasters, windows or fields.
    RasterError,
    /// The cause of a [`RasterError`], with the limit and the value.
    RasterErrorKind with Range {
        /// A width or a height is zero.
        Empty {
            /// The size, in pixels.
            size: [u32; 2],
        } => "a raster of {} × {} pixels is empty", size[0], size[1];
        /// The pixels are more than the address space, or the limit of 2^31, allows.
        TooLarge {
            /// The size, in pixels.
            size: [u32; 2],
        } => "a raster of {} × {} pixels is larger than the limit of 2^31 pixels", size[0], size[1];
        /// The number of values is not that of the pixels.
        Length {
            /// The number of values.
            length: usize,
            /// The number of values needed.
            needed: usize,
        } => "there are {length} values, but {needed} are needed";
        /// Two sizes that must be equal are not.
        SizeMismatch {
            /// The size that was passed, in pixels.
            size: [u32; 2],
            /// The size that was needed, in pixels.
            needed: [u32; 2],
        } => "the raster has {} × {} pixels, but {} × {} are needed", size[0], size[1], needed[0], needed[1];
        /// A rectangle reaches past the raster.
        OutOfBounds {
            /// The first column and row of the rectangle.
            first: [u32; 2],
            /// The size of the rectangle, in pixels.
            size: [u32; 2],
            /// The size of the raster, in pixels.
            bounds: [u32; 2],
        } =>
            "the rectangle of {} × {} pixels at ({}, {}) leaves the raster of {} × {}",
            size[0], size[1], first[0], first[1], bounds[0], bounds[1];
        /// The tile of a field was requested, but the field does not repeat along both axes.
        NoPeriod => "the field does not repeat along both axes, so that there is no tile of it";
        /// A number is not finite, or the size of a pixel is zero.
        NotFinite {
            /// The name of the number.
            what: &'static str,
            /// The number.
            value: f64,
        } => "the {what} is {value}, but it must be finite and a pixel's size must not be zero";
    }
}

impl RasterError {
    /// Checks that memory for `length` values has exactly the `needed` length. For implementations of
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

    /// Checks that a number lies in its range, which is so if `holds`. For implementations of [`Field`](crate::Field).
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
