//! Splits text into lines and words, for line-based formats.

use super::text::{content, in_range, parse, words};
use crate::MeshIoError;
use glam::DVec3;

/// A non-empty line, split into words.
pub(crate) struct Line<'a> {
    format: &'static str,
    /// Line number, starting at 1. If several lines are joined, it is the number of the last one.
    number: usize,
    /// The text of the whole line.
    text: &'a [u8],
    /// Words before a comment; at least one.
    pub(crate) words: Vec<&'a [u8]>,
}

/// Returns the lines of a text, without empty lines and without comments (which start with `#`).
///
/// Fails if the text is neither ASCII nor UTF-8.
pub(crate) fn lines<'a>(
    format: &'static str,
    bytes: &'a [u8],
) -> Result<impl Iterator<Item = Line<'a>>, MeshIoError> {
    let lines = content(format, bytes)?
        .split(|&byte| byte == b'\n')
        .zip(1..);
    Ok(lines.filter_map(move |(text, number)| {
        let words: Vec<_> = words(text.split(|&byte| byte == b'#').next()?).collect();
        (!words.is_empty()).then_some(Line {
            format,
            number,
            text,
            words,
        })
    }))
}

impl Line<'_> {
    /// Returns the first word, which must be ASCII. A keyword with another byte, such as one joined to its numbers by
    /// a no-break space, would be skipped as unknown, and all later indices would be off by one.
    pub(crate) fn keyword(&self) -> Result<&[u8], MeshIoError> {
        let word = self.words[0];
        if word.is_ascii() {
            return Ok(word);
        }
        let word = String::from_utf8_lossy(word);
        Err(self.error(format!(
            "the keyword `{}` is not ASCII",
            word.escape_debug()
        )))
    }

    /// Parses word `at` as a number.
    pub(crate) fn number(&self, at: usize) -> Result<f64, MeshIoError> {
        let word = self.words.get(at).copied();
        word.and_then(parse)
            .ok_or_else(|| self.error(format!("a number is needed in place {}", at + 1)))
    }

    /// Parses word `at` as a component of a position, a normal or a texture coordinate.
    pub(crate) fn part(&self, at: usize) -> Result<f64, MeshIoError> {
        in_range(self.number(at)?).map_err(|why| self.error(why))
    }

    /// Parses three words, starting with word `at`, as a position or normal.
    pub(crate) fn position(&self, at: usize) -> Result<DVec3, MeshIoError> {
        let [x, y, z] = [at, at + 1, at + 2].map(|at| self.part(at));
        Ok(DVec3::new(x?, y?, z?))
    }

    /// Parses three words, starting with word `at`, as numbers without a range check.
    pub(crate) fn vector(&self, at: usize) -> Result<DVec3, MeshIoError> {
        Ok(DVec3::new(
            self.number(at)?,
            self.number(at + 1)?,
            self.number(at + 2)?,
        ))
    }

    /// Returns all words after the first, including those after `#`, which a name may contain.
    pub(crate) fn name_words(&self) -> Vec<&[u8]> {
        words(self.text).skip(1).collect()
    }

    /// Appends the words of the next line, for a line that continues there.
    pub(crate) fn extend(&mut self, next: Self) {
        self.number = next.number;
        self.words.extend(next.words);
    }

    /// Creates an error about this line that states its number.
    pub(crate) fn error(&self, why: impl core::fmt::Display) -> MeshIoError {
        MeshIoError::file(self.format, format!("line {}: {why}", self.number))
    }
}
