//! Errors of mesh files.

use dapple_mesh::MeshError;

dapple_raster::error! {
    /// An error of reading or writing a mesh file.
    MeshIoError,
    /// The cause of a [`MeshIoError`], with the limit and the value.
    MeshIoErrorKind {
        /// A file does not follow its format.
        File {
            /// The name of the format.
            format: &'static str,
            /// The reason, and the place in the file.
            why: String,
        } => "this is not a valid {format} file: {why}";
        /// A file is valid, but uses a feature that is not supported.
        Unsupported {
            /// The name of the feature.
            feature: String,
        } => "{feature} is not supported";
        /// A file cannot be read from the disk or written to it.
        Io {
            /// The path of the file.
            path: String,
            /// The error of the operating system, as text.
            why: String,
            /// The number of the error, if it is one of the operating system.
            code: Option<i32>,
        } => "{path}: {why}";
        /// No format with this name can be read, or none can be written.
        Format {
            /// The name, as in the ending of a path.
            name: String,
            /// The known endings, as text.
            known: String,
        } => "no mesh format is named `{name}`; there are {known}";
        /// Files that refer to each other by name cannot have this name.
        Name {
            /// The name of the files without their endings.
            name: String,
        } => "files of an OBJ model cannot be named `{name}`: white space, slashes and `#` do not work in them";
        /// A file would be larger than its format can hold.
        Size {
            /// The name of the format.
            format: &'static str,
            /// The number of bytes of the file.
            bytes: usize,
        } => "the {format} file would have {bytes} bytes, but must have less than 2^32";
    }
    from {
        /// An error of the mesh or the model.
        Mesh(MeshError),
    }
}

impl MeshIoError {
    /// The error of a file that does not follow its format.
    pub(crate) fn file(format: &'static str, why: impl Into<String>) -> Self {
        let why = why.into();
        Self::new(MeshIoErrorKind::File { format, why })
    }
}
