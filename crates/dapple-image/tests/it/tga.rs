//! Tests of TGA files, written byte by byte.

use dapple_image::{Format, Image, ImageErrorKind, Limits, PngPixels, decode_image};
use dapple_raster::Raster;
use proptest::prelude::*;

/// Descriptors: rows from the top or the bottom, with this number of alpha bits.
const TOP: u8 = 32;
const BOTTOM: u8 = 0;

/// Returns a header without a palette.
fn header(kind: u8, [width, height]: [u8; 2], bits: u8, descriptor: u8) -> [u8; 18] {
    [
        0, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0, width, 0, height, 0, bits, descriptor,
    ]
}

fn codes(bytes: &[u8]) -> PngPixels {
    match decode_image(bytes, &Limits::default()).unwrap() {
        Image::Codes(Format::Tga, image) => image.pixels,
        other => panic!("{other:?}"),
    }
}

fn refusal(bytes: &[u8]) -> String {
    let error = decode_image(bytes, &Limits::default()).unwrap_err();
    error.to_string()
}

fn raster<T>(size: [u32; 2], pixels: Vec<T>) -> Raster<T> {
    Raster::from_vec(size, pixels).unwrap()
}

#[test]
fn colors_are_read_from_each_corner() {
    // Blue, green, red of the pixels a to d.
    let [a, b, c, d] = [[3, 2, 1], [6, 5, 4], [9, 8, 7], [12, 11, 10]];
    let expected = PngPixels::Rgb8(raster(
        [2, 2],
        vec![[1, 2, 3], [4, 5, 6], [7, 8, 9], [10, 11, 12]],
    ));
    for (descriptor, stored) in [
        (TOP, [a, b, c, d]),
        (BOTTOM, [c, d, a, b]),
        (BOTTOM | 16, [d, c, b, a]),
        (TOP | 16, [b, a, d, c]),
    ] {
        let bytes = [
            header(2, [2, 2], 24, descriptor).as_slice(),
            stored.as_flattened(),
        ]
        .concat();
        assert_eq!(codes(&bytes), expected, "descriptor {descriptor}");
    }
    let image = decode_image(
        &[header(2, [1, 1], 24, TOP).as_slice(), &[0, 0, 255]].concat(),
        &Limits::default(),
    );
    let red = image.unwrap().color().unwrap().pixels()[0];
    assert_eq!(red.to_array(), [1.0, 0.0, 0.0], "red comes last");
}

#[test]
fn runs_of_pixels_may_cross_rows() {
    // A run of three pixels, two single pixels, and a run of one.
    let packets = [
        &[130, 1, 2, 3, 4][..],
        &[1, 5, 6, 7, 8, 9, 10, 11, 12],
        &[128, 13, 14, 15, 16],
    ]
    .concat();
    let bytes = [header(10, [2, 3], 32, TOP | 8).as_slice(), &packets].concat();
    let run = [3, 2, 1, 4];
    let expected = vec![
        run,
        run,
        run,
        [7, 6, 5, 8],
        [11, 10, 9, 12],
        [15, 14, 13, 16],
    ];
    assert_eq!(codes(&bytes), PngPixels::Rgba8(raster([2, 3], expected)));
    let beyond = [
        header(10, [2, 3], 32, TOP | 8).as_slice(),
        &[134, 1, 2, 3, 4],
    ]
    .concat();
    let expected = "the TGA data is damaged: a packet of pixels reaches beyond the image";
    assert_eq!(refusal(&beyond), expected);
}

#[test]
fn alpha_is_read_if_the_header_counts_its_bits() {
    let pixel = [3, 2, 1, 77];
    let read = |descriptor| codes(&[header(2, [1, 1], 32, descriptor).as_slice(), &pixel].concat());
    assert_eq!(
        read(TOP | 8),
        PngPixels::Rgba8(raster([1, 1], vec![[1, 2, 3, 77]]))
    );
    assert_eq!(read(TOP), PngPixels::Rgb8(raster([1, 1], vec![[1, 2, 3]])));
}

#[test]
fn five_bits_are_scaled_to_eight() {
    // Red 31, green 16 and blue 1: 16 · 255 / 31 is 131.6, and 255 / 31 is 8.2.
    let number: u16 = 31 << 10 | 16 << 5 | 1;
    let read = |number: u16, descriptor| {
        codes(
            &[
                header(2, [1, 1], 16, descriptor).as_slice(),
                &number.to_le_bytes(),
            ]
            .concat(),
        )
    };
    assert_eq!(
        read(number, TOP),
        PngPixels::Rgb8(raster([1, 1], vec![[255, 132, 8]]))
    );
    let expected = PngPixels::Rgba8(raster([1, 1], vec![[255, 132, 8, 255]]));
    assert_eq!(read(number | 1 << 15, TOP | 1), expected, "with alpha");
}

