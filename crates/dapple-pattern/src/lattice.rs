//! Lattice positions: coordinates split into cells and offsets, wrapped by periods.

use dapple_raster::{RasterError, RasterViewMut, Window};

/// Rows that one parallel task renders.
const ROWS: u32 = 16;

/// Cells beyond this one are clamped, so that sums of cells do not overflow.
const FARTHEST: i64 = 1 << 60;

/// A coordinate in cells, split into the cell and the offset within it, from 0 to below 1. The offset is NaN if the
/// coordinate is not finite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Split {
    pub(crate) cell: i64,
    pub(crate) offset: f64,
}

impl Split {
    pub(crate) fn of(coordinate: f64) -> Self {
        Self {
            cell: 0,
            offset: coordinate,
        }
        .carried()
    }

    /// Adds a distance of a few cells. The result depends on the offset alone, so equal offsets in two periods stay
    /// equal.
    pub(crate) fn shifted(self, by: f64) -> Self {
        Self {
            offset: self.offset + by,
            ..self
        }
        .carried()
    }

    /// Moves the whole part of the offset to the cell.
    fn carried(self) -> Self {
        let whole = self.offset.floor();
        let offset = self.offset - whole;
        // A tiny negative offset rounds to 1: it belongs to the next cell.
        let (whole, offset) = if offset >= 1.0 {
            (whole + 1.0, 0.0)
        } else {
            (whole, offset)
        };
        Self {
            cell: self.cell + (whole as i64).clamp(-FARTHEST, FARTHEST),
            offset,
        }
    }
}

/// Wraps a cell by a period along an axis; `None` for no period.
pub(crate) fn wrapped(cell: i64, period: Option<u32>) -> i64 {
    match period {
        None | Some(0) => cell,
        Some(period) => cell.rem_euclid(i64::from(period)),
    }
}

/// Renders the values at the pixel centers of a window, on all cores if the feature `rayon` is enabled.
pub(crate) fn render(
    window: &Window,
    out: RasterViewMut<'_, f32>,
    value: impl Fn([f64; 2]) -> f32 + Sync,
) -> Result<(), RasterError> {
    window.check_size(out.size())?;
    out.for_each_band(ROWS, |first, mut band| {
        for (row, values) in (first..).zip(band.rows_mut()) {
            for (column, pixel) in (0..).zip(values) {
                *pixel = value(window.position(column, row));
            }
        }
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Split;

    #[test]
    fn split_offsets_are_from_0_to_below_1() {
        for (coordinate, cell, offset) in [
            (2.25, 2, 0.25),
            (-0.25, -1, 0.75),
            (-1e-30, 0, 0.0),
            (2_147_483_648.5, 1 << 31, 0.5),
        ] {
            let split = Split::of(coordinate);
            assert_eq!((split.cell, split.offset), (cell, offset), "{coordinate}");
        }
        let moved = Split::of(7.75).shifted(0.5);
        assert_eq!((moved.cell, moved.offset), (8, 0.25));
        assert!(Split::of(f64::INFINITY).offset.is_nan());
    }
}
