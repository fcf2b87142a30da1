//! Tests of octaves with sines and noise.

use super::{hann, kept, octave, octave_powers, windowed};
use core::f64::consts::TAU;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::Raster;

/// Returns a wave with the given cycles per pixel along each axis.
fn wave(size: [u32; 2], frequency: [f64; 2]) -> Raster<f32> {
    let turn = |x, y| f64::from(x) * frequency[0] + f64::from(y) * frequency[1];
    Raster::from_fn(size, |x, y| libm::sin(TAU * turn(x, y) + 0.3) as f32).unwrap()
}

/// Returns white noise with a variance of 1/12.
fn noise(size: [u32; 2], seed: u64) -> Raster<f32> {
    let pixel = |x, y| unit_f32(hash2(Seed(seed), [i64::from(x), i64::from(y)], 0) as u32);
    Raster::from_fn(size, pixel).unwrap()
}

#[test]
fn octaves_end_at_powers_of_a_half() {
    let of = |indices: &[u32], n| {
        indices
            .iter()
            .map(|&index| octave(index, n))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        of(&[64, 33, 32, 17, 16, 9, 8, 1], 128),
        [0, 0, 1, 1, 2, 2, 3, 6]
    );
    assert_eq!(of(&[127, 96, 95, 65], 128), [6, 1, 0, 0]);
    assert_eq!(of(&[50, 26, 25, 13, 12], 101), [0, 0, 1, 1, 2]);
    assert_eq!(octave(0, 128), usize::MAX);
}

/// Computes the power spectrum by the definition, along rows and then along columns.
fn naive_power_spectrum(values: &[f64], [width, height]: [usize; 2]) -> Vec<f64> {
    let mut plane: Vec<[f64; 2]> = values.iter().map(|&value| [value, 0.0]).collect();
    let lines = [(width, 1, height, width), (height, width, width, 1)];
    for (length, step, n_lines, next) in lines {
        let before = plane.clone();
        for (line, frequency) in (0..n_lines).flat_map(|line| (0..length).map(move |at| (line, at)))
        {
            let mut sum = [0.0; 2];
            for at in 0..length {
                let angle = TAU * ((frequency * at) % length) as f64 / length as f64;
                let (sin, cos) = (libm::sin(angle), libm::cos(angle));
                let [re, im] = before[line * next + at * step];
                sum = [sum[0] + re * cos + im * sin, sum[1] + im * cos - re * sin];
            }
            plane[line * next + frequency * step] = sum;
        }
    }
    plane.iter().map(|[re, im]| re * re + im * im).collect()
}

#[test]
fn powers_equal_those_of_the_plain_sum() {
    let size = [36, 33];
    let image = noise(size, 9);
    let windows = [hann(36), hann(33)];
    let energy = windows
        .each_ref()
        .map(|of| of.iter().map(|w| w * w).sum::<f64>());
    let spectrum = naive_power_spectrum(&windowed(&image, &windows), [36, 33]);
    let mut expected = [0.0; 2];
    for (index, power) in (0..).zip(spectrum) {
        let [x, y] = [f64::from(index % 36) / 36.0, f64::from(index / 36) / 33.0];
        let frequency = x.min(1.0 - x).max(y.min(1.0 - y));
        if frequency > 0.125 {
            expected[usize::from(frequency <= 0.25)] += power / (36.0 * 33.0);
        }
    }
    for (power, expected) in octave_powers(&image, 2).iter().zip(expected) {
        let expected = expected / (energy[0] * energy[1]);
        // Sums of a thousand numbers in another order.
        assert!(
            (power / expected - 1.0).abs() < 1e-12,
            "{power} is not {expected}"
        );
    }
}

#[test]
fn waves_have_their_power_in_their_octave() {
    for (frequency, own) in [
        ([0.4, 0.0], 0),
        ([0.0, 0.3], 0),
        ([0.31, 0.01], 0),
        ([0.2, 0.2], 1),
        ([0.01, 0.19], 1),
        ([0.1, 0.05], 2),
        ([0.0, 0.05], 3),
    ] {
        for size in [[128, 128], [150, 131]] {
            let powers = octave_powers(&wave(size, frequency), 4);
            for (index, power) in powers.iter().enumerate() {
                let expected = if index == own { 0.5 } else { 0.0 };
                // At frequencies between the integers, a Hann window leaks at most 1/(6π) of the amplitude to bins at a
                // distance of three. Here all frequencies are two bins or more from the end of their octave.
                assert!((power - expected).abs() < 2e-3, "{frequency:?}: {powers:?}");
            }
        }
    }
}

#[test]
fn noise_has_power_in_proportion_to_area() {
    let mut sums = [0.0; 3];
    for seed in 0..20 {
        let powers = octave_powers(&noise([64, 96], seed), 3);
        sums.iter_mut()
            .zip(powers)
            .for_each(|(sum, power)| *sum += power / 20.0);
    }
    // Number of the 64 × 96 frequencies in each octave, including the corners.
    let shares = [6144 - 33 * 49, 33 * 49 - 17 * 25, 17 * 25 - 9 * 13];
    for (power, share) in sums.iter().zip(shares) {
        let relative = power / (f64::from(share) / 6144.0 / 12.0);
        // The last octave has 308 frequencies. Under the window a quarter of them is independent, in each of twenty
        // images: a standard error of 3 %.
        assert!((relative - 1.0).abs() < 0.09, "{sums:?}");
    }
}

#[test]
fn kept_power_does_not_depend_on_the_size() {
    let frequency = [0.35, 0.13];
    let large = wave([160, 128], frequency);
    let small = wave([97, 64], frequency).map(|value| value * 0.5);
    let kept = kept(&large, &small);
    assert_eq!(kept.len(), 3, "64 pixels have three octaves");
    assert!((kept[0] - 0.25).abs() < 1e-3, "{kept:?}");
}

#[test]
fn kept_is_one_for_the_image_itself_and_for_flat_images() {
    let image = noise([40, 33], 4);
    assert_eq!(kept(&image, &image), [1.0, 1.0]);
    let flat = Raster::filled([32, 32], 0.1).unwrap();
    assert_eq!(kept(&flat, &flat), [1.0, 1.0]);
}

#[test]
fn number_of_octaves_follows_the_smallest_side() {
    for (n, n_octaves) in [(1, 0), (8, 0), (15, 0), (16, 1), (31, 1), (32, 2), (128, 4)] {
        let large = noise([130, 128], 5);
        let image = noise([n, 128], 6);
        assert_eq!(kept(&large, &image).len(), n_octaves, "{n} pixels");
        assert_eq!(kept(&image, &large).len(), n_octaves, "{n} pixels");
    }
}

#[test]
fn value_stability_octaves() {
    let powers = octave_powers(&noise([32, 36], 7), 2);
    let bits = powers.iter().map(|power| power.to_bits());
    assert_eq!(
        bits.collect::<Vec<_>>(),
        [4588697536760290681, 4581194745337164105]
    );
}
