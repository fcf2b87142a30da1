//! Tests whether both sides of a wrap are mirror images of each other.

use crate::TileError;
use crate::axis::transpose;
use dapple_raster::Raster;

/// Number of pixels that are compared on either side.
const REACH: usize = 8;

/// Maximum squared difference of mirror images, as a fraction of the variation of the compared pixels.
const LARGEST: f64 = 0.01;

/// Returns whether the last columns mirror the first columns, or the last rows the first rows, along an axis that
/// repeats.
pub(super) fn is_mirrored(tile: &Raster<f32>, axes: [bool; 2]) -> Result<bool, TileError> {
    Ok((axes[0] && along_rows(tile)) || (axes[1] && along_rows(&transpose(tile)?)))
}

fn along_rows(tile: &Raster<f32>) -> bool {
    let reach = REACH.min(tile.width() as usize / 2);
    let [mut apart, mut varies] = [0.0; 2];
    for line in tile.view().rows() {
        // Take the first pixels of the line, and the last ones in reverse order.
        let after = line.iter().take(reach).map(|&value| f64::from(value));
        let before = line.iter().rev().map(|&value| f64::from(value));
        let mean =
            after.clone().chain(before.clone().take(reach)).sum::<f64>() / (2 * reach) as f64;
        // Sum the squared differences of both, and their variation around the mean.
        for (a, b) in after.zip(before) {
            apart += (a - b) * (a - b);
            varies += (a - mean) * (a - mean) + (b - mean) * (b - mean);
        }
    }
    varies > 0.0 && apart < LARGEST * varies
}

#[cfg(test)]
mod tests {
    use super::is_mirrored;
    use crate::test_fields::fbm;
    use crate::{Method, Seamless};
    use dapple_raster::Raster;

    #[test]
    fn only_mirror_images_are_mirrored() {
        let image = fbm(1, [64; 2], true);
        assert_eq!(is_mirrored(&image, [true; 2]), Ok(false));
        let mirrored = Seamless::new(Method::Mirror)
            .with_axes([false, true])
            .apply(&image)
            .unwrap();
        assert_eq!(is_mirrored(&mirrored, [true; 2]), Ok(true));
        assert_eq!(is_mirrored(&mirrored, [true, false]), Ok(false));
        let flat = Raster::filled([64; 2], 1.0).unwrap();
        assert_eq!(is_mirrored(&flat, [true; 2]), Ok(false));
    }
}
