//! Hashes sixteen cells at once in SIMD lanes, with the same bits as [`CellHash`] in every lane.
//!
//! The arithmetic of [`mix`](crate::mix) is repeated here for SIMD registers; a test compares both.

use crate::CellHash;
use crate::mix::{M0, M1, M2, M3, N0, N1};
use core::ops::{Add, BitOr, BitXor, BitXorAssign, Mul, Shl, Shr};
use fearless_simd::{prelude::*, u32x16};

/// Sixteen [`CellHash`]es, one in each lane.
#[derive(Clone, Copy, Debug)]
pub struct CellHashes<S: Simd> {
    state: [u32x16<S>; 2],
}

impl<S: Simd> CellHashes<S> {
    /// Copies one hash to all lanes, for example the state at the start of a row of cells.
    #[inline(always)]
    pub fn splat(simd: S, hash: CellHash) -> Self {
        let [a, b] = hash.state;
        Self {
            state: [u32x16::splat(simd, a), u32x16::splat(simd, b)],
        }
    }

    /// Creates hashes from two words per lane that are already random; see [`CellHash::of_words`].
    #[inline(always)]
    #[must_use]
    pub const fn of_words(words: [u32x16<S>; 2]) -> Self {
        Self { state: words }
    }

    /// Absorbs the coordinate of one more axis, which then varies faster than the axes absorbed before. The
    /// coordinate is given as its low and its high 32 bits.
    #[inline(always)]
    pub fn axis(self, low: u32x16<S>, high: u32x16<S>) -> Self {
        let [hashes] = Self::axis_each([self], [[low, high]]);
        hashes
    }

    /// Returns the 64 random bits for counter `index`, which may differ between lanes, as the high 32 bits followed
    /// by the low 32 bits.
    #[inline(always)]
    pub fn at(self, index: u32x16<S>) -> [u32x16<S>; 2] {
        let [bits] = Self::at_each([self], [index]);
        bits
    }

    /// Computes [`axis`](Self::axis) for several registers, interleaved. This is faster than sequential calls,
    /// because a hash is one long chain of dependent operations.
    #[inline(always)]
    pub fn axis_each<const C: usize>(hashes: [Self; C], words: [[u32x16<S>; 2]; C]) -> [Self; C] {
        let [low, high] = in_step(words);
        let [a, b] = absorb(absorb(in_step(states(hashes)), high), low);
        let mut hashes = hashes;
        for (i, hash) in hashes.iter_mut().enumerate() {
            hash.state = [a.0[i], b.0[i]];
        }
        hashes
    }

    /// Computes [`at`](Self::at) for several registers, interleaved, which is faster than sequential calls.
    #[inline(always)]
    pub fn at_each<const C: usize>(
        hashes: [Self; C],
        index: [u32x16<S>; C],
    ) -> [[u32x16<S>; 2]; C] {
        out_of_step(finish(absorb(in_step(states(hashes)), InStep(index))))
    }
}

/// Computes [`LatticeHash::part`](crate::LatticeHash::part) in every lane of several interleaved registers, for
/// coordinates from -2³¹ to 2³¹ - 1, given their axis's key.
#[inline(always)]
#[must_use]
pub fn lattice_parts<S: Simd, const C: usize>(
    simd: S,
    key: u32,
    coordinates: [u32x16<S>; C],
) -> [u32x16<S>; C] {
    mix(InStep(coordinates) ^ InStep([u32x16::splat(simd, key); C])).0
}

/// Computes [`LatticeHash::part`](crate::LatticeHash::part) in every lane of several interleaved registers, for two
/// hashes, given their keys for one axis. Coordinates are given as their low and their high 32 bits.
#[inline(always)]
#[must_use]
pub fn lattice_part_pairs<S: Simd, const C: usize>(
    simd: S,
    keys: [u32; 2],
    coordinates: [[u32x16<S>; 2]; C],
) -> [[u32x16<S>; 2]; C] {
    let mut words = coordinates;
    let mut far = u32x16::splat(simd, 0);
    for i in 0..C {
        let [low, high] = coordinates[i];
        words[i] = [low ^ keys[0], low ^ keys[1]];
        far |= high + (low >> 31);
    }
    // Hash the upper halves only if a coordinate is outside 32 bits.
    if !far.simd_eq(0).all_true() {
        for i in 0..C {
            let [low, high] = coordinates[i];
            let high = high + (low >> 31);
            let is_near = high.simd_eq(0);
            let [mixed] = mix32_pairs([[high ^ keys[0], high ^ keys[1]]]);
            for which in 0..2 {
                words[i][which] ^= is_near.select(u32x16::splat(simd, 0), mixed[which]);
            }
        }
    }
    mix32_pairs(words)
}

