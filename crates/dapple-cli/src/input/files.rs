//! Checks paths before their files are read, and formats the names of inputs for messages.

use super::NAMES_MAX;
use crate::error::Hint;
use anyhow::{Context, Result, anyhow};
use dapple::recipe::similar_words;
use std::fs;
use std::io;
use std::path::Path;

/// Returns the name of an input for messages.
pub(crate) fn name(path: &Path) -> String {
    if path == Path::new("-") {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

/// Returns an error if a path does not exist, or is a directory, a device or an empty file.
pub(super) fn check_file(path: &Path, what: &str) -> Result<()> {
    let found = match fs::metadata(path) {
        Ok(found) => found,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let error = anyhow!("{}: there is no such file", path.display());
            return Err(match similar_names(path).as_slice() {
                [] => error,
                names => error.hint(format!("there is {}", names.join(", "))),
            });
        }
        Err(error) => {
            return Err(error).with_context(|| format!("{} cannot be read", path.display()));
        }
    };
    if found.is_dir() {
        return Err(anyhow!("{} is a folder, and not {what}", path.display()));
    }
    if is_device(&found) {
        return Err(anyhow!("{} is a device, and not {what}", path.display()));
    }
    if found.is_file() && found.len() == 0 {
        return Err(anyhow!("{} is empty, and not {what}", path.display()));
    }
    Ok(())
}

/// Returns whether a file is a device or a socket, from which reading may never end. Pipes are accepted, since the user
/// has created them.
#[cfg(unix)]
fn is_device(found: &fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    let kind = found.file_type();
    kind.is_char_device() || kind.is_block_device() || kind.is_socket()
}

#[cfg(not(unix))]
fn is_device(_: &fs::Metadata) -> bool {
    false
}

/// Checks that a path is a regular file. The path is named by an input file rather than on the command line, so a pipe
/// or a device could block the command forever.
///
/// # Errors
///
/// If the path does not exist, or is not a regular file.
pub(crate) fn check_regular(path: &Path, what: &str) -> Result<()> {
    check_file(path, what)?;
    dapple::image::open_regular(path)
        .map(drop)
        .with_context(|| format!("{} cannot be read as {what}", path.display()))
}

/// Returns the names in a path's directory that are similar to its file name, most similar first.
fn similar_names(path: &Path) -> Vec<String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new(""));
    let listed = if folder.as_os_str().is_empty() {
        fs::read_dir(".")
    } else {
        fs::read_dir(folder)
    };
    let entries = listed.into_iter().flatten().flatten();
    let others: Vec<_> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    let names = similar_words(&name, others.iter().map(String::as_str)).into_iter();
    names
        .take(NAMES_MAX)
        .map(|name| folder.join(name).display().to_string())
        .collect()
}
