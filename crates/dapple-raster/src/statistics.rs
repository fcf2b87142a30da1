//! Range, mean, standard deviation and histogram of a raster of numbers.

use crate::Raster;

/// The range, mean and standard deviation of the numbers of a raster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// The smallest number.
    pub min: f32,
    /// The largest number.
    pub max: f32,
    /// The mean.
    pub mean: f64,
    /// The standard deviation, with the number of pixels as the divisor.
    pub deviation: f64,
    /// How many pixels are NaN or infinite; the other fields leave them out.
    pub n_not_finite: usize,
}

impl Raster<f32> {
    /// The statistics of all finite pixels, summed row by row in a fixed order.
    ///
    /// Without a finite pixel `min` is infinite, `max` is minus infinity, and the other numbers are NaN.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        let finite = || {
            self.pixels()
                .iter()
                .copied()
                .filter(|value| value.is_finite())
        };
        let (mut min, mut max, mut sum, mut count) =
            (f32::INFINITY, f32::NEG_INFINITY, 0.0, 0_usize);
        for value in finite() {
            (min, max) = (min.min(value), max.max(value));
            sum += f64::from(value);
            count += 1;
        }
        let mean = sum / count as f64;
        let squares: f64 = finite()
            .map(|value| f64::from(value) - mean)
            .map(|off| off * off)
            .sum();
        let deviation = (squares / count as f64).sqrt();
        Statistics {
            min,
            max,
            mean,
            deviation,
            n_not_finite: self.pixels().len() - count,
        }
    }

    /// How many pixels lie in each of `bins` equal parts of the range from `from` to `to`.
    ///
    /// Numbers outside of the range count in the first or last part; NaN counts nowhere.
    #[must_use]
    pub fn histogram(&self, from: f32, to: f32, bins: u32) -> Vec<usize> {
        let mut counts = vec![0; bins.max(1) as usize];
        for &value in self.pixels().iter().filter(|value| !value.is_nan()) {
            let part = (value - from) / (to - from) * counts.len() as f32;
            let last = counts.len() - 1;
            // A negative number becomes zero, a large one the last.
            counts[(part as usize).min(last)] += 1;
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use crate::Raster;

    #[test]
    fn statistics_of_a_small_raster() {
        let raster =
            Raster::from_vec([2, 3], vec![1.0, 2.0, 3.0, 4.0, f32::NAN, f32::INFINITY]).unwrap();
        let statistics = raster.statistics();
        assert_eq!(
            (statistics.min, statistics.max, statistics.mean),
            (1.0, 4.0, 2.5)
        );
        assert_eq!(statistics.deviation, 1.25_f64.sqrt());
        assert_eq!(statistics.n_not_finite, 2);
        assert_eq!(raster.histogram(1.0, 5.0, 2), [2, 3]);
    }
}
