//! Errors of polygonization.

use dapple_mesh::MeshError;

dapple_raster::error! {
    /// An error in converting a solid to a mesh.
    ModelError,
    /// The cause of a [`ModelError`], with the limit and the value.
    ModelErrorKind with Range {
        /// The surface is not closed: some edges have only one face.
        Open {
            /// The number of edges with one face.
            edges: usize,
        } => "the surface has {edges} edges with one face, but it must be closed; the distance changes too fast";
        /// No surface was found within the bounds.
        NoSurface => "no surface was found in the bounds of the solid";
    }
    from {
        /// An error of the mesh.
        Mesh(MeshError),
    }
}
