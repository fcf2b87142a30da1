//! Converts positions in a text to UTF-16 code units, which JavaScript counts.

use core::ops::Range;

/// Distance between cached positions, in bytes.
const STEP: usize = 1 << 10;

/// Converts byte offsets of a text to UTF-16 code units.
#[derive(Clone, Debug)]
pub(crate) struct Positions {
    /// Number of code units before every [`STEP`]th byte, rounded down to a character boundary. Empty if the text is
    /// ASCII.
    known: Vec<usize>,
}

impl Positions {
    /// Builds the positions of a text.
    pub(crate) fn new(text: &str) -> Self {
        let mut known = Vec::new();
        if !text.is_ascii() {
            let mut units = 0;
            for (byte, character) in text.char_indices() {
                while known.len() * STEP < byte + character.len_utf8() {
                    known.push(units);
                }
                units += character.len_utf16();
            }
        }
        Self { known }
    }

    /// Returns the number of code units before a byte of the text.
    pub(crate) fn units(&self, text: &str, byte: usize) -> usize {
        let byte = floor(text, byte);
        let Some(&before) = self.known.get(byte / STEP) else {
            return match self.known.last() {
                None => byte,
                Some(_) => text[..byte].encode_utf16().count(),
            };
        };
        let start = floor(text, byte / STEP * STEP);
        before + text[start..byte].encode_utf16().count()
    }

    /// Converts a range of bytes to code units.
    pub(crate) fn span(&self, text: &str, bytes: Range<usize>) -> [usize; 2] {
        [self.units(text, bytes.start), self.units(text, bytes.end)]
    }
}

/// Rounds a byte offset down to a character boundary.
fn floor(text: &str, byte: usize) -> usize {
    let mut byte = byte.min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1;
    }
    byte
}

#[cfg(test)]
mod tests {
    use super::Positions;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn units_are_those_of_the_text_before(text in "[a-zé𝄞 ]{0,3000}") {
            let positions = Positions::new(&text);
            for (byte, _) in text.char_indices().step_by(7) {
                prop_assert_eq!(positions.units(&text, byte), text[..byte].encode_utf16().count());
            }
            prop_assert_eq!(positions.units(&text, text.len()), text.encode_utf16().count());
        }
    }
}
