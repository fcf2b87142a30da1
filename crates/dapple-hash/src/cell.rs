//! Counter-based hashes of lattice cells.
//!
//! A hash is a pure function of a seed, a cell and a counter. Words are absorbed from the slowest axis to the
//! fastest, and the counter last. A [`CellHash`] is the state after a prefix of these words, so that cells in a row,
//! or several numbers for one cell, share the work. To separate numbers by purpose, use child seeds: the purpose is
//! the name passed to [`Seed::child`].

use crate::Seed;
use crate::mix::{absorb, finish};

/// Returns 64 random bits for a counter in a cell of the 1-D lattice.
#[must_use]
#[inline]
pub const fn hash1(seed: Seed, cell: [i64; 1], index: u32) -> u64 {
    CellHash::new(seed, cell).at(index)
}

/// Returns 64 random bits for a counter in a cell of the 2-D lattice.
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

/// Returns 64 random bits for a counter in a cell of the 3-D lattice.
#[must_use]
#[inline]
pub const fn hash3(seed: Seed, cell: [i64; 3], index: u32) -> u64 {
    CellHash::new(seed, cell).at(index)
}

/// Returns 64 random bits for a counter in a cell of the 4-D lattice.
#[must_use]
#[inline]
pub const fn hash4(seed: Seed, cell: [i64; 4], index: u32) -> u64 {
    CellHash::new(seed, cell).at(index)
}

/// The hash state after absorbing a seed and a cell. Any number of random values can be drawn from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellHash {
    pub(crate) state: [u32; 2],
}

impl CellHash {
    /// Absorbs `seed` and `cell`, last axis first, for any number of axes. [`hash1`] to [`hash4`] use 1 to 4.
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

    /// Creates a hash state directly from two random words, for example the [parts](crate::LatticeHash::part) of two
    /// lattice hashes. Nothing is absorbed.
    #[must_use]
    #[inline]
    pub const fn of_words(words: [u32; 2]) -> Self {
        Self { state: words }
    }

    /// Absorbs the coordinate of one more axis, which then varies faster than the axes absorbed before.
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

    /// Returns the 64 random bits for counter `index` in this cell.
    #[must_use]
    #[inline]
    pub const fn at(self, index: u32) -> u64 {
        let [a, b] = finish(absorb(self.state, index));
        (a as u64) << 32 | b as u64
    }
}

/// Splits a word into its low and high half.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the halves are what is asked for"
)]
const fn words(bits: u64) -> [u32; 2] {
    [bits as u32, (bits >> 32) as u32]
}

#[cfg(test)]
mod tests;
