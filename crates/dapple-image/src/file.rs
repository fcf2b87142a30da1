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

#[cfg(test)]
mod tests {
    use super::{read, replace};
    use crate::ImageErrorKind;
    use std::error::Error;
    use std::fs;
    use std::path::PathBuf;

    /// An empty folder of its own for a test.
    fn folder(name: &str) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("dapple-image-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let folder = folder("replace");
        let path = folder.join("a.png");
        for content in [b"first".as_slice(), b"second, longer", b"3"] {
            replace(&path, content).unwrap();
            assert_eq!(read(&path, 100).unwrap(), content, "the content");
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "one file");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_longest_name_of_a_file_system_can_be_written() {
        let folder = folder("long");
        let path = folder.join(format!("{}.png", "n".repeat(251)));
        replace(&path, b"content").unwrap();
        assert_eq!(read(&path, 10).unwrap(), b"content", "255 bytes");
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = folder("kept");
        let (file, link) = (folder.join("a.png"), folder.join("link.png"));
        fs::write(&file, b"old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        replace(&link, b"new").unwrap();
        assert!(link.is_symlink(), "the link stays");
        assert_eq!(read(&file, 10).unwrap(), b"new", "where it leads to");
        let mode = fs::metadata(&file).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640, "the permissions stay");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_failed_write_leaves_what_was_there() {
        let folder = folder("failed");
        let taken = folder.join("taken");
        fs::create_dir_all(taken.join("inside")).unwrap();
        for path in [taken.clone(), folder.join("missing").join("a.png")] {
            let error = replace(&path, b"content").unwrap_err();
            assert_eq!(error.kind(), &ImageErrorKind::Io, "{error}");
            assert_eq!(error.path(), Some(path.as_path()), "{error}");
            assert!(error.source().is_some(), "{error}");
        }
        assert!(taken.join("inside").is_dir(), "the folder is untouched");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing else");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_file_past_the_limit_is_refused() {
        let folder = folder("limit");
        let path = folder.join("ten");
        replace(&path, b"0123456789").unwrap();
        assert_eq!(read(&path, 10).unwrap().len(), 10, "exactly the limit");
        let error = read(&path, 9).unwrap_err();
        let expected = ImageErrorKind::TooManyBytes {
            bytes: 10,
            limit: 9,
        };
        assert_eq!(error.kind(), &expected, "one more");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_missing_file_is_an_error_with_a_source() {
        let error = read(&std::env::temp_dir().join("dapple-image-none"), 10).unwrap_err();
        assert_eq!(error.kind(), &ImageErrorKind::Io, "{error}");
        let source = error
            .source()
            .and_then(|source| source.downcast_ref::<std::io::Error>());
        assert_eq!(
            source.map(std::io::Error::kind),
            Some(std::io::ErrorKind::NotFound),
            "{error}"
        );
    }
}
