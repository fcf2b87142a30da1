//! Reads glTF containers: GLB files with their chunks, buffers, and data URIs.

use super::document::Document;
use super::{FORMAT, unsupported, wrong};
use crate::FileResolver;
use crate::MeshIoError;
use crate::text::content;
use std::borrow::Cow;

/// Signature of a GLB file.
pub(super) const MAGIC: &[u8; 4] = b"glTF";
/// Type of the first chunk.
pub(super) const JSON: &[u8; 4] = b"JSON";
/// Type of the second chunk.
pub(super) const BIN: &[u8; 4] = b"BIN\0";

pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    bin: Option<&'a [u8]>,
}

impl<'a> Container<'a> {
    /// Splits a GLB file into its chunks. The bytes of any other file are its JSON.
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self, MeshIoError> {
        if !bytes.starts_with(MAGIC) {
            let json = content(FORMAT, bytes)?;
            return Ok(Self { json, bin: None });
        }
        let (version, length) = (word(bytes, 4), word(bytes, 8));
        if let Some(version) = version.filter(|&version| version != 2) {
            return Err(unsupported(format!("version {version} of binary glTF")));
        }
        let bytes = length.and_then(|length| bytes.get(12..length));
        let bytes = bytes.ok_or_else(|| wrong("it is shorter than it says"))?;
        let (kind, json, rest) = chunk(bytes).ok_or_else(|| wrong("its first chunk is cut off"))?;
        if kind != *JSON {
            return Err(wrong("its first chunk is not JSON"));
        }
        let bin = chunk(rest)
            .filter(|(kind, ..)| *kind == *BIN)
            .map(|(_, bin, _)| bin);
        Ok(Self { json, bin })
    }

    /// Returns the bytes of all buffers; `None` for a buffer that is missing or too short.
    pub(super) fn buffers(
        &self,
        document: &Document,
        resolve: &mut FileResolver<'_>,
    ) -> Vec<Option<Cow<'a, [u8]>>> {
        let mut buffers = Vec::new();
        for (i, buffer) in document.buffers.iter().enumerate() {
            let bytes = match &buffer.uri {
                None if i == 0 => self.bin.map(Cow::Borrowed),
                None => None,
                Some(uri) if uri.starts_with("data:") => data(uri).map(Cow::Owned),
                Some(uri) => resolve(&percent_decoded(uri)).map(Cow::Owned),
            };
            buffers.push(bytes.filter(|bytes| bytes.len() >= buffer.byte_length));
        }
        buffers
    }
}

/// Splits off the first chunk, and returns its type, its content and the remaining bytes.
fn chunk(bytes: &[u8]) -> Option<([u8; 4], &[u8], &[u8])> {
    let length = word(bytes, 0)?;
    let kind = bytes.get(4..8)?.try_into().ok()?;
    let (content, rest) = bytes.get(8..)?.split_at_checked(length)?;
    Some((kind, content, rest))
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + 4)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(bytes)).ok()
}

/// Decodes a base64 data URI; `None` for other encodings.
pub(super) fn data(uri: &str) -> Option<Vec<u8>> {
    let (head, text) = uri.split_once(',')?;
    head.ends_with(";base64").then_some(())?;
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut n_bits) = (0u32, 0);
    for digit in text.trim_end_matches('=').bytes() {
        let digit = match digit {
            b'A'..=b'Z' => digit - b'A',
            b'a'..=b'z' => digit - b'a' + 26,
            b'0'..=b'9' => digit - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(digit);
        n_bits += 6;
        if n_bits >= 8 {
            n_bits -= 8;
            bytes.push((bits >> n_bits) as u8);
        }
    }
    Some(bytes)
}

/// Decodes the percent-encoding of a URI.
pub(super) fn percent_decoded(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, tail)) = rest.split_first() {
        let digits = tail
            .get(..2)
            .and_then(|digits| core::str::from_utf8(digits).ok());
        let code = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match code {
            Some(code) if byte == b'%' => {
                bytes.push(code);
                rest = &tail[2..];
            }
            _ => {
                bytes.push(byte);
                rest = tail;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
