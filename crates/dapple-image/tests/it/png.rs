//! Tests of PNG files against a naive encoder that stores the samples without compression, written from the
//! specification alone.

use core::slice;
use dapple_image::{
    ImageErrorKind, Limits, PngImage, PngPixel, PngPixels, Transfer, decode_png, encode_png,
};
use dapple_raster::Raster;
use proptest::prelude::*;

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Returns the CRC-32 checksum of a chunk, computed bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let mut sum = u32::MAX;
    for &byte in bytes {
        sum ^= u32::from(byte);
        for _ in 0..8 {
            sum = (sum >> 1) ^ (0xedb8_8320 * (sum & 1));
        }
    }
    !sum
}

pub(crate) fn chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let named = [name.as_slice(), data].concat();
    let length = u32::try_from(data.len()).unwrap();
    [
        length.to_be_bytes().as_slice(),
        &named,
        &crc(&named).to_be_bytes(),
    ]
    .concat()
}

/// Returns a zlib stream with a single uncompressed block.
pub(crate) fn stored(data: &[u8]) -> Vec<u8> {
    let length = u16::try_from(data.len()).unwrap();
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in data {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    let mut bytes = vec![0x78, 0x01, 1];
    bytes.extend(length.to_le_bytes());
    bytes.extend((!length).to_le_bytes());
    bytes.extend(data);
    bytes.extend((b << 16 | a).to_be_bytes());
    bytes
}

/// Returns a PNG file. `format` is the bit depth, the color type and the interlacing; `extra` are chunks after the
/// header; `lines` are the filter bytes and samples, unchanged.
pub(crate) fn naive_png(
    size: [u32; 2],
    format: [u8; 3],
    extra: &[Vec<u8>],
    lines: &[u8],
) -> Vec<u8> {
    let mut header = size.map(u32::to_be_bytes).concat();
    header.extend([format[0], format[1], 0, 0, format[2]]);
    let mut bytes = SIGNATURE.to_vec();
    bytes.extend(chunk(b"IHDR", &header));
    extra.iter().for_each(|chunk| bytes.extend(chunk));
    bytes.extend(chunk(b"IDAT", &stored(lines)));
    bytes.extend(chunk(b"IEND", &[]));
    bytes
}

fn decode(bytes: &[u8]) -> PngImage {
    decode_png(bytes, &Limits::default()).unwrap()
}

fn kind(bytes: &[u8], limits: &Limits) -> ImageErrorKind {
    decode_png(bytes, limits).unwrap_err().kind().clone()
}

fn check_round_trip<P: PngPixel + PartialEq + core::fmt::Debug>(
    raster: Raster<P>,
    wrap: impl Fn(Raster<P>) -> PngPixels,
) {
    for transfer in [Transfer::Data, Transfer::Srgb] {
        let bytes = encode_png(raster.view(), transfer).unwrap();
        let expected = PngImage {
            pixels: wrap(raster.clone()),
            transfer,
            space: decode(&bytes).space,
        };
        assert_eq!(decode(&bytes), expected, "the round trip");
        assert!(expected.space.is_srgb(), "{}", expected.space);
    }
}

#[test]
fn all_eight_kinds_survive_the_round_trip() {
    fn fill<const N: usize>(x: u32, y: u32) -> [u16; N] {
        core::array::from_fn(|channel| (x * 7919 + y * 104_729 + channel as u32 * 31_337) as u16)
    }
    fn narrow<const N: usize>(x: u32, y: u32) -> [u8; N] {
        fill(x, y).map(|code| code as u8)
    }
    let size = [13, 7];
    let wide = |x, y| fill::<1>(x, y)[0];
    check_round_trip(
        Raster::from_fn(size, |x, y| wide(x, y) as u8).unwrap(),
        PngPixels::Gray8,
    );
    check_round_trip(Raster::from_fn(size, wide).unwrap(), PngPixels::Gray16);
    check_round_trip(
        Raster::from_fn(size, narrow).unwrap(),
        PngPixels::GrayAlpha8,
    );
    check_round_trip(Raster::from_fn(size, fill).unwrap(), PngPixels::GrayAlpha16);
    check_round_trip(Raster::from_fn(size, narrow).unwrap(), PngPixels::Rgb8);
    check_round_trip(Raster::from_fn(size, fill).unwrap(), PngPixels::Rgb16);
    check_round_trip(Raster::from_fn(size, narrow).unwrap(), PngPixels::Rgba8);
    check_round_trip(Raster::from_fn(size, fill).unwrap(), PngPixels::Rgba16);
}

#[test]
fn a_crop_is_written_without_its_surroundings() {
    let raster = Raster::from_fn([9, 9], |x, y| (10 * x + y) as u8).unwrap();
    let view = raster.view().crop([3, 2], [4, 5]).unwrap();
    let bytes = encode_png(view, Transfer::Data).unwrap();
    let crop = raster.crop([3, 2], [4, 5]).unwrap();
    assert_eq!(decode(&bytes).pixels, PngPixels::Gray8(crop), "the crop");
}

#[test]
fn color_is_marked_and_data_is_not() {
    let has = |bytes: &[u8], name: &[u8]| bytes.windows(4).any(|window| window == name);
    let raster = Raster::filled([2, 2], 7_u8).unwrap();
    let color = encode_png(raster.view(), Transfer::Srgb).unwrap();
    let data = encode_png(raster.view(), Transfer::Data).unwrap();
    for name in [b"sRGB", b"gAMA"] {
        assert!(has(&color, name) && !has(&data, name), "{name:?}");
    }
}

#[test]
fn small_gray_depths_are_spread_over_eight_bits() {
    // Five pixels of 1 bit, then three of 2 bits, then two of 4 bits; the rest of each byte is not used.
    let one = naive_png([5, 1], [1, 0, 0], &[], &[0, 0b1011_0111]);
    let two = naive_png([3, 1], [2, 0, 0], &[], &[0, 0b0001_1000]);
    let four = naive_png([2, 1], [4, 0, 0], &[], &[0, 0x1f]);
    let gray = |codes: &[u8]| {
        let size = [codes.len() as u32, 1];
        PngPixels::Gray8(Raster::from_vec(size, codes.to_vec()).unwrap())
    };
    assert_eq!(decode(&one).pixels, gray(&[255, 0, 255, 255, 0]), "1 bit");
    assert_eq!(decode(&two).pixels, gray(&[0, 85, 170]), "2 bits");
    assert_eq!(decode(&four).pixels, gray(&[17, 255]), "4 bits");
}

#[test]
fn palettes_and_transparent_colors_are_resolved() {
    let palette = chunk(b"PLTE", &[1, 2, 3, 40, 50, 60]);
    let plain = naive_png(
        [3, 1],
        [1, 3, 0],
        slice::from_ref(&palette),
        &[0, 0b0100_0000],
    );
    let rgb = vec![[1, 2, 3], [40, 50, 60], [1, 2, 3]];
    let expected = PngPixels::Rgb8(Raster::from_vec([3, 1], rgb).unwrap());
    assert_eq!(decode(&plain).pixels, expected, "a palette");

    let alpha = chunk(b"tRNS", &[9]);
    let clear = naive_png([2, 1], [8, 3, 0], &[palette, alpha], &[0, 1, 0]);
    let rgba = vec![[40, 50, 60, 255], [1, 2, 3, 9]];
    let expected = PngPixels::Rgba8(Raster::from_vec([2, 1], rgba).unwrap());
    assert_eq!(decode(&clear).pixels, expected, "a palette with alpha");

    let transparent_seven = [chunk(b"tRNS", &[0, 7])];
    let gray = naive_png([2, 1], [8, 0, 0], &transparent_seven, &[0, 7, 8]);
    let expected = PngPixels::GrayAlpha8(Raster::from_vec([2, 1], vec![[7, 0], [8, 255]]).unwrap());
    assert_eq!(decode(&gray).pixels, expected, "a transparent gray");
}

#[test]
fn interlaced_files_give_the_same_pixels() {
    // The seven passes of Adam7: first column and row, and the steps between them.
    const PASSES: [[u32; 4]; 7] = [
        [0, 0, 8, 8],
        [4, 0, 8, 8],
        [0, 4, 4, 8],
        [2, 0, 4, 4],
        [0, 2, 2, 4],
        [1, 0, 2, 2],
        [0, 1, 1, 2],
    ];
    for size in [[1, 1], [5, 3], [13, 11]] {
        let raster = Raster::from_fn(size, |x, y| (x * 16 + y) as u8).unwrap();
        let mut lines = Vec::new();
        for [x, y, dx, dy] in PASSES {
            for row in (y..size[1]).step_by(dy as usize).filter(|_| x < size[0]) {
                lines.push(0);
                let columns = (x..size[0]).step_by(dx as usize);
                lines.extend(columns.map(|column| raster.row(row)[column as usize]));
            }
        }
        let bytes = naive_png(size, [8, 0, 1], &[], &lines);
        assert_eq!(decode(&bytes).pixels, PngPixels::Gray8(raster), "{size:?}");
    }
}

#[test]
fn empty_and_huge_sizes_are_refused() {
    let limits = Limits::default();
    for size in [[0, 4], [4, 0], [0, 0]] {
        let refused = kind(&naive_png(size, [8, 0, 0], &[], &[0]), &limits);
        let size = size.map(u64::from);
        assert_eq!(refused, ImageErrorKind::Empty { size }, "{size:?}");
    }
    let side = i32::MAX as u32;
    let bomb = naive_png([side, side], [16, 6, 0], &[], &[0]);
    let refused = kind(&bomb, &limits);
    assert!(
        matches!(refused, ImageErrorKind::TooManyPixels { limit, .. } if limit == limits.pixels),
        "{refused:?}"
    );
}

#[test]
fn limits_are_kept_to_the_pixel_and_the_byte() {
    let raster = Raster::filled([20, 10], [1_u16, 2, 3]).unwrap();
    let bytes = encode_png(raster.view(), Transfer::Data).unwrap();
    let pixels = |pixels| Limits {
        pixels,
        ..Limits::default()
    };
    assert!(
        decode_png(&bytes, &pixels(200)).is_ok(),
        "exactly the limit"
    );
    let refused = kind(&bytes, &pixels(199));
    let size = [20, 10];
    assert_eq!(
        refused,
        ImageErrorKind::TooManyPixels { size, limit: 199 },
        "one less"
    );

    let tight = Limits {
        bytes: 1199,
        ..Limits::default()
    };
    let refused = kind(&bytes, &tight);
    assert!(
        matches!(refused, ImageErrorKind::TooManyBytes { limit: 1199, .. }),
        "{refused:?}"
    );
}

#[test]
fn palettes_that_end_within_a_color_are_refused() {
    for length in 1..=12 {
        let palette = chunk(b"PLTE", &vec![7; length]);
        for depth in [1, 2, 4, 8] {
            let bytes = naive_png([1, 1], [depth, 3, 0], slice::from_ref(&palette), &[0, 0]);
            let result = decode_png(&bytes, &Limits::default());
            let whole = length % 3 == 0;
            assert_eq!(result.is_ok(), whole, "{length} bytes, depth {depth}");
        }
    }
}

#[test]
fn every_truncation_is_refused() {
    let raster = Raster::from_fn([6, 5], |x, y| [(x * 40) as u8, (y * 50) as u8, 3]).unwrap();
    let bytes = encode_png(raster.view(), Transfer::Srgb).unwrap();
    for length in 0..bytes.len() {
        let result = decode_png(&bytes[..length], &Limits::default());
        assert!(result.is_err(), "{length} of {} bytes", bytes.len());
    }
}

#[test]
fn every_flipped_bit_gives_an_image_or_an_error() {
    let raster = Raster::from_fn([6, 5], |x, y| [(x * 40) as u8, (y * 50) as u8, 3]).unwrap();
    let bytes = encode_png(raster.view(), Transfer::Srgb).unwrap();
    let mut refused = 0;
    for bit in 0..8 * bytes.len() {
        let mut damaged = bytes.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        refused += usize::from(decode_png(&damaged, &Limits::default()).is_err());
    }
    // Nearly all bytes are under a checksum.
    assert!(
        refused > 4 * bytes.len(),
        "{refused} of {} refused",
        8 * bytes.len()
    );
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(body in proptest::collection::vec(any::<u8>(), 0..200)) {
        let bytes = [SIGNATURE, &body].concat();
        prop_assert!(decode_png(&bytes, &Limits::default()).is_err());
        let refused = decode_png(&body, &Limits::default());
        prop_assert!(refused.is_err());
    }

    #[test]
    fn headers_and_lines_of_any_kind_do_no_harm(
        size in [0_u32..70, 0..70],
        format in (prop::sample::select(vec![1_u8, 2, 4, 8, 16, 3]), 0_u8..8, 0_u8..3),
        lines in proptest::collection::vec(any::<u8>(), 0..900),
        palette in proptest::collection::vec(any::<u8>(), 0..40),
    ) {
        let palette = chunk(b"PLTE", &palette);
        let bytes = naive_png(size, [format.0, format.1, format.2], &[palette], &lines);
        if let Ok(image) = decode_png(&bytes, &Limits::default()) {
            prop_assert_eq!(image.pixels.size(), size);
        }
    }
}
