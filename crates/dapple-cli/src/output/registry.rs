//! Registry of the temporary files and new directories of this process, which the handler of Ctrl-C removes.
//!
//! Creating and renaming such a file holds the lock of the registry, so that an interrupt is handled before or after
//! it, never in between.

#![expect(
    clippy::disallowed_methods,
    reason = "this module takes files away again"
)]

use crate::error::Exit;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static PATHS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A lock on the registry, with access to its paths.
pub(super) type Held = MutexGuard<'static, Vec<PathBuf>>;

/// Locks the registry. Other threads wait until the guard is dropped.
pub(super) fn hold() -> Held {
    // The list of paths is consistent even if a thread panicked while it held the lock.
    PATHS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Creates a directory and registers it for removal.
pub(super) fn make_folder(folder: &Path) -> io::Result<()> {
    let mut held = hold();
    fs::create_dir(folder)?;
    held.push(folder.to_owned());
    Ok(())
}

/// Removes a path from the registry.
pub(super) fn forget(held: &mut Held, path: &Path) {
    held.retain(|other| other != path);
}

/// Removes all registered files and directories, then exits the process.
pub(crate) fn exit_without_rubbish(exit: Exit) -> ! {
    let held = hold();
    for path in held.iter().rev() {
        // A directory that is not empty remains. Errors cannot be reported at this point.
        let _ = if path.is_dir() {
            fs::remove_dir(path)
        } else {
            fs::remove_file(path)
        };
    }
    std::process::exit(exit as i32)
}
