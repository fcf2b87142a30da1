//! Reading and writing models by path. No other module accesses files.

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

/// Maximum number of bytes read from a file and from all files that it refers to. The length of a device or a pipe is
/// unknown, and a small file may refer to a large one many times.
const BYTES_MAX: u64 = 1 << 32;

/// Reads a mesh file. The path's extension selects the format from [`FORMATS`](crate::FORMATS).
///
/// Materials, buffers and textures are read only from regular files in the same folder and its subfolders, up to 4 GiB
/// in total.
///
/// # Errors
///
/// [`MeshIoErrorKind::Io`] if the file cannot be read or is larger than 4 GiB; [`MeshIoErrorKind::Format`] if no
/// format has this extension; or any error from the format's reader.
pub fn read_model(path: impl AsRef<Path>) -> Result<Model, MeshIoError> {
    let path = path.as_ref();
    let format = format_of(path)?;
    let mut left = BYTES_MAX;
    let bytes = read_at_most(path, File::open(path), BYTES_MAX)?;
    format.read(&bytes, &mut |name| resolve(path, name, &mut left))
}

/// Reads a mesh file and encodes it again with some images replaced: the first image of each pair by the second. The
/// rest of the file is unchanged. Returns a single file whose extension is
/// [`written_ending`](MeshFormat::written_ending), or `None` if the format cannot contain images.
///
/// # Errors
///
/// Same as [`read_model`] for access to the files, or any error from [`MeshFormat::replace_images`].
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

/// Writes a mesh file. The path's extension selects the format from [`FORMATS`](crate::FORMATS).
///
/// The file is written under a temporary name, flushed to the disk and then renamed. Other programs never see a
/// partial file, and a power failure leaves either the old or the new one. Files that it refers to, such as materials
/// and textures, are written to the same folder first, with the same stem.
///
/// # Errors
///
/// [`MeshIoErrorKind::Io`] if a file cannot be written; [`MeshIoErrorKind::Format`] if no writable format has this
/// extension; or any error from the format's writer.
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

/// Returns the format that a path's extension selects.
fn format_of(path: &Path) -> Result<&'static MeshFormat, MeshIoError> {
    MeshFormat::of_path(path).ok_or_else(|| {
        let (name, known) = (ending(path), readable_endings().collect::<Vec<_>>());
        let known = known.join(", ");
        MeshIoError::new(MeshIoErrorKind::Format { name, known })
    })
}

/// Creates the error for an extension that no writable format has.
pub(crate) fn unwritable(name: String) -> MeshIoError {
    let known = writable_endings().collect::<Vec<_>>().join(", ");
    let known = format!("{known} to write");
    MeshIoError::new(MeshIoErrorKind::Format { name, known })
}

/// Reads a file that the file at `path` refers to by `name`; `None` unless it is in the same folder or a subfolder.
/// `left` is the number of bytes that may still be read.
fn resolve(path: &Path, name: &str, left: &mut u64) -> Option<Vec<u8>> {
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let name = Path::new(name);
    if !name.components().all(inside) {
        return None;
    }
    let path = path.with_file_name("").join(name);
    // Reading a pipe or a device might never end.
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

/// Atomically replaces the content of the file at `path` with `bytes`: see [`dapple_image::replace`].
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
