//! White noise per cell, from which the bands are generated.
//!
//! A value is the sum of the four 16-bit words of a hash, shifted and scaled to a mean of 0 and a variance of 1. It is
//! nearly normally distributed (its kurtosis is 2.7 instead of 3), at most 3.47 in absolute value, and computed
//! without logarithms, whose bits would differ between platforms.

use crate::error::cancelled;
use crate::{IsCancelled, WaveletError};
use dapple_hash::{CellHash, Seed};
use dapple_raster::Raster;

/// Creates a raster of white noise.
pub(crate) fn white_raster(
    size: [u32; 2],
    words: Seed,
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, WaveletError> {
    let made = Raster::from_rows_cancellable(size, is_cancelled, |row| {
        let row = CellHash::new(words, [row.into()]);
        (0..size[0]).map(move |column| white(row, column))
    })?;
    made.ok_or_else(cancelled)
}

/// Returns the white noise value of a cell, from the hash of its row and its column.
#[inline]
pub(crate) fn white(row: CellHash, column: u32) -> f32 {
    let bits = row.axis(column.into()).at(0);
    let words = [0, 16, 32, 48].map(|shift| (bits >> shift & 0xFFFF) as i32);
    let sum = words[0] + words[1] + words[2] + words[3];
    // A word has the mean (2^16 - 1) / 2 and the variance (2^32 - 1) / 12.
    (f64::from(sum - 2 * 0xFFFF) / (f64::from(u32::MAX) / 3.0).sqrt()) as f32
}

#[cfg(test)]
mod tests {
    use super::white;
    use dapple_hash::{CellHash, Seed};

    #[test]
    fn white_noise_has_the_moments_that_are_stated() {
        let n = 1_000_000;
        let mut sums = [0.0; 4];
        for index in 0..n {
            let value = f64::from(white(CellHash::new(Seed(5), [3]), index));
            assert!(value.abs() < 3.47, "{value}");
            let mut power = 1.0;
            for sum in &mut sums {
                power *= value;
                *sum += power;
            }
        }
        let moments = sums.map(|sum| sum / f64::from(n));
        // Four standard deviations of the estimates; the last one is the square root of (E x⁸ - 2.7²) / n.
        for (moment, expected, tolerance) in [
            (moments[0], 0.0, 0.004),
            (moments[1], 1.0, 0.0055),
            (moments[2], 0.0, 0.015),
            (moments[3], 2.7, 0.035),
        ] {
            assert!((moment - expected).abs() < tolerance, "{moments:?}");
        }
    }

    #[test]
    fn value_stability_white() {
        let row = CellHash::new(Seed(7), [-2]);
        assert_eq!(
            [0, 1, 2].map(|column| white(row, column)),
            [1.5924, 1.4238887, 0.22036499]
        );
    }
}
