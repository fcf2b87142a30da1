//! Tests of WebP files: lossless ones that the codec's encoder writes, and lossy ones by libwebp 1.6.

use dapple_image::{Format, Image, ImageErrorKind, Limits, PngPixels, decode_image};
use dapple_raster::Raster;
use image_webp::{ColorType, WebPEncoder};
use proptest::prelude::*;

/// A lossy image of 6 × 5 pixels.
const LOSSY: [u8; 82] = [
    0x52, 0x49, 0x46, 0x46, 0x4a, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x20,
    0x3e, 0x00, 0x00, 0x00, 0x10, 0x02, 0x00, 0x9d, 0x01, 0x2a, 0x06, 0x00, 0x05, 0x00, 0x02, 0x80,
    0x42, 0x25, 0xb0, 0x02, 0x74, 0xba, 0x00, 0x03, 0x08, 0x41, 0x0a, 0x50, 0x00, 0x00, 0xfe, 0xea,
    0x3a, 0x6b, 0xb2, 0xc7, 0x15, 0x88, 0xcf, 0xbd, 0xa6, 0x0e, 0x57, 0xe6, 0xf7, 0x67, 0x00, 0x23,
    0x5b, 0x52, 0xbf, 0xfb, 0x58, 0xb4, 0x3b, 0xb4, 0x63, 0xe1, 0xce, 0x1d, 0xb7, 0xc6, 0xfd, 0xf0,
    0x00, 0x00,
];

/// A lossy image of 5 × 3 pixels with alpha, which is not compressed.
const LOSSY_ALPHA: [u8; 106] = [
    0x52, 0x49, 0x46, 0x46, 0x62, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x58,
    0x0a, 0x00, 0x00, 0x00, 0x10, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x02, 0x00, 0x00, 0x41, 0x4c,
    0x50, 0x48, 0x10, 0x00, 0x00, 0x00, 0x00, 0x14, 0x46, 0x78, 0xaa, 0xdc, 0x14, 0x46, 0x78, 0xaa,
    0xdc, 0x14, 0x46, 0x78, 0xaa, 0xdc, 0x56, 0x50, 0x38, 0x20, 0x2c, 0x00, 0x00, 0x00, 0xb0, 0x01,
    0x00, 0x9d, 0x01, 0x2a, 0x05, 0x00, 0x03, 0x00, 0x02, 0xc0, 0x4c, 0x25, 0xa0, 0x02, 0x74, 0xba,
    0x00, 0x00, 0x00, 0x00, 0x00, 0xec, 0x8f, 0xc2, 0xb1, 0x4f, 0xf1, 0x6d, 0x23, 0xa1, 0x4c, 0x87,
    0xff, 0x04, 0x17, 0x14, 0xfc, 0x53, 0xd4, 0x00, 0x00, 0x00,
];

/// Encodes an image without loss. `set` configures the encoder.
fn encode(
    samples: &[u8],
    size: [u32; 2],
    kind: ColorType,
    set: impl FnOnce(&mut WebPEncoder<&mut Vec<u8>>),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = WebPEncoder::new(&mut bytes);
    set(&mut encoder);
    encoder.encode(samples, size[0], size[1], kind).unwrap();
    bytes
}

fn codes(bytes: &[u8]) -> PngPixels {
    match decode_image(bytes, &Limits::default()).unwrap() {
        Image::Codes(Format::WebP, image) => image.pixels,
        other => panic!("{other:?}"),
    }
}

#[test]
fn lossless_images_keep_every_code() {
    let size = [9, 4];
    let rgba: Vec<[u8; 4]> = (0..36_u8)
        .map(|at| [at * 7, 255 - at, at ^ 85, at * 5])
        .collect();
    let bytes = encode(rgba.as_flattened(), size, ColorType::Rgba8, |_| ());
    let expected = PngPixels::Rgba8(Raster::from_vec(size, rgba.clone()).unwrap());
    assert_eq!(codes(&bytes), expected, "with alpha");
    let rgb: Vec<[u8; 3]> = rgba.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    let bytes = encode(rgb.as_flattened(), size, ColorType::Rgb8, |_| ());
    let expected = PngPixels::Rgb8(Raster::from_vec(size, rgb).unwrap());
    assert_eq!(codes(&bytes), expected, "without alpha");
}

