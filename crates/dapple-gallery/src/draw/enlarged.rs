//! Enlarges images so that their pixels become visible squares.

use dapple_raster::{Raster, RasterError};

/// Resizes a raster by taking the nearest pixel, so that its longer side has `size` pixels. Enlarging turns every
/// pixel into a square.
///
/// # Errors
///
/// If `size` is zero.
pub fn enlarged<T: Copy>(raster: &Raster<T>, size: u32) -> Result<Raster<T>, RasterError> {
    let longer = u64::from(raster.width().max(raster.height()));
    let scaled = |side: u32| (u64::from(side) * u64::from(size)).div_ceil(longer) as u32;
    let nearest = |at: u32| (u64::from(at) * longer / u64::from(size)) as u32;
    Raster::from_fn(raster.size().map(scaled), |column, row| {
        raster.row(nearest(row))[nearest(column) as usize]
    })
}

#[cfg(test)]
mod tests {
    use super::enlarged;
    use dapple_raster::Raster;

    #[test]
    fn enlarged_pixels_become_squares() {
        let small = Raster::from_vec([2, 2], vec![1, 2, 3, 4]).unwrap();
        let large = enlarged(&small, 4).unwrap();
        assert_eq!(large.row(1), [1, 1, 2, 2]);
        assert_eq!(large.row(2), [3, 3, 4, 4]);
        let wide = enlarged(&Raster::from_vec([3, 1], vec![1, 2, 3]).unwrap(), 7).unwrap();
        assert_eq!(wide.size(), [7, 3]);
        assert_eq!(wide.row(2), [1, 1, 1, 2, 2, 3, 3]);
        assert!(enlarged(&small, 0).is_err(), "no pixel");
    }
}
