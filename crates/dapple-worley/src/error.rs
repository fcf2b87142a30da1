//! Errors of cellular bases.

use dapple_raster::RasterError;

dapple_raster::error! {
    /// An error of a cellular basis or of rendering it.
    WorleyError,
    /// The cause of a [`WorleyError`], with the limit and the value.
    WorleyErrorKind with Range {
        /// The number of values differs from the number of positions.
        Length {
            /// Number of values.
            length: usize,
            /// Number of values needed.
            needed: usize,
        } => "there is room for {length} values, but {needed} are needed";
        /// The WGSL of `dapple-wgsl` does not support the basis.
        NotInShader {
            /// Description of what is not supported.
            what: &'static str,
        } => "the shader does not support {what}";
        /// The texture has no measured range.
        NoRange {
            /// Description of the textures that have a measured range.
            measured: &'static str,
        } => "there is no range for this texture, but for {measured}: `measure_range` finds one, and `with_range` sets it";
    }
    from {
        /// The raster or the window is invalid.
        Raster(RasterError),
    }
}

impl WorleyError {
    /// Returns an error if the buffer length `length` differs from the `needed` length.
    pub(crate) fn check_length(length: usize, needed: usize) -> Result<(), Self> {
        if length == needed {
            Ok(())
        } else {
            Err(Self::new(WorleyErrorKind::Length { length, needed }))
        }
    }
}
