//! Reading squares of pixels from an image in the plane: of an exemplar, or of a texture that is being made.
//!
//! Positions are in half pixels, so that the place of a pixel on the next coarser level, half of its coordinates, is a
//! whole number. Between pixels values are interpolated; between two or four that is their mean.

use core::ops::RangeInclusive;
use dapple_raster::Wrap;

/// The pixels of a side of the largest square that is read, and one more for the places between two pixels.
const MAX_SIDE: usize = 16;

/// Pixels of `n_channels` values, row by row, and what lies past their edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid<'a> {
    pub(crate) values: &'a [f32],
    pub(crate) size: [u32; 2],
    pub(crate) n_channels: usize,
    pub(crate) wrap: [Wrap; 2],
}

impl Grid<'_> {
    /// Reads the square from `-half` to `half` around a position, `half` at most 7, row by row into `target`.
    ///
    /// Only the given rows are written; those above them keep their place.
    pub(crate) fn read(
        &self,
        halves: [i64; 2],
        half: i32,
        rows: RangeInclusive<i32>,
        target: &mut [f32],
    ) {
        let n = self.n_channels;
        let row_len = self.size[0] as usize * n;
        let side = 2 * half as usize + 1;
        let [columns, lines] = square(halves, half, self.size, self.wrap);
        let [odd_x, odd_y] = halves.map(|at| at.rem_euclid(2) as usize);
        // Most squares are contiguous.
        let first = columns[0];
        let contiguous = first + side + odd_x <= self.size[0] as usize
            && columns[side - 1 + odd_x] == first + side - 1 + odd_x;
        for row in rows.map(|row| (row + half) as usize) {
            let target = &mut target[row * side * n..][..side * n];
            let above = &self.values[lines[row] * row_len..][..row_len];
            let below = &self.values[lines[row + odd_y] * row_len..][..row_len];
            if !contiguous {
                gather(above, below, &columns, odd_x, n, target);
                continue;
            }
            let [above, below] =
                [above, below].map(|line| &line[first * n..][..(side + odd_x) * n]);
            if odd_x + odd_y == 0 {
                target.copy_from_slice(above);
            } else {
                mean(above, below, odd_x * n, target);
            }
        }
    }
}

/// The columns and the rows of the pixels of a square, and one more of each for places between two pixels.
///
/// The pixel of a place between two or four is the left and upper one.
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
            // The remainder of a division costs more than all else here.
            *place = if within {
                at as usize
            } else {
                wrap[axis].index(at, size[axis]) as usize
            };
        }
    }
    places
}

/// The means of four values each: of two lines, and `step` values apart in both.
#[inline]
fn mean(above: &[f32], below: &[f32], step: usize, target: &mut [f32]) {
    let len = target.len();
    let [a, b] = [&above[..len], &above[step..][..len]];
    let [c, d] = [&below[..len], &below[step..][..len]];
    for i in 0..len {
        target[i] = 0.25 * ((a[i] + b[i]) + (c[i] + d[i]));
    }
}

/// The same for pixels that are not side by side: those of columns, and of columns `step` places further on.
fn gather(
    above: &[f32],
    below: &[f32],
    columns: &[usize],
    step: usize,
    n: usize,
    target: &mut [f32],
) {
    for (i, target) in target.chunks_exact_mut(n).enumerate() {
        let [left, right] = [columns[i] * n, columns[i + step] * n];
        for (channel, target) in target.iter_mut().enumerate() {
            let [left, right] = [left + channel, right + channel];
            *target = 0.25 * ((above[left] + above[right]) + (below[left] + below[right]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Grid;
    use dapple_raster::Wrap;

    /// A pixel with its wrap, in a grid of two channels.
    fn pixel(grid: &Grid<'_>, column: i64, row: i64, channel: usize) -> f32 {
        let x = grid.wrap[0].index(column, grid.size[0]) as usize;
        let y = grid.wrap[1].index(row, grid.size[1]) as usize;
        grid.values[(y * grid.size[0] as usize + x) * 2 + channel]
    }

    #[test]
    fn squares_equal_naive_bilinear_reads() {
        for size in [[1, 1], [2, 5], [9, 7], [16, 3]] {
            for wrap in [[Wrap::Repeat, Wrap::Mirror], [Wrap::Mirror, Wrap::Repeat]] {
                let n = size[0] * size[1] * 2;
                let values: Vec<f32> = (0..n).map(|value| (value * 37 % 101) as f32).collect();
                let grid = Grid {
                    values: &values,
                    size,
                    n_channels: 2,
                    wrap,
                };
                for half in [1, 3] {
                    for [x, y] in (-9..30).flat_map(|x| (-5..12).map(move |y| [x, y])) {
                        check_square(&grid, [x, y], half);
                    }
                }
            }
        }
    }

    fn check_square(grid: &Grid<'_>, [x, y]: [i64; 2], half: i32) {
        let side = (2 * half + 1) as usize;
        let mut target = vec![0.0; side * side * 2];
        grid.read([x, y], half, -half..=half, &mut target);
        for (at, &value) in target.iter().enumerate() {
            let [i, j] = [at / 2 % side, at / 2 / side].map(|at| at as i64 - i64::from(half));
            let [left, up] = [(x + 2 * i).div_euclid(2), (y + 2 * j).div_euclid(2)];
            let [fx, fy] = [x, y].map(|at| at.rem_euclid(2) as f32 / 2.0);
            let value_at = |i, j| pixel(grid, left + i, up + j, at % 2);
            // Whole numbers and halves: exact in whatever order.
            let expected = (value_at(0, 0) * (1.0 - fx) + value_at(1, 0) * fx) * (1.0 - fy)
                + (value_at(0, 1) * (1.0 - fx) + value_at(1, 1) * fx) * fy;
            assert_eq!(value, expected, "{:?} {x} {y} {at}", grid.size);
        }
    }

    #[test]
    fn rows_that_are_not_asked_for_stay() {
        let values = [1.0; 25];
        let grid = Grid {
            values: &values,
            size: [5, 5],
            n_channels: 1,
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
