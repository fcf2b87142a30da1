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
