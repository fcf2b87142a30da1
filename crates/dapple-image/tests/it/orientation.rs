//! Tests of photographs that were stored rotated or mirrored.

use dapple_image::{Limits, PngPixels, decode_jpeg};
use dapple_raster::Raster;
use jpeg_encoder::{ColorType, Encoder};

/// Side of a JPEG block, in pixels.
const BLOCK: u32 = 8;

/// Stored size and pixels of the same upright image of 3 × 2 pixels, for each of the eight orientations. The
/// specification defines where the first row and first column of the file are in the image.
const STORED: [([u32; 2], &[u8]); 8] = [
    ([3, 2], b"abcdef"),
    ([3, 2], b"cbafed"),
    ([3, 2], b"fedcba"),
    ([3, 2], b"defabc"),
    ([2, 3], b"adbecf"),
    ([2, 3], b"cfbead"),
    ([2, 3], b"fcebda"),
    ([2, 3], b"daebfc"),
];

/// Decodes the test image, stored with orientation `number` and the Exif data `tiff`. Each pixel is a gray block, which
/// the best JPEG quality preserves exactly.
fn read(number: usize, tiff: &[u8]) -> Raster<u8> {
    let ([width, height], stored) = STORED[number - 1];
    let samples: Vec<u8> = (0..BLOCK * height)
        .flat_map(|y| {
            (0..BLOCK * width).map(move |x| stored[(y / BLOCK * width + x / BLOCK) as usize])
        })
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 100);
    encoder
        .add_app_segment(1, [b"Exif\0\0", tiff].concat())
        .unwrap();
    let [width, height] = [width, height].map(|side| (BLOCK * side) as u16);
    encoder
        .encode(&samples, width, height, ColorType::Luma)
        .unwrap();
    let PngPixels::Gray8(codes) = decode_jpeg(&bytes, &Limits::default()).unwrap().pixels else {
        panic!("the file is not gray");
    };
    let blocks = codes.size().map(|side| side / BLOCK);
    Raster::from_fn(blocks, |x, y| codes.row(BLOCK * y)[(BLOCK * x) as usize]).unwrap()
}

/// Returns the upright image that is stored in all orientations.
fn upright() -> Raster<u8> {
    Raster::from_vec([3, 2], b"abcdef".to_vec()).unwrap()
}

#[test]
fn all_eight_orientations_become_upright() {
    for number in 1..=8 {
        let start = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0";
        let tiff = [start.as_slice(), &[number, 0, 0]].concat();
        let picture = read(number.into(), &tiff);
        assert_eq!(picture, upright(), "orientation {number}");
    }
}

#[test]
fn both_orders_of_bytes_are_read() {
    let little =
        b"II*\0\x08\0\0\0\x02\0\x0f\x01\x02\0\x01\0\0\0\0\0\0\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0";
    let big = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x08\0\0";
    assert_eq!(read(6, little), upright(), "II");
    assert_eq!(read(8, big), upright(), "MM");
    for length in 0..little.len() - 2 {
        assert_eq!(read(1, &little[..length]), upright(), "{length} bytes");
    }
}

#[test]
fn odd_numbers_and_places_mean_the_usual_orientation() {
    let nine = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x09\0\0";
    let far = b"II*\0\xff\xff\xff\xff";
    for exif in [nine.as_slice(), far, b"", b"XX"] {
        assert_eq!(read(1, exif), upright(), "{exif:?}");
    }
}
