//! Targets for PNG, JPEG and OpenEXR.

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
        Image::Png(image) | Image::Jpeg(image) => check_png(image),
        Image::Exr(image) => check_exr(image),
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
    seeds
}
