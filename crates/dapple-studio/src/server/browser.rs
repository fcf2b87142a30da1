//! Opens the browser without showing the secret of the run to other users of the machine.
//!
//! The arguments of a program can be read by every user, and an address is an argument of the browser. So the browser is
//! given a file that only its owner can read, and that leads to the address, as in Jupyter (CVE-2018-8768 and the change
//! after it).

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tempfile::{Builder, NamedTempFile, TempPath};

/// A file that leads to the address of the page. It is removed when the page is there.
#[derive(Default)]
pub(super) struct Way {
    file: Mutex<Option<TempPath>>,
}

/// The longest time for which the file is kept.
pub(super) const LONGEST: Duration = Duration::from_secs(60);

impl Way {
    /// Opens an address in the browser of the user. Where there is none, the address was printed.
    pub(super) fn open(&self, url: &str) {
        let Ok(file) = write(url) else { return };
        // Also where it cannot be opened: `close` removes it.
        let _ = open::that_detached(&*file);
        *self.lock() = Some(file);
    }

    /// Removes the file: the page is there.
    pub(super) fn close(&self) {
        drop(self.lock().take());
    }

    fn lock(&self) -> MutexGuard<'_, Option<TempPath>> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Writes the file that leads to an address.
fn write(url: &str) -> io::Result<TempPath> {
    let url = url.replace('&', "&amp;").replace('"', "&quot;");
    let mut file = home_of_snaps()
        .and_then(|home| create(&home).ok())
        .map_or_else(|| create(&std::env::temp_dir()), Ok)?;
    writeln!(
        file,
        "<!doctype html><html lang=en><meta charset=utf-8><meta name=referrer content=no-referrer>\
         <title>dapple studio</title><meta http-equiv=refresh content=\"0;url={url}\">\
         <p><a href=\"{url}\">dapple studio</a></p>"
    )?;
    file.flush()?;
    Ok(file.into_temp_path())
}

/// Creates a file that only this user can read, under a name that nobody can guess.
fn create(folder: &Path) -> io::Result<NamedTempFile> {
    Builder::new()
        .prefix("dapple-studio-")
        .suffix(".html")
        .tempfile_in(folder)
}

/// The home of a user with programs from snaps: these see neither the folder of temporary files nor hidden folders.
fn home_of_snaps() -> Option<PathBuf> {
    let home = PathBuf::from(std::env::var_os("HOME")?);
    home.join("snap").is_dir().then_some(home)
}
