//! Counter-based hashes of lattice cells.
//!
//! A hash is a pure function of a seed, a cell and a counter. The words go in from the slowest axis to the fastest,
//! the counter last, so that whoever walks along a row or draws several numbers for one cell can share the beginning:
//! that is what [`CellHash`] holds. What a number is for is not a word of its own: it is the name of the
//! [`Seed::child`] that is passed.

use crate::Seed;
use crate::mix::{absorb, finish};

/// 64 random bits for a counter in a cell of the 1-D lattice.
#[must_use]
#[inline]
pub const fn hash1(seed: Seed, cell: [i64; 1], index: u32) -> u64 {
    CellHash::new(seed, cell).at(index)
}

/// 64 random bits for a counter in a cell of the 2-D lattice.
///
/// # Examples
///
/// ```
/// use dapple_hash::{Seed, hash2};
///
/// let seed = Seed(7).child("height", 0);
/// assert_eq!(hash2(seed, [3, -5], 0), hash2(seed, [3, -5], 0));
/// assert_ne!(hash2(seed, [3, -5], 0), hash2(seed, [-5, 3], 0));
/// ```
#[must_use]
#[inline]
pub const fn hash2(seed: Seed, cell: [i64; 2], index: u32) -> u64 {
    CellHash::new(seed, cell).at(index)
}

/// 64 random bits for a counter in a cell of the 3-D lattice.
#[must_use]
#[inline]
pub const fn hash3(seed: Seed, cell: [i64; 3], index: u32) -> u64 {
    CellHash::new(seed, cell).at(index)
}

/// 64 random bits for a counter in a cell of the 4-D lattice.
#[must_use]
#[inline]
pub const fn hash4(seed: Seed, cell: [i64; 4], index: u32) -> u64 {
    CellHash::new(seed, cell).at(index)
}

/// The hash state after a seed and a cell, from which as many numbers as the cell needs can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellHash {
    pub(crate) state: [u32; 2],
}

impl CellHash {
    /// Absorbs `seed` and `cell`, the last axis first, for any number of axes. [`hash1`] to [`hash4`] use 1 to 4.
    #[must_use]
    #[inline]
    pub const fn new<const N: usize>(seed: Seed, cell: [i64; N]) -> Self {
        let [low, high] = words(seed.0);
        let state = absorb(absorb([0, 0], high), low);
        let mut hash = Self { state };
        let mut axis = N;
        while axis > 0 {
            axis -= 1;
            hash = hash.axis(cell[axis]);
        }
        hash
    }

    /// The hash state of two words that are random already, such as the parts of two
    /// [`LatticeHash`](crate::LatticeHash)es.
    #[must_use]
    #[inline]
    pub const fn of_words(words: [u32; 2]) -> Self {
        Self { state: words }
    }

    /// Absorbs the coordinate of one more axis, a faster one than those before.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_hash::{CellHash, Seed};
    ///
    /// let row = CellHash::new(Seed(7), [-5]);
    /// assert_eq!(row.axis(3), CellHash::new(Seed(7), [3, -5]));
    /// ```
    #[must_use]
    #[inline]
    pub const fn axis(self, coordinate: i64) -> Self {
        let [low, high] = words(coordinate.cast_unsigned());
        Self {
            state: absorb(absorb(self.state, high), low),
        }
    }

    /// The 64 random bits of counter `index`.
    #[must_use]
    #[inline]
    pub const fn at(self, index: u32) -> u64 {
        let [a, b] = finish(absorb(self.state, index));
        (a as u64) << 32 | b as u64
    }
}

/// The low and the high half of a word.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the halves are what is asked for"
)]
const fn words(bits: u64) -> [u32; 2] {
    [bits as u32, (bits >> 32) as u32]
}

#[cfg(test)]
mod tests;
