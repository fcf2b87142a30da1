//! Parses hexadecimal colors, as in a style sheet.

use crate::{ColorError, ColorErrorKind, LinearRgb};
use core::str::FromStr;

impl LinearRgb {
    /// Parses an sRGB color in hexadecimal: `"#ff8000"`, `"ff8000"`, or `"#f80"`, which is short for `"#ff8800"`.
    ///
    /// # Errors
    ///
    /// [`ColorErrorKind::Hex`] if the text has any other form.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_color::LinearRgb;
    ///
    /// assert_eq!(LinearRgb::from_hex("#ff8000")?.to_srgb::<u8>(), [255, 128, 0]);
    /// # Ok::<(), dapple_color::ColorError>(())
    /// ```
    pub fn from_hex(text: &str) -> Result<Self, ColorError> {
        codes(text).map(Self::from_srgb).ok_or_else(|| {
            let text = text.to_owned();
            ColorError::new(ColorErrorKind::Hex { text })
        })
    }
}

impl FromStr for LinearRgb {
    type Err = ColorError;

    fn from_str(text: &str) -> Result<Self, ColorError> {
        Self::from_hex(text)
    }
}

/// Parses the codes of red, green and blue.
fn codes(text: &str) -> Option<[u8; 3]> {
    let text = text.strip_prefix('#').unwrap_or(text);
    let digits: Option<Vec<u8>> = text.chars().map(digit).collect();
    match *digits?.as_slice() {
        [r, g, b] => Some([r, g, b].map(|digit| 17 * digit)),
        [r, s, g, h, b, c] => Some([16 * r + s, 16 * g + h, 16 * b + c]),
        _ => None,
    }
}

fn digit(digit: char) -> Option<u8> {
    digit
        .to_digit(16)
        .and_then(|digit| u8::try_from(digit).ok())
}

#[cfg(test)]
mod tests {
    use super::codes;
    use crate::{ColorErrorKind, LinearRgb};

    #[test]
    fn short_and_long_codes_are_read() {
        for (text, expected) in [
            ("#000000", [0, 0, 0]),
            ("1a2B3c", [0x1a, 0x2b, 0x3c]),
            ("#f80", [0xff, 0x88, 0x00]),
            ("fff", [255, 255, 255]),
        ] {
            assert_eq!(codes(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn everything_else_is_refused() {
        for text in [
            "", "#", "#12", "#12345", "#1234567", "##123456", "+12345", "#12345g", "é12345", " fff",
        ] {
            let error = text.parse::<LinearRgb>().unwrap_err();
            assert_eq!(
                error.kind(),
                &ColorErrorKind::Hex { text: text.into() },
                "{error}"
            );
        }
    }
}
