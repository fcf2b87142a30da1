//! Parses a shard of a map on the command line, given as `COLUMN,ROW,WxH`, such as `3,7,2048`, or `3,7,1009+1` for
//! shards that overlap by one pixel.

use super::Size;
use crate::error::usage;
use anyhow::Result;
use dapple::recipe::{Region, Shards};
use serde::{Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// A shard, given by its position in the grid of shards and the size of shards before cropping at the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    /// The column and row of the shard in the grid, counted from 0.
    pub(crate) place: [u32; 2],
    /// Columns and rows of a shard, in pixels.
    pub(crate) size: Size,
    /// Overlap: number of columns and rows that neighboring shards share.
    pub(crate) overlap: u32,
}

impl Shard {
    /// Returns the shard's region in a map with the size `picture`, cropped at the border.
    ///
    /// # Errors
    ///
    /// If the column or the row is outside of the grid.
    pub(crate) fn region(self, picture: Size) -> Result<Region> {
        let shards = Shards::new(picture.0, self.size.0)?.with_overlap(self.overlap)?;
        let [columns, rows] = shards.grid();
        let [column, row] = self.place.map(u64::from);
        let index = (column < columns.into()).then_some(row * u64::from(columns) + column);
        let found = index.and_then(|index| shards.get(index));
        found.ok_or_else(|| {
            usage(format!(
                "there is no shard in column {column} and row {row}: of a picture of {picture} there are {columns} x {rows}, counted from 0"
            ))
        })
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!("{text:?} is no shard: give its column, its row and its size, such as 3,7,2048")
        };
        let parts: Vec<_> = text.split(',').map(str::trim).collect();
        let [column, row, size] = parts[..] else {
            return Err(wrong());
        };
        let (Ok(column), Ok(row)) = (column.parse(), row.parse()) else {
            return Err(wrong());
        };
        let (size, overlap) = match size.split_once('+') {
            Some((size, overlap)) => (size, overlap.parse().map_err(|_| wrong())?),
            None => (size, 0),
        };
        Ok(Self {
            place: [column, row],
            size: size.parse()?,
            overlap,
        })
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [column, row] = self.place;
        write!(f, "{column},{row},{}", self.size)?;
        match self.overlap {
            0 => Ok(()),
            overlap => write!(f, "+{overlap}"),
        }
    }
}

impl Serialize for Shard {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::{Shard, Size};

    #[test]
    fn a_shard_is_its_place_and_its_size() {
        let shard = Shard {
            place: [3, 1],
            size: Size([64, 32]),
            overlap: 0,
        };
        assert_eq!(
            "3,1,64x32+2".parse(),
            Ok(Shard {
                overlap: 2,
                ..shard
            })
        );
        assert_eq!(
            Shard {
                overlap: 2,
                ..shard
            }
            .to_string(),
            "3,1,64x32+2"
        );
        assert_eq!("3,1,64x32".parse(), Ok(shard));
        assert_eq!(shard.to_string().parse(), Ok(shard));
        for text in [
            "",
            "3,1",
            "3,1,0",
            "-1,1,64",
            "3,1,64,64",
            "a,b,c",
            "3,1,64+",
            "3,1,64+-1",
        ] {
            assert!(text.parse::<Shard>().is_err(), "{text:?} is no shard");
        }
    }

    #[test]
    fn the_pixels_of_a_shard_end_at_the_border() {
        let region = |text: &str| -> Option<_> {
            let shard: Shard = text.parse().ok()?;
            let region = shard.region(Size([200, 100])).ok()?;
            Some((region.first, region.size))
        };
        assert_eq!(region("0,0,64"), Some(([0, 0], [64, 64])));
        assert_eq!(region("3,1,64"), Some(([192, 64], [8, 36])));
        assert_eq!(region("1,1,64+1"), Some(([63, 63], [64, 37])));
        assert_eq!(region("0,0,64+64"), None, "an overlap of all columns");
        assert_eq!(region("4,0,64"), None, "past the last column");
        assert_eq!(region("0,2,64"), None, "past the last row");
    }
}
