//! Tests of noise tiles: no seam, documented powers, value stability.

use super::{wavelet_tile, wavelet_tile_cancellable};
use crate::{
    Border, IsCancelled, SplineFilter, WaveletError, WaveletErrorKind, WaveletNoise2, WaveletNoise3,
};
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use dapple_hash::Seed;
use dapple_raster::{Raster, RasterErrorKind};

fn mean_square(raster: &Raster<f32>) -> f64 {
    let squares = raster
        .pixels()
        .iter()
        .map(|&value| f64::from(value) * f64::from(value));
    squares.sum::<f64>() / raster.pixels().len() as f64
}

fn most(raster: &Raster<f32>) -> f32 {
    raster
        .pixels()
        .iter()
        .fold(0.0, |most, value| most.max(value.abs()))
}

#[test]
fn bands_have_the_mean_squares_of_their_weights() {
    for level in 0..4 {
        let mut weights = [0.0; 4];
        weights[level] = 0.5;
        let seeds = 32 << level;
        let tiles = (0..seeds).map(|seed| wavelet_tile([64, 32], &weights, Seed(seed)).unwrap());
        let mean = tiles.map(|tile| mean_square(&tile)).sum::<f64>() / seeds as f64;
        // At the coarsest level, 256 tiles with 24 independent values each: the mean is accurate to 2 %.
        assert!((mean / 0.25 - 1.0).abs() < 0.06, "{level}: {mean}");
    }
}

#[test]
fn tiny_tiles_have_the_mean_squares_of_their_weights() {
    for (size, weights) in [([2, 2], &[1.0][..]), ([4, 8], &[0.0, 1.0])] {
        let tiles = (0..4000).map(|seed| wavelet_tile(size, weights, Seed(seed)).unwrap());
        let mean = tiles.map(|tile| mean_square(&tile)).sum::<f64>() / 4000.0;
        // At least 12000 independent values: 1.3 %, four standard deviations.
        assert!((mean - 1.0).abs() < 0.05, "{size:?}: {mean}");
    }
}

#[test]
fn analysis_finds_the_bands_again() {
    let filter = SplineFilter::default();
    let alone = |weights: &[f32]| {
        let tile = wavelet_tile([64, 32], weights, Seed(3)).unwrap();
        filter.analyze(&tile, 3, [Border::Periodic; 2]).unwrap()
    };
    let together = alone(&[1.0, -0.5, 0.25]);
    assert!(
        most(&together.coarse) < 1e-5,
        "coarser than all bands: {}",
        most(&together.coarse)
    );
    for level in 0..3 {
        let mut weights = [0.0; 3];
        weights[level] = [1.0, -0.5, 0.25][level];
        let bands = alone(&weights);
        for other in 0..3 {
            let detail = &bands.details[other];
            // Values below 10 that were rounded to `f32` a few times
            if other == level {
                let difference = detail
                    .zip_map(&together.details[level], |a, b| a - b)
                    .unwrap();
                assert!(most(&difference) < 1e-5, "{level}: {}", most(&difference));
                assert!(most(detail) > 0.1, "{level} is nothing");
            } else {
                assert!(most(detail) < 1e-5, "{level} in {other}: {}", most(detail));
            }
        }
    }
}

#[test]
fn seam_is_like_any_other_boundary_of_its_phase() {
    let mut sums = [0.0; 2];
    for seed in 0..50 {
        let tile = wavelet_tile([64, 32], &[1.0, 1.0, 1.0], Seed(seed)).unwrap();
        for row in 0..32 {
            let row = tile.row(row);
            let step = |at: usize| f64::from((row[(at + 1) % 64] - row[at]).abs());
            sums[0] += step(63);
            // The noise is stationary only under shifts by eight pixels.
            sums[1] += (7..63).step_by(8).map(step).sum::<f64>() / 7.0;
        }
    }
    // 1600 steps, some hundreds of them independent
    let ratio = sums[0] / sums[1];
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn tile_is_the_same_at_any_number_of_threads() {
    let make = || wavelet_tile([96, 40], &[1.0, 0.5, 2.0], Seed(6)).unwrap();
    let expected = make();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        assert!(
            pool.unwrap().install(make) == expected,
            "{threads} threads give other bits"
        );
    }
}

