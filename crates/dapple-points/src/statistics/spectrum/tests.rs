//! Tests of spectra of noise, lattices and disk sets, and of invalid input.

use super::{SpectrumOptions, spectrum};
use crate::statistics::test_sets::{domains, random_set};
use crate::{Domain, PointSet, PointsErrorKind};
use core::{f64::consts::TAU, slice};
use dapple_hash::{Seed, hash1, unit_f64};
use glam::DVec2;

/// Returns the ring means and variances of the spectrum by the formula, one frequency at a time.
fn naive_rings(sets: &[PointSet], options: &SpectrumOptions) -> Vec<(u32, f64, f64)> {
    let size = sets[0].domain().size;
    let n_points: f64 = sets.iter().map(|set| set.len() as f64).sum();
    let unit = (n_points / sets.len() as f64 / sets[0].domain().area()).sqrt();
    let n_rings = (options.highest_frequency / options.ring_width).ceil() as usize;
    let mut powers = vec![Vec::new(); n_rings];
    let [columns, rows] =
        [size.x, size.y].map(|side| (side * unit * options.highest_frequency) as i32);
    for x in 0..=columns {
        for y in (if x == 0 { 1 } else { -rows })..=rows {
            let frequency = DVec2::new(f64::from(x), f64::from(y)) / size;
            let ring = (frequency.length() / unit / options.ring_width) as usize;
            if ring >= n_rings {
                continue;
            }
            let power = sets.iter().map(|set| power_at(set, frequency)).sum::<f64>();
            powers[ring].push(power / sets.len() as f64);
        }
    }
    powers
        .iter()
        .filter(|powers| !powers.is_empty())
        .map(|powers| {
            let count = powers.len() as f64;
            let mean = powers.iter().sum::<f64>() / count;
            let squares: f64 = powers
                .iter()
                .map(|power| (power - mean) * (power - mean))
                .sum();
            (powers.len() as u32, mean, squares / (count - 1.0))
        })
        .collect()
}

fn power_at(set: &PointSet, frequency: DVec2) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (_, position) in set.iter() {
        let angle = TAU * frequency.dot(position - set.domain().origin);
        re += libm::cos(angle);
        im += libm::sin(angle);
    }
    (re * re + im * im) / set.len() as f64
}

#[test]
fn spectrum_equals_the_formula() {
    let options = SpectrumOptions {
        highest_frequency: 1.5,
        ring_width: 0.2,
    };
    for domain in domains() {
        // Numbers of points below and above a block size, not multiples of the lanes.
        let sets = [random_set(domain, 37, 1), random_set(domain, 301, 2)];
        let naive = naive_rings(&sets, &options);
        let rings = spectrum(&sets, &options).unwrap().rings;
        assert_eq!(rings.len(), naive.len(), "rings in {domain:?}");
        for (ring, (count, power, variance)) in rings.iter().zip(naive) {
            assert_eq!(ring.n_frequencies, count, "{ring:?} in {domain:?}");
            // Angles reach 300 radians with 53 bits, and up to 338 of them are summed, squared.
            assert!(
                (ring.power - power).abs() < 1e-9 * (1.0 + power),
                "{ring:?}, not {power}"
            );
            let anisotropy = variance * 2.0 / (power * power);
            assert!(
                count == 1 || (ring.anisotropy - anisotropy).abs() < 1e-7 * anisotropy,
                "{ring:?}, not {anisotropy}"
            );
        }
    }
}

/// Returns sets of white noise.
fn white(n_sets: u64, n_points: i64) -> Vec<PointSet> {
    let set = |index| {
        let unit = |point, axis| unit_f64(hash1(Seed(1).child("white", index), [point], axis));
        let positions = (0..n_points).map(|point| DVec2::new(unit(point, 0), unit(point, 1)));
        PointSet::new(Domain::torus(DVec2::ZERO, DVec2::ONE), positions.collect()).unwrap()
    };
    (0..n_sets).map(set).collect()
}

