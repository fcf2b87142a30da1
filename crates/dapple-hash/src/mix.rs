//! The mixing functions that all hashes in this crate use.
//!
//! [`mix64`] is David Stafford's variant 13 of the MurmurHash3 finalizer ("Better Bit Mixing", 2011), as used by
//! SplitMix64. [`absorb`] and [`finish`] work on two 32-bit words, with multiplications that keep only the low half:
//! eight of them run in parallel in an AVX2 register, and shading languages support them too.

/// The increment of SplitMix64: the golden ratio as a 64-bit fraction, with its lowest bit set to make it odd.
pub(crate) const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

// Odd multipliers with about half of their bits set; the avalanche test verifies their quality.
pub(crate) const M0: u32 = 0x9E37_79B1;
pub(crate) const M1: u32 = 0x85EB_CA6B;
pub(crate) const M2: u32 = 0xC2B2_AE35;
pub(crate) const M3: u32 = 0x27D4_EB2F;

// Multipliers of `mix32`
pub(crate) const N0: u32 = 0x7FEB_352D;
pub(crate) const N1: u32 = 0x846C_A68B;

/// Applies a bijection of 64-bit words in which every input bit flips every output bit about half of the time.
pub(crate) const fn mix64(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Applies a bijection of 32-bit words in which every input bit flips every output bit about half of the time. With
/// only two multiplications, it is intended for bits that are derived from already random bits, such as the bits of a
/// [`CellHash`](crate::CellHash).
///
/// Chris Wellons found the constants by search ("Prospecting for Hash Functions", 2018).
#[must_use]
#[inline]
pub const fn mix32(mut bits: u32) -> u32 {
    bits = (bits ^ (bits >> 16)).wrapping_mul(N0);
    bits = (bits ^ (bits >> 15)).wrapping_mul(N1);
    bits ^ (bits >> 16)
}

/// Absorbs one word into the state. For a fixed word this is a bijection of the state, so no two states are merged.
#[inline(always)]
pub(crate) const fn absorb([mut a, mut b]: [u32; 2], word: u32) -> [u32; 2] {
    a = (a ^ word).wrapping_mul(M0);
    a ^= a >> 15;
    b = (b ^ a).wrapping_mul(M1);
    b ^= b >> 13;
    [a.wrapping_add(b.rotate_left(11)), b]
}

/// Diffuses the last absorbed words over all 64 bits.
#[inline(always)]
pub(crate) const fn finish([mut a, mut b]: [u32; 2]) -> [u32; 2] {
    a = (a ^ (a >> 16)).wrapping_mul(M2);
    b = b.wrapping_add(a ^ (a >> 15)).wrapping_mul(M3);
    b ^= b >> 15;
    a = a.wrapping_add(b).wrapping_mul(M1);
    a ^= a >> 13;
    b = (b ^ a).wrapping_mul(M0);
    b ^= b >> 16;
    [a ^ b.rotate_left(7), b]
}

#[cfg(test)]
mod tests {
    use super::mix32;

    #[test]
    fn mix32_flips_half_of_the_bits_for_every_bit() {
        for bit in 0..32 {
            let mut flips = [0_u32; 32];
            let n = 4096;
            for index in 0..n {
                let input = mix32(index).rotate_left(7) ^ index;
                let change = mix32(input) ^ mix32(input ^ 1 << bit);
                for (output, flips) in flips.iter_mut().enumerate() {
                    *flips += change >> output & 1;
                }
            }
            // The standard deviation over 4096 trials is 32; the known bias of the constants is below one in 500.
            for (output, flips) in flips.into_iter().enumerate() {
                assert!(
                    flips.abs_diff(n / 2) < 200,
                    "bit {bit} flips bit {output} {flips} times"
                );
            }
        }
    }

    #[test]
    fn value_stability_mix32() {
        assert_eq!([0, 1, 0xDEAD_BEEF].map(mix32), [0, 1753845952, 3861431939]);
    }
}
