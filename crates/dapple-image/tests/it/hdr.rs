//! Tests of Radiance HDR files, written byte by byte.

use dapple_image::{Format, Image, ImageErrorKind, Limits, decode_image};
use proptest::prelude::*;

const START: &str = "#?RADIANCE\n# A comment\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2.0\n\n";

/// Pixels of mantissas and exponents, and their colors.
const PIXELS: [([u8; 4], [f32; 3]); 4] = [
    ([128, 64, 0, 129], [1.0, 0.5, 0.0]),
    ([200, 100, 50, 136], [200.0, 100.0, 50.0]),
    ([9, 9, 9, 0], [0.0; 3]),
    ([255, 1, 0, 1], [255.0 * TINY, TINY, 0.0]),
];

/// 2^-135, which only subnormal numbers of `f32` represent.
const TINY: f32 = f32::from_bits(1 << 14);

fn decode(bytes: &[u8]) -> Image {
    decode_image(bytes, &Limits::default()).unwrap()
}

fn colors(bytes: &[u8]) -> Vec<[f32; 3]> {
    let image = decode(bytes);
    assert!(matches!(image, Image::Planes(Format::Hdr, _)), "{image:?}");
    let colors = image.color().unwrap();
    colors
        .pixels()
        .iter()
        .map(|color| color.to_array())
        .collect()
}

fn refusal(bytes: &[u8]) -> String {
    let error = decode_image(bytes, &Limits::default()).unwrap_err();
    error.to_string()
}

fn file(start: &str, resolution: &str, pixels: &[u8]) -> Vec<u8> {
    [start.as_bytes(), resolution.as_bytes(), b"\n", pixels].concat()
}

#[test]
fn mantissas_are_scaled_by_their_exponent() {
    let bytes = file(START, "-Y 2 +X 2", &PIXELS.map(|(pixel, _)| pixel).concat());
    assert_eq!(
        colors(&bytes),
        PIXELS.map(|(_, color)| color),
        "exact numbers"
    );
    let image = decode(&bytes);
    assert_eq!(
        (image.format(), image.size(), image.bits()),
        ("Radiance HDR", [2, 2], 32)
    );
    let largest = file("#?RGBE\n\n", "-Y 1 +X 1", &[255; 4]);
    assert_eq!(
        colors(&largest),
        [[f32::from_bits(0xfd << 23 | 0x7f << 16); 3]],
        "255 · 2^119"
    );
}

#[test]
fn scan_lines_are_read_by_channel() {
    // Ten pixels: red is a run of ten 8, green counts, blue is two runs, and the exponent is 136 throughout.
    let green: Vec<u8> = (1..=10).collect();
    let line = [
        &[2, 2, 0, 10][..],
        &[138, 8],
        &[10],
        &green,
        &[132, 5, 134, 7],
        &[138, 136],
    ]
    .concat();
    let found = colors(&file(START, "-Y 2 +X 10", &line.repeat(2)));
    for (at, found) in found.into_iter().enumerate() {
        let column = at % 10;
        let blue = if column < 4 { 5.0 } else { 7.0 };
        assert_eq!(found, [8.0, column as f32 + 1.0, blue], "pixel {at}");
    }
}

#[test]
fn repetitions_of_older_files_are_digits_of_one_count() {
    // A pixel that is repeated 2 + 1 · 256 times.
    let pixels = [[10, 20, 30, 136], [1, 1, 1, 2], [1, 1, 1, 1]].concat();
    let found = colors(&file(START, "-Y 1 +X 259", &pixels));
    assert_eq!(found, [[10.0, 20.0, 30.0]; 259]);
}

#[test]
fn all_orders_of_rows_and_columns_are_read() {
    // The stored pixels of an image of 3 × 2 pixels, numbered row by row.
    for (resolution, stored) in [
        ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
        ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
        ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
        ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
        ("+X 3 -Y 2", [1, 4, 2, 5, 3, 6]),
        ("-X 3 -Y 2", [3, 6, 2, 5, 1, 4]),
        ("-X 3 +Y 2", [6, 3, 5, 2, 4, 1]),
        ("+X 3 +Y 2", [4, 1, 5, 2, 6, 3]),
    ] {
        let pixels = stored.map(|number| [number, 0, 0, 136]).concat();
        let image = decode(&file(START, resolution, &pixels)).color().unwrap();
        assert_eq!(image.size(), [3, 2], "{resolution}");
        let found: Vec<f32> = image.pixels().iter().map(|color| color.r).collect();
        assert_eq!(found, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], "{resolution}");
    }
}

