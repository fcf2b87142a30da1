//! Target for all image formats.

use super::accepted;
use dapple::image::{
    ExrImage, ExrPlane, Image, Limits, PngImage, PngPixels, Transfer, decode_exr, decode_image,
    decode_png, encode_exr, encode_png,
};
use dapple::raster::Raster;
use jpeg_encoder::{ColorType, Encoder};

const LIMITS: Limits = Limits {
    pixels: 1 << 16,
    bytes: 1 << 22,
};

/// Decodes an image. It must be rejected, or be within the limits and equal after it is written and read again.
pub fn image(bytes: &[u8]) {
    let Some(image) = accepted(decode_image(bytes, &LIMITS)) else {
        return;
    };
    let [width, height] = image.size().map(u64::from);
    assert!(width * height > 0, "an image without pixels");
    assert!(
        width * height <= LIMITS.pixels,
        "more pixels than the limit"
    );
    let _ = accepted(image.gray());
    let _ = accepted(image.color());
    let _ = accepted(image.color_alpha());
    match &image {
        Image::Codes(_, image) => check_png(image),
        Image::Planes(_, image) => check_exr(image),
        _ => {}
    }
}

fn check_png(image: &PngImage) {
    let bytes = png(image).expect("what was read can be written");
    let limits = Limits::default();
    let again = decode_png(&bytes, &limits).expect("what was written can be read");
    // Compare pixels and transfer only: the encoder declares colors even if the decoded image did not.
    let same = |image: &PngImage| (image.pixels.clone(), image.transfer);
    assert!(same(&again) == same(image), "written and read again");
}

fn png(image: &PngImage) -> Result<Vec<u8>, dapple::image::ImageError> {
    let transfer = image.transfer;
    match &image.pixels {
        PngPixels::Gray8(raster) => encode_png(raster.view(), transfer),
        PngPixels::Gray16(raster) => encode_png(raster.view(), transfer),
        PngPixels::GrayAlpha8(raster) => encode_png(raster.view(), transfer),
        PngPixels::GrayAlpha16(raster) => encode_png(raster.view(), transfer),
        PngPixels::Rgb8(raster) => encode_png(raster.view(), transfer),
        PngPixels::Rgb16(raster) => encode_png(raster.view(), transfer),
        PngPixels::Rgba8(raster) => encode_png(raster.view(), transfer),
        PngPixels::Rgba16(raster) => encode_png(raster.view(), transfer),
    }
}

fn check_exr(image: &ExrImage) {
    // Images cannot be written if planes of several parts differ in size, or if joined names are too long.
    let Some(bytes) = accepted(encode_exr(&image.planes)) else {
        return;
    };
    let again = decode_exr(&bytes, &Limits::default()).expect("what was written can be read");
    for plane in &image.planes {
        let other = again.plane(&plane.name).expect("no plane is lost");
        let bits = |raster: &Raster<f32>| -> Vec<_> {
            raster
                .pixels()
                .iter()
                .map(|value| value.to_bits())
                .collect()
        };
        assert_eq!(bits(&plane.values), bits(other), "of {}", plane.name);
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let size = [5, 3];
    let pixels = |n: u32| (0..15 * n).map(move |index| (index * 37 % 256) as u8);
    let wide: Vec<u16> = pixels(1).map(|code| u16::from(code) * 251).collect();
    let two: Vec<[u8; 2]> = pixels(1).map(|code| [code, 255 - code]).collect();
    let four: Vec<[u8; 4]> = pixels(1).map(|code| [code, 7, 255 - code, code]).collect();
    let numbers: Vec<f32> = pixels(1).map(|code| f32::from(code) / 16.0 - 3.0).collect();
    let raster = Raster::from_vec(size, numbers).expect("15 values");
    let planes = ["A", "B", "G", "R"].map(|name| ExrPlane::new(name, raster.clone()));
    let gray = Raster::from_vec(size, pixels(1).collect()).expect("15 values");
    let encoded = [
        encode_png(gray.view(), Transfer::Data),
        encode_png(
            Raster::from_vec(size, wide).expect("15 values").view(),
            Transfer::Data,
        ),
        encode_png(
            Raster::from_vec(size, two).expect("15 values").view(),
            Transfer::Srgb,
        ),
        encode_png(
            Raster::from_vec(size, four).expect("15 values").view(),
            Transfer::Srgb,
        ),
        encode_exr(&planes[..1]),
        encode_exr(&planes),
    ];
    let mut seeds: Vec<_> = encoded.map(|bytes| bytes.expect("it is valid")).into();
    for (kind, channels) in [(ColorType::Luma, 1), (ColorType::Rgb, 3)] {
        for is_progressive in [false, true] {
            let mut bytes = Vec::new();
            let mut encoder = Encoder::new(&mut bytes, 80);
            encoder.set_progressive(is_progressive);
            let codes: Vec<u8> = pixels(channels).collect();
            encoder.encode(&codes, 5, 3, kind).expect("it is valid");
            seeds.push(bytes);
        }
    }
    seeds.extend(read_only());
    seeds
}

/// Frame of a lossy WebP image of 2 × 2 red pixels, encoded by libwebp.
const WEBP_FRAME: [u8; 44] = [
    0x90, 0x01, 0x00, 0x9d, 0x01, 0x2a, 0x02, 0x00, 0x02, 0x00, 0x02, 0xc0, 0x4c, 0x25, 0xa0, 0x02,
    0x74, 0xba, 0x00, 0x03, 0x98, 0x00, 0xfe, 0xee, 0x43, 0x1f, 0xee, 0x6c, 0x73, 0x8b, 0x70, 0x57,
    0xff, 0x6d, 0x0f, 0xff, 0x5a, 0x1f, 0xfe, 0xb4, 0x3f, 0xe9, 0x40, 0x00,
];

/// Returns files of the formats that have no encoder here.
fn read_only() -> [Vec<u8>; 5] {
    // TIFF: the entries of width, height, bits, interpretation, offset, rows and bytes of one strip of 5 × 3 pixels.
    let entry = |tag: u16, value: u16| {
        let numbers = [tag, 3, 1, 0, value, 0];
        numbers.map(u16::to_le_bytes).concat()
    };
    let entries = [
        (256, 5),
        (257, 3),
        (258, 8),
        (262, 1),
        (273, 98),
        (278, 3),
        (279, 15),
    ];
    let entries = entries.map(|(tag, value)| entry(tag, value)).concat();
    let start = b"II*\0\x08\0\0\0\x07\0".as_slice();
    let tiff = [start, &entries, &[0; 4], b"fifteen pixels."].concat();
    let webp = [b"RIFF\x38\0\0\0WEBPVP8 \x2c\0\0\0".as_slice(), &WEBP_FRAME];
    // TGA: raw colors, and runs of pixels with alpha.
    let header = |kind, bits, descriptor| {
        let zeros = [0; 9];
        [
            &[0, 0, kind],
            zeros.as_slice(),
            &[5, 0, 3, 0, bits, descriptor],
        ]
        .concat()
    };
    let raw = [header(2, 24, 32), vec![77; 45]].concat();
    let runs = [header(10, 32, 8), [[132, 1, 2, 3, 4]; 3].concat()].concat();
    // Radiance HDR: a scan line by channel.
    let start = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n\x02\x02\0\x08".as_slice();
    let hdr = [start, &[136, 9, 136, 8, 4, 1, 2, 3, 4, 132, 7, 136, 128]].concat();
    [tiff, webp.concat(), raw, runs, hdr]
}
