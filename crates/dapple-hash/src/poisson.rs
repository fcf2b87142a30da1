//! Poisson-distributed counts from a table.
//!
//! Steven Worley draws the number of feature points in a cell from a Poisson distribution with a precomputed table
//! ("A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>), and clamps it. Here
//! the table contains the cumulative probabilities as 32-bit integers, so that drawing compares integers and involves
//! no rounding.

use alloc::vec::Vec;
use core::fmt;

/// Maximum mean that a table accepts.
const MEAN_LIMIT: f64 = 64.0;

/// A table that maps 32 random bits to a Poisson-distributed count with a given mean, clamped to a range.
///
/// # Examples
///
/// ```
/// use dapple_hash::PoissonCounts;
///
/// let counts = PoissonCounts::new(3.0, 1..=9)?;
/// assert_eq!(counts.count(0), 1);
/// assert_eq!(counts.count(u32::MAX), 9);
/// # Ok::<(), dapple_hash::PoissonError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PoissonCounts {
    least: u32,
    /// `thresholds[k]` is the probability that the count is at most `least + k`, times 2^32.
    thresholds: Vec<u32>,
}

impl PoissonCounts {
    /// Creates the table for `mean` (above 0, at most 64) with counts clamped to `range`.
    ///
    /// The probability of counts below the range is added to its start, and the probability of counts above it to its
    /// end. A range up to `u32::MAX` leaves the counts unclamped, except for counts with a total probability below
    /// 2^-32.
    ///
    /// # Errors
    ///
    /// [`PoissonErrorKind::Mean`] if `mean` is not in `(0, 64]`, [`PoissonErrorKind::EmptyRange`] if `range` is empty.
    pub fn new(mean: f64, range: core::ops::RangeInclusive<u32>) -> Result<Self, PoissonError> {
        if !(mean > 0.0 && mean <= MEAN_LIMIT) {
            return Err(PoissonError {
                kind: PoissonErrorKind::Mean { mean },
            });
        }
        let (least, most) = range.into_inner();
        if least > most {
            return Err(PoissonError {
                kind: PoissonErrorKind::EmptyRange { least, most },
            });
        }
        let mut thresholds = Vec::new();
        let mut probability = libm::exp(-mean);
        let mut cumulative = 0.0;
        for count in 0..most {
            cumulative += probability;
            probability *= mean / f64::from(count + 1);
            if count < least {
                continue;
            }
            let threshold = (cumulative * (1_u64 << 32) as f64) as u64;
            // End of an unclamped table: the count is past the mean, and the remaining probability is below the
            // resolution of 32 bits.
            let Ok(threshold) = u32::try_from(threshold) else {
                break;
            };
            thresholds.push(threshold);
            if f64::from(count) > mean && probability * 4.0 < 1.0 / (1_u64 << 33) as f64 {
                break;
            }
        }
        Ok(Self { least, thresholds })
    }

    /// Returns the count for 32 random bits, which never decreases as `bits` increases.
    #[must_use]
    #[inline]
    pub fn count(&self, bits: u32) -> u32 {
        self.thresholds
            .iter()
            .fold(self.least, |count, &threshold| {
                count + u32::from(bits >= threshold)
            })
    }

    /// Returns the minimum count, which `bits` of 0 gives.
    #[must_use]
    #[inline]
    pub fn least(&self) -> u32 {
        self.least
    }

    /// Returns the thresholds for the random bits, in ascending order. The count is the minimum count plus the number
    /// of thresholds at or below the bits.
    #[must_use]
    #[inline]
    pub fn thresholds(&self) -> &[u32] {
        &self.thresholds
    }

    /// Returns the range of the counts that [`count`](Self::count) returns.
    #[must_use]
    #[inline]
    pub fn range(&self) -> core::ops::RangeInclusive<u32> {
        self.count(0)..=self.count(u32::MAX)
    }

    /// Returns the mean of the counts. Because of clamping, it may differ from the mean of the distribution.
    #[must_use]
    pub fn mean(&self) -> f64 {
        let above = self
            .thresholds
            .iter()
            .map(|&threshold| 1.0 - f64::from(threshold) / (1_u64 << 32) as f64);
        f64::from(self.least) + above.sum::<f64>()
    }
}

/// Returns the count that an unclamped table with this mean would give, but computes it without a table. Use it for
/// means that are needed only once.
///
/// The mean is clamped to the range that a table accepts; NaN becomes the lower end of the range.
///
/// # Examples
///
/// ```
/// use dapple_hash::{PoissonCounts, poisson_count};
///
/// let counts = PoissonCounts::new(3.0, 0..=u32::MAX)?;
/// assert_eq!(poisson_count(3.0, 0x9E37_79B9), counts.count(0x9E37_79B9));
/// # Ok::<(), dapple_hash::PoissonError>(())
/// ```
#[must_use]
pub fn poisson_count(mean: f64, bits: u32) -> u32 {
    let mean = if mean > 0.0 {
        mean.min(MEAN_LIMIT)
    } else {
        f64::MIN_POSITIVE
    };
    let mut probability = libm::exp(-mean);
    let mut cumulative = 0.0;
    let mut count = 0;
    loop {
        cumulative += probability;
        // Use the rounding and the end conditions of the table.
        let threshold = (cumulative * (1_u64 << 32) as f64) as u64;
        if u64::from(bits) < threshold || threshold > u64::from(u32::MAX) {
            return count;
        }
        probability *= mean / f64::from(count + 1);
        if f64::from(count) > mean && probability * 4.0 < 1.0 / (1_u64 << 33) as f64 {
            return count + 1;
        }
        count += 1;
    }
}

/// An error from creating a table of Poisson counts with parameters out of range.
#[derive(Clone, Debug, PartialEq)]
pub struct PoissonError {
    kind: PoissonErrorKind,
}

