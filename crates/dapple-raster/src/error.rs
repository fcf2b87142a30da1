//! Why a raster or a window was refused.

crate::error! {
    /// Why an operation on rasters was refused.
    RasterError,
    /// The limit that was broken.
    RasterErrorKind with Range {
        /// A width or a height is zero.
        Empty {
            /// The size that was asked for, in pixels.
            size: [u32; 2],
        } => "a raster of {} × {} pixels is empty", size[0], size[1];
        /// The pixels are more than the address space, or the limit of 2^31, allows.
        TooLarge {
            /// The size that was asked for, in pixels.
            size: [u32; 2],
        } => "a raster of {} × {} pixels is larger than the limit of 2^31 pixels", size[0], size[1];
        /// The number of values is not that of the pixels.
        Length {
            /// How many values there are.
            length: usize,
            /// How many were needed.
            needed: usize,
        } => "there are {length} values, but {needed} are needed";
        /// Two sizes that must be equal are not.
        SizeMismatch {
            /// The size of what was passed, in pixels.
            size: [u32; 2],
            /// The size that was needed.
            needed: [u32; 2],
        } => "the raster has {} × {} pixels, but {} × {} are needed", size[0], size[1], needed[0], needed[1];
        /// A rectangle reaches past the raster.
        OutOfBounds {
            /// The first column and row of the rectangle.
            first: [u32; 2],
            /// Its size in pixels.
            size: [u32; 2],
            /// The size of the raster.
            bounds: [u32; 2],
        } =>
            "the rectangle of {} × {} pixels at ({}, {}) leaves the raster of {} × {}",
            size[0], size[1], first[0], first[1], bounds[0], bounds[1];
        /// One period was asked for of a field that does not repeat along both axes.
        NoPeriod => "the field does not repeat along both axes, so that there is no tile of it";
        /// A number that has to be finite (and, for the size of a pixel, not zero) is not.
        NotFinite {
            /// What the number is.
            what: &'static str,
            /// The number.
            value: f64,
        } => "the {what} is {value}, but it must be finite and a pixel's size must not be zero";
    }
}

impl RasterError {
    /// Refuses memory for another number of values than are needed; for those who write a [`Field`](crate::Field).
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

    /// Refuses a number out of its range; for those who write a [`Field`](crate::Field).
    ///
    /// # Errors
    ///
    /// [`Range`](RasterErrorKind::Range) unless it `holds`.
    pub fn check_range(
        holds: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        Self::check(holds, what, value, range)
    }
}
