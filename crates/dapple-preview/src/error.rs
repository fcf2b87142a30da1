//! Errors of rendering and of meshes.

use dapple_mesh::MeshError;
use dapple_raster::RasterError;
use glam::DVec3;

/// Maximum coordinate, length or scale in a scene. A quartic of such numbers is far from overflow.
const SIZE_MAX: f64 = 1e30;

dapple_raster::error! {
    /// An error in rendering a scene or in creating a mesh.
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
        /// An error of the mesh.
        Mesh(MeshError),
        /// An error of the raster: the image has an invalid size.
        Raster(RasterError),
    }
}

impl PreviewError {
    /// Checks that the components of a vector are finite and do not overflow in computations.
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

    /// Normalizes a vector, which must have a direction.
    pub(crate) fn direction(what: &'static str, vector: DVec3) -> Result<DVec3, Self> {
        Self::check_vector(what, vector)?;
        let none = || Self::new(PreviewErrorKind::NoDirection { what });
        vector.try_normalize().ok_or_else(none)
    }
}
