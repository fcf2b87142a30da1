//! Why a mesh file was refused.

use dapple_mesh::MeshError;

dapple_raster::error! {
    /// Why a mesh file could not be read or written.
    MeshIoError,
    /// The limit that was broken.
    MeshIoErrorKind {
        /// A file does not follow its format.
        File {
            /// The format.
            format: &'static str,
            /// The reason, and where in the file it is.
            why: String,
        } => "this is not a valid {format} file: {why}";
        /// A file is valid, but uses a feature that is not read.
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
        } => "{path}: {why}";
        /// No reader, or no writer, has this name.
        Format {
            /// The name, as the ending of a path has it.
            name: String,
            /// The endings that are known, as text.
            known: String,
        } => "no mesh format is named `{name}`; there are {known}";
        /// Files that name each other cannot be named after this.
        Name {
            /// The name of the files without their endings.
            name: String,
        } => "files of an OBJ model cannot be named `{name}`: white space, slashes and `#` do not work in them";
        /// A file would be larger than its format can hold.
        Size {
            /// The format.
            format: &'static str,
            /// How many bytes it would have.
            bytes: usize,
        } => "the {format} file would have {bytes} bytes, but must have less than 2^32";
    }
    from {
        /// The mesh or the model was refused.
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
