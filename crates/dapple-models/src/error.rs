//! Why no mesh was made.

use dapple_mesh::MeshError;

dapple_raster::error! {
    /// Why no mesh of a solid was made.
    ModelError,
    /// The limit that was broken.
    ModelErrorKind with Range {
        /// Edges of the surface that was found have no second face.
        Open {
            /// How many edges.
            edges: usize,
        } => "the surface has {edges} edges with one face, but it must be closed; the distance changes too fast";
        /// No surface was found.
        NoSurface => "no surface was found in the bounds of the solid";
    }
    from {
        /// The mesh was refused.
        Mesh(MeshError),
    }
}
