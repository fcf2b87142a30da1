//! Reads whole files within a size limit, and replaces files atomically.
//!
//! A file is written under a temporary name in the same folder, `.dapple-XXXXXX.part`, and then renamed. Other
//! programs therefore never see a partial file, and the previous content remains if writing fails. The bytes are
//! flushed to the disk before the rename, and the folder is flushed after it. After a write has been reported as done,
//! a power cut leaves the new file. Before that, it leaves the old or the new file, never an empty one. (Pillai et
//! al., "All File Systems Are Not Created Equal", OSDI 2014, describes the failures without these steps.)
//!
//! The process that writes a file holds a lock on it, which the operating system releases however the process ends. A
//! temporary file without a lock is a leftover, and [`remove_left_behind`] removes it.

#![expect(
    clippy::disallowed_methods,
    reason = "this crate is where images meet files"
)]

use crate::{ImageError, ImageErrorKind};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::Path;
use tempfile::{Builder, NamedTempFile};

/// Prefix of temporary names.
const PREFIX: &str = ".dapple-";
/// Suffix of temporary names.
const SUFFIX: &str = ".part";

/// Reads a regular file of at most `limit` bytes.
pub(crate) fn read(path: &Path, limit: u64) -> Result<Vec<u8>, ImageError> {
    let io = |error: io::Error| ImageError::new(ImageErrorKind::Io).because(error);
    let too_many = |bytes| ImageError::new(ImageErrorKind::TooManyBytes { bytes, limit });
    let read = || {
        let file = open_regular(path).map_err(io)?;
        let bytes = file.metadata().map_err(io)?.len();
        if bytes > limit {
            return Err(too_many(bytes));
        }
        // Some system files report no length, so stop reading one byte past the limit.
        let mut content = Vec::with_capacity(usize::try_from(bytes).unwrap_or(0));
        let mut file = file.take(limit.saturating_add(1));
        file.read_to_end(&mut content).map_err(io)?;
        match content.len() as u64 {
            bytes if bytes > limit => Err(too_many(bytes)),
            _ => Ok(content),
        }
    };
    read().map_err(|error: ImageError| error.at(path))
}

/// Opens a regular file for reading and follows links. It never blocks, which opening a named pipe could do.
///
/// # Errors
///
/// [`io::ErrorKind::IsADirectory`] for a folder, [`io::ErrorKind::InvalidInput`] for a device, a pipe or a socket, or
/// any other error from the operating system.
pub fn open_regular(path: impl AsRef<Path>) -> io::Result<File> {
    let path = path.as_ref();
    check_regular(&fs::metadata(path)?)?;
    let mut options = File::options();
    options.read(true);
    // The file may have been replaced by a pipe since the check, so open without blocking and check again.
    let file = without_waiting(&mut options).open(path)?;
    check_regular(&file.metadata()?)?;
    Ok(file)
}

fn check_regular(found: &fs::Metadata) -> io::Result<()> {
    if found.is_file() {
        return Ok(());
    }
    let (kind, what) = if found.is_dir() {
        let what = "it is a folder, and not a regular file";
        (io::ErrorKind::IsADirectory, what)
    } else {
        let what = "it is a device, a pipe or a socket, and not a regular file";
        (io::ErrorKind::InvalidInput, what)
    };
    Err(io::Error::new(kind, what))
}

/// Sets options so that opening a pipe or device does not block.
fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(options, libc::O_NONBLOCK);
    options
}

/// A file that is written under a temporary name in its final folder and then renamed. If the value is dropped before
/// the rename, the temporary file is removed.
///
/// The steps of a commit are: write all bytes into [`file`](Self::file), [`sync`](Self::sync),
/// [`rename`](Self::rename), then [`sync_folder`]. For several files, sync all of them first, then rename them in
/// sequence.
///
/// # Examples
///
/// ```
/// use dapple_image::{AtomicFile, sync_folder};
/// use std::io::Write;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("heights.bin");
/// let new = AtomicFile::beside(&path)?;
/// new.file().write_all(b"all of it")?;
/// new.sync(&path)?;
/// assert!(!path.exists());
/// new.rename(&path, true)?;
/// sync_folder(folder.path())?;
/// assert_eq!(std::fs::read(&path)?, b"all of it");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct AtomicFile(NamedTempFile);

