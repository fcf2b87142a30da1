//! Reads squares of pixels from an exemplar, or from a planar texture during synthesis.
//!
//! Positions are in units of half a pixel. A pixel's position on the next coarser level, half of its coordinates, is
//! then an integer. Values halfway between two or four pixels are the mean of those pixels.

use crate::domain::Colors;
use core::ops::RangeInclusive;
use dapple_raster::Wrap;

/// Side of the largest square that can be read, 15 pixels, plus one: a square at a position between two pixels
/// touches one pixel more.
pub(crate) const MAX_SIDE: usize = 16;

/// Pixels stored row by row, with a wrapping rule past the edges for each axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid<C> {
    pub(crate) colors: C,
    pub(crate) size: [u32; 2],
    pub(crate) wrap: [Wrap; 2],
}

impl<C: Colors> Grid<C> {
    /// Reads the square from `-half` to `half` pixels around a position into `target`, row by row. `half` is at most 7,
    /// and `halves` is the position in units of half a pixel.
    ///
    /// Only the given `rows`, from `-half` to `half`, are written, at the same offsets in `target` as if all rows were
    /// written.
    #[inline]
    pub(crate) fn read(
        &self,
        halves: [i64; 2],
        half: i32,
        rows: RangeInclusive<i32>,
        target: &mut [f32],
    ) {
        let places = square(halves, half, self.size, self.wrap);
        self.read_at(&places, halves, half, rows, target);
    }

    /// Reads a square like [`read`](Self::read), with precomputed [columns and rows](square).
    #[inline]
    pub(crate) fn read_at(
        &self,
        [columns, lines]: &[[usize; MAX_SIDE]; 2],
        halves: [i64; 2],
        half: i32,
        rows: RangeInclusive<i32>,
        target: &mut [f32],
    ) {
        let n = self.colors.n_channels();
        let width = self.size[0] as usize;
        let side = 2 * half as usize + 1;
        let [odd_x, odd_y] = halves.map(|at| at.rem_euclid(2) as usize);
        for row in rows.map(|row| (row + half) as usize) {
            let target = target[row * side * n..][..side * n].chunks_exact_mut(n);
            let [above, below] = [row, row + odd_y].map(|row| lines[row] * width);
            for (at, target) in target.enumerate() {
                let [left, right] = [columns[at], columns[at + odd_x]];
                // On a pixel: copy its value.
                if odd_x + odd_y == 0 {
                    target.copy_from_slice(self.colors.of(above + left));
                    continue;
                }
                // Between pixels: take the mean of four values. Halfway between two pixels, each of the two counts
                // twice.
                let [a, b] = [left, right].map(|column| self.colors.of(above + column));
                let [c, d] = [left, right].map(|column| self.colors.of(below + column));
                for (channel, value) in target.iter_mut().enumerate() {
                    *value = 0.25 * ((a[channel] + b[channel]) + (c[channel] + d[channel]));
                }
            }
        }
    }
}

/// Returns the column and row of one of the four finer pixels that were reduced to `pixel`, an index on the coarser
/// level, whose width is `width`. `[i, j]` selects the finer pixel (each is 0 or 1).
#[inline]
pub(crate) fn over(pixel: u32, width: u32, [i, j]: [i64; 2]) -> [i64; 2] {
    let [column, row] = [pixel % width, pixel / width].map(i64::from);
    [2 * column + i, 2 * row + j]
}

/// Returns the wrapped columns and rows of the pixels in a square around `halves`, plus one more of each for positions
/// between two pixels.
///
/// A position between two or four pixels is assigned to the left or upper one.
pub(crate) fn square(
    halves: [i64; 2],
    half: i32,
    size: [u32; 2],
    wrap: [Wrap; 2],
) -> [[usize; MAX_SIDE]; 2] {
    let used = 2 * half as usize + 2;
    let mut places = [[0; MAX_SIDE]; 2];
    for axis in 0..2 {
        let first = halves[axis].div_euclid(2) - i64::from(half);
        for (place, at) in places[axis][..used].iter_mut().zip(first..) {
            let within = (0..i64::from(size[axis])).contains(&at);
            // Avoid the remainder of a division, which would dominate the cost, where the index is in bounds.
            *place = if within {
                at as usize
            } else {
                wrap[axis].index(at, size[axis]) as usize
            };
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::Grid;
    use crate::domain::{Colors as _, Plain};
    use dapple_raster::Wrap;

    /// Returns the value of a channel at a pixel, wrapped, in a grid with two channels.
    fn pixel(grid: &Grid<Plain<'_>>, column: i64, row: i64, channel: usize) -> f32 {
        let x = grid.wrap[0].index(column, grid.size[0]) as usize;
        let y = grid.wrap[1].index(row, grid.size[1]) as usize;
        grid.colors.of(y * grid.size[0] as usize + x)[channel]
    }

    #[test]
    fn squares_equal_naive_bilinear_reads() {
        for size in [[1, 1], [2, 5], [9, 7], [16, 3]] {
            for wrap in [[Wrap::Repeat, Wrap::Mirror], [Wrap::Mirror, Wrap::Repeat]] {
                let n = size[0] * size[1] * 2;
                let values: Vec<f32> = (0..n).map(|value| (value * 37 % 101) as f32).collect();
                let colors = Plain {
                    values: &values,
                    n_channels: 2,
                };
                let grid = Grid { colors, size, wrap };
                for half in [1, 3] {
                    for [x, y] in (-9..30).flat_map(|x| (-5..12).map(move |y| [x, y])) {
                        check_square(&grid, [x, y], half);
                    }
                }
            }
        }
    }

    fn check_square(grid: &Grid<Plain<'_>>, [x, y]: [i64; 2], half: i32) {
        let side = (2 * half + 1) as usize;
        let mut target = vec![0.0; side * side * 2];
        grid.read([x, y], half, -half..=half, &mut target);
        for (at, &value) in target.iter().enumerate() {
            let [i, j] = [at / 2 % side, at / 2 / side].map(|at| at as i64 - i64::from(half));
            let [left, up] = [(x + 2 * i).div_euclid(2), (y + 2 * j).div_euclid(2)];
            let [fx, fy] = [x, y].map(|at| at.rem_euclid(2) as f32 / 2.0);
            let value_at = |i, j| pixel(grid, left + i, up + j, at % 2);
            // Sums of integers and halves are exact in any order.
            let expected = (value_at(0, 0) * (1.0 - fx) + value_at(1, 0) * fx) * (1.0 - fy)
                + (value_at(0, 1) * (1.0 - fx) + value_at(1, 1) * fx) * fy;
            assert_eq!(value, expected, "{:?} {x} {y} {at}", grid.size);
        }
    }

    #[test]
    fn rows_that_are_not_asked_for_stay() {
        let values = [1.0; 25];
        let grid = Grid {
            colors: Plain {
                values: &values,
                n_channels: 1,
            },
            size: [5, 5],
            wrap: [Wrap::Mirror; 2],
        };
        let mut target = [7.0; 9];
        grid.read([4, 4], 1, -1..=-1, &mut target);
        assert_eq!(
            target,
            [1.0, 1.0, 1.0, 7.0, 7.0, 7.0, 7.0, 7.0, 7.0],
            "the row above"
        );
    }
}
