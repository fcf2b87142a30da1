//! Why a mesh, a file or a request was refused.

use core::fmt;

/// Why a mesh could not be made, read, or used.
///
/// Match on [`kind`](Self::kind); the text is for people.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshError {
    kind: MeshErrorKind,
}

/// The limit that was broken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshErrorKind {
    /// A number is outside of its range.
    Range {
        /// What the number is.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range it must lie in, as text.
        range: &'static str,
    },
    /// There are more or fewer things than needed.
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many were needed, as text.
        needed: &'static str,
    },
    /// A position has a part that is NaN, infinite, or above 1e30.
    Position {
        /// The vertex.
        vertex: usize,
        /// The part.
        value: f64,
    },
    /// A face names a vertex that there is not.
    Corner {
        /// The face.
        face: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// The mesh has defects that [`Mesh::repair`](crate::Mesh::repair) mends.
    Defects {
        /// Faces without an area.
        degenerate: usize,
        /// Faces with the same three vertices as an earlier one.
        duplicate: usize,
        /// Edges whose two faces go around different sides.
        winding: usize,
    },
    /// No face of the mesh has an area.
    NoArea,
    /// A file does not follow its format.
    File {
        /// The format.
        format: &'static str,
        /// What is wrong, and where.
        why: String,
    },
    /// A file is valid, but uses a feature that is not read.
    Unsupported {
        /// What is not read.
        feature: String,
    },
    /// A file cannot be read or written.
    Io {
        /// The path of the file.
        path: String,
        /// The error of the operating system, as text.
        why: String,
    },
    /// No reader, or no writer, has this name.
    Format {
        /// The name, as the extension of a path has it.
        name: String,
        /// What there is, as text.
        known: &'static str,
    },
}

impl MeshError {
    pub(crate) fn new(kind: MeshErrorKind) -> Self {
        Self { kind }
    }

    /// Says that a file does not follow its format.
    #[cfg(any(feature = "obj", feature = "ply", feature = "gltf", feature = "off"))]
    pub(crate) fn file(format: &'static str, why: impl Into<String>) -> Self {
        let why = why.into();
        Self::new(MeshErrorKind::File { format, why })
    }

    /// Refuses a value outside of its range.
    pub(crate) fn check(
        holds: bool,
        what: &'static str,
        value: f64,
        range: &'static str,
    ) -> Result<(), Self> {
        if holds {
            Ok(())
        } else {
            Err(Self::new(MeshErrorKind::Range { what, value, range }))
        }
    }

    /// The limit that was broken.
    #[must_use]
    pub fn kind(&self) -> &MeshErrorKind {
        &self.kind
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            MeshErrorKind::Range { what, value, range } => {
                write!(f, "the {what} is {value}, but it must be {range}")
            }
            MeshErrorKind::Count {
                what,
                count,
                needed,
            } => write!(f, "there are {count} {what}, but {needed} are needed"),
            MeshErrorKind::Position { vertex, value } => write!(
                f,
                "a part of the position of vertex {vertex} is {value}, but it must be between -1e30 and 1e30"
            ),
            MeshErrorKind::Corner {
                face,
                vertex,
                count,
            } => write!(
                f,
                "face {face} names vertex {vertex}, but there are only {count}"
            ),
            MeshErrorKind::Defects {
                degenerate,
                duplicate,
                winding,
            } => write!(
                f,
                "the mesh has {degenerate} faces without an area, {duplicate} duplicate faces and {winding} edges of inconsistent winding; `repair` mends them"
            ),
            MeshErrorKind::NoArea => write!(f, "no face of the mesh has an area"),
            MeshErrorKind::File { format, why } => {
                write!(f, "this is not a valid {format} file: {why}")
            }
            MeshErrorKind::Unsupported { feature } => write!(f, "{feature} is not supported"),
            MeshErrorKind::Io { path, why } => write!(f, "{path}: {why}"),
            MeshErrorKind::Format { name, known } => {
                write!(f, "no mesh format is named `{name}`; there are {known}")
            }
        }
    }
}

impl core::error::Error for MeshError {}
