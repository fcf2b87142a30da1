//! Tests of JPEG files that can be read, and of those that are errors.

use dapple_image::{
    Format, Image, ImageErrorKind, Limits, PngPixels, Transfer, decode_image, decode_jpeg,
};
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use proptest::prelude::*;

/// Returns a color of a smooth gradient, which JPEG changes little.
fn color(x: u32, y: u32) -> [u8; 3] {
    [(3 * x + 20) as u8, (2 * y + 60) as u8, (x + y + 100) as u8]
}

/// Encodes a smooth gradient as a JPEG file. `set` configures the encoder, such as the kind of coding.
fn encode(
    size: [u32; 2],
    kind: ColorType,
    set: impl FnOnce(&mut Encoder<&mut Vec<u8>>),
) -> Vec<u8> {
    let at = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let samples: Vec<u8> = match kind {
        ColorType::Luma => at.map(|(x, y)| color(x, y)[0]).collect(),
        ColorType::Cmyk => at.flat_map(|(x, y)| [color(x, y)[0]; 4]).collect(),
        _ => at.flat_map(|(x, y)| color(x, y)).collect(),
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 95);
    set(&mut encoder);
    let [width, height] = size.map(|side| side as u16);
    encoder.encode(&samples, width, height, kind).unwrap();
    bytes
}

/// Returns files of the same image in different codings of JPEG.
fn files(size: [u32; 2]) -> [Vec<u8>; 5] {
    [
        encode(size, ColorType::Luma, |_| ()),
        encode(size, ColorType::Rgb, |_| ()),
        encode(size, ColorType::Rgb, |encoder| {
            encoder.set_progressive(true);
        }),
        encode(size, ColorType::Rgb, |encoder| {
            encoder.set_sampling_factor(SamplingFactor::F_2_2);
            encoder.set_restart_interval(2);
        }),
        encode(size, ColorType::Luma, |encoder| {
            encoder.set_progressive(true);
        }),
    ]
}

#[test]
fn all_codings_give_the_picture() {
    for size in [[1, 1], [8, 8], [17, 9], [40, 33]] {
        for (at, bytes) in files(size).iter().enumerate() {
            let image = decode_jpeg(bytes, &Limits::default()).unwrap();
            assert_eq!(image.transfer, Transfer::Srgb, "file {at}");
            assert_eq!(image.pixels.size(), size, "file {at}");
            let near = |code: u8, expected: u8| code.abs_diff(expected) <= 6;
            for (x, y) in (0..size[0]).zip(0..size[1]) {
                let expected = color(x, y);
                // The quality of 95 allows a few steps, and halved colors a few more.
                let is_near = match &image.pixels {
                    PngPixels::Gray8(codes) => near(codes.row(y)[x as usize], expected[0]),
                    PngPixels::Rgb8(codes) => {
                        let found = codes.row(y)[x as usize];
                        found
                            .iter()
                            .zip(expected)
                            .all(|(&code, expected)| near(code, expected))
                    }
                    _ => false,
                };
                assert!(is_near, "file {at} of {size:?} at {x}, {y}");
            }
        }
    }
}

#[test]
fn value_stability_jpeg() {
    // The exact codes of the codec's whole-number transform.
    let image = decode_jpeg(&files([9, 9])[1], &Limits::default()).unwrap();
    let PngPixels::Rgb8(codes) = image.pixels else {
        panic!("the file is not RGB");
    };
    let found = [[0, 0], [8, 0], [4, 4], [8, 8]].map(|[x, y]| codes.row(y)[x as usize]);
    let expected = [[19, 61, 101], [44, 60, 109], [31, 69, 108], [44, 76, 115]];
    assert_eq!(found, expected, "four pixels");
}

#[test]
fn a_file_is_known_by_its_first_bytes_and_read_as_srgb() {
    let bytes = encode([16, 16], ColorType::Luma, |_| ());
    let image = decode_image(&bytes, &Limits::default()).unwrap();
    assert!(matches!(image, Image::Codes(Format::Jpeg, _)), "{image:?}");
    assert_eq!(image.size(), [16, 16], "columns and rows");
    let [gray, color] = [
        image.gray().unwrap().pixels()[0],
        image.color().unwrap().pixels()[0].r,
    ];
    assert!(color < gray, "{color} is under the curve, {gray} is not");
}

