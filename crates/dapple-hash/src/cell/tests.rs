//! Properties of the lattice hashes: every input bit flips half of the output bits, neighboring cells are not
//! correlated, and the values never change.

use super::{hash1, hash2, hash3, hash4};
use crate::{Seed, unit_f64};

/// Number of samples for each input bit. The standard deviation of a flip rate is 0.5 / sqrt(2^16) = 0.002, so that
/// 0.01 is five standard deviations: a good hash stays below it among 22 528 pairs of bits.
const SAMPLES: u32 = 1 << 16;

/// Returns the largest difference of a flip rate from 0.5, over all pairs of an input bit and an output bit.
fn worst_flip_rate<const N: usize>(hash: impl Fn(Seed, [i64; N], u32) -> u64) -> f64 {
    let input_bits = 64 * (N + 1) + 32;
    let mut flips = vec![[0_u32; 64]; input_bits];
    // Each number packs eight 8-bit counters, for the output bits `k`, `k + 8` to `k + 56`.
    let mut counters = vec![[0_u64; 8]; input_bits];
    for sample in 0..SAMPLES {
        // Half of the samples are near the origin, where textures are drawn; the others are anywhere.
        let draw = |lane: u64| {
            let bits = Seed(lane).child("avalanche", u64::from(sample)).0;
            if sample % 2 == 0 { bits % 64 } else { bits }
        };
        let seed = draw(0);
        let cell: [i64; N] = std::array::from_fn(|axis| {
            draw(axis as u64 + 1).cast_signed() - 32 * i64::from(sample % 2 == 0)
        });
        let index = u32::try_from(draw(9) % 8).unwrap();
        let base = hash(Seed(seed), cell, index);
        for (bit, counters) in counters.iter_mut().enumerate() {
            let (mut seed, mut cell, mut index) = (seed, cell, index);
            match bit {
                0..64 => seed ^= 1 << bit,
                64..96 => index ^= 1 << (bit - 64),
                _ => cell[(bit - 96) / 64] ^= 1 << ((bit - 96) % 64),
            }
            let changed = base ^ hash(Seed(seed), cell, index);
            for (k, counter) in counters.iter_mut().enumerate() {
                *counter += changed >> k & 0x0101_0101_0101_0101;
            }
        }
        // Flush the counters before they overflow.
        if sample % 128 == 127 {
            for (flips, counters) in flips.iter_mut().zip(&mut counters) {
                for (output, flips) in flips.iter_mut().enumerate() {
                    *flips += u32::from(counters[output % 8].to_le_bytes()[output / 8]);
                }
                *counters = [0; 8];
            }
        }
    }
    let rates = flips
        .as_flattened()
        .iter()
        .map(|&count| f64::from(count) / f64::from(SAMPLES));
    rates.map(|rate| (rate - 0.5).abs()).fold(0.0, f64::max)
}

#[test]
fn every_input_bit_flips_every_output_bit_half_of_the_time() {
    let worst = [
        worst_flip_rate(hash1),
        worst_flip_rate(hash2),
        worst_flip_rate(hash3),
        worst_flip_rate(hash4),
    ];
    assert!(
        worst.iter().all(|&worst| worst <= 0.01),
        "the flip rates are off by up to {worst:?}"
    );
}

#[test]
fn neighboring_cells_are_not_correlated() {
    // The correlation of n pairs of independent numbers has a standard deviation of 1 / sqrt(n) = 0.002.
    let side = 512_i64;
    let seed = Seed(1).child("correlation", 0);
    let value = |x: i64, y: i64, index: u32| unit_f64(hash2(seed, [x, y], index)) - 0.5;
    for [dx, dy, di] in [
        [1, 0, 0],
        [0, 1, 0],
        [1, 1, 0],
        [1, -1, 0],
        [2, 0, 0],
        [0, 2, 0],
        [256, 0, 0],
        [0, 0, 1],
    ] {
        let mut sum = 0.0;
        for y in 0..side {
            for x in 0..side {
                sum += value(x, y, 0) * value(x + dx, y + dy, u32::try_from(di).unwrap());
            }
        }
        let correlation = sum * 12.0 / (side * side) as f64;
        assert!(
            correlation.abs() < 0.01,
            "cells {dx}, {dy} apart have correlation {correlation}"
        );
    }
}

#[test]
fn a_cell_and_its_mirror_images_differ() {
    let seed = Seed(3);
    let cells = [[1, 2], [2, 1], [-1, 2], [1, -2], [-2, -1]];
    let hashes = cells.map(|cell| hash2(seed, cell, 0));
    for (at, hash) in hashes.iter().enumerate() {
        assert!(
            !hashes[..at].contains(hash),
            "two of {cells:?} share a hash"
        );
    }
}

#[test]
fn value_stability_hash1() {
    assert_eq!(
        [hash1(Seed(0), [0], 0), hash1(Seed(7), [-3], 5)],
        [0, 1758703119007051325]
    );
}

#[test]
fn value_stability_hash2() {
    assert_eq!(
        [hash2(Seed(0), [0, 0], 0), hash2(Seed(7), [-3, 1 << 40], 5)],
        [0, 2897120944895400016]
    );
}

#[test]
fn value_stability_hash3() {
    assert_eq!(
        [
            hash3(Seed(0), [0, 0, 0], 0),
            hash3(Seed(7), [-3, 1 << 40, 2], 5)
        ],
        [0, 4086707429832792272]
    );
}

#[test]
fn value_stability_hash4() {
    assert_eq!(
        [
            hash4(Seed(0), [0; 4], 0),
            hash4(Seed(7), [-3, 1 << 40, 2, i64::MIN], 5)
        ],
        [0, 17530640240227978239]
    );
}
