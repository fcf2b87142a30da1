//! Rectangular areas of pixels: blocks, their squares and tiles, and parts of these.

use core::ops::Range;

/// A box of pixels: columns of a block, rows of its band, and slices.
#[derive(Clone, Debug)]
pub(super) struct Area {
    pub(super) columns: Range<usize>,
    pub(super) rows: Range<usize>,
    pub(super) slices: Range<usize>,
}

impl Area {
    /// Divides the area into tiles with at most the given numbers of columns and rows.
    pub(super) fn parts(&self, size: [usize; 2]) -> Parts<'_> {
        Parts {
            column: self.columns.start,
            row: self.rows.start,
            area: self,
            size,
        }
    }

    /// Returns whether the area has more columns or more rows than the given size.
    pub(super) fn is_larger(&self, [width, height]: [usize; 2]) -> bool {
        self.columns.len() > width || self.rows.len() > height
    }
}

/// Iterator over the tiles of an area, row by row.
pub(super) struct Parts<'a> {
    area: &'a Area,
    size: [usize; 2],
    /// First column of the next tile.
    column: usize,
    row: usize,
}

impl Iterator for Parts<'_> {
    type Item = Area;

    #[inline]
    fn next(&mut self) -> Option<Area> {
        let Area {
            columns,
            rows,
            slices,
        } = self.area;
        let [width, height] = self.size;
        if self.row >= rows.end {
            return None;
        }
        let part = Area {
            columns: self.column..columns.end.min(self.column + width),
            rows: self.row..rows.end.min(self.row + height),
            slices: slices.clone(),
        };
        // Go on to the next columns, or to the first columns of the next rows.
        self.column += width;
        if self.column >= columns.end {
            self.column = columns.start;
            self.row += height;
        }
        Some(part)
    }
}