/// Computes [`LatticeHash::bits`](crate::LatticeHash::bits) in every lane of several interleaved registers.
#[inline(always)]
#[must_use]
pub fn lattice_bits<S: Simd, const C: usize>(parts: [u32x16<S>; C]) -> [u32x16<S>; C] {
    let bits = InStep(parts) * M2;
    ((bits ^ (bits >> 15)) * M1).0
}

/// Computes [`mix32`](crate::mix32) in every lane of several interleaved pairs of registers.
#[inline(always)]
#[must_use]
pub fn mix32_pairs<S: Simd, const C: usize>(pairs: [[u32x16<S>; 2]; C]) -> [[u32x16<S>; 2]; C] {
    let [a, b] = in_step(pairs);
    out_of_step([mix(a), mix(b)])
}

#[inline(always)]
fn mix<S: Simd, const C: usize>(mut bits: InStep<S, C>) -> InStep<S, C> {
    bits = (bits ^ (bits >> 16)) * N0;
    bits = (bits ^ (bits >> 15)) * N1;
    bits ^ (bits >> 16)
}

#[inline(always)]
fn absorb<S: Simd, const C: usize>(
    [mut a, mut b]: [InStep<S, C>; 2],
    word: InStep<S, C>,
) -> [InStep<S, C>; 2] {
    a = (a ^ word) * M0;
    a ^= a >> 15;
    b = (b ^ a) * M1;
    b ^= b >> 13;
    [a + (b << 11 | b >> 21), b]
}

#[inline(always)]
fn finish<S: Simd, const C: usize>([mut a, mut b]: [InStep<S, C>; 2]) -> [InStep<S, C>; 2] {
    a = (a ^ (a >> 16)) * M2;
    b = (b + (a ^ (a >> 15))) * M3;
    b ^= b >> 15;
    a = (a + b) * M1;
    a ^= a >> 13;
    b = (b ^ a) * M0;
    b ^= b >> 16;
    [a ^ (b << 7 | b >> 25), b]
}

/// Several SIMD registers in lockstep. Each operation is applied to all of them before the next one starts, which
/// hides the latency of dependent operations.
#[derive(Clone, Copy)]
struct InStep<S: Simd, const C: usize>([u32x16<S>; C]);

#[inline(always)]
fn states<S: Simd, const C: usize>(hashes: [CellHashes<S>; C]) -> [[u32x16<S>; 2]; C] {
    let mut states = [hashes[0].state; C];
    for i in 0..C {
        states[i] = hashes[i].state;
    }
    states
}

#[inline(always)]
fn in_step<S: Simd, const C: usize>(pairs: [[u32x16<S>; 2]; C]) -> [InStep<S, C>; 2] {
    let [mut a, mut b] = [[pairs[0][0]; C]; 2];
    for i in 0..C {
        [a[i], b[i]] = pairs[i];
    }
    [InStep(a), InStep(b)]
}

#[inline(always)]
fn out_of_step<S: Simd, const C: usize>([a, b]: [InStep<S, C>; 2]) -> [[u32x16<S>; 2]; C] {
    let mut pairs = [[a.0[0], b.0[0]]; C];
    for (i, pair) in pairs.iter_mut().enumerate() {
        *pair = [a.0[i], b.0[i]];
    }
    pairs
}

/// Implements binary operators for [`InStep`], lane by lane. The right operand is another group of registers or a
/// scalar.
macro_rules! operators {
    ($($operator:ident $function:ident $assign:tt $other:ty $(, $register:tt)?;)*) => {$(
        impl<S: Simd, const C: usize> $operator<$other> for InStep<S, C> {
            type Output = Self;

            #[inline(always)]
            fn $function(mut self, other: $other) -> Self {
                for i in 0..C {
                    self.0[i] $assign other $(.$register[i])?;
                }
                self
            }
        }
    )*};
}
operators! {
    Add add += Self, 0;
    BitOr bitor |= Self, 0;
    BitXor bitxor ^= Self, 0;
    Mul mul *= u32;
    Shl shl <<= u32;
    Shr shr >>= u32;
}

impl<S: Simd, const C: usize> BitXorAssign for InStep<S, C> {
    #[inline(always)]
    fn bitxor_assign(&mut self, other: Self) {
        *self = *self ^ other;
    }
}

