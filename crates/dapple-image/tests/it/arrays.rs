//! Tests of the bytes of arrays and raw heights against bytes written by hand.

use crate::pixel::Pixel;
use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_image::{
    Content, Depth, Encoding, ImageErrorKind, Limits, PngPixels, RowWriter, decode_png,
};
use dapple_raster::Raster;
use std::io::Cursor;

/// Encodes an image in two bands: the first row, and the remaining rows.
fn encode<T: Pixel>(image: &Raster<T>, encoding: Encoding) -> Vec<u8> {
    let [width, height] = image.size();
    let sink = Cursor::new(Vec::new());
    let mut writer = RowWriter::new(sink, image.size(), T::CONTENT, encoding).unwrap();
    for (row, band) in [(0, 1), (1, height - 1)] {
        let rows = image.view().crop([0, row], [width, band]).unwrap();
        T::write(&mut writer, rows).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

#[test]
fn an_array_is_its_shape_and_its_numbers() {
    let image = Raster::from_vec([2, 3], vec![0.0, -1.5, 2.0, 0.1, 1e9, 0.5]).unwrap();
    let bytes = encode(&image, Encoding::Npy);
    assert_eq!(
        bytes[..10],
        *b"\x93NUMPY\x01\x00\x76\x00",
        "128 bytes, 10 of them before the text"
    );
    let text = std::str::from_utf8(&bytes[10..128]).unwrap();
    let dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 2), }";
    assert_eq!(
        text.trim_end_matches(' '),
        format!("{dictionary}{}\n", " ".repeat(117 - dictionary.len()))
    );
    let numbers: Vec<u8> = image
        .pixels()
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    assert_eq!(bytes[128..], numbers);
}

#[test]
fn an_array_has_the_numbers_of_colors_and_vectors_as_they_are() {
    let color = LinearRgb::new(0.25, 3.0, -1.0);
    let normal = Normal {
        x: -0.6,
        y: 0.0,
        z: 0.8,
    };
    let half = LinearRgba { color, alpha: 0.5 };
    let numbers = |bytes: Vec<u8>| -> Vec<f32> {
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
        bytes[128..].chunks(4).take(4).map(number).collect()
    };
    let of_color = numbers(encode(
        &Raster::filled([1, 2], color).unwrap(),
        Encoding::Npy,
    ));
    assert_eq!(of_color, [0.25, 3.0, -1.0, 0.25]);
    let of_normal = numbers(encode(
        &Raster::filled([1, 2], normal).unwrap(),
        Encoding::Npy,
    ));
    assert_eq!(of_normal, [-0.6, 0.0, 0.8, -0.6]);
    let of_half = numbers(encode(
        &Raster::filled([1, 2], half).unwrap(),
        Encoding::Npy,
    ));
    assert_eq!(
        of_half,
        [0.25, 3.0, -1.0, 0.5],
        "alpha is not multiplied into the color"
    );
}

#[test]
fn raw_heights_are_codes_of_16_bits_with_the_low_byte_first() {
    let heights = vec![
        0.0,
        1.0,
        -3.0,
        7.0,
        0.5,
        1.0 / 65535.0,
        f32::NAN,
        258.0 / 65535.0,
    ];
    let image = Raster::from_vec([4, 2], heights).unwrap();
    let codes: [u16; 8] = [0, 65535, 0, 65535, 32768, 1, 0, 258];
    let bytes: Vec<u8> = codes.iter().flat_map(|code| code.to_le_bytes()).collect();
    assert_eq!(encode(&image, Encoding::R16), bytes);
    assert_eq!(bytes[14..], [2, 1]);
}

#[test]
fn raw_heights_take_numbers_only() {
    for content in [
        Content::Color,
        Content::ColorAlpha,
        Content::Normal,
        Content::Packed,
        Content::PackedFour,
    ] {
        let refused = RowWriter::new(Cursor::new(Vec::new()), [2, 2], content, Encoding::R16);
        let error = refused.unwrap_err();
        assert!(
            matches!(
                error.kind(),
                ImageErrorKind::Channels { needed: "gray", .. }
            ),
            "{error}"
        );
    }
}

#[test]
fn four_packed_numbers_are_the_channels_of_a_png_without_a_color_chunk() {
    let image = Raster::filled([2, 2], [0.0, 0.2, 1.0, 0.4]).unwrap();
    let bytes = encode(&image, Encoding::Png(Depth::Eight));
    let decoded = decode_png(&bytes, &Limits::default()).unwrap();
    assert_eq!(
        decoded.pixels,
        PngPixels::Rgba8(Raster::filled([2, 2], [0, 51, 255, 102]).unwrap())
    );
    assert!(
        !bytes.windows(4).any(|chunk| chunk == b"sRGB"),
        "they are no colors"
    );
}
