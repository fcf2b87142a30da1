//! Why a scene was refused.

use dapple_mesh::MeshError;
use dapple_raster::RasterError;
use glam::DVec3;

/// The largest size of a coordinate, a length or a scale that a scene may hold; a quartic in it is far from overflow.
const SIZE_MAX: f64 = 1e30;

dapple_raster::error! {
    /// Why a scene could not be rendered, or a mesh not be made.
    PreviewError,
    /// The limit that was broken.
    PreviewErrorKind with Range {
        /// A vector that has to point somewhere has no length, or none that counts.
        NoDirection {
            /// The name of the vector.
            what: &'static str,
        } => "the {what} has no direction";
        /// A shape without an inside cannot be cut.
        NotSolid {
            /// The name of the shape.
            shape: &'static str,
        } => "a {shape} has no inside, so it cannot be cut";
    }
    from {
        /// The mesh was refused.
        Mesh(MeshError),
        /// The picture has a size that a raster cannot have.
        Raster(RasterError),
    }
}

impl PreviewError {
    /// Refuses a vector with a part that is not finite or too large to compute with.
    pub(crate) fn check_vector(what: &'static str, vector: DVec3) -> Result<(), Self> {
        vector.to_array().into_iter().try_for_each(|value| {
            let holds = value.abs() <= SIZE_MAX;
            Self::check(holds, what, value, "from -1e30 to 1e30")
        })
    }

    /// Refuses a length that is not above zero, or that is too small or too large to compute with.
    pub(crate) fn check_length(what: &'static str, value: f64) -> Result<(), Self> {
        let holds = (SIZE_MAX.recip()..=SIZE_MAX).contains(&value);
        Self::check(holds, what, value, "from 1e-30 to 1e30")
    }

    /// The vector with a length of 1, which must have a direction.
    pub(crate) fn direction(what: &'static str, vector: DVec3) -> Result<DVec3, Self> {
        Self::check_vector(what, vector)?;
        let none = || Self::new(PreviewErrorKind::NoDirection { what });
        vector.try_normalize().ok_or_else(none)
    }
}
