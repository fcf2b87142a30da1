//! Parses a seed or an inclusive range of seeds, such as `7` or `1-20`.

use crate::args::seed;
use serde::{Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// Maximum number of seeds in a range.
const MOST: u64 = 10_000;

/// Consecutive seeds; a single seed is a range of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Seeds {
    pub(super) first: u64,
    last: u64,
}

impl Seeds {
    /// Creates a range of one seed.
    pub(super) fn one(seed: u64) -> Self {
        Self {
            first: seed,
            last: seed,
        }
    }

    /// Returns whether there are several seeds.
    pub(super) fn are_several(self) -> bool {
        self.first < self.last
    }

    /// Returns all seeds, in order.
    pub(super) fn all(self) -> impl Iterator<Item = u64> {
        self.first..=self.last
    }

    /// Returns the label of a seed for file names, padded with zeros so that all labels of the range have the same
    /// length.
    pub(super) fn label(self, seed: u64) -> String {
        let digits = self.last.to_string().len();
        format!("{seed:0digits$}")
    }
}

impl FromStr for Seeds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((first, last)) = text
            .trim()
            .split_once('-')
            .filter(|(first, _)| !first.is_empty())
        else {
            return seed(text).map(Self::one);
        };
        let (first, last) = (seed(first)?, seed(last)?);
        if first > last {
            return Err(format!("the range of seeds ends at {last}, below {first}"));
        }
        if last - first >= MOST {
            return Err(format!("a range has at most {MOST} seeds"));
        }
        Ok(Self { first, last })
    }
}

impl fmt::Display for Seeds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.are_several() {
            true => write!(f, "{}-{}", self.first, self.last),
            false => write!(f, "{}", self.first),
        }
    }
}

impl Serialize for Seeds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.are_several() {
            true => serializer.collect_str(self),
            false => serializer.serialize_u64(self.first),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Seeds;

    #[test]
    fn seeds_are_one_number_or_a_rising_range() {
        let read = |text: &str| text.parse::<Seeds>();
        assert_eq!(read("7"), Ok(Seeds::one(7)));
        let seeds = read("8-11").unwrap();
        let labels: Vec<_> = seeds.all().map(|seed| seeds.label(seed)).collect();
        assert_eq!(labels, ["08", "09", "10", "11"]);
        assert_eq!(seeds.to_string(), "8-11");
        for (text, part) in [
            ("-1", "not negative"),
            ("5-2", "below 5"),
            ("1-", "whole number"),
            ("0-10000", "at most 10000"),
            ("1-2-3", "whole number"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
