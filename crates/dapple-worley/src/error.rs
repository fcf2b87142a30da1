//! Why a basis was refused.

use dapple_raster::RasterError;

dapple_raster::error! {
    /// Why a cellular basis was refused, or a picture of it.
    WorleyError,
    /// The limit that was broken.
    WorleyErrorKind with Range {
        /// The number of values is not that of the positions.
        Length {
            /// How many values there are.
            length: usize,
            /// How many were needed.
            needed: usize,
        } => "there is room for {length} values, but {needed} are needed";
        /// The table of ranges has no entry for this combination.
        NoRange => "the table of ranges has the named combinations at the default density only; measure the range";
    }
    from {
        /// The raster or the window was refused.
        Raster(RasterError),
    }
}

impl WorleyError {
    /// Refuses memory of another length.
    pub(crate) fn check_length(length: usize, needed: usize) -> Result<(), Self> {
        if length == needed {
            Ok(())
        } else {
            Err(Self::new(WorleyErrorKind::Length { length, needed }))
        }
    }
}
