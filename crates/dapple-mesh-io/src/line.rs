//! Lines of text, for formats in which a line says one thing.

use super::text::{in_range, parse, words};
use crate::MeshIoError;
use glam::DVec3;

/// A line that has something to say.
pub(crate) struct Line<'a> {
    format: &'static str,
    /// The number of the line, from 1; of several lines that go together, the last.
    number: usize,
    /// All of it.
    text: &'a [u8],
    /// The words before a comment; at least one.
    pub(crate) words: Vec<&'a [u8]>,
}

/// The lines of a text without comments, which begin with `#`, and without those where nothing else is.
pub(crate) fn lines<'a>(format: &'static str, bytes: &'a [u8]) -> impl Iterator<Item = Line<'a>> {
    let lines = bytes.split(|&byte| byte == b'\n').zip(1..);
    lines.filter_map(move |(text, number)| {
        let words: Vec<_> = words(text.split(|&byte| byte == b'#').next()?).collect();
        (!words.is_empty()).then_some(Line {
            format,
            number,
            text,
            words,
        })
    })
}

impl Line<'_> {
    /// The number at a place.
    pub(crate) fn number(&self, at: usize) -> Result<f64, MeshIoError> {
        let word = self.words.get(at).copied();
        word.and_then(parse)
            .ok_or_else(|| self.error(format!("a number is needed in place {}", at + 1)))
    }

    /// The part of a position, a normal or a texture coordinate at a place.
    pub(crate) fn part(&self, at: usize) -> Result<f64, MeshIoError> {
        in_range(self.number(at)?).map_err(|why| self.error(why))
    }

    /// The position or normal in the three numbers from a place on.
    pub(crate) fn position(&self, at: usize) -> Result<DVec3, MeshIoError> {
        let [x, y, z] = [at, at + 1, at + 2].map(|at| self.part(at));
        Ok(DVec3::new(x?, y?, z?))
    }

    /// The three numbers from a place on, whatever they are.
    pub(crate) fn vector(&self, at: usize) -> Result<DVec3, MeshIoError> {
        Ok(DVec3::new(
            self.number(at)?,
            self.number(at + 1)?,
            self.number(at + 2)?,
        ))
    }

    /// All words behind the first, also those in what may be a comment: a name may have `#`.
    pub(crate) fn name_words(&self) -> Vec<&[u8]> {
        words(self.text).skip(1).collect()
    }

    /// Puts the words of a line that goes on with this one behind its own.
    pub(crate) fn extend(&mut self, next: Self) {
        self.number = next.number;
        self.words.extend(next.words);
    }

    /// Says what is wrong with the line.
    pub(crate) fn error(&self, why: impl core::fmt::Display) -> MeshIoError {
        MeshIoError::file(self.format, format!("line {}: {why}", self.number))
    }
}
