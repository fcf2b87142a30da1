//! The two places that touch files: reading all of one within a limit, and replacing one as a whole.
//!
//! A file is written under a temporary name beside its own and then renamed, so that nobody ever sees half of it, and
//! what was there before stays if writing fails.

#![expect(
    clippy::disallowed_methods,
    reason = "this crate is where images meet files"
)]

use crate::{ImageError, ImageErrorKind};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// All bytes of a file, if there are at most `limit`.
pub(crate) fn read(path: &Path, limit: u64) -> Result<Vec<u8>, ImageError> {
    let io = |error: io::Error| ImageError::new(ImageErrorKind::Io).because(error);
    let mut bytes = Vec::new();
    // A device or a pipe has no length to trust, so the reader stops by itself, one byte past the limit.
    File::open(path)
        .and_then(|file| file.take(limit.saturating_add(1)).read_to_end(&mut bytes))
        .map_err(|error| io(error).at(path))?;
    if bytes.len() as u64 > limit {
        let bytes = bytes.len() as u64;
        return Err(ImageError::new(ImageErrorKind::TooManyBytes { bytes, limit }).at(path));
    }
    Ok(bytes)
}

/// Makes `bytes` the content of the file at `path`, which is new or the old one until all of it is written.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    let temporary = temporary_beside(path);
    write_and_rename(&temporary, path, bytes).map_err(|error| {
        // What remains is of no use, and the first error is the one to report.
        let _ = fs::remove_file(&temporary);
        ImageError::new(ImageErrorKind::Io).because(error).at(path)
    })
}

fn write_and_rename(temporary: &Path, path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::options()
        .write(true)
        .create_new(true)
        .open(temporary)?;
    file.write_all(bytes)?;
    // Closed first, since not every system renames an open file.
    drop(file);
    fs::rename(temporary, path)
}

/// A name in the same folder that no other call, in this process or another, has at the same time.
fn temporary_beside(path: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}-{count}.tmp", std::process::id()));
    path.with_file_name(name)
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
