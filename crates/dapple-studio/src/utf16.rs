//! Positions of a text in UTF-16 code units, as JavaScript counts them.

use core::ops::Range;

/// Bytes between two positions that are known.
const STEP: usize = 1 << 10;

/// Turns bytes of a text into code units and back.
#[derive(Clone, Debug)]
pub(crate) struct Positions {
    /// The code units before every [`STEP`]th byte, or before the character that it is in; none where all is ASCII.
    known: Vec<usize>,
}

impl Positions {
    /// The positions of a text.
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

    /// The code units before a byte of the text.
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

    /// A range of bytes as code units.
    pub(crate) fn span(&self, text: &str, bytes: Range<usize>) -> [usize; 2] {
        [self.units(text, bytes.start), self.units(text, bytes.end)]
    }
}

/// The start of the character in which a byte lies.
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