/// Cause of a [`PoissonError`], with the value.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PoissonErrorKind {
    /// The mean is not a number in `(0, 64]`.
    Mean {
        /// The requested mean.
        mean: f64,
    },
    /// The range is empty.
    EmptyRange {
        /// Start of the range.
        least: u32,
        /// End of the range.
        most: u32,
    },
}

impl PoissonError {
    /// Returns the cause of the error, with the value.
    #[must_use]
    pub fn kind(&self) -> &PoissonErrorKind {
        &self.kind
    }
}

impl fmt::Display for PoissonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            PoissonErrorKind::Mean { mean } => {
                write!(
                    f,
                    "the mean of a Poisson distribution is {mean}, but it must be above 0 and at most {MEAN_LIMIT}"
                )
            }
            PoissonErrorKind::EmptyRange { least, most } => {
                write!(
                    f,
                    "the counts are clamped to {least}..={most}, which holds no number"
                )
            }
        }
    }
}

impl core::error::Error for PoissonError {}

#[cfg(test)]
mod tests {
    use super::{PoissonCounts, PoissonErrorKind, poisson_count};
    use crate::{Seed, hash2};

    /// Returns the exact probabilities of the counts 0.. with the tails added to the ends of the range.
    fn clamped_probabilities(mean: f64, least: usize, most: usize) -> Vec<f64> {
        let mut probabilities = vec![0.0; most + 1];
        let mut probability = libm::exp(-mean);
        for count in 0..400 {
            probabilities[count.clamp(least, most)] += probability;
            probability *= mean / (count + 1) as f64;
        }
        probabilities
    }

    #[test]
    fn counts_follow_the_clamped_distribution() {
        let cells = 1 << 18;
        for (mean, least, most) in [(3.0, 1, 9), (1.0, 0, 5), (0.1, 0, 3), (8.0, 4, 12)] {
            let counts = PoissonCounts::new(mean, least..=most).unwrap();
            let mut histogram = vec![0.0; most as usize + 1];
            for cell in 0..cells {
                let bits = hash2(Seed(5), [cell % 512, cell / 512], 0);
                histogram[counts.count((bits >> 32) as u32) as usize] += 1.0;
            }
            let expected = clamped_probabilities(mean, least as usize, most as usize);
            let chi_square: f64 = (least as usize..=most as usize)
                .map(|count| (histogram[count], expected[count] * cells as f64))
                .map(|(seen, expected)| (seen - expected) * (seen - expected) / expected)
                .sum();
            // The 99.9 % quantile of chi-square with 8 degrees of freedom; the other cases have at most as many.
            assert!(
                chi_square < 26.2,
                "mean {mean} in {least}..={most}: chi-square is {chi_square}"
            );
            let exact: f64 = expected
                .iter()
                .enumerate()
                .map(|(count, p)| count as f64 * p)
                .sum();
            assert!(
                (counts.mean() - exact).abs() < 1e-8,
                "the mean is {}, not {exact}",
                counts.mean()
            );
        }
    }

    #[test]
    fn unclamped_counts_keep_their_mean() {
        for mean in [0.01, 0.5, 3.0, 20.0, 64.0] {
            let counts = PoissonCounts::new(mean, 0..=u32::MAX).unwrap();
            // Counts with a probability below 2^-32 are missing: a few counts near the mean, times 2^-32.
            assert!(
                (counts.mean() - mean).abs() < 1e-6,
                "mean {mean} became {}",
                counts.mean()
            );
            assert!(
                *counts.range().end() < 200,
                "mean {mean} reaches {:?}",
                counts.range()
            );
        }
    }

    #[test]
    fn counts_without_a_table_are_those_of_the_table() {
        for mean in [1.0 / 64.0, 0.3, 1.0, 3.0, 17.5, 64.0] {
            let counts = PoissonCounts::new(mean, 0..=u32::MAX).unwrap();
            let random = (0..20_000).map(|x| (hash2(Seed(2), [x, 0], 0) >> 32) as u32);
            let ends = [0, 1, u32::MAX - 1, u32::MAX].into_iter();
            let steps = counts
                .thresholds()
                .iter()
                .flat_map(|&bits| [bits.wrapping_sub(1), bits]);
            for bits in random.chain(ends).chain(steps) {
                assert_eq!(
                    poisson_count(mean, bits),
                    counts.count(bits),
                    "{mean}, {bits:#x}"
                );
            }
        }
        assert_eq!(poisson_count(f64::NAN, 5), 0);
    }

    #[test]
    fn bad_tables_are_refused_with_their_limit() {
        for mean in [0.0, -1.0, f64::NAN, f64::INFINITY, 65.0] {
            let error = PoissonCounts::new(mean, 0..=9).unwrap_err();
            assert!(
                matches!(error.kind(), PoissonErrorKind::Mean { .. }),
                "mean {mean} gave {error}"
            );
        }
        #[expect(
            clippy::reversed_empty_ranges,
            reason = "the empty range is the bad input"
        )]
        let error = PoissonCounts::new(3.0, 5..=4).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the counts are clamped to 5..=4, which holds no number"
        );
    }

    #[test]
    fn a_single_count_needs_no_table() {
        assert_eq!(PoissonCounts::new(3.0, 4..=4).unwrap().range(), 4..=4);
    }

    #[test]
    fn value_stability_counts() {
        let counts = PoissonCounts::new(3.0, 1..=9).unwrap();
        let drawn: Vec<u32> = (0..16)
            .map(|x| counts.count((hash2(Seed(0), [x, 0], 0) >> 32) as u32))
            .collect();
        assert_eq!(drawn, [1, 3, 3, 2, 1, 2, 5, 3, 1, 3, 3, 2, 6, 5, 1, 3]);
    }
}
