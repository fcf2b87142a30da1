//! Tests of seam ratios against values computed by hand and naive sums.

use super::{SeamOptions, SeamRatio, seams};
use crate::SeamReport;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::{Raster, Wrap};
use dapple_wavelet::{Border, SplineFilter};

/// Returns white noise from 0 to 1.
fn noise(size: [u32; 2], seed: u64) -> Raster<f32> {
    let pixel = |x, y| unit_f32(hash2(Seed(seed), [i64::from(x), i64::from(y)], 0) as u32);
    Raster::from_fn(size, pixel).unwrap()
}

fn with_lattice(lattice: u32) -> SeamOptions {
    SeamOptions {
        lattice: [lattice; 2],
        ..SeamOptions::default()
    }
}

/// Computes the step across a boundary of columns by the definition.
fn naive_step(tile: &Raster<f32>, boundary: i64, width: u32) -> f64 {
    let mean = |first: i64, row: u32| {
        let columns = first..first + i64::from(width);
        let pixel = |column| f64::from(*tile.at(column, i64::from(row), [Wrap::Repeat; 2]));
        columns.map(pixel).sum::<f64>() / f64::from(width)
    };
    let step = |row| (mean(boundary, row) - mean(boundary - i64::from(width), row)).abs();
    (0..tile.height()).map(step).sum::<f64>() / f64::from(tile.height())
}

/// Computes the ratio along x and its spread by the definition.
fn naive_ratio(tile: &Raster<f32>, width: u32, lattice: u32) -> Option<(f64, f64)> {
    let fits = |&at: &u32| at % lattice == 0 && at >= width && at + width <= tile.width();
    let inside: Vec<f64> = (1..tile.width())
        .filter(fits)
        .map(|at| naive_step(tile, i64::from(at), width))
        .collect();
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    let variance = inside.iter().map(|step| (step - mean) * (step - mean));
    let variance = variance.sum::<f64>() / (inside.len() as f64 - 1.0);
    let ratio = naive_step(tile, 0, width) / mean;
    (!inside.is_empty()).then(|| (ratio, variance.sqrt() / mean))
}

#[test]
fn ratios_equal_their_definition() {
    for (size, lattice) in [
        ([24, 10], 1),
        ([24, 10], 2),
        ([48, 7], 4),
        ([45, 3], 5),
        ([9, 9], 1),
    ] {
        let tile = noise(size, u64::from(lattice));
        let options = SeamOptions {
            axes: [true, false],
            lattice: [lattice, 1],
        };
        for seam in seams(&tile, &options).unwrap() {
            let naive = naive_ratio(&tile, seam.width, lattice);
            assert_eq!(
                seam.x.is_some(),
                naive.is_some(),
                "{size:?} at {}",
                seam.width
            );
            let Some((SeamRatio { ratio, spread }, naive)) = seam.x.zip(naive) else {
                continue;
            };
            // Sums of at most 500 numbers below 10, in another order.
            assert!(
                (ratio - naive.0).abs() < 1e-12,
                "{ratio} is not {}",
                naive.0
            );
            if let Some(spread) = spread {
                assert!(
                    (spread - naive.1).abs() < 1e-12,
                    "{spread} is not {}",
                    naive.1
                );
            }
            assert_eq!(spread.is_some(), naive.1.is_finite(), "at {}", seam.width);
        }
    }
}

#[test]
fn ratios_of_a_small_raster_are_as_by_hand() {
    // Along x, the steps across the wraps are 5 and 5, and the steps inside 1, 2, 2 and 1, 3, 1. Along y, the step
    // across the wrap equals the step inside.
    let tile = Raster::from_vec([4, 2], vec![0.0, 1.0, 3.0, 5.0, 6.0, 5.0, 2.0, 1.0]).unwrap();
    let [one, two, four, _] = seams(&tile, &SeamOptions::default()).unwrap();
    let x = one.x.unwrap();
    assert_eq!(x.ratio, 5.0 / ((1.0 + 2.5 + 1.5) / 3.0));
    assert_eq!(one.y.unwrap().ratio, 1.0);
    assert_eq!(one.y.unwrap().spread, None, "there is one boundary inside");
    // With means of 2 pixels there is one boundary inside, and the wrap has the same step.
    assert_eq!(two.x.unwrap().ratio, 1.0);
    assert_eq!((two.y, two.both), (None, None));
    assert_eq!((four.x, four.y, four.both), (None, None, None));
}

#[test]
fn ratio_of_a_ramp_is_its_length_less_one() {
    for n in [3, 10, 100] {
        let ramp = Raster::from_fn([n, 4], |x, _| x as f32).unwrap();
        let x = seams(&ramp, &SeamOptions::default()).unwrap()[0].x.unwrap();
        assert_eq!((x.ratio, x.spread), (f64::from(n - 1), Some(0.0)));
    }
}

#[test]
fn ratio_of_a_periodic_sine_is_one() {
    // A wave along the diagonal, so that every line has another phase.
    let wave = |x: u32, y: u32| libm::sin(core::f64::consts::TAU * f64::from(3 * x + 5 * y) / 64.0);
    let tile = Raster::from_fn([64, 64], |x, y| wave(x, y) as f32).unwrap();
    for seam in seams(&tile, &SeamOptions::default()).unwrap() {
        for ratio in [seam.x, seam.y, seam.both].map(Option::unwrap) {
            // Pixels are rounded to 24 bits, and steps are at least 1/100 of them.
            assert!((ratio.ratio - 1.0).abs() < 1e-5, "{seam:?}");
        }
    }
}

