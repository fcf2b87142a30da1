//! A file under a temporary name, beside the one that it is to become.
//!
//! `height.png` is written as `.height.png.<process>-<count>.part`. As long as its process lives, that holds a lock on it,
//! which the operating system gives up however the process ends. So a file that nobody has a lock on was left behind, as by
//! `kill -9`, and the next run that writes the same name takes it away.

#![expect(
    clippy::disallowed_methods,
    reason = "this module makes and renames files"
)]

use super::registry::{self, Held};
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// How the temporary names end.
const ENDING: &str = ".part";
/// How many names are tried.
const ATTEMPTS: usize = 16;

/// An open temporary file with a lock on it.
#[derive(Debug)]
pub(super) struct Temporary {
    path: PathBuf,
    file: File,
}

impl Temporary {
    /// A new file in the folder of `path`.
    pub(super) fn beside(path: &Path) -> io::Result<Self> {
        let mut held = registry::hold();
        for _ in 0..ATTEMPTS {
            let path = temporary_name(path);
            let file = File::options()
                .read(true)
                .write(true)
                .create_new(true)
                .open(&path);
            match file {
                Ok(file) if keeps(&file, &path) => {
                    held.push(path.clone());
                    return Ok(Self { path, file });
                }
                // Another process took it for one that was left behind.
                Ok(_) => {}
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other("no temporary name is free"))
    }

    /// The file.
    pub(super) fn file(&self) -> &File {
        &self.file
    }

    /// Makes it the file at `path`, and replaces one that is there only if it may.
    pub(super) fn put(self, held: &mut Held, path: &Path, force: bool) -> io::Result<()> {
        let put = if force {
            fs::rename(&self.path, path)
        } else {
            rename_if_new(&self.path, path)
        };
        if put.is_err() {
            self.remove(held);
        } else {
            registry::forget(held, &self.path);
        }
        put
    }

    /// Takes it away.
    pub(super) fn remove(self, held: &mut Held) {
        // If somebody took it away before, all the better.
        let _ = fs::remove_file(&self.path);
        registry::forget(held, &self.path);
    }
}

/// Takes away what processes that are no more have left of the file at `path`.
pub(super) fn remove_left_behind(path: &Path) {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut start = prefix(path);
    start.push(".");
    // What cannot be read here is of no harm, and will be said where it is written.
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let [name, start] = [&name, &start].map(|name| name.as_encoded_bytes());
        let middle = name
            .strip_prefix(start)
            .and_then(|rest| rest.strip_suffix(ENDING.as_bytes()));
        if !middle.is_some_and(is_process_and_count) {
            continue;
        }
        // Opened for writing, since some file systems lock nothing else.
        let file = File::options().write(true).open(entry.path());
        // The lock is kept while the file goes, or else its maker could get it in between.
        if let Ok(file) = file
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Locks a new file, and says whether it is still there.
fn keeps(file: &File, path: &Path) -> bool {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => false,
        // Where there are no locks, nobody takes a file for one that was left behind.
        Ok(()) | Err(TryLockError::Error(_)) => path.exists(),
    }
}

/// A rename that fails if the new name is taken.
fn rename_if_new(from: &Path, to: &Path) -> io::Result<()> {
    match fs::hard_link(from, to) {
        Ok(()) => {
            // The file has its name; should this fail, the next run does it.
            let _ = fs::remove_file(from);
            Ok(())
        }
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(error),
        // Not every file system has links. What is left then is a look before the rename.
        Err(_) if to.symlink_metadata().is_ok() => Err(io::ErrorKind::AlreadyExists.into()),
        Err(_) => fs::rename(from, to),
    }
}

/// A name in the same folder that nothing else in this process has.
fn temporary_name(path: &Path) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut name = prefix(path);
    name.push(format!(".{}-{count}{ENDING}", std::process::id()));
    path.with_file_name(name)
}

/// What the temporary names of a file begin with.
fn prefix(path: &Path) -> OsString {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name
}

/// Whether it is two numbers with a dash between, as `4711-0`.
fn is_process_and_count(middle: &[u8]) -> bool {
    let numbers: Vec<_> = middle.split(|&byte| byte == b'-').collect();
    let is_number = |digits: &&[u8]| !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
    numbers.len() == 2 && numbers.iter().all(is_number)
}
