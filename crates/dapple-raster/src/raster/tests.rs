//! Tests of rasters: sizes, rows, crops, tiles, and independence of the number of threads.

use super::Raster;
use crate::{RasterErrorKind, Window, Wrap};

fn numbered(size: [u32; 2]) -> Raster<u32> {
    Raster::from_fn(size, |x, y| x + 100 * y).unwrap()
}

#[test]
fn rows_come_from_the_top() {
    let raster = numbered([3, 2]);
    assert_eq!(raster.row(0), [0, 1, 2]);
    assert_eq!(raster.row(1), [100, 101, 102]);
    assert_eq!(
        raster.view().rows().flatten().copied().collect::<Vec<_>>(),
        raster.pixels()
    );
}

#[test]
fn mapping_on_all_cores_equals_mapping_in_order() {
    let raster = numbered([130, 70]);
    let change = |&value: &u32| value.wrapping_mul(2_654_435_761);
    assert_eq!(raster.par_map(change), raster.map(change), "every pixel");
}

#[test]
fn a_crop_of_a_crop_is_a_crop() {
    let raster = numbered([7, 5]);
    let once = raster.crop([2, 1], [4, 3]).unwrap();
    assert_eq!(once.row(0), [102, 103, 104, 105]);
    let twice = raster
        .view()
        .crop([2, 1], [4, 3])
        .unwrap()
        .crop([1, 2], [2, 1])
        .unwrap();
    assert_eq!(Raster::from_view(twice).pixels(), [303, 304]);
}

#[test]
fn tiles_repeat() {
    let raster = numbered([3, 2]);
    let tiled = raster.tile([2, 3]).unwrap();
    assert_eq!(tiled.size(), [6, 6]);
    for y in 0..6_i64 {
        for x in 0..6_i64 {
            let wrap = [Wrap::Repeat; 2];
            assert_eq!(tiled.at(x, y, wrap), raster.at(x, y, wrap));
        }
    }
}

#[test]
fn bands_cover_every_row_once() {
    let mut raster = numbered([3, 7]);
    for (band, mut view) in (0..).zip(raster.view_mut().bands(3)) {
        assert_eq!(view.size(), [3, if band == 2 { 1 } else { 3 }]);
        view.fill(band);
    }
    assert_eq!(
        (0..7).map(|row| raster.row(row)[2]).collect::<Vec<_>>(),
        [0, 0, 0, 1, 1, 1, 2]
    );
}

#[test]
fn writing_into_a_crop_leaves_the_rest_alone() {
    let mut raster = Raster::filled([5, 4], 0).unwrap();
    raster.view_mut().crop([1, 1], [3, 2]).unwrap().fill(1);
    assert_eq!(raster.pixels().iter().sum::<i32>(), 6);
    assert_eq!(raster.row(1), [0, 1, 1, 1, 0]);
    assert_eq!(raster.row(3), [0; 5]);
}

#[test]
fn bad_sizes_are_refused() {
    assert!(matches!(
        Raster::filled([0, 3], 0).unwrap_err().kind(),
        RasterErrorKind::Empty { .. }
    ));
    assert!(matches!(
        Raster::filled([1 << 17, 1 << 17], 0).unwrap_err().kind(),
        RasterErrorKind::TooLarge { .. }
    ));
    let error = Raster::from_vec([2, 2], vec![0; 3]).unwrap_err();
    assert_eq!(error.to_string(), "there are 3 values, but 4 are needed");
    let raster = numbered([4, 4]);
    assert!(matches!(
        raster.crop([2, 2], [3, 1]).unwrap_err().kind(),
        RasterErrorKind::OutOfBounds { .. }
    ));
    assert!(matches!(
        raster.crop([u32::MAX, 0], [2, 1]).unwrap_err().kind(),
        RasterErrorKind::OutOfBounds { .. }
    ));
    assert!(matches!(
        raster.crop([0, 0], [0, 1]).unwrap_err().kind(),
        RasterErrorKind::Empty { .. }
    ));
    assert!(matches!(
        raster.tile([u32::MAX, 2]).unwrap_err().kind(),
        RasterErrorKind::TooLarge { .. }
    ));
    let other = numbered([4, 3]);
    assert!(matches!(
        raster.zip_map(&other, |a, b| a + b).unwrap_err().kind(),
        RasterErrorKind::SizeMismatch { .. }
    ));
}

#[test]
fn rows_that_are_too_short_are_refused() {
    let error = Raster::from_rows([3, 2], |_| [1, 2]).unwrap_err();
    assert!(matches!(
        error.kind(),
        RasterErrorKind::Length {
            length: 4,
            needed: 6
        }
    ));
    assert_eq!(
        Raster::from_rows([2, 1], |_| [1, 2, 3]).unwrap().pixels(),
        [1, 2]
    );
}

#[test]
fn a_window_is_a_crop_of_the_whole() {
    let whole = Window::unit([9, 8]).unwrap();
    let value = |position: glam::DVec2| (position.x * 3.0 + position.y) as f32;
    let all = Raster::from_window(&whole, value).unwrap();
    let part = Raster::from_window(&whole.crop([2, 3], [4, 5]).unwrap(), value).unwrap();
    assert_eq!(part, all.crop([2, 3], [4, 5]).unwrap());
}
