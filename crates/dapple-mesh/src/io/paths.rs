//! Reading and writing models at paths: the only place that touches files.

#![expect(
    clippy::disallowed_methods,
    reason = "this module is where meshes meet files"
)]

use crate::{MeshError, MeshErrorKind, Model};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The most bytes that are read of a file, and of all files beside it. A device or a pipe has no length to trust, and a
/// small file may name a large one many times.
const BYTES_MAX: u64 = 1 << 32;

/// Reads a mesh file by the extension of its path: `obj`, `ply`, `gltf`, `glb` or `off`, if their features are on.
///
/// Materials, buffers and textures are looked for in the same folder and those in it, never outside of it, and
/// until there are 4 GiB of them.
///
/// # Errors
///
/// [`MeshErrorKind::Io`] if the file cannot be read or has more than 4 GiB; [`MeshErrorKind::Format`] if its extension
/// is none of these; and what the reader of the format refuses.
pub fn read_model(path: impl AsRef<Path>) -> Result<Model, MeshError> {
    let path = path.as_ref();
    let extension = extension(path);
    #[cfg(any(feature = "obj", feature = "gltf"))]
    let mut left = BYTES_MAX;
    #[cfg(any(feature = "obj", feature = "gltf"))]
    let beside = &mut |name: &str| beside(path, name, &mut left);
    match extension.as_str() {
        #[cfg(feature = "obj")]
        "obj" => super::obj::read_with(&read(path)?, beside),
        #[cfg(feature = "ply")]
        "ply" => super::ply::read(&read(path)?),
        #[cfg(feature = "gltf")]
        "gltf" | "glb" => super::gltf::read_with(&read(path)?, beside),
        #[cfg(feature = "off")]
        "off" => super::off::read(&read(path)?),
        _ => Err(unknown(extension, "obj, ply, gltf, glb and off")),
    }
}

/// Writes a mesh file by the extension of its path: `obj`, `ply` (binary) or `glb`, if their features are on.
///
/// A file is written under a temporary name and then renamed, so that nobody ever sees half of it. With OBJ, its
/// material and textures are written beside it before it, under the same stem.
///
/// # Errors
///
/// [`MeshErrorKind::Io`] if a file cannot be written; [`MeshErrorKind::Format`] if the extension is none of these;
/// and what the writer of the format refuses.
#[cfg(any(feature = "obj", feature = "ply", feature = "gltf"))]
pub fn write_model(path: impl AsRef<Path>, model: &Model) -> Result<(), MeshError> {
    let path = path.as_ref();
    let extension = extension(path);
    match extension.as_str() {
        #[cfg(feature = "obj")]
        "obj" => {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let mut files = super::obj::write_files(model, &stem)?;
            let obj = files.pop();
            for file in files {
                replace(&path.with_file_name(file.name), &file.bytes)?;
            }
            obj.map_or(Ok(()), |obj| replace(path, &obj.bytes))
        }
        #[cfg(feature = "ply")]
        "ply" => replace(path, &super::ply::write(model)?),
        #[cfg(feature = "gltf")]
        "glb" => replace(path, &super::gltf::write(model)?),
        _ => Err(unknown(extension, "obj, ply and glb to write")),
    }
}

/// The extension in small letters; empty where there is none.
fn extension(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}

fn unknown(name: String, known: &'static str) -> MeshError {
    MeshError::new(MeshErrorKind::Format { name, known })
}

/// The content of another file by its name in a file, if it is in the folder of that or deeper.
#[cfg(any(feature = "obj", feature = "gltf"))]
fn beside(path: &Path, name: &str, left: &mut u64) -> Option<Vec<u8>> {
    use std::path::Component;
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let name = Path::new(name);
    if !name.components().all(inside) {
        return None;
    }
    let bytes = read_at_most(&path.with_file_name("").join(name), *left).ok()?;
    *left -= bytes.len() as u64;
    Some(bytes)
}

fn read(path: &Path) -> Result<Vec<u8>, MeshError> {
    read_at_most(path, BYTES_MAX)
}

fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, MeshError> {
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

fn failed(path: &Path, error: &io::Error) -> MeshError {
    let (path, why) = (path.display().to_string(), error.to_string());
    MeshError::new(MeshErrorKind::Io { path, why })
}

/// Makes `bytes` the content of the file at `path`, which is new or the old one until all of it is written.
///
/// A file that is there keeps its permissions, and one that a link leads to, the link.
#[cfg(any(feature = "obj", feature = "ply", feature = "gltf"))]
fn replace(path: &Path, bytes: &[u8]) -> Result<(), MeshError> {
    write_and_rename(path, bytes).map_err(|error| failed(path, &error))
}

#[cfg(any(feature = "obj", feature = "ply", feature = "gltf"))]
fn write_and_rename(path: &Path, bytes: &[u8]) -> io::Result<()> {
    use std::io::Write as _;
    let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = path.parent().unwrap_or(Path::new(""));
    // Made here, so that its permissions are those of any new file.
    let create = |path: &Path| File::options().write(true).create_new(true).open(path);
    let mut file = tempfile::Builder::new()
        .prefix(".dapple-")
        .make_in(folder, create)?;
    file.as_file_mut().write_all(bytes)?;
    if let Ok(found) = std::fs::metadata(&path) {
        file.as_file().set_permissions(found.permissions())?;
    }
    file.persist(path)?;
    Ok(())
}

#[cfg(all(test, feature = "obj", feature = "ply", feature = "gltf"))]
mod tests;