#[test]
fn an_exif_orientation_turns_the_picture() {
    let exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0";
    let plain = encode([16, 8], ColorType::Rgb, |_| ());
    let turned = encode([16, 8], ColorType::Rgb, |encoder| {
        encoder.add_app_segment(1, exif.to_vec()).unwrap();
    });
    let pixels = |bytes: &[u8]| match decode_jpeg(bytes, &Limits::default()).unwrap().pixels {
        PngPixels::Rgb8(codes) => codes,
        _ => panic!("the file is not RGB"),
    };
    let (plain, turned) = (pixels(&plain), pixels(&turned));
    assert_eq!(turned.size(), [8, 16], "a quarter turn");
    for (x, y) in [(0, 0), (15, 0), (3, 5), (15, 7)] {
        // A quarter turn clockwise takes the bottom to the left.
        let upright = turned.row(x)[7 - y as usize];
        assert_eq!(upright, plain.row(y)[x as usize], "{x}, {y}");
    }
}

#[test]
fn what_is_not_read_is_named() {
    let refusal = |bytes: &[u8]| {
        let error = decode_jpeg(bytes, &Limits::default()).unwrap_err();
        error.to_string()
    };
    let cmyk = encode([8, 8], ColorType::Cmyk, |_| ());
    assert_eq!(refusal(&cmyk), "CMYK in JPEG is not supported");
    let plain = encode([8, 8], ColorType::Rgb, |_| ());
    let frame = plain.windows(2).position(|pair| pair == [0xff, 0xc0]);
    let frame = frame.unwrap();
    for (marker, feature) in [
        (0xc3, "lossless JPEG"),
        (0xc5, "hierarchical JPEG"),
        (0xc9, "JPEG with arithmetic coding"),
        (0xcb, "lossless JPEG"),
        (0xf7, "JPEG-LS"),
    ] {
        let mut bytes = plain.clone();
        bytes[frame + 1] = marker;
        assert_eq!(refusal(&bytes), format!("{feature} is not supported"));
    }
    let mut deep = plain;
    deep[frame + 4] = 12;
    let expected = "JPEG with other than 8 bits per channel is not supported";
    assert_eq!(refusal(&deep), expected);
}

#[test]
fn limits_are_kept_to_the_pixel_and_the_byte() {
    let bytes = encode([20, 10], ColorType::Rgb, |_| ());
    let kind = |pixels, bytes_limit| {
        let limits = Limits {
            pixels,
            bytes: bytes_limit,
        };
        decode_jpeg(&bytes, &limits)
            .map(|_| ())
            .map_err(|error| error.kind().clone())
    };
    assert_eq!(kind(200, 1800), Ok(()), "exactly the limits");
    let size = [20, 10];
    let pixels = ImageErrorKind::TooManyPixels { size, limit: 199 };
    assert_eq!(kind(199, 1800), Err(pixels), "one pixel less");
    let memory = ImageErrorKind::TooManyBytes {
        bytes: 1800,
        limit: 1799,
    };
    assert_eq!(kind(200, 1799), Err(memory), "one byte less");
}

#[test]
fn a_header_that_claims_a_huge_size_is_refused() {
    let mut bytes = encode([8, 8], ColorType::Rgb, |_| ());
    // After the marker of the frame come its length, the bits, and rows and columns.
    let at = bytes
        .windows(2)
        .position(|window| window == [0xff, 0xc0])
        .unwrap()
        + 5;
    bytes[at..at + 4].copy_from_slice(&[0xff; 4]);
    let error = decode_jpeg(&bytes, &Limits::default()).unwrap_err();
    let size = [65_535; 2];
    let limit = Limits::default().pixels;
    let expected = ImageErrorKind::TooManyPixels { size, limit };
    assert_eq!(error.kind(), &expected, "{error}");
}

#[test]
fn bytes_after_the_end_are_skipped() {
    let bytes = encode([8, 8], ColorType::Rgb, |_| ());
    let longer = [bytes.as_slice(), b"more \xff\xd9"].concat();
    let decode = |bytes: &[u8]| decode_jpeg(bytes, &Limits::default()).unwrap();
    assert_eq!(decode(&longer), decode(&bytes), "the same image");
}

#[test]
fn every_truncation_is_refused() {
    for (at, bytes) in files([17, 9]).iter().enumerate() {
        for length in 0..bytes.len() {
            let result = decode_jpeg(&bytes[..length], &Limits::default());
            assert!(
                result.is_err(),
                "file {at}, {length} of {} bytes",
                bytes.len()
            );
        }
    }
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(body in proptest::collection::vec(any::<u8>(), 0..300)) {
        let bytes = [b"\xff\xd8\xff".as_slice(), &body].concat();
        prop_assert!(decode_jpeg(&bytes, &Limits::default()).is_err());
        prop_assert!(decode_jpeg(&body, &Limits::default()).is_err());
    }
}