#[test]
fn colors_follow_the_declared_primaries() {
    let pixel = [128, 128, 128, 129];
    let rgb = |start: &str| colors(&file(start, "-Y 1 +X 1", &pixel))[0];
    let bt709 = "#?RADIANCE\nPRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n\n";
    assert_eq!(rgb(bt709), [1.0; 3], "the same primaries");
    let near = |found: [f32; 3], expected: [f32; 3]| {
        let pairs = found.into_iter().zip(expected);
        pairs
            .into_iter()
            .all(|(found, expected)| (found - expected).abs() < 1e-3)
    };
    // The sums of the rows of the matrix from XYZ to BT.709.
    let xyz = rgb("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n");
    assert!(near(xyz, [1.2048, 0.9484, 0.9088]), "{xyz:?}");
    // White stays white: the white of equal energy is adapted.
    let white = "#?RADIANCE\nPRIMARIES=0.64 0.33 0.29 0.6 0.15 0.06 0.3333 0.3333\n\n";
    assert!(near(rgb(white), [1.0; 3]), "{:?}", rgb(white));
}

#[test]
fn wrong_headers_are_refused() {
    for (bytes, expected) in [
        (
            file("#?RADIANCE\nFORMAT=ascii\n\n", "-Y 1 +X 1", &[0; 4]),
            "Radiance HDR with pixels other than RGBE and XYZE is not supported",
        ),
        (
            file(START, "1 1", &[0; 4]),
            "the Radiance HDR data is damaged: the resolution is missing",
        ),
        (
            file(START, "-Y 1 +X a", &[0; 4]),
            "the Radiance HDR data is damaged: the resolution is not two whole numbers",
        ),
        (
            file("#?RADIANCE\nPRIMARIES=1 2\n\n", "-Y 1 +X 1", &[0; 4]),
            "the Radiance HDR data is damaged: PRIMARIES are not eight numbers",
        ),
        (
            b"#?RADIANCE\n".to_vec(),
            "the Radiance HDR data is damaged: the header ends too soon",
        ),
        (
            file(START, "-Y 1 +X 2", &[1, 1, 1, 1, 0, 0, 0, 0]),
            "the Radiance HDR data is damaged: a scan line begins with a repetition",
        ),
        (
            file(START, "-Y 1 +X 2", &[0, 0, 0, 0, 1, 1, 1, 2]),
            "the Radiance HDR data is damaged: a repetition reaches beyond its scan line",
        ),
        (
            file(START, "-Y 1 +X 8", &[2, 2, 0, 9]),
            "the Radiance HDR data is damaged: a scan line is not as long as the image is wide",
        ),
        (
            file(START, "-Y 1 +X 8", &[2, 2, 0, 8, 137, 1]),
            "the Radiance HDR data is damaged: a run of pixels is empty or reaches beyond its scan line",
        ),
        (
            file(START, "-Y 1 +X 8", &[2, 2, 0, 8, 0]),
            "the Radiance HDR data is damaged: a run of pixels is empty or reaches beyond its scan line",
        ),
    ] {
        assert_eq!(refusal(&bytes), expected);
    }
}

#[test]
fn limits_are_kept_to_the_pixel_and_the_byte() {
    let bytes = file(START, "-Y 2 +X 2", &[128; 16]);
    let kind = |pixels, bytes_limit| {
        let limits = Limits {
            pixels,
            bytes: bytes_limit,
        };
        let image = decode_image(&bytes, &limits);
        image.map(|_| ()).map_err(|error| error.kind().clone())
    };
    assert_eq!(kind(4, 112), Ok(()), "exactly the limits");
    let size = [2, 2];
    let expected = ImageErrorKind::TooManyPixels { size, limit: 3 };
    assert_eq!(kind(3, 112), Err(expected), "one pixel less");
    let expected = ImageErrorKind::TooManyBytes {
        bytes: 112,
        limit: 111,
    };
    assert_eq!(kind(4, 111), Err(expected), "one byte less");
    let size = [0, 3];
    let empty = decode_image(&file(START, "-Y 3 +X 0", &[]), &Limits::default());
    assert_eq!(empty.unwrap_err().kind(), &ImageErrorKind::Empty { size });
}

#[test]
fn every_truncation_is_refused() {
    let line = [
        2, 2, 0, 8, 136, 1, 8, 1, 2, 3, 4, 5, 6, 7, 8, 136, 3, 136, 130,
    ];
    for bytes in [
        file(START, "-Y 1 +X 8", &line),
        file(START, "-Y 2 +X 1", &[9; 8]),
    ] {
        decode(&bytes);
        for length in 0..bytes.len() {
            let result = decode_image(&bytes[..length], &Limits::default());
            assert!(result.is_err(), "{length} of {} bytes", bytes.len());
        }
    }
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(body in proptest::collection::vec(any::<u8>(), 0..300)) {
        let _ = decode_image(&file(START, "-Y 20 +X 20", &body), &Limits::default());
        let _ = decode_image(&[START.as_bytes(), &body].concat(), &Limits::default());
    }
}