#[test]
fn ratio_stays_near_one_when_a_periodic_image_is_shifted() {
    let tile = noise([64, 64], 5);
    for shift in [[0, 0], [1, 0], [13, 40], [32, 32]] {
        let at = |x, y| {
            *tile.at(
                i64::from(x + shift[0]),
                i64::from(y + shift[1]),
                [Wrap::Repeat; 2],
            )
        };
        let moved = Raster::from_fn([64, 64], at).unwrap();
        for seam in seams(&moved, &SeamOptions::default()).unwrap() {
            // 128 independent lines: 0.7 / √128 = 0.06 for one standard deviation.
            assert!((seam.both.unwrap().ratio - 1.0).abs() < 0.25, "{seam:?}");
        }
    }
}

#[test]
fn spread_tells_how_far_from_one_good_tiles_are() {
    let (mut off, mut spread) = (0.0, 0.0);
    for seed in 0..200 {
        let both = seams(&noise([32, 32], seed), &SeamOptions::default()).unwrap()[0]
            .both
            .unwrap();
        off += (both.ratio - 1.0) * (both.ratio - 1.0);
        spread += both.spread.unwrap() * both.spread.unwrap();
    }
    // 200 squares have a standard error of √(2/200) = 0.1, and the mean inside is itself uncertain by 1/60.
    assert!((off / spread - 1.0).abs() < 0.35, "{}", off / spread);
}

#[test]
fn seam_of_a_mirror_image_is_exactly_zero() {
    let half = noise([20, 20], 6);
    let at = |x, y| *half.at(i64::from(x), i64::from(y), [Wrap::Mirror; 2]);
    let tile = Raster::from_fn([40, 40], at).unwrap();
    for seam in seams(&tile, &SeamOptions::default()).unwrap() {
        assert_eq!(seam.both.unwrap().ratio, 0.0, "at {} pixels", seam.width);
    }
}

#[test]
fn flat_tiles_have_no_seam_and_steps_on_flat_ground_are_finite() {
    let flat = Raster::filled([32, 32], 0.1).unwrap();
    for seam in seams(&flat, &SeamOptions::default()).unwrap() {
        let expected = SeamRatio {
            ratio: 1.0,
            spread: Some(0.0),
        };
        assert_eq!(seam.both, Some(expected), "at {} pixels", seam.width);
    }
    // All steps are at boundaries off the lattice.
    let steps = Raster::from_fn([32, 32], |x, _| if x < 2 { 0.1 } else { 0.7 }).unwrap();
    let x = seams(&steps, &with_lattice(8)).unwrap()[0].x.unwrap();
    assert_eq!((x.ratio, x.spread), (SeamReport::MOST, Some(0.0)));
}

#[test]
fn lattice_leaves_out_other_boundaries() {
    // Pairs of equal pixels: the step within a pair is 0, and the wrap is between pairs.
    let pairs = Raster::from_fn([64, 64], |x, y| {
        noise([32, 32], 7).row(y / 2)[x as usize / 2]
    });
    let pairs = pairs.unwrap();
    let ratio = |lattice| {
        seams(&pairs, &with_lattice(lattice)).unwrap()[0]
            .both
            .unwrap()
            .ratio
    };
    assert!((ratio(2) - 1.0).abs() < 0.2, "{}", ratio(2));
    assert!(
        (ratio(1) / ratio(2) - 63.0 / 31.0).abs() < 1e-9,
        "{}",
        ratio(1)
    );
}

#[test]
fn spline_tiles_score_one_beside_boundaries_of_their_lattice_only() {
    let filter = SplineFilter::default();
    let mut means = [0.0; 2];
    for seed in 0..200 {
        let tile = filter
            .project(&noise([64, 64], seed), 1, [Border::Periodic; 2])
            .unwrap();
        for (mean, lattice) in means.iter_mut().zip([1, 2]) {
            *mean += seams(&tile, &with_lattice(lattice)).unwrap()[0]
                .both
                .unwrap()
                .ratio
                / 200.0;
        }
    }
    let [naive, matched] = means;
    // The exact ratio of 0.654 to the mean of 0.654 and 0.267 is 1.42. It is the ratio along one axis; across both it
    // is less.
    assert!((naive - 1.42).abs() < 0.02, "{naive}");
    // A tile has 128 lines, and neighboring lines are correlated. 200 tiles give a standard error of about half a
    // percent.
    assert!((matched - 1.0).abs() < 0.015, "{matched}");
}

#[test]
fn value_stability_seams() {
    let [one, _, four, eight] = seams(&noise([40, 24], 8), &with_lattice(2)).unwrap();
    let bits = [one.x, one.y, four.both, eight.both].map(|seam| seam.unwrap().ratio.to_bits());
    assert_eq!(
        bits,
        [
            4607591720731884452,
            4607437158837004946,
            4606007214566683954,
            4607296228417936410
        ]
    );
}
