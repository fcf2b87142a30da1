//! Errors from meshes, mesh files and queries.

dapple_raster::error! {
    /// An error from creating, reading or using a mesh.
    MeshError,
    /// The limit that was violated.
    MeshErrorKind with Range {
        /// A count is too large or too small.
        Count {
            /// Name of the counted items.
            what: &'static str,
            /// Number of items.
            count: usize,
            /// Required number, as text.
            needed: &'static str,
        } => "there are {count} {what}, but {needed} are needed";
        /// A coordinate of a position is NaN, infinite, or above 1e30 in absolute value.
        Position {
            /// Index of the vertex.
            vertex: usize,
            /// Value of the coordinate.
            value: f64,
        } => "a part of the position of vertex {vertex} is {value}, but it must be between -1e30 and 1e30";
        /// A face refers to a vertex that does not exist.
        Corner {
            /// Index of the face.
            face: usize,
            /// Index of the missing vertex.
            vertex: u32,
            /// Number of vertices.
            count: usize,
        } => "face {face} names vertex {vertex}, but there are only {count}";
        /// The mesh has defects that [`Mesh::repair`](crate::Mesh::repair) fixes.
        Defects {
            /// Number of faces with zero area.
            degenerate: usize,
            /// Number of faces with the same three vertices as an earlier face.
            duplicate: usize,
            /// Number of edges whose two faces have inconsistent winding.
            winding: usize,
        } =>
            "the mesh has {degenerate} faces without an area, {duplicate} duplicate faces and \
             {winding} edges of inconsistent winding; `repair` mends them";
        /// No face of the mesh has an area.
        NoArea => "no face of the mesh has an area";
        /// The bytes of an image are neither a PNG nor a JPEG file.
        Image => "the image is neither a PNG nor a JPEG file";
    }
}