#[test]
fn value_stability_lossy() {
    // Codes that libwebp decodes.
    let PngPixels::Rgb8(found) = codes(&LOSSY) else {
        panic!("no RGB");
    };
    let at = |raster: &Raster<[u8; 3]>, [x, y]: [u32; 2]| raster.row(y)[x as usize];
    let found = [[0, 0], [5, 0], [2, 3], [5, 4]].map(|place| at(&found, place));
    let expected = [
        [19, 11, 118],
        [182, 12, 104],
        [95, 149, 128],
        [199, 200, 134],
    ];
    assert_eq!(found, expected, "four pixels");
    let PngPixels::Rgba8(found) = codes(&LOSSY_ALPHA) else {
        panic!("no alpha");
    };
    let found = [[0, 0], [4, 0], [2, 2]].map(|[x, y]: [u32; 2]| found.row(y)[x as usize]);
    let expected = [[198, 104, 51, 20], [198, 102, 50, 220], [198, 104, 51, 120]];
    assert_eq!(found, expected, "three pixels");
}

#[test]
fn an_exif_orientation_turns_the_image() {
    let exif = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x03\0\0\0\0\0\0";
    let bytes = encode(&[1, 2, 3, 4, 5, 6], [2, 1], ColorType::Rgb8, |encoder| {
        encoder.set_exif_metadata(exif.to_vec());
    });
    let expected = PngPixels::Rgb8(Raster::from_vec([2, 1], vec![[4, 5, 6], [1, 2, 3]]).unwrap());
    assert_eq!(codes(&bytes), expected, "half a turn");
}

#[test]
fn an_animation_is_refused() {
    let frame = encode(&[0; 12], [2, 2], ColorType::Rgb8, |_| ());
    let chunk = |name: &[u8], content: &[u8]| {
        [name, &(content.len() as u32).to_le_bytes(), content].concat()
    };
    let chunks = [
        chunk(b"VP8X", &[2, 0, 0, 0, 1, 0, 0, 1, 0, 0]),
        chunk(b"ANIM", &[0; 6]),
        chunk(
            b"ANMF",
            &[
                &[0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 9, 0, 0, 0],
                &frame[12..],
            ]
            .concat(),
        ),
    ];
    let animation = chunk(b"RIFF", &[b"WEBP".as_slice(), &chunks.concat()].concat());
    let error = decode_image(&animation, &Limits::default()).unwrap_err();
    assert_eq!(error.to_string(), "an animated WebP image is not supported");
}

#[test]
fn limits_are_kept_to_the_pixel_and_the_byte() {
    let kind = |pixels, bytes| {
        let image = decode_image(&LOSSY, &Limits { pixels, bytes });
        image.map(|_| ()).map_err(|error| error.kind().clone())
    };
    assert_eq!(kind(30, 480), Ok(()), "exactly the limits");
    let size = [6, 5];
    let expected = ImageErrorKind::TooManyPixels { size, limit: 29 };
    assert_eq!(kind(29, 480), Err(expected), "one pixel less");
    let expected = ImageErrorKind::TooManyBytes {
        bytes: 480,
        limit: 479,
    };
    assert_eq!(kind(30, 479), Err(expected), "one byte less");
}

#[test]
fn a_frame_of_another_size_is_refused() {
    let mut bytes = LOSSY_ALPHA;
    let frame = bytes.windows(4).position(|name| name == b"VP8 ").unwrap();
    bytes[frame + 14..frame + 18].copy_from_slice(&[0xff, 0x3f, 0xff, 0x3f]);
    let error = decode_image(&bytes, &Limits::default()).unwrap_err();
    let expected = "the WebP data is damaged: the frame is not of the size of the image";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn every_truncation_is_refused() {
    for bytes in [LOSSY.as_slice(), &LOSSY_ALPHA] {
        for length in 0..bytes.len() {
            let result = decode_image(&bytes[..length], &Limits::default());
            assert!(result.is_err(), "{length} of {} bytes", bytes.len());
        }
    }
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(body in proptest::collection::vec(any::<u8>(), 0..300)) {
        let bytes = [b"RIFF\x20\0\0\0WEBPVP8L".as_slice(), &body].concat();
        let _ = decode_image(&bytes, &Limits { pixels: 1 << 16, bytes: 1 << 22 });
    }
}
