//! Computes the range, mean, standard deviation and histogram of a raster.

use crate::Raster;

/// Range, mean and standard deviation of the pixels of a raster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// Minimum value.
    pub min: f32,
    /// Maximum value.
    pub max: f32,
    /// Mean value.
    pub mean: f64,
    /// Standard deviation, with the number of pixels as the divisor.
    pub deviation: f64,
    /// Number of pixels that are NaN or infinite; the other fields exclude them.
    pub n_not_finite: usize,
}

impl Raster<f32> {
    /// Computes the statistics of all finite pixels, summed row by row in a fixed order.
    ///
    /// Without a finite pixel, `min` is infinity, `max` is minus infinity, and the other numbers are NaN.
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

    /// Returns the number of pixels in each of `bins` equal intervals from `from` to `to`.
    ///
    /// Values outside the range count in the first or last interval; NaN is ignored.
    #[must_use]
    pub fn histogram(&self, from: f32, to: f32, bins: u32) -> Vec<usize> {
        let mut counts = vec![0; bins.max(1) as usize];
        for &value in self.pixels().iter().filter(|value| !value.is_nan()) {
            let part = (value - from) / (to - from) * counts.len() as f32;
            let last = counts.len() - 1;
            // The cast maps negative numbers to zero; large numbers are clamped.
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
