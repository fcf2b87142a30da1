//! Decodes text files, such as recipes, tables, lists and text mesh formats.
//!
//! All text is UTF-8. A leading byte order mark is skipped, and the error for other Unicode encodings names the
//! encoding.

crate::error! {
    /// An error from decoding text.
    TextError,
    /// Cause of a [`TextError`].
    TextErrorKind {
        /// The text has a Unicode encoding other than UTF-8.
        Encoding {
            /// Name of the encoding: UTF-16 or UTF-32.
            found: &'static str,
        } => "the text is {found}, but must be UTF-8";
        /// The bytes are not UTF-8.
        NotUtf8 {
            /// Number of valid bytes before the first invalid one.
            at: usize,
        } => "the text is not UTF-8 at byte {at}";
    }
}

/// Byte order mark in UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Returns the bytes of a text without its byte order mark. The bytes may be invalid UTF-8, such as Latin-1 comments
/// in old files.
///
/// UTF-16 and UTF-32 are recognized by their byte order marks, or by the zero bytes of the first two (UTF-16) or one
/// (UTF-32) ASCII characters.
///
/// # Errors
///
/// [`Encoding`](TextErrorKind::Encoding) for UTF-16 and UTF-32.
pub fn without_mark(bytes: &[u8]) -> Result<&[u8], TextError> {
    let found = match *bytes {
        // Test UTF-32 first: its little-endian mark starts like the mark of UTF-16.
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => "UTF-32",
        [1..=0x7f, 0, 0, 0, ..] | [0, 0, 0, 1..=0x7f, ..] => "UTF-32",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "UTF-16",
        [1..=0x7f, 0, 1..=0x7f, 0, ..] | [0, 1..=0x7f, 0, 1..=0x7f, ..] => "UTF-16",
        _ => return Ok(bytes.strip_prefix(MARK).unwrap_or(bytes)),
    };
    Err(TextError::new(TextErrorKind::Encoding { found }))
}

/// Decodes UTF-8 text and skips its byte order mark, which a `str` may have too.
///
/// # Errors
///
/// [`Encoding`](TextErrorKind::Encoding) for UTF-16 and UTF-32; [`NotUtf8`](TextErrorKind::NotUtf8) for other invalid
/// bytes.
///
/// # Examples
///
/// ```
/// use dapple_raster::text::decode;
///
/// assert_eq!(decode(b"\xef\xbb\xbfx,y")?, "x,y");
/// let error = decode(b"\xff\xfex\0,\0y\0").unwrap_err();
/// assert_eq!(error.to_string(), "the text is UTF-16, but must be UTF-8");
/// # Ok::<(), dapple_raster::text::TextError>(())
/// ```
pub fn decode(bytes: &[u8]) -> Result<&str, TextError> {
    let text = without_mark(bytes)?;
    core::str::from_utf8(text).map_err(|error| {
        let at = bytes.len() - text.len() + error.valid_up_to();
        TextError::new(TextErrorKind::NotUtf8 { at })
    })
}

#[cfg(test)]
mod tests {
    use super::{TextErrorKind, decode, without_mark};

    fn wide<const N: usize, U>(units: impl Iterator<Item = U>, code: fn(U) -> [u8; N]) -> Vec<u8> {
        units.flat_map(code).collect()
    }

    #[test]
    fn one_mark_of_utf_8_is_skipped() {
        assert_eq!(decode("\u{feff}dapple = 1".as_bytes()), Ok("dapple = 1"));
        assert_eq!(decode("dapple = 1".as_bytes()), Ok("dapple = 1"));
        assert_eq!(decode("\u{feff}\u{feff}a".as_bytes()), Ok("\u{feff}a"));
        assert_eq!(decode(b""), Ok(""));
        assert_eq!(decode(b"\xef\xbb\xbf"), Ok(""));
    }

    #[test]
    fn utf_16_and_utf_32_are_named_with_and_without_marks() {
        let text = "x,y \u{1f600}";
        let marked = format!("\u{feff}{text}");
        for text in [text, &marked] {
            for bytes in [
                wide(text.encode_utf16(), u16::to_le_bytes),
                wide(text.encode_utf16(), u16::to_be_bytes),
            ] {
                let error = decode(&bytes).unwrap_err();
                assert_eq!(error.kind(), &TextErrorKind::Encoding { found: "UTF-16" });
                assert!(without_mark(&bytes).is_err());
            }
            let codes = || text.chars().map(u32::from);
            for bytes in [
                wide(codes(), u32::to_le_bytes),
                wide(codes(), u32::to_be_bytes),
            ] {
                let error = decode(&bytes).unwrap_err();
                assert_eq!(error.kind(), &TextErrorKind::Encoding { found: "UTF-32" });
            }
        }
    }

    #[test]
    fn bytes_that_are_not_utf_8_are_refused_with_their_place() {
        let error = decode(b"\xef\xbb\xbfab\xe9c").unwrap_err();
        assert_eq!(error.to_string(), "the text is not UTF-8 at byte 5");
        assert_eq!(without_mark(b"\xe9"), Ok(b"\xe9".as_slice()));
    }
}
