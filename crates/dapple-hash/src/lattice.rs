//! A fast hash for lattice corners, intended for noise that is sampled at single positions.

use crate::Seed;
use crate::mix::{M1, M2, mix32};

/// A hash of the corners of an `N`-dimensional lattice, which gives 32 random bits for a seed and a corner's
/// coordinates.
///
/// Each coordinate is hashed separately, by [`part`](Self::part), with its axis's key. The exclusive or of the parts
/// of all axes is hashed once more, by [`bits`](Self::bits). The corners around a position have only two coordinates
/// along each axis, so most of the work is shared between them. A [`CellHash`](crate::CellHash) has 64 bits and a
/// counter, and is more expensive.
///
/// # Examples
///
/// ```
/// use dapple_hash::{LatticeHash, Seed};
///
/// let hash = LatticeHash::<2>::new(Seed(7));
/// let [x, far_x, y] = [hash.part(0, 3), hash.part(0, 3 + (1 << 32)), hash.part(1, -5)];
/// assert_ne!(LatticeHash::<2>::bits(x ^ y), LatticeHash::<2>::bits(far_x ^ y));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeHash<const N: usize> {
    keys: [u32; N],
}

impl<const N: usize> LatticeHash<N> {
    /// Creates the hash for `seed`.
    #[must_use]
    pub const fn new(seed: Seed) -> Self {
        let mut keys = [0; N];
        let mut axis = 0;
        while axis < N {
            keys[axis] = (seed.child("axis of a lattice", axis as u64).0 >> 32) as u32;
            axis += 1;
        }
        Self { keys }
    }

    /// Returns the key of `axis`, which is passed to the SIMD functions.
    #[must_use]
    #[inline(always)]
    pub const fn key(&self, axis: usize) -> u32 {
        self.keys[axis]
    }

    /// Hashes a coordinate along `axis`. [`bits`](Self::bits) turns the exclusive or of the results for all axes into
    /// a corner's hash. For coordinates from -2³¹ to 2³¹ - 1, this is a bijection.
    ///
    /// Beyond this range, the upper 32 bits of a coordinate permute the parts, so that the lattice does not repeat
    /// after 2³² corners.
    #[must_use]
    #[inline(always)]
    pub const fn part(&self, axis: usize, coordinate: i64) -> u32 {
        let high = (coordinate.wrapping_add(1 << 31) >> 32) as u32;
        let word = coordinate as u32 ^ self.keys[axis];
        mix32(if high == 0 {
            word
        } else {
            word ^ mix32(high ^ self.keys[axis])
        })
    }

    /// Returns a corner's random bits, given the exclusive or of its coordinates' parts. Use the upper 24 bits, which
    /// have the best quality.
    #[must_use]
    #[inline(always)]
    pub const fn bits(parts: u32) -> u32 {
        let bits = parts.wrapping_mul(M2);
        (bits ^ (bits >> 15)).wrapping_mul(M1)
    }
}

#[cfg(test)]
mod tests {
    use super::LatticeHash;
    use crate::Seed;

    /// Returns the hash of a corner of the three-dimensional lattice.
    fn hash(seed: u64, [x, y, z]: [i64; 3]) -> u32 {
        let hash = LatticeHash::<3>::new(Seed(seed));
        LatticeHash::<3>::bits(hash.part(0, x) ^ hash.part(1, y) ^ hash.part(2, z))
    }

    #[test]
    fn every_bit_of_a_corner_flips_half_of_the_upper_bits() {
        // The standard deviation over 2^14 trials is 0.004.
        let n = 1 << 14;
        let mut worst = (0.0_f64, 0, 0);
        for bit in 0..4 * 64 {
            let mut flips = [0_u32; 32];
            for sample in 0..n {
                let draw = |lane: u64| {
                    let bits = Seed(lane).child("avalanche", sample).0;
                    if sample % 2 == 0 { bits % 64 } else { bits }
                };
                let mut words = [draw(0), draw(1), draw(2), draw(3)];
                let all = |words: [u64; 4]| {
                    let [seed, x, y, z] = words;
                    hash(seed, [x, y, z].map(u64::cast_signed))
                };
                let base = all(words);
                words[bit / 64] ^= 1 << (bit % 64);
                let changed = base ^ all(words);
                for (output, flips) in flips.iter_mut().enumerate() {
                    *flips += changed >> output & 1;
                }
            }
            // The upper 24 bits choose a gradient, and nearly always the first five of them decide.
            for (output, &flips) in flips.iter().enumerate().skip(24) {
                let rate = (f64::from(flips) / n as f64 - 0.5).abs();
                if rate > worst.0 {
                    worst = (rate, bit, output);
                }
            }
        }
        assert!(worst.0 < 0.02, "{worst:?}");
    }

    #[test]
    fn neighboring_corners_are_not_correlated() {
        let value = |x: i64, y: i64| f64::from(hash(1, [x, y, 0])) / 4_294_967_296.0 - 0.5;
        let side = 512;
        for [dx, dy] in [
            [1, 0],
            [0, 1],
            [1, 1],
            [1, -1],
            [2, 0],
            [0, 2],
            [256, 0],
            [0, 256],
        ] {
            let mut sum = 0.0;
            for (x, y) in (0..side * side).map(|at| (at % side, at / side)) {
                sum += value(x, y) * value(x + dx, y + dy);
            }
            // Independent numbers have a standard deviation of 1 / 512.
            let correlation = sum * 12.0 / (side * side) as f64;
            assert!(correlation.abs() < 0.01, "{dx}, {dy}: {correlation}");
        }
    }

    #[test]
    fn corners_of_rectangles_are_not_correlated() {
        // The parts of these corners cancel, so only the final mixing separates their bits.
        let side = 512;
        for [dx, dy] in [[1, 1], [1, 2], [3, 1], [16, 16], [256, 256]] {
            let mut odd = [0_u32; 32];
            for (x, y) in (0..side * side).map(|at| (at % side, at / side)) {
                let corners = [
                    [x, y, 0],
                    [x + dx, y, 0],
                    [x, y + dy, 0],
                    [x + dx, y + dy, 0],
                ];
                let bits = corners
                    .into_iter()
                    .fold(0, |bits, corner| bits ^ hash(1, corner));
                for (bit, odd) in odd.iter_mut().enumerate() {
                    *odd += bits >> bit & 1;
                }
            }
            // Independent bits have a standard deviation of 1 / 1024.
            for (bit, odd) in odd.into_iter().enumerate().skip(24) {
                let rate = f64::from(odd) / (side * side) as f64;
                assert!((rate - 0.5).abs() < 0.005, "{dx}, {dy}, bit {bit}: {rate}");
            }
        }
    }

    #[test]
    fn rows_of_corners_share_no_run() {
        // A run of eight numbers that occurs twice among 2^20 would be a repetition: the probability by chance is
        // 2^-216.
        let mut seen = std::collections::BTreeSet::new();
        for y in -512..512 {
            for x in (-512..512).step_by(8) {
                let run: [u32; 8] = core::array::from_fn(|i| hash(5, [x + i as i64, y, 0]));
                assert!(seen.insert(run), "{x}, {y}");
            }
        }
    }

    #[test]
    fn a_corner_and_its_mirror_images_differ() {
        let corners = [
            [1, 2, 0],
            [2, 1, 0],
            [-1, 2, 0],
            [1, -2, 0],
            [0, 1, 2],
            [1 << 32, 2, 0],
        ];
        let hashes = corners.map(|corner| hash(3, corner));
        for (at, hash) in hashes.iter().enumerate() {
            assert!(!hashes[..at].contains(hash), "{:?}", corners[at]);
        }
    }
}