#[test]
fn bad_sizes_and_weights_are_refused() {
    let kind = |size, weights: &[f32]| {
        wavelet_tile(size, weights, Seed(0))
            .unwrap_err()
            .kind()
            .clone()
    };
    for (size, length) in [([1, 8], 1), ([8, 1], 1), ([3, 4], 3), ([8, 6], 6)] {
        let expected = WaveletErrorKind::NotDivisible { length, levels: 2 };
        assert_eq!(kind(size, &[1.0, 1.0]), expected);
    }
    let is_empty = |error: &RasterErrorKind| matches!(error, RasterErrorKind::Empty { .. });
    let is_too_large = |error: &RasterErrorKind| matches!(error, RasterErrorKind::TooLarge { .. });
    let of_raster = |size| match kind(size, &[1.0]) {
        WaveletErrorKind::Raster(error) => error.kind().clone(),
        other => panic!("{other:?}"),
    };
    assert!(is_empty(&of_raster([0, 8])), "no columns");
    assert!(is_too_large(&of_raster([1 << 20, 1 << 20])), "2^40 pixels");
    for count in [0, 17] {
        let fits = matches!(kind([4, 4], &vec![1.0; count]),
            WaveletErrorKind::Range { value, .. } if value == count as f64);
        assert!(fits, "{count} weights");
    }
    let fits = matches!(
        kind([4, 4], &[0.0, f32::NAN]),
        WaveletErrorKind::NotFinite { index: 1, .. }
    );
    assert!(fits, "NaN as a weight");
}

#[test]
fn value_stability_wavelet_tile() {
    let tile = wavelet_tile([16, 8], &[1.0, 0.5], Seed(7)).unwrap();
    assert_eq!(
        tile.row(3)[4..8],
        [1.5378956, -1.085114, 0.890169, 0.47323287]
    );
}

/// Checks that cancellation at each call gives the typed error, and that the result is unchanged without cancellation.
/// Returns the number of calls.
fn check_cancel<T: PartialEq>(
    made: &T,
    make: impl Fn(&IsCancelled) -> Result<T, WaveletError>,
) -> usize {
    let made_until = |last: usize| {
        let n_calls = AtomicUsize::new(0);
        let made = make(&|| n_calls.fetch_add(1, Relaxed) >= last);
        (made, n_calls.into_inner())
    };
    let (whole, n_calls) = made_until(usize::MAX);
    assert!(whole.is_ok_and(|whole| whole == *made));
    for last in 0..n_calls {
        let error = made_until(last).0.err().map(|error| error.kind().clone());
        assert_eq!(error, Some(WaveletErrorKind::Cancelled), "at call {last}");
    }
    n_calls
}

#[test]
fn tiles_and_noise_can_be_cancelled_at_every_call() {
    let (size, weights) = ([256, 512], [0.5, 1.0]);
    let made = wavelet_tile(size, &weights, Seed(7)).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        wavelet_tile_cancellable(size, &weights, Seed(7), stop)
    });
    // The fine band makes two calls each for the noise, its rows and the sum, and one each for its columns and both
    // doublings; the coarse band makes a call for each of the five.
    assert_eq!(n_calls, 2 + 2 + 2 + 1 + 1 + 1 + 5);

    let made = WaveletNoise2::of_size(size, Seed(7)).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        WaveletNoise2::of_size_cancellable(size, Seed(7), stop)
    });
    assert_eq!(n_calls, 2 + (2 + 1) + 1 + 2 + 1, "of noise in the plane");

    let size = [32, 64, 64];
    let made = WaveletNoise3::of_size(size, Seed(7)).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        WaveletNoise3::of_size_cancellable(size, Seed(7), stop)
    });
    // Halving goes through 4096, 1024 and 512 lines, 256 at a time.
    assert_eq!(n_calls, 2 + (16 + 4 + 2) + 1 + 2 + 1, "of noise in space");
}

#[test]
fn filters_can_be_cancelled_at_every_call() {
    let (filter, borders) = (SplineFilter::default(), [Border::Mirror; 2]);
    let image = Raster::from_fn([300, 70], |x, y| (x * y % 7) as f32).unwrap();
    let made = filter.analyze(&image, 2, borders).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        filter.analyze_cancellable(&image, 2, borders, stop)
    });
    assert_eq!(n_calls, 2 * 4, "for rows, columns, doubling and difference");
    let whole = filter.synthesize(&made, borders).unwrap();
    let n_calls = check_cancel(&whole, |stop| {
        filter.synthesize_cancellable(&made, borders, stop)
    });
    assert_eq!(n_calls, 2 * 2, "for doubling and sum");
    let made = filter.coefficients(&image, borders).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        filter.coefficients_cancellable(&image, borders, stop)
    });
    assert_eq!(n_calls, 1 + 2, "for rows and columns");
    let made = filter.samples(&image, borders).unwrap();
    let n_calls = check_cancel(&made, |stop| {
        filter.samples_cancellable(&image, borders, stop)
    });
    assert_eq!(n_calls, 1 + 2, "for rows and columns");
}