impl AtomicFile {
    /// Creates and locks an empty file in the folder of `path`, with the default permissions of new files.
    ///
    /// # Errors
    ///
    /// If the operating system fails, for example because there is no such folder.
    pub fn beside(path: &Path) -> io::Result<Self> {
        let mut builder = Builder::new();
        let file = builder.prefix(PREFIX).suffix(SUFFIX);
        Ok(Self(file.make_in(folder(path), create_locked)?))
    }

    /// Returns the temporary path.
    #[must_use]
    pub fn temporary_path(&self) -> &Path {
        self.0.path()
    }

    /// Returns the file, open for reading and writing.
    #[must_use]
    pub fn file(&self) -> &File {
        self.0.as_file()
    }

    /// Flushes the bytes to the disk. If a file exists at `path`, its permissions are copied first.
    ///
    /// # Errors
    ///
    /// If the operating system fails, for example because the disk is full.
    pub fn sync(&self, path: &Path) -> io::Result<()> {
        if let Ok(found) = fs::metadata(path) {
            self.file().set_permissions(found.permissions())?;
        }
        tolerate_unsupported(self.file().sync_all())
    }

    /// Renames the file to `path`. An existing file is replaced only if `may_replace`.
    ///
    /// # Errors
    ///
    /// [`io::ErrorKind::AlreadyExists`] if there is a file that may not be replaced, or any other error from the
    /// operating system.
    pub fn rename(self, path: &Path, may_replace: bool) -> io::Result<()> {
        if may_replace {
            self.0.persist(path)?;
            return Ok(());
        }
        if let Err(refused) = self.0.persist_noclobber(path) {
            // Not every file system can rename without replacing. In this case, check for the name before the rename.
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
}

/// Flushes the entries of a folder to the disk: renamed files and new folders.
///
/// Does nothing on systems other than Unix, which flush names themselves. A folder without read permission is skipped.
///
/// # Errors
///
/// If writing to the disk fails.
pub fn sync_folder(path: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    let path = if path.as_os_str().is_empty() {
        Path::new(".")
    } else {
        path
    };
    match File::open(path) {
        Ok(folder) => tolerate_unsupported(folder.sync_all()),
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => Ok(()),
        Err(error) => Err(error),
    }
}

/// Ignores the error of a file system that does not support flushing.
fn tolerate_unsupported(synced: io::Result<()>) -> io::Result<()> {
    use io::ErrorKind::{InvalidInput, Unsupported};
    match synced {
        Err(error) if matches!(error.kind(), InvalidInput | Unsupported) => Ok(()),
        synced => synced,
    }
}

/// Removes temporary files that terminated processes left behind in the folder of `path`. Errors are ignored: a
/// folder that cannot be read is reported when the file is written.
pub fn remove_left_behind(path: &Path) {
    let Ok(entries) = fs::read_dir(folder(path)) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        let is_ours = name.starts_with(PREFIX.as_bytes()) && name.ends_with(SUFFIX.as_bytes());
        // A link or a pipe may have such a name, and opening a pipe would block.
        if !is_ours || !entry.file_type().is_ok_and(|found| found.is_file()) {
            continue;
        }
        // Open for writing, since some file systems lock only files that are open for writing.
        let mut options = File::options();
        options.write(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::custom_flags(
            &mut options,
            libc::O_NONBLOCK | libc::O_NOFOLLOW,
        );
        // Hold the lock during the removal; otherwise another process could lock the file in between.
        if let Ok(file) = options.open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Replaces the content of the file at `path` with `bytes`. The change is atomic, and on the disk when the function
/// returns.
///
/// An existing file keeps its permissions. If `path` is a link, its target is replaced.
///
/// # Errors
///
/// [`ImageErrorKind::Io`] with the path, if the folder does not exist or the operating system fails.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    write_and_rename(path, bytes)
        .map_err(|error| ImageError::new(ImageErrorKind::Io).because(error).at(path))
}

fn write_and_rename(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let new = AtomicFile::beside(&path)?;
    new.file().write_all(bytes)?;
    new.sync(&path)?;
    new.rename(&path, true)?;
    sync_folder(folder(&path))
}

/// Returns the folder of a file; `.` for a bare name.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Creates and locks a file, with the default permissions of new files.
fn create_locked(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    let file = options.read(true).write(true).create_new(true).open(path)?;
    match file.try_lock() {
        // The file system has no locks, so no process can take the file for a leftover.
        Ok(()) | Err(TryLockError::Error(_)) if path.exists() => Ok(file),
        // Another process removed the file as a leftover; the error makes the caller try another name.
        _ => Err(io::ErrorKind::AlreadyExists.into()),
    }
}
