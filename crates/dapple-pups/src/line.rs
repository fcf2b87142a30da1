//! Pixel coordinates along one axis: monotonic runs, and the pixels whose coordinates are in an interval.

use core::ops::Range;

/// Coordinates of consecutive pixels along one axis, usually evenly spaced.
pub(crate) struct Line {
    first: f64,
    /// Number of coordinates per unit of length, negative if they descend; `None` if they are not evenly spaced.
    per_unit: Option<f64>,
    count: usize,
    /// Maximum offset of a coordinate from its evenly spaced position, in pixels.
    slack: f64,
}

impl Line {
    pub(crate) fn new(coordinates: &[f64]) -> Self {
        let (first, count) = (coordinates[0], coordinates.len());
        let last = coordinates[count - 1];
        // Coordinates out of range were clamped to the same value, at either end.
        let goes = |index: usize| coordinates[index] != coordinates[index - 1];
        let even = count > 1 && goes(1) && goes(count - 1);
        let per_unit = even.then(|| (count - 1) as f64 / (last - first));
        // Bound the rounding of coordinates far from zero, in pixels.
        let rounding =
            4.0 * f64::EPSILON * first.abs().max(last.abs()) * per_unit.unwrap_or(0.0).abs();
        Self {
            first,
            per_unit,
            count,
            slack: 1e-3 + rounding,
        }
    }

    /// Returns the indices of the pixels whose coordinates are in the interval from `min` to `max`. May include a
    /// neighbor on either side.
    #[inline(always)]
    pub(crate) fn touched(&self, min: f64, max: f64) -> Range<usize> {
        let Some(per_unit) = self.per_unit else {
            return 0..self.count;
        };
        // Convert the interval to fractional indices. They are in descending order if the coordinates are.
        let [a, b] = [(min - self.first) * per_unit, (max - self.first) * per_unit];
        // The conversion to an index turns negative numbers into zero, and truncates.
        let start = (a.min(b) + 1.0 - self.slack) as usize;
        let end = ((a.max(b) + 1.0 + self.slack) as usize).min(self.count);
        start..end
    }
}

/// Divides coordinates into maximal monotonic runs. A run ends at the end of a period, and a coordinate that is not
/// finite forms a separate run.
///
/// Either all runs ascend or all descend, whichever gives fewer runs.
pub(crate) fn runs(coordinates: &[f64]) -> Vec<Range<usize>> {
    let ascending = stretches(coordinates, |last, next| next >= last);
    let descending = stretches(coordinates, |last, next| next <= last);
    if descending.len() < ascending.len() {
        descending
    } else {
        ascending
    }
}

/// Divides coordinates into maximal runs in which `goes_on(previous, next)` holds between successive coordinates.
fn stretches(coordinates: &[f64], goes_on: impl Fn(f64, f64) -> bool) -> Vec<Range<usize>> {
    let mut stretches = Vec::new();
    let mut start = 0;
    for index in 1..=coordinates.len() {
        if index == coordinates.len() || !goes_on(coordinates[index - 1], coordinates[index]) {
            stretches.push(start..index);
            start = index;
        }
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::{Line, runs};

    #[test]
    fn runs_end_where_a_period_ends_or_a_coordinate_is_lost() {
        assert_eq!(runs(&[0.5, 0.75, 0.0, 0.25, 0.5]), [0..2, 2..5]);
        assert_eq!(runs(&[0.5, 0.25, 0.0, 0.75]), [0..3, 3..4]);
        assert_eq!(runs(&[f64::NAN, 0.0, 1.0, f64::NAN]), [0..1, 1..3, 3..4]);
        assert!(
            runs(&[1.0]).iter().eq([&(0..1)]),
            "a single coordinate is a stretch"
        );
    }

    #[test]
    fn runs_are_as_few_as_periods_wherever_the_window_begins() {
        for step in [1.0 / 256.0, -1.0 / 256.0] {
            for first in 0..=256 {
                let coordinate =
                    |index: i32| ((f64::from(first + index) + 0.5) * step).rem_euclid(1.0);
                let coordinates: Vec<f64> = (0..300).map(coordinate).collect();
                let n_runs = runs(&coordinates).len();
                // 300 columns with a period of 256 touch two or three periods.
                assert!(
                    n_runs <= 3,
                    "{n_runs} runs, in steps of {step} from column {first} on"
                );
            }
        }
    }

    #[test]
    fn touched_coordinates_are_never_missed() {
        for (first, last, count) in [
            (0.0, 9.9, 100),
            (5.0, -5.0, 37),
            (2.0, 2.0, 1),
            (1e9, 1e9 + 1.0, 50),
        ] {
            let coordinate =
                |index: usize| first + (last - first) * index as f64 / (count.max(2) - 1) as f64;
            let coordinates: Vec<f64> = (0..count).map(coordinate).collect();
            let line = Line::new(&coordinates);
            for (min, max) in [
                (-1.0, 3.05),
                (2.0, 2.0),
                (-9.0, -8.0),
                (4.0, f64::INFINITY),
                (1e9 + 0.5, 1e9 + 0.6),
            ] {
                let touched = line.touched(min, max);
                for index in (0..count).filter(|&index| (min..=max).contains(&coordinate(index))) {
                    assert!(
                        touched.contains(&index),
                        "{min}..{max} misses {index} in {first}..{last}"
                    );
                }
            }
        }
    }
}
