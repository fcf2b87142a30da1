//! Coordinates of columns or rows: where they go one way, and which of them an interval touches.

use core::ops::Range;

/// Coordinates that go evenly from the first to the last.
pub(crate) struct Line {
    first: f64,
    /// Coordinates per unit of length, negative where they descend; nothing where they are not even.
    per_unit: Option<f64>,
    count: usize,
    /// How far a coordinate may be from its even place, in pixels.
    slack: f64,
}

impl Line {
    pub(crate) fn new(coordinates: &[f64]) -> Self {
        let (first, count) = (coordinates[0], coordinates.len());
        let last = coordinates[count - 1];
        // Coordinates that are out of range were all brought to the same place, at either end.
        let goes = |index: usize| coordinates[index] != coordinates[index - 1];
        let even = count > 1 && goes(1) && goes(count - 1);
        let per_unit = even.then(|| (count - 1) as f64 / (last - first));
        let rounding =
            4.0 * f64::EPSILON * first.abs().max(last.abs()) * per_unit.unwrap_or(0.0).abs();
        Self {
            first,
            per_unit,
            count,
            slack: 1e-3 + rounding,
        }
    }

    /// The coordinates that an interval touches, or may touch.
    #[inline(always)]
    pub(crate) fn touched(&self, min: f64, max: f64) -> Range<usize> {
        let Some(per_unit) = self.per_unit else {
            return 0..self.count;
        };
        let [a, b] = [(min - self.first) * per_unit, (max - self.first) * per_unit];
        // As an index, a negative number becomes zero, and a fraction is cut off.
        let start = (a.min(b) + 1.0 - self.slack) as usize;
        let end = ((a.max(b) + 1.0 + self.slack) as usize).min(self.count);
        start..end
    }
}

/// The longest stretches in which coordinates go one way, as they do until a period ends. What is not finite stands by
/// itself.
///
/// The way is the one that makes fewer stretches: where a period ends, two neighbors go the other way.
pub(crate) fn runs(coordinates: &[f64]) -> Vec<Range<usize>> {
    let ascending = stretches(coordinates, |last, next| next >= last);
    let descending = stretches(coordinates, |last, next| next <= last);
    if descending.len() < ascending.len() {
        descending
    } else {
        ascending
    }
}

/// The longest stretches in which every coordinate but the first goes on from the one before.
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
                // 300 columns of a period of 256 lie in two or three periods.
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
