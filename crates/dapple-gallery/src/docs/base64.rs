//! Encodes and decodes Base64, the encoding of bytes in a data URI.
//!
//! Reference: S. Josefsson, "The Base16, Base32, and Base64 Data Encodings", RFC 4648, 2006,
//! <https://www.rfc-editor.org/rfc/rfc4648>, section 4.

use anyhow::{Context, ensure};

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Encodes bytes: three bytes become four characters of six bits each, from the highest bits down; `=` pads the end.
pub(super) fn encode(bytes: &[u8]) -> String {
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let byte = |index: usize| u32::from(group.get(index).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for letter in 0..4 {
            text.push(if letter <= group.len() {
                char::from(ALPHABET[(bits >> (18 - 6 * letter)) as usize & 63])
            } else {
                '='
            });
        }
    }
    text
}

/// Decodes a text produced by [`encode`].
pub(super) fn decode(text: &str) -> anyhow::Result<Vec<u8>> {
    ensure!(text.len().is_multiple_of(4), "base64 ends within a group");
    let mut bytes = Vec::new();
    let letters = text.trim_end_matches('=').as_bytes();
    for group in letters.chunks(4) {
        let mut bits = 0;
        for (index, letter) in group.iter().enumerate() {
            let value = ALPHABET.iter().position(|known| known == letter);
            let value = value.with_context(|| format!("{letter:#x} is no letter of base64"))?;
            bits |= (value as u32) << (18 - 6 * index);
        }
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::{decode, encode};

    /// Test vectors from section 10 of the RFC.
    const VECTORS: [(&str, &str); 7] = [
        ("", ""),
        ("f", "Zg=="),
        ("fo", "Zm8="),
        ("foo", "Zm9v"),
        ("foob", "Zm9vYg=="),
        ("fooba", "Zm9vYmE="),
        ("foobar", "Zm9vYmFy"),
    ];

    #[test]
    fn test_vectors_of_the_rfc_are_met_both_ways() {
        for (bytes, text) in VECTORS {
            assert_eq!(encode(bytes.as_bytes()), text);
            assert_eq!(decode(text).unwrap(), bytes.as_bytes(), "{text}");
        }
    }

    #[test]
    fn every_byte_survives() {
        let bytes: Vec<u8> = (0..=255).collect();
        assert_eq!(decode(&encode(&bytes)).unwrap(), bytes);
    }

    #[test]
    fn other_letters_and_broken_groups_are_refused() {
        for bad in ["Zm9", "Zm9v!mFy", "Zm 9"] {
            assert!(decode(bad).is_err(), "{bad}");
        }
    }
}
