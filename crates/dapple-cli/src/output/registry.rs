//! The temporary files and new folders of this process, which an interrupt removes.
//!
//! The handler of Ctrl-C removes all of them. Creating and renaming such a file holds the lock of the registry, so that an
//! interrupt comes before or after it.

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

/// The locked registry.
pub(super) type Held = MutexGuard<'static, Vec<PathBuf>>;

/// Locks the registry.
pub(super) fn hold() -> Held {
    // A list of paths is consistent even if a thread panicked with the lock.
    PATHS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Creates a folder that is removed on an interrupt until it is forgotten.
pub(super) fn make_folder(folder: &Path) -> io::Result<()> {
    let mut held = hold();
    fs::create_dir(folder)?;
    held.push(folder.to_owned());
    Ok(())
}

/// Removes a path from the list.
pub(super) fn forget(held: &mut Held, path: &Path) {
    held.retain(|other| other != path);
}

/// Removes all files and folders on the list, and ends the process.
pub(crate) fn exit_without_rubbish(exit: Exit) -> ! {
    let held = hold();
    for path in held.iter().rev() {
        // A folder that is not empty stays, and an error cannot be reported any more.
        let _ = if path.is_dir() {
            fs::remove_dir(path)
        } else {
            fs::remove_file(path)
        };
    }
    std::process::exit(exit as i32)
}
