//! Reading and writing models at paths: the only module that touches files.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where meshes meet files"
)]

use crate::formats::{ending, readable_endings, writable_endings};
use crate::{MeshFormat, MeshIoError, MeshIoErrorKind};
use dapple_mesh::{EncodedImage, Model};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path};

/// The largest number of bytes that are read of a file, and of all files beside it. The length of a device or a pipe is
/// unknown, and a small file may name a large one many times.
const BYTES_MAX: u64 = 1 << 32;

/// Reads a mesh file, in the format of [`FORMATS`](crate::FORMATS) with the ending of its path.
///
/// Materials, buffers and textures are read from regular files in the same folder and the folders in it, never from
/// outside of it, and up to 4 GiB in total.
///
/// # Errors
///
/// [`MeshIoErrorKind::Io`] if the file cannot be read or has more than 4 GiB; [`MeshIoErrorKind::Format`] if no format
/// has its ending; and the errors of the reader of the format.
pub fn read_model(path: impl AsRef<Path>) -> Result<Model, MeshIoError> {
    let path = path.as_ref();
    let format = format_of(path)?;
    let mut left = BYTES_MAX;
    let bytes = read_at_most(path, File::open(path), BYTES_MAX)?;
    format.read(&bytes, &mut |name| resolve(path, name, &mut left))
}

/// Reads a mesh file and encodes it again with the second image of each pair in place of the first, and nothing else
/// changed, as one file with the [written ending](MeshFormat::written_ending) of its format; `None` if the format holds
/// no images.
///
/// # Errors
///
/// The errors of [`read_model`] about files, and those of [`MeshFormat::replace_images`].
pub fn replace_images(
    path: impl AsRef<Path>,
    replaced: &[(EncodedImage, EncodedImage)],
) -> Result<Option<Vec<u8>>, MeshIoError> {
    let path = path.as_ref();
    let format = format_of(path)?;
    let mut left = BYTES_MAX;
    let bytes = read_at_most(path, File::open(path), BYTES_MAX)?;
    format.replace_images(&bytes, &mut |name| resolve(path, name, &mut left), replaced)
}

/// Writes a mesh file, in the format of [`FORMATS`](crate::FORMATS) that is written with the ending of its path.
///
/// A file is written under a temporary name, flushed to the disk and then renamed, so that no program ever sees half of
/// it, and a power cut leaves the old or the new one. Files to which it refers, such as materials and textures, are
/// written beside it first, under the same stem.
///
/// # Errors
///
/// [`MeshIoErrorKind::Io`] if a file cannot be written; [`MeshIoErrorKind::Format`] if no format is written with this
/// ending; and the errors of the writer of the format.
pub fn write_model(path: impl AsRef<Path>, model: &Model) -> Result<(), MeshIoError> {
    let path = path.as_ref();
    let ending = ending(path);
    let format = MeshFormat::of_path(path);
    let Some(format) = format.filter(|format| format.written_ending() == Some(&ending)) else {
        return Err(unwritable(ending));
    };
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut files = format.write(model, &stem)?;
    let main = files.pop();
    for file in files {
        replace(&path.with_file_name(file.name), &file.bytes)?;
    }
    main.map_or(Ok(()), |main| replace(path, &main.bytes))
}

/// The format with the ending of a path.
fn format_of(path: &Path) -> Result<&'static MeshFormat, MeshIoError> {
    MeshFormat::of_path(path).ok_or_else(|| {
        let (name, known) = (ending(path), readable_endings().collect::<Vec<_>>());
        let known = known.join(", ");
        MeshIoError::new(MeshIoErrorKind::Format { name, known })
    })
}

/// The error of an ending with which no format is written.
pub(crate) fn unwritable(name: String) -> MeshIoError {
    let known = writable_endings().collect::<Vec<_>>().join(", ");
    let known = format!("{known} to write");
    MeshIoError::new(MeshIoErrorKind::Format { name, known })
}

/// The content of a file, by its name in another file, if it is in the folder of that file or deeper.
fn resolve(path: &Path, name: &str, left: &mut u64) -> Option<Vec<u8>> {
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let name = Path::new(name);
    if !name.components().all(inside) {
        return None;
    }
    let path = path.with_file_name("").join(name);
    // A pipe or a device may never end.
    let file = dapple_image::open_regular(&path).ok()?;
    let bytes = read_at_most(&path, Ok(file), *left).ok()?;
    *left -= bytes.len() as u64;
    Some(bytes)
}

fn read_at_most(path: &Path, file: io::Result<File>, limit: u64) -> Result<Vec<u8>, MeshIoError> {
    let mut bytes = Vec::new();
    file.and_then(|file| file.take(limit + 1).read_to_end(&mut bytes))
        .map_err(|error| failed(path, &error))?;
    if bytes.len() as u64 > limit {
        let why = format!("it has more than {limit} bytes");
        return Err(failed(path, &io::Error::other(why)));
    }
    Ok(bytes)
}

fn failed(path: &Path, error: &io::Error) -> MeshIoError {
    MeshIoError::new(MeshIoErrorKind::Io {
        path: path.display().to_string(),
        why: error.to_string(),
        code: error.raw_os_error(),
    })
}

/// Replaces the content of the file at `path` with `bytes`, at once and for good: see [`dapple_image::replace`].
fn replace(path: &Path, bytes: &[u8]) -> Result<(), MeshIoError> {
    dapple_image::replace(path, bytes).map_err(|error| {
        let cause = std::error::Error::source(&error);
        match cause.and_then(|cause| cause.downcast_ref::<io::Error>()) {
            Some(cause) => failed(path, cause),
            None => failed(path, &io::Error::other(error.to_string())),
        }
    })
}

#[cfg(all(test, feature = "gltf"))]
mod tests;
