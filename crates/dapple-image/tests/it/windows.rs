//! Tests of data windows and display windows of OpenEXR files.

use dapple_image::{ImageErrorKind, Limits, decode_exr, decode_exr_region};
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
use exr::math::Vec2;
use exr::meta::attribute::IntegerBounds;
use exr::meta::header::{ImageAttributes, LayerAttributes};
use std::io::Cursor;

/// First column, first row, width and height of a window.
type Window = [i32; 4];

/// Returns the value of the pixel at column `x` and row `y`, in the coordinates of windows. It is never 0.
fn value(x: i32, y: i32) -> f32 {
    (1000 + 100 * y + x) as f32
}

/// Returns a file whose pixels have the values that [`value`] returns.
fn file(data: Window, display: Window) -> Vec<u8> {
    let bounds = |[x, y, width, height]: Window| {
        IntegerBounds::new((x, y), (width as usize, height as usize))
    };
    let [x, y, width, height] = data;
    let places = (y..y + height).flat_map(|y| (x..x + width).map(move |x| value(x, y)));
    let channel = AnyChannel::new("Y", FlatSamples::F32(places.collect()));
    let layer = Layer::new(
        (width as usize, height as usize),
        LayerAttributes::default().with_position(Vec2(x, y)),
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort([channel].into_iter().collect()),
    );
    let image = Image::from_layers(ImageAttributes::new(bounds(display)), vec![layer]);
    let mut bytes = Vec::new();
    let sink = Cursor::new(&mut bytes);
    image.write().non_parallel().to_buffered(sink).unwrap();
    bytes
}

/// Data window and display window of each test: equal windows, a crop, an overscan, windows shifted against each other
/// in eight directions, and negative coordinates.
const WINDOWS: [[Window; 2]; 12] = [
    [[0, 0, 7, 5], [0, 0, 7, 5]],
    [[24, 20, 16, 10], [0, 0, 64, 64]],
    [[-16, -16, 96, 96], [0, 0, 64, 64]],
    [[-3, 0, 7, 5], [0, 0, 7, 5]],
    [[3, 0, 7, 5], [0, 0, 7, 5]],
    [[0, -2, 7, 5], [0, 0, 7, 5]],
    [[0, 2, 7, 5], [0, 0, 7, 5]],
    [[-6, -4, 7, 5], [0, 0, 7, 5]],
    [[6, 4, 7, 5], [0, 0, 7, 5]],
    [[-6, 4, 7, 5], [0, 0, 7, 5]],
    [[-9, -8, 4, 3], [-10, -10, 7, 5]],
    [[5, -1, 1, 9], [3, 1, 5, 4]],
];

#[test]
fn pixels_are_those_of_the_display_window() {
    for [data, display] in WINDOWS {
        let image = decode_exr(&file(data, display), &Limits::default()).unwrap();
        let found = image.gray().unwrap();
        let [left, top, width, height] = display;
        assert_eq!(found.size(), [width as u32, height as u32], "{data:?}");
        for row in 0..height {
            for column in 0..width {
                let (x, y) = (left + column, top + row);
                let [first, line, columns, rows] = data;
                let is_stored =
                    (first..first + columns).contains(&x) && (line..line + rows).contains(&y);
                let right = if is_stored { value(x, y) } else { 0.0 };
                let pixel = found.row(row as u32)[column as usize];
                assert_eq!(pixel, right, "{data:?} {display:?} at {x}, {y}");
            }
        }
    }
}

#[test]
fn regions_are_those_of_the_display_window() {
    for [data, display] in WINDOWS {
        let bytes = file(data, display);
        let whole = decode_exr(&bytes, &Limits::default()).unwrap();
        let [_, _, width, height] = display.map(|part| part.max(0) as u32);
        for first in [[0, 0], [width / 2, height / 3], [width - 1, height - 1]] {
            let size = [width - first[0], height - first[1]];
            let part = decode_exr_region(&bytes, first, size, &Limits::default()).unwrap();
            let right = whole.gray().unwrap().crop(first, size).unwrap();
            assert_eq!(
                part.gray().unwrap(),
                &right,
                "{data:?} {display:?} {first:?}"
            );
        }
    }
}

#[test]
fn windows_without_a_common_pixel_are_refused_by_name() {
    for data in [[7, 0, 4, 5], [-4, 0, 4, 5], [0, 5, 7, 2], [0, -3, 7, 3]] {
        let error = decode_exr(&file(data, [0, 0, 7, 5]), &Limits::default()).unwrap_err();
        let kind = ImageErrorKind::Windows {
            data: data.map(i64::from),
            display: [0, 0, 7, 5],
        };
        assert_eq!(error.kind(), &kind, "{error}");
        assert!(error.to_string().contains("display window"), "{error}");
    }
}

#[test]
fn limits_hold_for_both_windows() {
    let read = |data, display, pixels| {
        let limits = Limits {
            pixels,
            ..Limits::default()
        };
        decode_exr(&file(data, display), &limits).map_err(|error| error.kind().clone())
    };
    let size = [64, 64];
    let refused = ImageErrorKind::TooManyPixels { size, limit: 4095 };
    let (small, large) = ([0, 0, 4, 4], [0, 0, 64, 64]);
    assert!(read(small, large, 4096).is_ok(), "exactly the limit");
    assert_eq!(read(small, large, 4095), Err(refused.clone()), "display");
    assert_eq!(read(large, small, 4095), Err(refused), "data");
}
