//! Parses a region of an image on the command line, given as `x,y,w,h` in pixels from the top left corner.

use super::Numbers;
use serde::Serialize;
use std::str::FromStr;

/// A rectangle of an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Region {
    /// The column and the row of the first pixel.
    pub(crate) first: [u32; 2],
    /// Columns and rows, each at least 1.
    pub(crate) size: [u32; 2],
}

impl Region {
    /// Converts the region to a bake option.
    pub(crate) fn of_recipe(self) -> dapple::recipe::Region {
        dapple::recipe::Region {
            first: self.first,
            size: self.size,
        }
    }
}

impl FromStr for Region {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            Ok(Numbers([x, y, w, h])) if w > 0 && h > 0 => Ok(Self {
                first: [x, y],
                size: [w, h],
            }),
            _ => Err(format!(
                "{text:?} is not a region: give x,y,w,h in whole pixels, such as 0,0,256,128"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Region;

    #[test]
    fn regions_are_four_whole_numbers() {
        let region = Region {
            first: [1, 2],
            size: [30, 40],
        };
        assert_eq!("1,2,30,40".parse(), Ok(region));
        assert_eq!("1, 2, 30, 40".parse(), Ok(region));
        for text in ["", "1,2,3", "1,2,3,4,5", "1,2,0,4", "-1,0,2,2", "a,b,c,d"] {
            assert!(text.parse::<Region>().is_err(), "{text:?} is no region");
        }
    }
}
