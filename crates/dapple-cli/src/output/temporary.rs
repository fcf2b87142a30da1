//! A file under a temporary name, in the folder of its final name.
//!
//! Its name is `.dapple-`, six letters and `.part`. Its process holds a lock on it, which the operating system releases
//! however the process ends. So a file without a lock was left behind, for example by `kill -9`, and the next run that
//! writes into the same folder removes it.

#![expect(
    clippy::disallowed_methods,
    reason = "this module makes and renames files"
)]

use super::registry::{self, Held};
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// The beginning of the temporary names.
const PREFIX: &str = ".dapple-";
/// The end of the temporary names.
const SUFFIX: &str = ".part";

/// An open temporary file with a lock on it.
#[derive(Debug)]
pub(super) struct Temporary(NamedTempFile);

impl Temporary {
    /// A new file in the folder of `path`.
    pub(super) fn beside(path: &Path) -> io::Result<Self> {
        let mut held = registry::hold();
        let mut builder = Builder::new();
        let file = builder.prefix(PREFIX).suffix(SUFFIX);
        let file = file.make_in(folder(path), create_locked)?;
        held.push(file.path().to_owned());
        Ok(Self(file))
    }

    /// The file.
    pub(super) fn file(&self) -> &File {
        self.0.as_file()
    }

    /// Renames it to `path`; an existing file is replaced only with `force`, and keeps its permissions.
    pub(super) fn put(self, held: &mut Held, path: &Path, force: bool) -> io::Result<()> {
        registry::forget(held, self.0.path());
        if force {
            if let Ok(found) = fs::metadata(path) {
                self.file().set_permissions(found.permissions())?;
            }
            self.0.persist(path)?;
            return Ok(());
        }
        if let Err(refused) = self.0.persist_noclobber(path) {
            // Not every file system can rename without replacing. There, the name is checked before the rename.
            if refused.error.kind() == io::ErrorKind::AlreadyExists {
                return Err(refused.error);
            }
            if path.symlink_metadata().is_ok() {
                return Err(io::ErrorKind::AlreadyExists.into());
            }
            refused.file.persist(path)?;
        }
        Ok(())
    }

    /// Removes the file.
    pub(super) fn remove(self, held: &mut Held) {
        registry::forget(held, self.0.path());
    }
}

/// Removes the temporary files that ended processes have left in the folder of `path`.
pub(super) fn remove_left_behind(path: &Path) {
    // A folder that cannot be read is reported when the file is written.
    let Ok(entries) = fs::read_dir(folder(path)) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        if !name.starts_with(PREFIX.as_bytes()) || !name.ends_with(SUFFIX.as_bytes()) {
            continue;
        }
        // Opened for writing, since some file systems only lock files open for writing.
        let file = File::options().write(true).open(entry.path());
        // The lock is held during the removal, or else another process could lock the file in between.
        if let Ok(file) = file
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The folder of a file.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Creates a file and locks it. Its permissions are those of any new file.
fn create_locked(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    let file = options.read(true).write(true).create_new(true).open(path)?;
    match file.try_lock() {
        // Without locks, no process takes a file for one that was left behind.
        Ok(()) | Err(TryLockError::Error(_)) if path.exists() => Ok(file),
        // Another process has removed it as left behind, so that another name is tried.
        _ => Err(io::ErrorKind::AlreadyExists.into()),
    }
}
