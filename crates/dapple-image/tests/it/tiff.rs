//! Tests of TIFF files: those that the codec's encoder writes, and small files written byte by byte.

use dapple_image::{
    Format, Image, ImageErrorKind, Limits, PngPixels, decode_image, read_header, replace,
};
use dapple_raster::Raster;
use proptest::prelude::*;
use std::io::Cursor;
use tiff::encoder::colortype::{self, ColorType};
use tiff::encoder::{Compression, DeflateLevel, Predictor, TiffEncoder, TiffValue};

/// Data types of entries.
const BYTE: u16 = 1;
const SHORT: u16 = 3;
const LONG: u16 = 4;

/// Offset of the pixels in a file by [`file`].
const PIXELS: u32 = 8;

/// An entry of a directory: tag, type and values.
type Entry = (u16, u16, Vec<u32>);

/// Returns the entries of an image in one strip, with the channels of each pixel side by side.
fn page([width, height]: [u32; 2], photometric: u32, bits: &[u32]) -> Vec<Entry> {
    let n_bytes = width * height * bits.iter().sum::<u32>() / 8;
    vec![
        (256, LONG, vec![width]),
        (257, LONG, vec![height]),
        (258, SHORT, bits.to_vec()),
        (259, SHORT, vec![1]),
        (262, SHORT, vec![photometric]),
        (273, LONG, vec![PIXELS]),
        (277, SHORT, vec![bits.len() as u32]),
        (278, LONG, vec![height]),
        (279, LONG, vec![n_bytes]),
    ]
}

/// Replaces or adds an entry.
fn with(mut page: Vec<Entry>, entry: Entry) -> Vec<Entry> {
    page.retain(|(tag, ..)| *tag != entry.0);
    page.push(entry);
    page.sort_by_key(|(tag, ..)| *tag);
    page
}

/// Returns the bytes of a file with these pages, whose pixels begin at byte 8.
fn file(is_big: bool, pages: &[Vec<Entry>], pixels: &[u8]) -> Vec<u8> {
    let short = |n: u32| match is_big {
        true => (n as u16).to_be_bytes(),
        false => (n as u16).to_le_bytes(),
    };
    let long = |n: u32| {
        if is_big {
            n.to_be_bytes()
        } else {
            n.to_le_bytes()
        }
    };
    let mut bytes = if is_big { b"MM\0*" } else { b"II*\0" }.to_vec();
    let mut next = PIXELS + pixels.len() as u32;
    bytes.extend(long(next));
    bytes.extend(pixels);
    for (at, page) in pages.iter().enumerate() {
        let end = next + 6 + 12 * page.len() as u32;
        let mut values = Vec::new();
        bytes.extend(short(page.len() as u32));
        for (tag, kind, numbers) in page {
            let number = |&n: &u32| match *kind {
                BYTE => vec![n as u8],
                SHORT => short(n).to_vec(),
                _ => long(n).to_vec(),
            };
            let mut value: Vec<u8> = numbers.iter().flat_map(number).collect();
            bytes.extend([short((*tag).into()), short((*kind).into())].concat());
            bytes.extend(long(numbers.len() as u32));
            if value.len() > 4 {
                bytes.extend(long(end + values.len() as u32));
                values.extend(value);
            } else {
                value.resize(4, 0);
                bytes.extend(value);
            }
        }
        next = end + values.len() as u32;
        bytes.extend(long(if at + 1 < pages.len() { next } else { 0 }));
        bytes.extend(values);
    }
    bytes
}

fn read(bytes: &[u8]) -> Image {
    let image = decode_image(bytes, &Limits::default()).unwrap();
    assert_eq!(image.format(), "TIFF", "format");
    image
}

fn codes(bytes: &[u8]) -> PngPixels {
    match read(bytes) {
        Image::Codes(Format::Tiff, image) => image.pixels,
        other => panic!("{other:?}"),
    }
}

fn refusal(bytes: &[u8]) -> String {
    decode_image(bytes, &Limits::default())
        .unwrap_err()
        .to_string()
}