#[cfg(test)]
mod tests {
    use super::{CellHashes, lattice_bits, lattice_part_pairs, lattice_parts, mix32_pairs};
    use crate::{CellHash, LatticeHash, Seed, hash1, mix32};
    use fearless_simd::{Level, dispatch, prelude::*, u32x16};

    #[test]
    fn lanes_have_the_bits_of_single_cells() {
        let random = |axis: i64, lane: usize| hash1(Seed(3), [axis], lane as u32).cast_signed();
        let cells: [[i64; 3]; 16] =
            core::array::from_fn(|lane| [random(0, lane), random(1, lane) >> 40, random(2, 0)]);
        let hash = CellHash::new(Seed(9), [cells[0][2]]);
        let lanes = dispatch!(Level::new(), simd => high_and_low(simd, hash, &cells));
        for (lane, cell) in cells.into_iter().enumerate() {
            let expected = CellHash::new(Seed(9), cell).at(lane as u32);
            assert_eq!(
                lanes[lane],
                (expected, mix32(expected as u32)),
                "lane {lane}"
            );
        }
    }

    #[inline(always)]
    fn high_and_low<S: Simd>(simd: S, row: CellHash, cells: &[[i64; 3]; 16]) -> [(u64, u32); 16] {
        let mut words = [[0; 16]; 5];
        for (lane, cell) in cells.iter().enumerate() {
            words[0][lane] = cell[0] as u32;
            words[1][lane] = (cell[0] >> 32) as u32;
            words[2][lane] = cell[1] as u32;
            words[3][lane] = (cell[1] >> 32) as u32;
            words[4][lane] = lane as u32;
        }
        let [x, x_high, y, y_high, index] = words.map(|word| u32x16::from_slice(simd, &word));
        let hashes = CellHashes::splat(simd, row).axis(y, y_high).axis(x, x_high);
        let [high, low] = hashes.at(index);
        let [[_, mixed]] = mix32_pairs([[high, low]]);
        core::array::from_fn(|lane| {
            (
                u64::from(high[lane]) << 32 | u64::from(low[lane]),
                mixed[lane],
            )
        })
    }

    #[test]
    fn lanes_have_the_bits_of_single_corners() {
        let columns: [i32; 16] =
            core::array::from_fn(|lane| hash1(Seed(3), [0], lane as u32).cast_signed() as i32);
        let hash = LatticeHash::<2>::new(Seed(9));
        let row = hash.part(1, -7);
        let words = columns.map(i32::cast_unsigned);
        let bits = dispatch!(Level::new(), simd => corner_bits(simd, hash.key(0), row, &words));
        let expected = columns.map(|x| LatticeHash::<2>::bits(hash.part(0, x.into()) ^ row));
        assert_eq!(bits, expected);
    }

    #[test]
    fn pairs_of_parts_are_those_of_single_coordinates() {
        let hashes = [1, 2].map(|seed| LatticeHash::<2>::new(Seed(seed)));
        // Coordinates on both sides of the 32-bit limits, and far outside
        let near: [i64; 16] = core::array::from_fn(|lane| lane as i64 - 8);
        let edges = near.map(|x| {
            if x % 2 == 0 {
                x + (1 << 31)
            } else {
                x - (1 << 31)
            }
        });
        let far = near.map(|x| x << 50 | 5);
        for coordinates in [near, edges, far] {
            let words = [0, 32].map(|shift| coordinates.map(|x| (x >> shift) as u32));
            let keys = hashes.map(|hash| hash.key(1));
            let parts = dispatch!(Level::new(), simd => part_pairs(simd, keys, &words));
            for which in 0..2 {
                let expected = coordinates.map(|x| hashes[which].part(1, x));
                assert_eq!(parts[which], expected, "{coordinates:?}");
            }
        }
    }

    #[inline(always)]
    fn part_pairs<S: Simd>(simd: S, keys: [u32; 2], words: &[[u32; 16]; 2]) -> [[u32; 16]; 2] {
        let [low, high] = words
            .each_ref()
            .map(|words| u32x16::from_slice(simd, words));
        let [parts] = lattice_part_pairs(simd, keys, [[low, high]]);
        parts.map(|parts| core::array::from_fn(|lane| parts[lane]))
    }

    #[inline(always)]
    fn corner_bits<S: Simd>(simd: S, key: u32, row: u32, columns: &[u32; 16]) -> [u32; 16] {
        let [parts] = lattice_parts(simd, key, [u32x16::from_slice(simd, columns)]);
        let [bits] = lattice_bits([parts ^ row]);
        core::array::from_fn(|lane| bits[lane])
    }
}
