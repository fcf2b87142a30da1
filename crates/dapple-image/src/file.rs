//! Access to files: reading a whole file within a limit, and replacing one as a whole.
//!
//! A file is written under a temporary name beside its own and then renamed. So no program ever sees half of it, and
//! the previous content remains if writing fails.

#![expect(
    clippy::disallowed_methods,
    reason = "this crate is where images meet files"
)]

use crate::{ImageError, ImageErrorKind};
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;
use tempfile::Builder;

/// All bytes of a file with at most `limit` bytes.
pub(crate) fn read(path: &Path, limit: u64) -> Result<Vec<u8>, ImageError> {
    let io = |error: io::Error| ImageError::new(ImageErrorKind::Io).because(error);
    let mut bytes = Vec::new();
    // The length of a device or a pipe is unknown, so the reader stops by itself, one byte past the limit.
    File::open(path)
        .and_then(|file| file.take(limit.saturating_add(1)).read_to_end(&mut bytes))
        .map_err(|error| io(error).at(path))?;
    if bytes.len() as u64 > limit {
        let bytes = bytes.len() as u64;
        return Err(ImageError::new(ImageErrorKind::TooManyBytes { bytes, limit }).at(path));
    }
    Ok(bytes)
}

/// Replaces the content of the file at `path` with `bytes`: it changes from the old to the new content at once.
///
/// An existing file keeps its permissions; if `path` is a link, the file that it leads to is replaced.
///
/// # Errors
///
/// [`ImageErrorKind::Io`] with the path, if the folder does not exist or the system fails.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    write_and_rename(path, bytes)
        .map_err(|error| ImageError::new(ImageErrorKind::Io).because(error).at(path))
}

fn write_and_rename(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = path.parent().unwrap_or(Path::new(""));
    // Created here, so that its permissions are those of any new file.
    let create = |path: &Path| File::options().write(true).create_new(true).open(path);
    let mut file = Builder::new().prefix(".dapple-").make_in(folder, create)?;
    file.as_file_mut().write_all(bytes)?;
    if let Ok(found) = fs::metadata(&path) {
        file.as_file().set_permissions(found.permissions())?;
    }
    file.persist(path)?;
    Ok(())
}
