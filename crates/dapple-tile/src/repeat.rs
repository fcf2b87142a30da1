//! Repeats a tile over a map of any size.
//!
//! Every row starts with one period, which is copied in pieces of doubling length, at the speed of copying memory. A
//! window of a large map can be filled without computing the rest of the map, and equals the same crop of it.

use crate::TileError;
use dapple_raster::{Raster, RasterViewMut, Wrap};

/// Builds a map of `size` pixels covered with copies of a tile, starting at the top left corner.
///
/// # Errors
///
/// [`TileErrorKind::Raster`](crate::TileErrorKind::Raster) if `size` is empty or too large.
///
/// # Examples
///
/// ```
/// use dapple_tile::raster::Raster;
/// use dapple_tile::repeat;
///
/// let tile = Raster::from_vec([2, 1], vec![1, 2])?;
/// assert_eq!(repeat(&tile, [5, 2])?.row(1), [1, 2, 1, 2, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn repeat<T: Copy + Send + Sync>(
    tile: &Raster<T>,
    size: [u32; 2],
) -> Result<Raster<T>, TileError> {
    // Fill the first rows, up to the height of the tile; the following rows are copies of them. The size is checked
    // before memory is allocated.
    let n_rows = size[1].min(tile.height());
    Raster::<()>::filled(size, ())?;
    let mut first = Raster::filled([size[0], n_rows], tile.pixels()[0])?;
    repeat_into(tile, [0, 0], first.view_mut());
    let mut pixels = first.into_pixels();
    let n_pixels = size[0] as usize * size[1] as usize;
    pixels.reserve_exact(n_pixels - pixels.len());
    while pixels.len() < n_pixels {
        pixels.extend_from_within(..pixels.len().min(n_pixels - pixels.len()));
    }
    Ok(Raster::from_vec(size, pixels)?)
}

/// Covers `out` with copies of a tile. With the feature `rayon`, bands of rows are filled in parallel.
///
/// The pixel in column c and row r becomes the tile's pixel `first + [c, r]`, modulo the tile's size. So windows of a
/// large map agree with the map.
pub fn repeat_into<T: Copy + Send + Sync>(
    tile: &Raster<T>,
    first: [i64; 2],
    out: RasterViewMut<'_, T>,
) {
    let [left, top] = [0, 1].map(|axis| Wrap::Repeat.index(first[axis], tile.size()[axis]));
    out.for_each_band(BAND_ROWS, |first_row, mut rows| {
        let above = i64::from(top) + i64::from(first_row);
        for (row, to) in (above..).zip(rows.rows_mut()) {
            let row = Wrap::Repeat.index(row, tile.height());
            repeat_row(tile.row(row), left as usize, to);
        }
    });
}

/// Number of rows that a thread fills at a time.
const BAND_ROWS: u32 = 64;

/// Fills a row with periods of the tile's row, starting at pixel `first` of the tile.
fn repeat_row<T: Copy>(from: &[T], first: usize, to: &mut [T]) {
    // Copy one period, starting in column `first` of the tile.
    let end = (from.len() - first).min(to.len());
    to[..end].copy_from_slice(&from[first..first + end]);
    let begin = first.min(to.len() - end);
    to[end..end + begin].copy_from_slice(&from[..begin]);
    // Repeat it, in pieces of doubling length.
    let mut filled = end + begin;
    while filled < to.len() {
        let more = filled.min(to.len() - filled);
        to.copy_within(..more, filled);
        filled += more;
    }
}

#[cfg(test)]
mod tests {
    use super::{repeat, repeat_into};
    use crate::TileErrorKind;
    use crate::test_fields::same_on_threads;
    use dapple_raster::{Raster, Wrap};

    fn numbered(size: [u32; 2]) -> Raster<u32> {
        Raster::from_fn(size, |x, y| x + 1000 * y).unwrap()
    }

    #[test]
    fn repeat_has_at_every_pixel_that_of_the_tile() {
        for tile in [[1, 1], [1, 3], [3, 1], [5, 4], [7, 100]] {
            let tile = numbered(tile);
            for size in [[1, 1], [1, 9], [9, 1], [4, 4], [20, 13], [31, 300]] {
                let at = |x: u32, y: u32| *tile.at(x.into(), y.into(), [Wrap::Repeat; 2]);
                let expected = Raster::from_fn(size, at).unwrap();
                assert_eq!(
                    repeat(&tile, size).unwrap(),
                    expected,
                    "{:?} {size:?}",
                    tile.size()
                );
            }
        }
    }

    #[test]
    fn repeat_into_fills_windows_as_the_whole() {
        let tile = numbered([5, 3]);
        for first in [[0, 0], [-7, 4], [12, -1], [i64::MAX, i64::MIN]] {
            for size in [[1, 1], [3, 2], [17, 140]] {
                let mut out = Raster::filled(size, 0).unwrap();
                repeat_into(&tile, first, out.view_mut());
                let [left, top] = [first[0].rem_euclid(5), first[1].rem_euclid(3)];
                let at = |x: u32, y: u32| {
                    *tile.at(left + i64::from(x), top + i64::from(y), [Wrap::Repeat; 2])
                };
                assert_eq!(
                    out,
                    Raster::from_fn(size, at).unwrap(),
                    "{first:?} {size:?}"
                );
            }
        }
    }

    #[test]
    fn repeat_into_leaves_pixels_outside_of_the_view_alone() {
        let mut out = Raster::filled([6, 5], u32::MAX).unwrap();
        let view = out.view_mut().crop([2, 1], [3, 2]).unwrap();
        repeat_into(&numbered([2, 2]), [0, 0], view);
        let kept = out
            .pixels()
            .iter()
            .filter(|value| **value == u32::MAX)
            .count();
        assert_eq!(kept, 24, "only 3 × 2 pixels are written");
    }

    #[test]
    fn repeat_has_the_same_bits_on_any_number_of_threads() {
        let tile = Raster::from_fn([9, 7], |x, y| (x * y) as f32 + 0.5).unwrap();
        assert!(same_on_threads(|| repeat(&tile, [100, 300]).unwrap()));
    }

    #[test]
    fn repeat_refuses_sizes_that_no_raster_has() {
        for size in [[0, 4], [4, 0], [u32::MAX, u32::MAX], [1 << 16, 1 << 16]] {
            let error = repeat(&numbered([2, 2]), size).unwrap_err();
            assert!(matches!(error.kind(), TileErrorKind::Raster(_)), "{error}");
        }
    }
}
