//! Parsing and formatting of words and numbers.

use core::fmt::Display;
use core::fmt::Write as _;
use core::str::FromStr;
use dapple_mesh::POSITION_MAX;

/// The words of a text, separated by white space.
pub(crate) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// Parses a word as a number.
pub(crate) fn parse<T: FromStr>(word: &[u8]) -> Option<T> {
    core::str::from_utf8(word).ok()?.parse().ok()
}

/// Checks the range of a component of a position, a normal or a texture coordinate; the error is the reason.
pub(crate) fn in_range(part: f64) -> Result<f64, String> {
    if part.abs() <= POSITION_MAX {
        return Ok(part);
    }
    Err(format!(
        "a number is {part:e}, but it must be between -1e30 and 1e30"
    ))
}

/// The message for a corner with a vertex that does not exist.
pub(crate) fn no_vertex(vertex: impl Display, count: impl Display) -> String {
    format!("a corner of a face is vertex {vertex}, but there are {count}")
}

/// Appends the shortest text that reads back as the same number, with an exponent where there would be many zeros.
pub(crate) fn shortest(text: &mut String, number: f64) {
    let plain = number == 0.0 || (1e-5..1e16).contains(&number.abs());
    // Writing to a string cannot fail.
    let _ = if plain {
        write!(text, "{number}")
    } else {
        write!(text, "{number:e}")
    };
}
