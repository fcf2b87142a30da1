//! Lines and numbers of text.

use crate::MeshError;
#[cfg(any(feature = "obj", feature = "ply"))]
use core::fmt::Write as _;
use core::str::FromStr;
#[cfg(any(feature = "obj", feature = "off"))]
use glam::DVec3;

/// A line that has something to say.
#[cfg(any(feature = "obj", feature = "off"))]
pub(super) struct Line<'a> {
    format: &'static str,
    /// From 1.
    number: usize,
    /// The words; at least one.
    pub(super) words: Vec<&'a [u8]>,
}

/// The lines of a text without comments, which begin with `#`, and without those where nothing else is.
#[cfg(any(feature = "obj", feature = "off"))]
pub(super) fn lines<'a>(format: &'static str, bytes: &'a [u8]) -> impl Iterator<Item = Line<'a>> {
    let lines = bytes.split(|&byte| byte == b'\n').zip(1..);
    lines.filter_map(move |(line, number)| {
        let words: Vec<_> = words(line.split(|&byte| byte == b'#').next()?).collect();
        (!words.is_empty()).then_some(Line {
            format,
            number,
            words,
        })
    })
}

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

/// The triangles around the first corner of a polygon.
pub(super) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    let pairs = corners.iter().skip(1).zip(corners.iter().skip(2));
    pairs.map(|(&b, &c)| [corners[0], b, c])
}

#[cfg(any(feature = "obj", feature = "off"))]
impl Line<'_> {
    /// The number at a place.
    pub(super) fn number(&self, at: usize) -> Result<f64, MeshError> {
        let word = self.words.get(at).copied();
        word.and_then(parse)
            .ok_or_else(|| self.error(format!("a number is needed in place {}", at + 1)))
    }

    /// The three numbers from a place on.
    pub(super) fn vector(&self, at: usize) -> Result<DVec3, MeshError> {
        Ok(DVec3::new(
            self.number(at)?,
            self.number(at + 1)?,
            self.number(at + 2)?,
        ))
    }

    /// Says what is wrong with the line.
    pub(super) fn error(&self, why: impl core::fmt::Display) -> MeshError {
        MeshError::file(self.format, format!("line {}: {why}", self.number))
    }
}