/// Encodes an image of 7 × 5 pixels.
fn encode<C: ColorType>(
    samples: &[C::Inner],
    compression: Compression,
    predictor: Predictor,
) -> Vec<u8>
where
    [C::Inner]: TiffValue,
{
    let mut sink = Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut sink).unwrap();
    let mut encoder = encoder
        .with_compression(compression)
        .with_predictor(predictor);
    encoder.write_image::<C>(7, 5, samples).unwrap();
    sink.into_inner()
}

/// Returns different numbers for the samples of an image of 7 × 5 pixels.
fn samples<const N: usize>() -> Vec<[u16; N]> {
    let pixel = |at: usize| core::array::from_fn(|channel| (at * 1871 + channel * 9973) as u16);
    (0..35).map(pixel).collect()
}

fn raster<T>(pixels: Vec<T>) -> Raster<T> {
    Raster::from_vec([7, 5], pixels).unwrap()
}

#[test]
fn codes_are_read_with_every_compression() {
    let compressions = [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Deflate(DeflateLevel::Best),
        Compression::Packbits,
    ];
    for (at, compression) in compressions.into_iter().enumerate() {
        for predictor in [Predictor::None, Predictor::Horizontal] {
            let deep = samples::<1>();
            let bytes = encode::<colortype::Gray16>(deep.as_flattened(), compression, predictor);
            let expected = PngPixels::Gray16(raster(deep.as_flattened().to_vec()));
            assert_eq!(codes(&bytes), expected, "compression {at}, {predictor:?}");
            let deep = samples::<4>();
            let bytes = encode::<colortype::RGBA16>(deep.as_flattened(), compression, predictor);
            let expected = PngPixels::Rgba16(raster(deep));
            assert_eq!(codes(&bytes), expected, "compression {at}, {predictor:?}");
            let eight: Vec<_> = samples::<3>()
                .iter()
                .map(|of| of.map(|code| code as u8))
                .collect();
            let bytes = encode::<colortype::RGB8>(eight.as_flattened(), compression, predictor);
            let expected = PngPixels::Rgb8(raster(eight));
            assert_eq!(codes(&bytes), expected, "compression {at}, {predictor:?}");
        }
    }
}

#[test]
fn floating_point_numbers_are_linear_planes() {
    let numbers: Vec<f32> = (0..105).map(|at| at as f32 * 1.7 - 20.0).collect();
    let bytes = encode::<colortype::RGB32Float>(&numbers, Compression::Lzw, Predictor::None);
    let image = read(&bytes);
    assert!(matches!(image, Image::Planes(Format::Tiff, _)), "{image:?}");
    let colors = image.color().unwrap();
    let found: Vec<f32> = colors
        .pixels()
        .iter()
        .flat_map(|color| color.to_array())
        .collect();
    assert_eq!(found, numbers, "linear light, below 0 and above 1, too");
    let numbers = [f32::NAN, f32::INFINITY, -0.0].repeat(12)[..35].to_vec();
    let bytes =
        encode::<colortype::Gray32Float>(&numbers, Compression::Uncompressed, Predictor::None);
    let heights = read(&bytes).gray().unwrap();
    let bits = |numbers: &[f32]| -> Vec<u32> { numbers.iter().map(|of| of.to_bits()).collect() };
    assert_eq!(bits(heights.pixels()), bits(&numbers), "every bit");
}

#[test]
fn half_and_double_precision_are_read() {
    // 1, -2 and 65504 in half precision.
    let half = [[0x00, 0x3c], [0x00, 0xc0], [0xff, 0x7b]].concat();
    let page_of = |bits| with(page([3, 1], 1, &[bits]), (339, SHORT, vec![3]));
    let heights = read(&file(false, &[page_of(16)], &half)).gray().unwrap();
    assert_eq!(heights.pixels(), [1.0, -2.0, 65504.0]);
    let double = [0.1_f64, -3.5, 1e300].map(f64::to_be_bytes).concat();
    let heights = read(&file(true, &[page_of(64)], &double)).gray().unwrap();
    assert_eq!(heights.pixels(), [0.1, -3.5, f32::INFINITY]);
}

