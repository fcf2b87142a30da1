//! Applies random mutations that preserve much of an input. They are the same in every run.

use dapple::hash::{Seed, rand_core::Rng};

/// Numbers that replace numbers in text inputs.
const NUMBERS: [&str; 16] = [
    "0",
    "-1",
    "1",
    "2",
    "0.5",
    "1e-9",
    "1e9",
    "1e30",
    "1e300",
    "1e400",
    "nan",
    "-inf",
    "255",
    "65536",
    "4294967295",
    "18446744073709551616",
];

/// Bytes that replace numbers in binary inputs.
const BYTES: [[u8; 4]; 8] = [
    [0; 4],
    [0xff; 4],
    [1, 0, 0, 0],
    [0, 0, 0, 1],
    [0xff, 0xff, 0xff, 0x7f],
    [0x7f, 0xff, 0xff, 0xff],
    [0, 0, 0x80, 0x7f],
    [0, 0, 0xc0, 0x7f],
];

/// A source of random mutations.
pub(crate) struct Mutator {
    random: Box<dyn FnMut() -> u64>,
}

impl Mutator {
    pub(crate) fn new(target: &str, seed: u64, round: u64) -> Self {
        let mut stream = Seed(seed).child(target, round).stream();
        Self {
            random: Box::new(move || stream.next_u64()),
        }
    }

    /// Returns a random number below `n`, which must not be 0.
    fn below(&mut self, n: usize) -> usize {
        ((self.random)() % n as u64) as usize
    }

    /// Returns a copy of the bytes with one to four mutations. Some mutations insert bytes of `others`.
    pub(crate) fn changed(&mut self, bytes: &[u8], others: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..=self.below(4) {
            if bytes.is_empty() {
                break;
            }
            let at = self.below(bytes.len());
            match self.below(8) {
                0 => bytes[at] ^= 1 << self.below(8),
                1 => bytes[at] = self.below(256) as u8,
                2 => bytes.truncate(at),
                3 => {
                    let other = self.below(others.len());
                    self.splice(&mut bytes, at, &others[other]);
                }
                4 => {
                    let own = bytes.clone();
                    self.splice(&mut bytes, at, &own);
                }
                5 => {
                    let word = BYTES[self.below(BYTES.len())];
                    let end = bytes.len().min(at + 4);
                    bytes[at..end].copy_from_slice(&word[..end - at]);
                }
                _ => self.replace_number(&mut bytes, at),
            }
        }
        bytes
    }

    /// Inserts 1 to 40 bytes of `other` at position `at`, in place of at most as many bytes.
    fn splice(&mut self, bytes: &mut Vec<u8>, at: usize, other: &[u8]) {
        if other.is_empty() {
            return;
        }
        let from = self.below(other.len());
        let part = &other[from..other.len().min(from + 1 + self.below(40))];
        let end = bytes.len().min(at + self.below(part.len() + 1));
        bytes.splice(at..end, part.iter().copied());
    }

    /// Replaces the first number in a text at or after position `at`.
    fn replace_number(&mut self, bytes: &mut Vec<u8>, at: usize) {
        let is_digit = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
        let Some(start) = bytes[at..].iter().position(is_digit) else {
            return;
        };
        let start = at + start;
        let length = bytes[start..]
            .iter()
            .take_while(|byte| is_digit(byte))
            .count();
        let number = NUMBERS[self.below(NUMBERS.len())];
        bytes.splice(start..start + length, number.bytes());
    }
}