#[test]
fn white_noise_has_power_and_anisotropy_one() {
    let spectrum = spectrum(&white(10, 1000), &SpectrumOptions::default()).unwrap();
    // 6300 frequencies and 10 sets: four standard deviations of the mean power, and of its variance.
    let power = spectrum.mean_power(0.0, 2.0);
    assert!((power - 1.0).abs() < 0.016, "the power is {power}");
    let anisotropy = spectrum.anisotropy();
    assert!(
        (anisotropy - 1.0).abs() < 0.1,
        "the anisotropy is {anisotropy}"
    );
    assert!(spectrum.peak_power() > power, "no ring is above the mean");
    assert!(
        spectrum.mean_power(5.0, 6.0).is_nan(),
        "there is no ring past 5"
    );
}

#[test]
fn a_lattice_in_the_noise_shows_as_anisotropy() {
    let sets: Vec<_> = white(5, 1024)
        .into_iter()
        .map(|set| {
            let cell = |i: usize| DVec2::new((i % 32) as f64, (i / 32) as f64);
            let jittered = set.positions().iter().enumerate();
            let positions = jittered.map(|(i, &offset)| (cell(i) + offset * 0.8) / 32.0);
            PointSet::new(*set.domain(), positions.collect()).unwrap()
        })
        .collect();
    let anisotropy = spectrum(&sets, &SpectrumOptions::default())
        .unwrap()
        .anisotropy();
    assert!(anisotropy > 2.0, "the anisotropy is {anisotropy}");
}

#[test]
fn spectrum_refuses_what_it_cannot_measure() {
    let default = SpectrumOptions::default();
    let set = random_set(Domain::paper_torus(), 10, 1);
    let kind = |sets: &[PointSet], options: &SpectrumOptions| {
        spectrum(sets, options).unwrap_err().kind().clone()
    };
    assert_eq!(kind(&[], &default), PointsErrorKind::NoPoints);
    let empty = PointSet::new(*set.domain(), Vec::new()).unwrap();
    assert_eq!(
        kind(&[set.clone(), empty], &default),
        PointsErrorKind::NoPoints
    );
    let other = random_set(Domain::torus(DVec2::ZERO, DVec2::ONE), 10, 1);
    assert!(
        matches!(
            kind(&[set.clone(), other], &default),
            PointsErrorKind::DifferentDomains { .. }
        ),
        "two domains were accepted"
    );
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for options in [
            SpectrumOptions {
                highest_frequency: bad,
                ..default
            },
            SpectrumOptions {
                ring_width: bad,
                ..default
            },
        ] {
            assert!(
                matches!(
                    kind(slice::from_ref(&set), &options),
                    PointsErrorKind::NotPositive { .. }
                ),
                "{options:?} was accepted"
            );
        }
    }
    for options in [
        SpectrumOptions {
            highest_frequency: 1e200,
            ..default
        },
        SpectrumOptions {
            ring_width: 1e-200,
            ..default
        },
    ] {
        assert!(
            matches!(
                kind(slice::from_ref(&set), &options),
                PointsErrorKind::TooManyFrequencies { .. }
            ),
            "{options:?} was accepted"
        );
    }
}

#[test]
fn value_stability_spectrum() {
    let spectrum = spectrum(&white(2, 500), &SpectrumOptions::default()).unwrap();
    assert_eq!(spectrum.anisotropy().to_bits(), 4607231088435337625);
    assert_eq!(spectrum.peak_power().to_bits(), 4608380555698398217);
}

#[cfg(feature = "rayon")]
#[test]
fn spectrum_is_the_same_for_any_number_of_threads() {
    let sets = white(2, 700);
    let on_threads = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build()
            .unwrap();
        pool.install(|| spectrum(&sets, &SpectrumOptions::default()).unwrap())
    };
    let single = on_threads(1);
    for n_threads in [2, 7] {
        assert_eq!(on_threads(n_threads), single, "{n_threads} threads");
    }
}
