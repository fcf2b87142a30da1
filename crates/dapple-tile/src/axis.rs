//! Processes planes along one axis after the other.
//!
//! A function for rows is applied to columns by transposing the planes before and after it.

use crate::error::check;
use crate::{IsCancelled, TileError};
use dapple_raster::Raster;

/// An axis of an image. The x axis is processed before the y axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    X,
    Y,
}

/// Processes the rows of all planes if x repeats, then the columns of the result if y repeats.
///
/// `along_rows` receives planes whose rows run along the given axis.
pub(crate) fn each_axis(
    planes: &[Raster<f32>],
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
    along_rows: impl Fn(&[Raster<f32>], Axis) -> Result<Vec<Raster<f32>>, TileError>,
) -> Result<Vec<Raster<f32>>, TileError> {
    let mut planes = planes.to_vec();
    if axes[0] {
        planes = along_rows(&planes, Axis::X)?;
    }
    if axes[1] {
        let columns = along_rows(&transpose_all(&planes, is_cancelled)?, Axis::Y)?;
        planes = transpose_all(&columns, is_cancelled)?;
    }
    Ok(planes)
}

/// Transposes all planes. The callback is called before each strip of rows.
pub(crate) fn transpose_all(
    planes: &[Raster<f32>],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let transposed = planes
        .iter()
        .map(|plane| transpose_cancellable(plane, is_cancelled));
    transposed.collect()
}

/// Side length of the blocks that are transposed at a time, in pixels. Source and target of a block fit into the cache.
const BLOCK: usize = 32;

/// Exchanges the rows and columns of a raster.
pub(crate) fn transpose(raster: &Raster<f32>) -> Result<Raster<f32>, TileError> {
    transpose_cancellable(raster, &|| false)
}

fn transpose_cancellable(
    raster: &Raster<f32>,
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, TileError> {
    let [width, height] = raster.size().map(|side| side as usize);
    let from = raster.pixels();
    let mut to = vec![0.0; from.len()];
    // Transpose in square blocks.
    for top in (0..height).step_by(BLOCK) {
        check(is_cancelled)?;
        for left in (0..width).step_by(BLOCK) {
            for y in top..(top + BLOCK).min(height) {
                for x in left..(left + BLOCK).min(width) {
                    to[x * height + y] = from[y * width + x];
                }
            }
        }
    }
    let [width, height] = raster.size();
    Ok(Raster::from_vec([height, width], to)?)
}

#[cfg(test)]
mod tests {
    use super::{Axis, each_axis, transpose};
    use dapple_raster::Raster;

    #[test]
    fn transpose_swaps_columns_and_rows() {
        for size in [[1, 1], [1, 70], [33, 2], [65, 40]] {
            let raster = Raster::from_fn(size, |x, y| (x + 100 * y) as f32).unwrap();
            let turned = transpose(&raster).unwrap();
            let expected = Raster::from_fn([size[1], size[0]], |x, y| (y + 100 * x) as f32);
            assert_eq!(turned, expected.unwrap(), "{size:?}");
        }
    }

    #[test]
    fn each_axis_works_on_x_first_and_only_where_asked() {
        let raster = Raster::from_fn([3, 2], |x, y| (x + 10 * y) as f32).unwrap();
        // Adds the position along the axis, times 1 for x and times 100 for y.
        let sum = |planes: &[Raster<f32>], axis: Axis| {
            let factor = if axis == Axis::X { 1.0 } else { 100.0 };
            let size = planes[0].size();
            let out = Raster::from_fn(size, |x, y| {
                planes[0].row(y)[x as usize] + x as f32 * factor
            });
            Ok(vec![out?])
        };
        for axes in [[false; 2], [true, false], [false, true], [true; 2]] {
            let out = each_axis(core::slice::from_ref(&raster), axes, &|| false, sum).unwrap();
            let expected = Raster::from_fn([3, 2], |x, y| {
                let along = [x as f32, 100.0 * y as f32];
                let added = along.iter().zip(axes).filter(|(_, repeats)| *repeats);
                (x + 10 * y) as f32 + added.map(|(value, _)| value).sum::<f32>()
            });
            assert_eq!(out, [expected.unwrap()], "{axes:?}");
        }
    }
}
