//! Smooths edges by supersampling: every pixel is the mean of many samples.

use dapple_raster::{Raster, RasterError, Texel};

/// Returns a raster `side` times smaller along each axis. Every pixel is the mean of `side` × `side` samples.
///
/// Samples at the right and the bottom that do not fill a whole pixel are ignored.
///
/// # Errors
///
/// If no pixel remains.
pub fn shrink<T: Texel>(fine: &Raster<T>, side: u32) -> Result<Raster<T>, RasterError> {
    let side = side.max(1);
    let size = fine.size().map(|samples| samples / side);
    let share = 1.0 / (side * side) as f32;
    Raster::from_fn(size, |column, row| {
        let columns = (column * side) as usize..((column + 1) * side) as usize;
        let rows = row * side..(row + 1) * side;
        let samples = rows.flat_map(|row| &fine.row(row)[columns.clone()]);
        let sum = samples.copied().reduce(|sum, sample| sum + sample);
        // There is a first sample, so the sum exists.
        sum.unwrap_or(fine.pixels()[0]) * share
    })
}

#[cfg(test)]
mod tests {
    use super::shrink;
    use dapple_raster::Raster;

    #[test]
    fn shrink_takes_means_and_leaves_out_what_does_not_fill_a_pixel() {
        let fine = Raster::from_fn([5, 2], |column, row| (column + 10 * row) as f32).unwrap();
        let small = shrink(&fine, 2).unwrap();
        assert_eq!((small.size(), small.pixels()), ([2, 1], &[5.5, 7.5][..]));
        assert!(shrink(&fine, 3).is_err(), "no pixel is left");
    }
}
