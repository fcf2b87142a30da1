//! Why a mesh, a file or a request was refused.

dapple_raster::error! {
    /// Why a mesh could not be made, read, or used.
    MeshError,
    /// The limit that was broken.
    MeshErrorKind with Range {
        /// There are more or fewer things than needed.
        Count {
            /// The name of the counted things.
            what: &'static str,
            /// How many there are.
            count: usize,
            /// How many were needed, as text.
            needed: &'static str,
        } => "there are {count} {what}, but {needed} are needed";
        /// A position has a part that is NaN, infinite, or above 1e30.
        Position {
            /// The vertex.
            vertex: usize,
            /// The part.
            value: f64,
        } => "a part of the position of vertex {vertex} is {value}, but it must be between -1e30 and 1e30";
        /// A face names a vertex that there is not.
        Corner {
            /// The face.
            face: usize,
            /// The vertex that it names.
            vertex: u32,
            /// How many vertices there are.
            count: usize,
        } => "face {face} names vertex {vertex}, but there are only {count}";
        /// The mesh has defects that [`Mesh::repair`](crate::Mesh::repair) mends.
        Defects {
            /// Faces without an area.
            degenerate: usize,
            /// Faces with the same three vertices as an earlier one.
            duplicate: usize,
            /// Edges whose two faces go around different sides.
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
