//! Opens the browser without revealing the token of the run to other users of the machine.
//!
//! Every user can read the arguments of a process, and the address is an argument of the browser. So the browser is
//! given a file that only its owner can read and that redirects to the address, as in Jupyter (CVE-2018-8768 and the
//! change after it).

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tempfile::{Builder, NamedTempFile, TempPath};

/// A temporary file that redirects to the address of the page. It is removed once the page has connected.
#[derive(Default)]
pub(super) struct Way {
    file: Mutex<Option<TempPath>>,
}

/// Maximum lifetime of the temporary file, if no page connects.
pub(super) const LONGEST: Duration = Duration::from_secs(60);

impl Way {
    /// Opens an address in the user's browser. Failures are ignored, since the address is also printed.
    pub(super) fn open(&self, url: &str) {
        let Ok(file) = write(url) else { return };
        // Keep the file even if the browser fails to start: `close` removes it.
        let _ = open::that_detached(&*file);
        *self.lock() = Some(file);
    }

    /// Removes the file once the page has connected.
    pub(super) fn close(&self) {
        drop(self.lock().take());
    }

    fn lock(&self) -> MutexGuard<'_, Option<TempPath>> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Writes the file that redirects to an address.
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

/// Creates a file with a random name that only this user can read.
fn create(folder: &Path) -> io::Result<NamedTempFile> {
    Builder::new()
        .prefix("dapple-studio-")
        .suffix(".html")
        .tempfile_in(folder)
}

/// Returns the user's home folder if snaps are installed. Programs from snaps cannot read the temporary folder or
/// hidden folders.
fn home_of_snaps() -> Option<PathBuf> {
    let home = PathBuf::from(std::env::var_os("HOME")?);
    home.join("snap").is_dir().then_some(home)
}
