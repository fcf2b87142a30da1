//! Lattice positions: coordinates split into cells and offsets, wrapped by periods. Also the arithmetic that patterns share.

use crate::PatternError;
use dapple_hash::{CellHash, unit_f32};
use dapple_raster::{RasterError, RasterViewMut, Window};

/// Number of pixel rows in a band, the unit of parallel work.
const ROWS: u32 = 16;

/// Maximum magnitude of a cell's coordinate. Cells beyond it are clamped, so that sums do not overflow.
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

    /// Adds a distance of a few cells. The new offset depends only on the old offset, so equal offsets in two periods
    /// stay equal.
    pub(crate) fn shifted(self, by: f64) -> Self {
        Self {
            offset: self.offset + by,
            ..self
        }
        .carried()
    }

    /// Moves the integer part of the offset to the cell.
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

/// Wraps a column and a row by the period along each axis.
pub(crate) fn wrapped_cell(cell: [i64; 2], period: [Option<u32>; 2]) -> [i64; 2] {
    [0, 1].map(|axis| wrapped(cell[axis], period[axis]))
}

/// Returns an error if a period is 0.
pub(crate) fn check_period(period: [Option<u32>; 2]) -> Result<(), PatternError> {
    let holds = !period.contains(&Some(0));
    PatternError::check(holds, "period", 0.0, "at least 1 cell")
}

/// Returns a random number of a cell, from 0 to below 1.
pub(crate) fn random(hash: CellHash, index: u32) -> f32 {
    unit_f32((hash.at(index) >> 32) as u32)
}

/// Returns the length of a vector.
pub(crate) fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// Returns the smoothstep `3t² − 2t³` of a number from 0 to 1.
pub(crate) fn smoothstep(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// Returns the cosine and the sine of an angle in degrees; exact for multiples of 90.
#[doc(hidden)]
#[must_use]
pub fn direction(degrees: f64) -> [f64; 2] {
    let degrees = degrees % 360.0;
    match (degrees + 360.0) % 360.0 {
        0.0 => [1.0, 0.0],
        90.0 => [0.0, 1.0],
        180.0 => [-1.0, 0.0],
        270.0 => [0.0, -1.0],
        _ => {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            [cos, sin]
        }
    }
}

/// Returns the bits of a number as high and low word, the form in which shaders read it.
pub(crate) fn shader_words(number: f64) -> [u32; 2] {
    seed_words(number.to_bits())
}

/// Returns the high and the low word of 64 bits.
pub(crate) fn seed_words(bits: u64) -> [u32; 2] {
    [(bits >> 32) as u32, bits as u32]
}

/// Returns a period as shaders read it: 0 for an axis without a period.
pub(crate) fn period_words(period: [Option<u32>; 2]) -> [u32; 2] {
    period.map(|cells| cells.unwrap_or(0))
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
