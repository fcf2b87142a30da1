//! Errors from mesh files.

use dapple_mesh::MeshError;

dapple_raster::error! {
    /// An error from reading or writing a mesh file.
    MeshIoError,
    /// Cause of a [`MeshIoError`], with the limit and the value.
    MeshIoErrorKind {
        /// A file violates its format.
        File {
            /// Name of the format.
            format: &'static str,
            /// Reason for the error, and its location in the file.
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
            /// The operating system's error, as text.
            why: String,
            /// The operating system's error number; `None` if the error has another origin.
            code: Option<i32>,
        } => "{path}: {why}";
        /// No readable (or writable) format has this name.
        Format {
            /// Requested name, such as the extension of a path.
            name: String,
            /// Supported extensions, as text.
            known: String,
        } => "no mesh format is named `{name}`; there are {known}";
        /// The name of the main file cannot be used, because the files written with it refer to each other by name.
        Name {
            /// Name without extension.
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
        /// An error in the mesh or the model.
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
