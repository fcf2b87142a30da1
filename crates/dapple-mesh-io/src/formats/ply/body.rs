//! Reads the body of a PLY file, which holds the values after the header.

use super::FORMAT;
use super::header::{Element, Encoding, Kind, Scalar};
use crate::MeshIoError;
use crate::text::{in_range, parse};
use core::fmt::Display;

/// The rest of the file after the header that has not been read yet.
pub(super) struct Body<'a> {
    encoding: Encoding,
    /// The whole file, including its header.
    bytes: &'a [u8],
    rest: &'a [u8],
}

impl<'a> Body<'a> {
    pub(super) fn new(encoding: Encoding, bytes: &'a [u8], rest: &'a [u8]) -> Self {
        Self {
            encoding,
            bytes,
            rest,
        }
    }

    /// Creates an error about the values that were read last, with the line number if the body is text.
    pub(super) fn error(&self, why: impl Display) -> MeshIoError {
        if self.encoding != Encoding::Text {
            return MeshIoError::file(FORMAT, why.to_string());
        }
        let read = &self.bytes[..self.bytes.len() - self.rest.len()];
        let ends = read.trim_ascii_end().iter().filter(|&&byte| byte == b'\n');
        MeshIoError::file(FORMAT, format!("line {}: {why}", ends.count() + 1))
    }

    /// Checks that the remaining bytes are enough for the number of items that the header states for this element.
    pub(super) fn check_room(&self, element: &Element) -> Result<(), MeshIoError> {
        let least = |kind: Kind| match kind {
            // A digit and a space; the last space may be missing.
            _ if self.encoding == Encoding::Text => 2,
            Kind::Scalar(scalar) | Kind::List(scalar, _) => scalar.size(),
        };
        let row: usize = element
            .properties
            .iter()
            .map(|property| least(property.kind))
            .sum();
        let needed = u128::from(element.count) * row as u128;
        if needed <= self.rest.len() as u128 + 1 {
            return Ok(());
        }
        let (name, count, left) = (&element.name, element.count, self.rest.len());
        let why = format!(
            "line {}: the header says {count} of the element {name}, but there are only {left} bytes left",
            element.line
        );
        Err(MeshIoError::file(FORMAT, why))
    }

    /// Returns a component of a position, normal or texture coordinate if it is in range; otherwise an error.
    /// Components in binary files are checked later, since the error then has the vertex index instead of a line
    /// number.
    pub(super) fn in_range(&self, part: f64) -> Result<f64, MeshIoError> {
        if self.encoding == Encoding::Text {
            return in_range(part).map_err(|why| self.error(why));
        }
        Ok(part)
    }

    /// Reads the values of a property into `list`, which is cleared first.
    pub(super) fn values(&mut self, kind: Kind, list: &mut Vec<f64>) -> Result<(), MeshIoError> {
        list.clear();
        let (count, item) = match kind {
            Kind::Scalar(item) => (1, item),
            Kind::List(count, item) => (self.count(count)?, item),
        };
        for _ in 0..count {
            let value = self.scalar(item)?;
            list.push(value);
        }
        Ok(())
    }

    /// Reads the length of a list.
    fn count(&mut self, scalar: Scalar) -> Result<usize, MeshIoError> {
        let count = self.scalar(scalar)?;
        // Each value has at least one byte, so reading soon fails for a false count; memory is not allocated in
        // advance.
        if count >= 0.0 && count <= self.rest.len() as f64 {
            return Ok(count as usize);
        }
        let left = self.rest.len();
        let why = format!("a list says it has {count} items, but there are only {left} bytes left");
        Err(self.error(why))
    }

    fn scalar(&mut self, scalar: Scalar) -> Result<f64, MeshIoError> {
        let value = match self.encoding {
            Encoding::Text => self.word(),
            Encoding::Little => self
                .take(scalar.size())
                .and_then(|bytes| little(scalar, bytes)),
            Encoding::Big => self
                .take(scalar.size())
                .and_then(|bytes| big(scalar, bytes)),
        };
        let why = "it ends early, or has something else in place of a number";
        value.ok_or_else(|| self.error(why))
    }

    /// Parses the next word as a number.
    fn word(&mut self) -> Option<f64> {
        let text = self.rest.trim_ascii_start();
        let end = text
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(text.len());
        let (word, rest) = text.split_at(end);
        self.rest = rest;
        parse(word)
    }

    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(bytes)
    }
}

fn little(scalar: Scalar, bytes: &[u8]) -> Option<f64> {
    Some(match scalar {
        Scalar::I8 => i8::from_le_bytes(bytes.try_into().ok()?).into(),
        Scalar::U8 => u8::from_le_bytes(bytes.try_into().ok()?).into(),
        Scalar::I16 => i16::from_le_bytes(bytes.try_into().ok()?).into(),
        Scalar::U16 => u16::from_le_bytes(bytes.try_into().ok()?).into(),
        Scalar::I32 => i32::from_le_bytes(bytes.try_into().ok()?).into(),
        Scalar::U32 => u32::from_le_bytes(bytes.try_into().ok()?).into(),
        Scalar::F32 => f32::from_le_bytes(bytes.try_into().ok()?).into(),
        Scalar::F64 => f64::from_le_bytes(bytes.try_into().ok()?),
    })
}

fn big(scalar: Scalar, bytes: &[u8]) -> Option<f64> {
    let mut reversed = [0; 8];
    let reversed = reversed.get_mut(..bytes.len())?;
    reversed.copy_from_slice(bytes);
    reversed.reverse();
    little(scalar, reversed)
}
