//! Valid ranges of options. Each range is defined once, for the check, the error message, and the recipe schema.

use core::ops::{Bound, RangeBounds as _};

/// The valid range of an option. It contains only finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub least: Bound<f64>,
    /// Upper bound.
    pub most: Bound<f64>,
    /// Text that completes "it must be" in an error message.
    pub text: &'static str,
}

impl Range {
    /// Returns whether a number is in the range.
    #[must_use]
    pub fn holds(&self, number: f64) -> bool {
        number.is_finite() && (self.least, self.most).contains(&number)
    }
}

/// Builds a [`Range`] and its text from one of these forms: `finite`, `above 0`, `above 0 to 1`, `at least 1`,
/// `from 1 to 16` or `from 0 below 1`.
#[doc(hidden)]
#[macro_export]
macro_rules! range {
    (finite) => {
        $crate::range!(@ Unbounded, Unbounded, "finite")
    };
    (above $least:literal) => {
        $crate::range!(@ Excluded($least as f64), Unbounded, concat!("above ", $least, " and finite"))
    };
    (above $least:literal to $most:literal) => {
        $crate::range!(
            @ Excluded($least as f64), Included($most as f64),
            concat!("above ", $least, " and at most ", $most)
        )
    };
    (at least $least:literal) => {
        $crate::range!(@ Included($least as f64), Unbounded, concat!("at least ", $least))
    };
    (from $least:literal to $most:literal) => {
        $crate::range!(
            @ Included($least as f64), Included($most as f64),
            concat!("from ", $least, " to ", $most)
        )
    };
    (from $least:literal below $most:literal) => {
        $crate::range!(
            @ Included($least as f64), Excluded($most as f64),
            concat!("from ", $least, " to below ", $most)
        )
    };
    (@ $least:expr, $most:expr, $text:expr) => {{
        #[expect(unused_imports, reason = "a range has two of the three kinds of bounds at most")]
        use ::core::ops::Bound::{Excluded, Included, Unbounded};
        $crate::Range { least: $least, most: $most, text: $text }
    }};
}

#[cfg(test)]
mod tests {
    use super::Range;

    #[test]
    fn ranges_hold_what_their_texts_say() {
        let cases: [(Range, &str, &[f64], &[f64]); 5] = [
            (range!(finite), "finite", &[-1e300, 0.0], &[]),
            (range!(above 0), "above 0 and finite", &[1e-9], &[0.0, -1.0]),
            (
                range!(above 0 to 1e6),
                "above 0 and at most 1e6",
                &[1e6],
                &[0.0, 1e6 + 1.0],
            ),
            (
                range!(from -1 to 16),
                "from -1 to 16",
                &[-1.0, 16.0],
                &[-1.1, 16.5],
            ),
            (
                range!(from 0 below 1),
                "from 0 to below 1",
                &[0.0, 0.99],
                &[1.0],
            ),
        ];
        for (range, text, inside, outside) in cases {
            assert_eq!(range.text, text);
            assert!(inside.iter().all(|&number| range.holds(number)), "{text}");
            let outside = outside.iter().chain(&[f64::NAN, f64::INFINITY]);
            assert!(
                outside.into_iter().all(|&number| !range.holds(number)),
                "{text}"
            );
        }
    }
}
