//! Reads text in UTF-8.

use super::files::{check_file, name};
use crate::error::Hint;
use anyhow::{Context, Result, anyhow};
use dapple::raster::text::decode;
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// Maximum size of a text, in bytes.
const TEXT_MAX: u64 = 1 << 28;

/// Reads a text, without its byte order mark; `-` is standard input.
///
/// # Errors
///
/// If the file does not exist, is too long, or is not UTF-8.
pub(crate) fn text(path: &Path) -> Result<String> {
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        io::stdin()
            .lock()
            .take(TEXT_MAX + 1)
            .read_to_end(&mut bytes)
    } else {
        check_file(path, "a text")?;
        fs::File::open(path).and_then(|file| file.take(TEXT_MAX + 1).read_to_end(&mut bytes))
    };
    read.with_context(|| format!("{} cannot be read", path.display()))?;
    if bytes.len() as u64 > TEXT_MAX {
        return Err(anyhow!("{} has more than {TEXT_MAX} bytes", path.display()));
    }
    let text = decode(&bytes).map(str::to_owned);
    text.hint("save it as UTF-8").with_context(|| name(path))
}
