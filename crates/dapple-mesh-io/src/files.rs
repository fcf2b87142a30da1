//! Reading and writing models at paths: the only place that touches files.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where meshes meet files"
)]

use crate::formats::{ending, readable_endings, writable_endings};
use crate::{MeshFormat, MeshIoError, MeshIoErrorKind};
use dapple_mesh::Model;
use std::fs::File;
use std::io::{self, Read, Write as _};
use std::path::{Component, Path};

/// The most bytes that are read of a file, and of all files beside it. A device or a pipe has no length to trust, and a
/// small file may name a large one many times.
const BYTES_MAX: u64 = 1 << 32;

/// Reads a mesh file, in the format of [`FORMATS`](crate::FORMATS) that has the ending of its path.
///
/// Materials, buffers and textures are looked for in the same folder and those in it, never outside of it, and
/// until there are 4 GiB of them.
///
/// # Errors
///
/// [`MeshIoErrorKind::Io`] if the file cannot be read or has more than 4 GiB; [`MeshIoErrorKind::Format`] if no format
/// has its ending; and what the reader of the format refuses.
pub fn read_model(path: impl AsRef<Path>) -> Result<Model, MeshIoError> {
    let path = path.as_ref();
    let Some(format) = MeshFormat::of_path(path) else {
        let (name, known) = (ending(path), readable_endings().collect::<Vec<_>>());
        let known = known.join(", ");
        return Err(MeshIoError::new(MeshIoErrorKind::Format { name, known }));
    };
    let mut left = BYTES_MAX;
    let bytes = read_at_most(path, BYTES_MAX)?;
    format.read(&bytes, &mut |name| beside(path, name, &mut left))
}

/// Writes a mesh file, in the format of [`FORMATS`](crate::FORMATS) that is written with the ending of its path.
///
/// A file is written under a temporary name and then renamed, so that no program ever sees half of it. Files that it
/// names, such as materials and textures, are written beside it before it, under the same stem.
///
/// # Errors
///
/// [`MeshIoErrorKind::Io`] if a file cannot be written; [`MeshIoErrorKind::Format`] if nothing is written with this
/// ending; and what the writer of the format refuses.
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

/// The error of an ending that nothing is written with.
pub(crate) fn unwritable(name: String) -> MeshIoError {
    let known = writable_endings().collect::<Vec<_>>().join(", ");
    let known = format!("{known} to write");
    MeshIoError::new(MeshIoErrorKind::Format { name, known })
}

/// The content of another file by its name in a file, if it is in the folder of that or deeper.
fn beside(path: &Path, name: &str, left: &mut u64) -> Option<Vec<u8>> {
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let name = Path::new(name);
    if !name.components().all(inside) {
        return None;
    }
    let bytes = read_at_most(&path.with_file_name("").join(name), *left).ok()?;
    *left -= bytes.len() as u64;
    Some(bytes)
}

fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, MeshIoError> {
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(limit + 1).read_to_end(&mut bytes))
        .map_err(|error| failed(path, &error))?;
    if bytes.len() as u64 > limit {
        let why = format!("it has more than {limit} bytes");
        return Err(failed(path, &io::Error::other(why)));
    }
    Ok(bytes)
}

fn failed(path: &Path, error: &io::Error) -> MeshIoError {
    let (path, why) = (path.display().to_string(), error.to_string());
    MeshIoError::new(MeshIoErrorKind::Io { path, why })
}

/// Makes `bytes` the content of the file at `path`, which is new or the old one until all of it is written.
///
/// A file that is there keeps its permissions, and one that a link leads to, the link.
fn replace(path: &Path, bytes: &[u8]) -> Result<(), MeshIoError> {
    let replaced = || {
        let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        // Made here, so that its permissions are those of any new file.
        let create = |path: &Path| File::options().write(true).create_new(true).open(path);
        let mut builder = tempfile::Builder::new();
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut file = builder.prefix(".dapple-").make_in(folder, create)?;
        file.as_file_mut().write_all(bytes)?;
        if let Ok(found) = std::fs::metadata(&path) {
            file.as_file().set_permissions(found.permissions())?;
        }
        file.persist(path)?;
        Ok(())
    };
    replaced().map_err(|error| failed(path, &error))
}

#[cfg(all(test, feature = "gltf"))]
mod tests;
