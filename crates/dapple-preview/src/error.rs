//! Errors from rendering and from building meshes.

use dapple_mesh::MeshError;
use dapple_raster::RasterError;
use glam::DVec3;

/// Maximum coordinate, length or scale in a scene. Quartics with coefficients of this size do not overflow.
const SIZE_MAX: f64 = 1e30;

dapple_raster::error! {
    /// An error from rendering a scene or creating a mesh.
    PreviewError,
    /// The cause of a [`PreviewError`], with the limit and the value.
    PreviewErrorKind with Range {
        /// A vector that needs a direction has no length, or is too short or too long.
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
        /// The mesh is invalid.
        Mesh(MeshError),
        /// The image size is invalid.
        Raster(RasterError),
    }
}

impl PreviewError {
    /// Returns an error unless the components of a vector are finite and at most [`SIZE_MAX`].
    pub(crate) fn check_vector(what: &'static str, vector: DVec3) -> Result<(), Self> {
        vector.to_array().into_iter().try_for_each(|value| {
            let holds = value.abs() <= SIZE_MAX;
            Self::check(holds, what, value, "from -1e30 to 1e30")
        })
    }

    /// Checks that a length is positive and neither underflows nor overflows in computations.
    pub(crate) fn check_length(what: &'static str, value: f64) -> Result<(), Self> {
        let holds = (SIZE_MAX.recip()..=SIZE_MAX).contains(&value);
        Self::check(holds, what, value, "from 1e-30 to 1e30")
    }

    /// Returns the normalized vector. Fails if it has no direction.
    pub(crate) fn direction(what: &'static str, vector: DVec3) -> Result<DVec3, Self> {
        Self::check_vector(what, vector)?;
        let none = || Self::new(PreviewErrorKind::NoDirection { what });
        vector.try_normalize().ok_or_else(none)
    }
}
