//! Makes a tile from an image and its mirror image.
//!
//! No pixel is lost, and there is no seam: along each axis that repeats, the last pixel is adjacent to its own copy,
//! and so is the first. The cost is a tile twice as long with visible symmetry. It is a baseline for comparison.

use crate::error::rows_cancellable;
use crate::{IsCancelled, TileError};
use dapple_raster::{Raster, Wrap};

/// Makes tiles from all planes, twice as large along each axis that repeats.
///
/// Halves reflected along x are multiplied by the plane's first factor, halves reflected along y by its second.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    reflections: &[[f32; 2]],
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let planes = planes.iter().zip(reflections);
    planes
        .map(|(plane, &factors)| mirrored(plane, factors, axes, is_cancelled))
        .collect()
}

fn mirrored(
    plane: &Raster<f32>,
    [across, down]: [f32; 2],
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    let side = |axis: usize| match axes[axis] {
        true => plane.size()[axis].saturating_mul(2),
        false => plane.size()[axis],
    };
    rows_cancellable([side(0), side(1)], is_cancelled, |row| {
        // Rows and columns beyond the last are reflected, and multiplied by the factors of the reflection.
        let down = if row < plane.height() { 1.0 } else { down };
        let row = plane.row(Wrap::Mirror.index(row.into(), plane.height()));
        let left = row.iter().map(move |value| value * down);
        let right = row.iter().rev().map(move |value| value * down * across);
        left.chain(right)
    })
}

#[cfg(test)]
mod tests {
    use super::tile;
    use dapple_raster::{Raster, Wrap};

    #[test]
    fn tile_is_the_image_and_its_mirror_image() {
        for size in [[1, 1], [2, 2], [1, 5], [5, 1], [3, 4]] {
            let image = Raster::from_fn(size, |x, y| (x + 10 * y) as f32).unwrap();
            for axes in [[false; 2], [true, false], [false, true], [true; 2]] {
                let planes = [image.clone(), image.map(|value| -value)];
                let tiles = tile(&planes, &[[1.0; 2]; 2], axes, &|| false).unwrap();
                let [width, height] = [0, 1].map(|axis| size[axis] * (1 + u32::from(axes[axis])));
                let wrap = [Wrap::Mirror; 2];
                let expected =
                    Raster::from_fn([width, height], |x, y| *image.at(x.into(), y.into(), wrap));
                let expected = expected.unwrap();
                assert_eq!(tiles[0], expected, "{size:?} {axes:?}");
                assert_eq!(tiles[1], expected.map(|value| -value), "{size:?} {axes:?}");
            }
        }
    }
}
