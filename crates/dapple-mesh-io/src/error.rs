//! Errors of mesh files.

use dapple_mesh::MeshError;

dapple_raster::error! {
    /// An error of reading or writing a mesh file.
    MeshIoError,
    /// Cause of a [`MeshIoError`], with the limit and the value.
    MeshIoErrorKind {
        /// A file violates its format.
        File {
            /// Name of the format.
            format: &'static str,
            /// Reason and location in the file.
            why: String,
        } => "this is not a valid {format} file: {why}";
        /// A file is valid, but uses a feature that is not supported.
        Unsupported {
            /// Name of the feature.
            feature: String,
        } => "{feature} is not supported";
        /// A file cannot be read from the disk or written to it.
        Io {
            /// Path of the file.
            path: String,
            /// Error of the operating system, as text.
            why: String,
            /// Error number, if the error is from the operating system.
            code: Option<i32>,
        } => "{path}: {why}";
        /// There is no readable, or no writable, format with this name.
        Format {
            /// Requested name, as in the extension of a path.
            name: String,
            /// Supported extensions, as text.
            known: String,
        } => "no mesh format is named `{name}`; there are {known}";
        /// The name cannot be used for files that refer to each other.
        Name {
            /// Name of the files without extension.
            name: String,
        } => "files of an OBJ model cannot be named `{name}`: white space, slashes and `#` do not work in them";
        /// The file would exceed the maximum size of its format.
        Size {
            /// Name of the format.
            format: &'static str,
            /// Size of the file, in bytes.
            bytes: usize,
        } => "the {format} file would have {bytes} bytes, but must have less than 2^32";
    }
    from {
        /// An error of the mesh or the model.
        Mesh(MeshError),
    }
}

impl MeshIoError {
    /// Creates the error for a file that violates its format.
    pub(crate) fn file(format: &'static str, why: impl Into<String>) -> Self {
        let why = why.into();
        Self::new(MeshIoErrorKind::File { format, why })
    }
}
