//! The package's exception, and the conversion of the crates' errors to it.

use dapple::{
    color::ColorError, graph::GraphError, image::ImageError, mesh::MeshError, mesh_io::MeshIoError,
    mesh_io::MeshIoErrorKind, points::PointsError, pups::PupsError, raster::RasterError,
    recipe::RecipeError, synth::SynthError, tile::TileError, wavelet::WaveletError,
    worley::WorleyError,
};
use pyo3::exceptions::{PyIsADirectoryError, PyOSError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use std::{io, path::Path};

/// The C error number EISDIR ("is a directory"), which is the same on all systems.
const EISDIR: i32 = 21;

pyo3::create_exception!(
    dapple_textures,
    DappleError,
    PyValueError,
    "A value that the library refuses. The message names the limit and the value; `kind` is the kind of the limit in \
     small letters, `node` the node of a recipe, and `hint` what was perhaps meant; the last two may be None."
);

pyo3::create_exception!(
    dapple_textures,
    DappleWarning,
    PyUserWarning,
    "Something that the library did, but that was perhaps not meant. The message names the share or the number."
);

/// An error raised by a call, before its conversion to a Python exception.
pub(crate) enum Error {
    /// An error of the library.
    Refused(Refusal),
    /// A Python exception.
    Python(PyErr),
}

/// The contents of a [`DappleError`].
pub(crate) struct Refusal {
    kind: String,
    message: String,
    node: Option<String>,
    hint: Option<String>,
}

/// The result of a call.
pub(crate) type Result<T> = core::result::Result<T, Error>;

impl Error {
    /// Creates an error that the package itself raises. `kind` is in lower case.
    pub(crate) fn new(kind: &str, message: impl Into<String>) -> Self {
        Self::Refused(Refusal {
            kind: kind.to_owned(),
            message: message.into(),
            node: None,
            hint: None,
        })
    }

    /// Returns the error with another message.
    pub(crate) fn with_message(self, message: String) -> Self {
        match self {
            Self::Refused(refusal) => Self::Refused(Refusal { message, ..refusal }),
            Self::Python(_) => self,
        }
    }

    /// Adds the nearest valid name as a hint.
    pub(crate) fn with_near(self, near: Option<String>) -> Self {
        match (self, near) {
            (Self::Refused(refusal), Some(near)) => Self::Refused(Refusal {
                message: format!("{}; did you mean `{near}`?", refusal.message),
                hint: Some(near),
                ..refusal
            }),
            (refusal, _) => refusal,
        }
    }

    /// Creates the exception for an operating system error number: `FileNotFoundError`, `IsADirectoryError`, or
    /// another `OSError`.
    pub(crate) fn of_system(code: i32, path: Option<&Path>) -> Self {
        Self::Python(Python::attach(|py| {
            let make = || -> PyResult<PyErr> {
                // Call the class, which returns an instance of the subclass for the number.
                let class = py.get_type::<PyOSError>();
                let error = if cfg!(windows) {
                    // Pass the Windows error number as the fourth argument; Python derives the C error number from it.
                    let text = io::Error::from_raw_os_error(code).to_string();
                    class.call1((0, text, path, code))?
                } else {
                    let text = py.import("os")?.call_method1("strerror", (code,))?;
                    class.call1((code, text, path))?
                };
                Ok(PyErr::from_value(error))
            };
            make().unwrap_or_else(|error| error)
        }))
    }

    /// Creates the exception for a directory in place of a file, for the case that the library reports it instead of
    /// the operating system.
    fn of_folder(path: Option<&Path>) -> Self {
        let arguments = (EISDIR, "Is a directory", path.map(Path::to_owned));
        Self::Python(PyIsADirectoryError::new_err(arguments))
    }

    /// Converts a crate's error. The kind is the name of the enum variant in snake case.
    fn of(kind: &impl core::fmt::Debug, message: &impl ToString) -> Self {
        Self::new(&snake_case(&format!("{kind:?}")), message.to_string())
    }
}

/// Returns the identifier at the start of a debug text, in snake case.
fn snake_case(text: &str) -> String {
    let mut name = String::new();
    for letter in text.chars().take_while(|letter| letter.is_alphanumeric()) {
        if letter.is_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.extend(letter.to_lowercase());
    }
    name
}

macro_rules! refusals {
    ($($error:ty),* $(,)?) => {$(
        impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::of(error.kind(), &error)
            }
        }
    )*};
}

refusals!(
    ColorError,
    GraphError,
    MeshError,
    PointsError,
    PupsError,
    RasterError,
    SynthError,
    TileError,
    WaveletError,
    WorleyError,
);

impl From<ImageError> for Error {
    fn from(error: ImageError) -> Self {
        let source = std::error::Error::source(&error);
        let cause = source.and_then(|source| source.downcast_ref::<io::Error>());
        match cause.map(|cause| (cause.raw_os_error(), cause.kind())) {
            Some((Some(code), _)) => Self::of_system(code, error.path()),
            Some((None, io::ErrorKind::IsADirectory)) => Self::of_folder(error.path()),
            _ => Self::of(error.kind(), &error),
        }
    }
}

impl From<MeshIoError> for Error {
    fn from(error: MeshIoError) -> Self {
        match error.kind() {
            MeshIoErrorKind::Io {
                path,
                code: Some(code),
                ..
            } => Self::of_system(*code, Some(Path::new(path))),
            _ => Self::of(error.kind(), &error),
        }
    }
}

impl From<RecipeError> for Error {
    fn from(error: RecipeError) -> Self {
        let mut refusal = Refusal {
            kind: snake_case(&format!("{:?}", error.kind())),
            message: error.to_string(),
            node: error.node().map(str::to_owned),
            hint: error.nearest().map(str::to_owned),
        };
        if refusal.kind == "global" {
            let way = "bake the node `tile` or `blend_map` first and give the result to the recipe as an image";
            refusal.message = format!("{}; {way}", refusal.message);
            refusal.hint = Some(way.to_owned());
        }
        Self::Refused(refusal)
    }
}

impl From<PyErr> for Error {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        let refusal = match error {
            Error::Python(error) => return error,
            Error::Refused(refusal) => refusal,
        };
        Python::attach(|py| {
            let error = DappleError::new_err(refusal.message);
            let value = error.value(py);
            let set = || {
                value.setattr("kind", refusal.kind)?;
                value.setattr("node", refusal.node)?;
                value.setattr("hint", refusal.hint)
            };
            set().err().unwrap_or(error)
        })
    }
}