#[test]
fn gray_images_are_read() {
    let bytes = [header(3, [3, 1], 8, TOP).as_slice(), &[5, 6, 7]].concat();
    assert_eq!(
        codes(&bytes),
        PngPixels::Gray8(raster([3, 1], vec![5, 6, 7]))
    );
    let bytes = [header(11, [3, 1], 8, TOP).as_slice(), &[130, 9]].concat();
    assert_eq!(codes(&bytes), PngPixels::Gray8(raster([3, 1], vec![9; 3])));
    let bytes = [header(3, [1, 1], 16, TOP | 8).as_slice(), &[5, 6]].concat();
    assert_eq!(
        codes(&bytes),
        PngPixels::GrayAlpha8(raster([1, 1], vec![[5, 6]]))
    );
}

#[test]
fn palettes_begin_at_any_index() {
    let mut palette = header(1, [2, 1], 8, TOP);
    // An identification of three bytes, and two entries of 24 bits from index 10 on.
    palette[0] = 3;
    palette[1] = 1;
    palette[3..8].copy_from_slice(&[10, 0, 2, 0, 24]);
    let bytes =
        |indices: [u8; 2]| [palette.as_slice(), b"id.", &[3, 2, 1, 6, 5, 4], &indices].concat();
    let expected = PngPixels::Rgb8(raster([2, 1], vec![[4, 5, 6], [1, 2, 3]]));
    assert_eq!(codes(&bytes([11, 10])), expected);
    for index in [9, 12] {
        let expected = "the TGA data is damaged: a pixel is outside the palette";
        assert_eq!(refusal(&bytes([10, index])), expected, "index {index}");
    }
}

#[test]
fn bytes_without_a_valid_header_are_of_no_format() {
    let valid = header(2, [1, 1], 24, TOP);
    for (at, value) in [
        (1, 2),
        (2, 0),
        (2, 32),
        (12, 0),
        (14, 0),
        (16, 12),
        (17, 64),
        (17, 9),
    ] {
        let mut bytes = [valid.as_slice(), &[0; 3]].concat();
        bytes[at] = value;
        let error = decode_image(&bytes, &Limits::default()).unwrap_err();
        assert_eq!(
            error.kind(),
            &ImageErrorKind::UnknownFormat,
            "byte {at}: {value}"
        );
    }
}

#[test]
fn limits_are_kept_to_the_pixel_and_the_byte() {
    let bytes = [header(2, [4, 3], 24, TOP).as_slice(), &[0; 36]].concat();
    let kind = |pixels, bytes_limit| {
        let limits = Limits {
            pixels,
            bytes: bytes_limit,
        };
        let image = decode_image(&bytes, &limits);
        image.map(|_| ()).map_err(|error| error.kind().clone())
    };
    assert_eq!(kind(12, 108), Ok(()), "exactly the limits");
    let size = [4, 3];
    let expected = ImageErrorKind::TooManyPixels { size, limit: 11 };
    assert_eq!(kind(11, 108), Err(expected), "one pixel less");
    let expected = ImageErrorKind::TooManyBytes {
        bytes: 108,
        limit: 107,
    };
    assert_eq!(kind(12, 107), Err(expected), "one byte less");
}

#[test]
fn every_truncation_is_refused() {
    let raw = [header(2, [2, 2], 24, TOP).as_slice(), &[7; 12]].concat();
    let runs = [
        header(10, [2, 2], 24, TOP).as_slice(),
        &[1, 1, 2, 3, 4, 5, 6, 129, 7, 8, 9],
    ]
    .concat();
    for bytes in [raw, runs] {
        decode_image(&bytes, &Limits::default()).unwrap();
        for length in 0..bytes.len() {
            let result = decode_image(&bytes[..length], &Limits::default());
            assert!(result.is_err(), "{length} of {} bytes", bytes.len());
        }
    }
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(body in proptest::collection::vec(any::<u8>(), 0..300)) {
        let bytes = [header(10, [100, 100], 32, TOP).as_slice(), &body].concat();
        let _ = decode_image(&bytes, &Limits::default());
        let _ = decode_image(&body, &Limits::default());
    }
}
