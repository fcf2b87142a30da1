//! Poisson-distributed counts by table.
//!
//! Steven Worley draws the number of feature points of a cell from a Poisson distribution with a precomputed table
//! ("A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>), and clamps it. Here
//! the table holds the cumulative probabilities as 32-bit integers, so that drawing compares integers and rounds
//! nothing.

use alloc::vec::Vec;
use core::fmt;

/// The largest mean that the table accepts.
const MEAN_LIMIT: f64 = 64.0;

/// A table that turns 32 random bits into a count with a Poisson distribution of a given mean, clamped to a range.
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
    /// The table for `mean` (above 0, at most 64) with the counts clamped to `range`.
    ///
    /// The probability of the counts below the range goes to its start, that of the counts above to its end. A range up
    /// to `u32::MAX` leaves the counts unclamped, except for those with a total probability below 2^-32.
    ///
    /// # Errors
    ///
    /// [`PoissonErrorKind::Mean`] if `mean` is not a number in `(0, 64]`, [`PoissonErrorKind::EmptyRange`] if `range`
    /// holds no number.
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
            // Past the mean, and with nothing left that 32 bits could tell: the end of an unclamped table.
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

    /// The count for 32 random bits; it never falls as the bits grow.
    #[must_use]
    #[inline]
    pub fn count(&self, bits: u32) -> u32 {
        self.thresholds
            .iter()
            .fold(self.least, |count, &threshold| {
                count + u32::from(bits >= threshold)
            })
    }

    /// The smallest count, which belongs to the smallest bits.
    #[must_use]
    #[inline]
    pub fn least(&self) -> u32 {
        self.least
    }

    /// The thresholds of the bits, ascending: the count is the smallest one plus the number of thresholds at or below
    /// the bits.
    #[must_use]
    #[inline]
    pub fn thresholds(&self) -> &[u32] {
        &self.thresholds
    }

    /// The smallest and the largest count that [`count`](Self::count) returns.
    #[must_use]
    #[inline]
    pub fn range(&self) -> core::ops::RangeInclusive<u32> {
        self.count(0)..=self.count(u32::MAX)
    }

    /// The mean of the counts, which clamping moves away from the mean of the distribution.
    #[must_use]
    pub fn mean(&self) -> f64 {
        let above = self
            .thresholds
            .iter()
            .map(|&threshold| 1.0 - f64::from(threshold) / (1_u64 << 32) as f64);
        f64::from(self.least) + above.sum::<f64>()
    }
}

/// The count of an unclamped table with this mean, without a table: for means that are used once.
///
/// The mean is clamped to the range that a table accepts; NaN counts as its lower end.
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
        // The same rounding, and the same ends, as in the table.
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

/// The error of a table of Poisson counts with parameters out of range.
#[derive(Clone, Debug, PartialEq)]
pub struct PoissonError {
    kind: PoissonErrorKind,
}

/// The cause of a [`PoissonError`], with the value.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PoissonErrorKind {
    /// The mean is not a number in `(0, 64]`.
    Mean {
        /// The mean that was asked for.
        mean: f64,
    },
    /// The range holds no number.
    EmptyRange {
        /// The start of the range.
        least: u32,
        /// The end of the range.
        most: u32,
    },
}

impl PoissonError {
    /// The cause of the error, with the value.
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

    /// The exact probabilities of the counts 0.. with the tails moved to the ends of the range.
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
            // The 99.9 % point of chi-square with 8 degrees of freedom; the other cases have as many or fewer.
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
            // What is less likely than 2^-32 is missing: a few counts of the size of the mean, times 2^-32.
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
