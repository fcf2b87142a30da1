//! Arranges several images on one sheet.

use dapple_raster::{Raster, RasterError};

/// Builds a sheet of `size` pixels with a grid of columns × rows images, row by row, and gaps between them.
///
/// `picture` renders the image with the given index, counted from 0 along the rows, at the given size. Sizes differ
/// by at most one pixel, so that the images fill the sheet.
///
/// # Errors
///
/// If the sheet is too small for its images, if `picture` fails, or if it returns an image of a different size.
pub fn sheet<T: Copy>(
    size: [u32; 2],
    grid: [u32; 2],
    gap: u32,
    background: T,
    mut picture: impl FnMut(u32, [u32; 2]) -> anyhow::Result<Raster<T>>,
) -> anyhow::Result<Raster<T>> {
    let mut sheet = Raster::filled(size, background)?;
    for number in 0..grid[0] * grid[1] {
        let place = [number % grid[0], number / grid[0]];
        let [start, side] = cell(size, grid, gap, place);
        let picture = picture(number, side)?;
        picture.check_same_size(side)?;
        paste(&mut sheet, start, &picture)?;
    }
    Ok(sheet)
}

/// Returns the position and the size, in pixels, of the image at a column and row of the sheet.
fn cell(size: [u32; 2], grid: [u32; 2], gap: u32, place: [u32; 2]) -> [[u32; 2]; 2] {
    let edge = |axis: usize, index: u32| {
        let whole = u64::from(size[axis]) + u64::from(gap);
        (whole * u64::from(index) / u64::from(grid[axis])) as u32
    };
    let start = [0, 1].map(|axis| edge(axis, place[axis]));
    let end = [0, 1].map(|axis| edge(axis, place[axis] + 1));
    [
        start,
        [0, 1].map(|axis| (end[axis] - start[axis]).saturating_sub(gap)),
    ]
}

fn paste<T: Copy>(
    sheet: &mut Raster<T>,
    start: [u32; 2],
    picture: &Raster<T>,
) -> Result<(), RasterError> {
    let size = picture.size();
    let mut place = sheet.view_mut().crop(start, size)?;
    for (row, pixels) in (0..).zip(place.rows_mut()) {
        pixels.copy_from_slice(picture.row(row));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::sheet;
    use dapple_raster::Raster;

    #[test]
    fn sheet_places_its_pictures_row_by_row_with_gaps() {
        let numbers = sheet([5, 3], [2, 2], 1, 9, |number, size| {
            Ok(Raster::filled(size, number)?)
        });
        let expected = [0, 0, 9, 1, 1, 9, 9, 9, 9, 9, 2, 2, 9, 3, 3];
        assert_eq!(numbers.unwrap().pixels(), expected);
    }

    #[test]
    fn sheet_is_filled_where_sides_do_not_divide() {
        for width in 7..12 {
            let filled = sheet([width, 4], [3, 1], 0, 0, |_, size| {
                Ok(Raster::filled(size, 1)?)
            });
            assert!(
                filled.unwrap().pixels().iter().all(|&pixel| pixel == 1),
                "{width} columns have a hole"
            );
        }
    }

    #[test]
    fn sheet_without_room_is_refused() {
        let refused = sheet([2, 2], [4, 4], 1, 0, |_, size| Ok(Raster::filled(size, 1)?));
        assert!(refused.is_err(), "pictures without pixels");
    }
}
