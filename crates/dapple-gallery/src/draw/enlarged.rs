//! Enlarged pictures, whose pixels become visible squares.

use dapple_raster::{Raster, RasterError};

/// Resizes a square raster to `size` × `size` pixels by taking the nearest pixel; enlarging turns every pixel into a
/// square.
///
/// # Errors
///
/// If `size` is zero.
pub fn enlarged<T: Copy>(raster: &Raster<T>, size: u32) -> Result<Raster<T>, RasterError> {
    let nearest = |at: u32| (u64::from(at) * u64::from(raster.width()) / u64::from(size)) as u32;
    Raster::from_fn([size; 2], |column, row| {
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
        assert!(enlarged(&small, 0).is_err(), "no pixel");
    }
}
