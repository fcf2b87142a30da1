//! Parses sizes on the command line, which are columns and rows in pixels, `1024x512` or `1024`, and extents in units
//! of the plane, `2x1.5`.

use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// Maximum length of a side, in pixels.
const SIDE_MAX: u32 = 1 << 20;

/// Columns and rows in pixels, each from 1 to 2^20.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Size(pub(crate) [u32; 2]);

/// Width and height in units of the plane, each finite and above 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Extent(pub(crate) [f64; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| {
            let side = text.parse().map_err(|_| {
                format!("{text:?} is not a number of pixels: give a size such as 1024 or 1024x512")
            })?;
            if (1..=SIDE_MAX).contains(&side) {
                Ok(side)
            } else {
                Err(format!("a side has 1 to {SIDE_MAX} pixels, not {side}"))
            }
        };
        pair(text, side).map(Self)
    }
}

impl FromStr for Extent {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| {
            let side = text.parse().map_err(|_| {
                format!("{text:?} is not a number: give an extent such as 1, 0.5 or 2x1.5")
            })?;
            if side > 0.0 && f64::is_finite(side) {
                Ok(side)
            } else {
                Err(format!("a side is above 0 and finite, not {side}"))
            }
        };
        pair(text, side).map(Self)
    }
}

impl Size {
    /// Returns a note for the user if resampling an image of the size `from` to this size changes its aspect ratio;
    /// otherwise `None`.
    pub(crate) fn stretch_note(self, from: [u32; 2]) -> Option<String> {
        let [width, height] = from;
        let is_stretched =
            u64::from(width) * u64::from(self.0[1]) != u64::from(height) * u64::from(self.0[0]);
        is_stretched.then(|| {
            format!(
                "the tile of {width} × {height} pixels is stretched: cut out another part with --region to keep the shape"
            )
        })
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.0;
        write!(f, "{width}x{height}")
    }
}

/// Parses two sides separated by `x`, or one number for both.
fn pair<T: Copy>(text: &str, side: impl Fn(&str) -> Result<T, String>) -> Result<[T; 2], String> {
    match text.split_once(['x', 'X', '×']) {
        Some((width, height)) => Ok([side(width)?, side(height)?]),
        None => side(text).map(|side| [side; 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::{Extent, Size};

    #[test]
    fn sizes_are_one_number_or_two() {
        assert_eq!("512".parse(), Ok(Size([512, 512])));
        for text in ["1024x512", "1024X512", "1024×512"] {
            assert_eq!(text.parse(), Ok(Size([1024, 512])), "{text}");
        }
        assert_eq!("0.5x2".parse(), Ok(Extent([0.5, 2.0])));
    }

    #[test]
    fn sizes_that_are_none_say_so() {
        for text in ["", "x", "12x", "0", "-1", "1048577", "1x2x3", "big"] {
            assert!(text.parse::<Size>().is_err(), "{text:?} is no size");
        }
        for text in ["", "0", "-1x1", "nan", "inf", "1x2x3"] {
            assert!(text.parse::<Extent>().is_err(), "{text:?} is no extent");
        }
    }
}
