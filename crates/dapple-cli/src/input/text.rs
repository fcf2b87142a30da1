//! Text in UTF-8.

use super::files::{check_file, name};
use crate::error::Hint;
use anyhow::{Context, Result, anyhow};
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// The maximum number of bytes of a text.
const TEXT_MAX: u64 = 1 << 28;
/// The character that some editors put before a text.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Reads a text; `-` is standard input.
///
/// # Errors
///
/// If there is no such file, it is too long, or it is not UTF-8.
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
    decoded(bytes).with_context(|| name(path))
}

/// The text in some bytes in UTF-8, without a byte order mark.
fn decoded(bytes: Vec<u8>) -> Result<String> {
    let found = match bytes.as_slice() {
        // The mark of UTF-32 in little endian begins like that of UTF-16.
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("UTF-16"),
        _ => None,
    };
    if let Some(found) = found {
        return Err(anyhow!("the text is in {found}, and not in UTF-8").hint("save it as UTF-8"));
    }
    let text = String::from_utf8(bytes).map_err(|_| anyhow!("it is not a text in UTF-8"))?;
    Ok(text.trim_start_matches(BYTE_ORDER_MARK).to_owned())
}