#[test]
fn both_byte_orders_and_separate_planes_are_read() {
    let expected =
        PngPixels::Rgb16(Raster::from_vec([2, 1], vec![[1, 2, 3], [256, 257, 258]]).unwrap());
    let interleaved = [1_u16, 2, 3, 256, 257, 258];
    let rgb = page([2, 1], 2, &[16; 3]);
    let little = file(
        false,
        std::slice::from_ref(&rgb),
        &interleaved.map(u16::to_le_bytes).concat(),
    );
    assert_eq!(codes(&little), expected, "the low byte first");
    let big = file(
        true,
        std::slice::from_ref(&rgb),
        &interleaved.map(u16::to_be_bytes).concat(),
    );
    assert_eq!(codes(&big), expected, "the high byte first");
    let planes = with(rgb, (284, SHORT, vec![2]));
    let planes = with(planes, (273, LONG, vec![PIXELS, PIXELS + 4, PIXELS + 8]));
    let planes = with(planes, (279, LONG, vec![4; 3]));
    let separate = [1_u16, 256, 2, 257, 3, 258].map(u16::to_le_bytes).concat();
    assert_eq!(
        codes(&file(false, &[planes], &separate)),
        expected,
        "separate planes"
    );
}

#[test]
fn tiles_are_read_without_their_padding() {
    let tiles = with(page([3, 2], 1, &[8]), (322, LONG, vec![16]));
    let tiles = with(tiles, (323, LONG, vec![16]));
    let tiles = with(tiles, (324, LONG, vec![PIXELS]));
    let mut tiles = with(tiles, (325, LONG, vec![256]));
    tiles.retain(|(tag, ..)| ![273, 278, 279].contains(tag));
    let mut pixels = vec![99; 256];
    pixels[..3].copy_from_slice(b"abc");
    pixels[16..19].copy_from_slice(b"def");
    let expected = PngPixels::Gray8(Raster::from_vec([3, 2], b"abcdef".to_vec()).unwrap());
    assert_eq!(codes(&file(false, &[tiles], &pixels)), expected);
}

#[test]
fn alpha_becomes_straight_in_codes_and_associated_in_planes() {
    let alpha = |page, kind| with(page, (338, SHORT, vec![kind]));
    let rgba = page([2, 1], 2, &[8; 4]);
    let stored = [[100, 50, 0, 200], [7, 9, 11, 0]].concat();
    let pixels =
        |first| PngPixels::Rgba8(Raster::from_vec([2, 1], vec![first, [7, 9, 11, 0]]).unwrap());
    let straight = file(false, &[alpha(rgba.clone(), 2)], &stored);
    assert_eq!(codes(&straight), pixels([100, 50, 0, 200]), "straight");
    // 100 · 255 / 200 is 127.5, and 50 · 255 / 200 is 63.75. Where alpha is 0, there is nothing to divide by.
    let associated = file(false, &[alpha(rgba, 1)], &stored);
    assert_eq!(codes(&associated), pixels([128, 64, 0, 200]), "associated");
    let gray = alpha(page([1, 1], 1, &[8, 8]), 2);
    let expected = PngPixels::GrayAlpha8(Raster::filled([1, 1], [3, 4]).unwrap());
    assert_eq!(codes(&file(false, &[gray], &[3, 4])), expected, "gray");
    let float = with(page([1, 1], 2, &[32; 4]), (339, SHORT, vec![3; 4]));
    let numbers = [0.5_f32, 1.0, 2.0, 0.25].map(f32::to_le_bytes).concat();
    for (kind, red) in [(1, 2.0), (2, 0.5)] {
        let image = read(&file(false, &[alpha(float.clone(), kind)], &numbers));
        let pixel = image.color_alpha().unwrap().pixels()[0];
        assert_eq!((pixel.color.r, pixel.alpha), (red, 0.25), "kind {kind}");
    }
}

#[test]
fn white_may_be_zero() {
    let expected = PngPixels::Gray8(Raster::from_vec([2, 1], vec![255, 245]).unwrap());
    assert_eq!(
        codes(&file(false, &[page([2, 1], 0, &[8])], &[0, 10])),
        expected
    );
}

