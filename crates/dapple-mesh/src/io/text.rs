//! Words and numbers of text.

#[cfg(any(feature = "obj", feature = "ply"))]
use core::fmt::Write as _;
use core::str::FromStr;

/// The words of a text: what is between white space.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// The number that a word is.
pub(super) fn parse<T: FromStr>(word: &[u8]) -> Option<T> {
    core::str::from_utf8(word).ok()?.parse().ok()
}

/// Appends the shortest text that reads back as the same number, with an exponent where zeros would be many.
#[cfg(any(feature = "obj", feature = "ply"))]
pub(super) fn shortest(text: &mut String, number: f64) {
    let plain = number == 0.0 || (1e-5..1e16).contains(&number.abs());
    // Writing to a string cannot fail.
    let _ = if plain {
        write!(text, "{number}")
    } else {
        write!(text, "{number:e}")
    };
}
