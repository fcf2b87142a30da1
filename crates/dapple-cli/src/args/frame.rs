//! Parses a frame of a looping animation on the command line. `3/24` is the third of 24 frames.

use serde::{Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// A frame of a looping animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Frame {
    /// Number of the frame in the loop, starting at 1.
    number: u32,
    /// The number of frames in the loop.
    count: u32,
}

impl Frame {
    /// Returns all frames of a looping animation of `count` frames. Without a count, returns a single `None`, which
    /// means a still image.
    pub(crate) fn all(count: Option<u32>) -> impl Iterator<Item = Option<Self>> {
        let pictures = 1..=count.unwrap_or(1);
        pictures.map(move |number| count.map(|count| Self { number, count }))
    }

    /// Returns whether this is the first frame.
    pub(crate) fn is_first(self) -> bool {
        self.number == 1
    }

    /// Returns the frame's phase in the looping animation, from 0 for the first frame to below 1 for the last.
    pub(crate) fn time(self) -> f64 {
        f64::from(self.number - 1) / f64::from(self.count)
    }

    /// Returns the number of frames in the loop.
    pub(crate) fn count(self) -> u32 {
        self.count
    }

    /// Returns the number of the frame for file names, such as `001`. It has as many digits as the number of the last
    /// frame, and at least three.
    pub(crate) fn label(self) -> String {
        let digits = self.count.to_string().len().max(3);
        format!("{:0digits$}", self.number)
    }
}

impl FromStr for Frame {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let parts = parts.map(|(number, count)| (number.trim().parse(), count.trim().parse()));
        match parts {
            Some((Ok(number), Ok(count))) if (1..=count).contains(&number) => {
                Ok(Self { number, count })
            }
            _ => Err(format!(
                "{text:?} is no picture of a loop: give its number, from 1, and how many there are, such as 3/24"
            )),
        }
    }
}

impl fmt::Display for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl Serialize for Frame {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::Frame;

    fn labels(count: Option<u32>) -> Vec<Option<String>> {
        Frame::all(count)
            .map(|frame| frame.map(Frame::label))
            .collect()
    }

    #[test]
    fn pictures_are_numbered_with_enough_digits() {
        assert_eq!(labels(None), [None], "no loop");
        let two = ["001", "002"].map(|label| Some(label.to_owned()));
        assert_eq!(labels(Some(2)), two);
        assert_eq!(labels(Some(1000))[0].as_deref(), Some("0001"));
    }

    #[test]
    fn a_picture_is_its_number_and_that_of_all() {
        let times = ["1/4", "2/4", "4/4"].map(|text| text.parse().map(Frame::time));
        assert_eq!(times, [Ok(0.0), Ok(0.25), Ok(0.75)]);
        for text in ["", "3", "0/4", "5/4", "1/0", "a/b", "1/2/3"] {
            assert!(text.parse::<Frame>().is_err(), "{text:?} is no picture");
        }
    }
}