#[test]
fn the_orientation_makes_the_image_upright() {
    let stored = [
        ([3, 2], b"abcdef"),
        ([3, 2], b"fedcba"),
        ([2, 3], b"daebfc"),
    ];
    let expected = PngPixels::Gray8(Raster::from_vec([3, 2], b"abcdef".to_vec()).unwrap());
    for (orientation, (size, pixels)) in [1, 3, 8].into_iter().zip(stored) {
        let page = with(page(size, 1, &[8]), (274, SHORT, vec![orientation]));
        assert_eq!(
            codes(&file(false, &[page], pixels)),
            expected,
            "{orientation}"
        );
    }
}

#[test]
fn what_is_not_read_is_named() {
    let gray = page([2, 1], 1, &[8]);
    let is_reduced = (254, LONG, vec![1]);
    let thumbnail = with(page([1, 1], 1, &[8]), is_reduced);
    let reduced = file(false, &[gray.clone(), thumbnail], &[1, 2]);
    assert_eq!(read(&reduced).size(), [2, 1], "a thumbnail is skipped");
    let pages = file(false, &[gray.clone(), gray.clone()], &[1, 2]);
    assert_eq!(
        refusal(&pages),
        "a TIFF file of several pages is not supported"
    );
    let cmyk = file(false, &[page([1, 1], 5, &[8; 4])], &[0; 4]);
    assert_eq!(refusal(&cmyk), "CMYK in TIFF is not supported");
    let bands = file(false, &[page([1, 1], 1, &[8; 3])], &[0; 3]);
    let expected = "a TIFF image that is neither gray nor RGB is not supported";
    assert_eq!(refusal(&bands), expected);
    let expected = "TIFF without 8 or 16 bits or floating-point numbers is not supported";
    let wide = file(false, &[page([1, 1], 1, &[32])], &[0; 4]);
    assert_eq!(refusal(&wide), expected);
    let narrow = file(false, &[page([8, 1], 1, &[1])], &[0]);
    assert_eq!(refusal(&narrow), expected);
    let signed = with(gray.clone(), (339, SHORT, vec![2]));
    assert_eq!(refusal(&file(false, &[signed], &[0; 2])), expected);
    for (page, name) in [
        (with(gray.clone(), (262, SHORT, vec![3])), "a palette"),
        (with(gray, (259, SHORT, vec![7])), "JPEG compression"),
    ] {
        let message = refusal(&file(false, &[page], &[0; 2]));
        let expected = "this kind of TIFF image is not supported: ";
        assert!(message.starts_with(expected), "{name}: {message}");
    }
}

#[test]
fn a_header_claims_a_size_before_pixels_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let huge = with(page([1, 1], 1, &[16]), (256, LONG, vec![40_000]));
    let huge = with(huge, (257, LONG, vec![30_000]));
    let huge = with(huge, (278, LONG, vec![30_000]));
    replace(&path, &file(false, &[huge], &[0; 2])).unwrap();
    let header = read_header(&path).unwrap();
    assert_eq!((header.format, header.size), ("TIFF", [40_000, 30_000]));
    let error = decode_image(
        &file(false, &[page([20, 10], 1, &[8])], &[0; 200]),
        &Limits {
            pixels: 199,
            ..Limits::default()
        },
    );
    let size = [20, 10];
    let expected = ImageErrorKind::TooManyPixels { size, limit: 199 };
    assert_eq!(error.unwrap_err().kind(), &expected);
    let limits = Limits {
        pixels: 200,
        bytes: 599,
    };
    let error = decode_image(&file(false, &[page([20, 10], 1, &[8])], &[0; 200]), &limits);
    let expected = ImageErrorKind::TooManyBytes {
        bytes: 600,
        limit: 599,
    };
    assert_eq!(error.unwrap_err().kind(), &expected);
}

#[test]
fn every_truncation_is_refused() {
    let deep = samples::<3>();
    for compression in [Compression::Uncompressed, Compression::Lzw] {
        let bytes = encode::<colortype::RGB16>(deep.as_flattened(), compression, Predictor::None);
        for length in 0..bytes.len() {
            let result = decode_image(&bytes[..length], &Limits::default());
            assert!(result.is_err(), "{length} of {} bytes", bytes.len());
        }
    }
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(body in proptest::collection::vec(any::<u8>(), 0..300)) {
        let bytes = [b"II*\0\x08\0\0\0".as_slice(), &body].concat();
        prop_assert!(decode_image(&bytes, &Limits::default()).is_err());
    }
}
