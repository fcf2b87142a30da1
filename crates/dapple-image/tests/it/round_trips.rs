//! Tests of round trips of values through a file.

use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_image::{
    ColorSpace, Content, Depth, Encoding, Image, ImageError, ImageErrorKind, Limits, PngImage,
    PngPixels, RowWriter, Transfer, decode_image, encode_png, read_image, write_color_alpha_exr,
    write_color_alpha_png, write_color_exr, write_color_png, write_gray_exr, write_gray_png,
    write_normal_png,
};
use dapple_raster::Raster;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// A unique file name for a test. The file is removed on drop.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("dapple-image-{}-{name}", std::process::id());
        Self(std::env::temp_dir().join(name))
    }

    fn write_and_read(&self, write: impl FnOnce(&Path) -> Result<(), ImageError>) -> Image {
        write(&self.0).unwrap();
        read_image(&self.0, &Limits::default()).unwrap()
    }
}

impl Drop for Scratch {
    #[expect(
        clippy::disallowed_methods,
        reason = "the test removes the file that it wrote"
    )]
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn values() -> Raster<f32> {
    Raster::from_fn([9, 4], |x, y| (x * 4 + y) as f32 / 35.0).unwrap()
}

fn colors() -> Raster<LinearRgb> {
    values().map(|&value| LinearRgb::new(value, 1.0 - value, 0.25))
}

fn covered() -> Raster<LinearRgba> {
    colors().map(|&color| LinearRgba { color, alpha: 0.5 })
}

/// Returns the content of a PNG image; panics for other formats.
fn png(image: Image) -> PngImage {
    match image {
        Image::Codes(_, png) => png,
        _ => panic!("the file is not PNG"),
    }
}

#[test]
fn gray_png_holds_the_nearest_codes() {
    let scratch = Scratch::new("gray.png");
    for (depth, step) in [(Depth::Eight, 1.0 / 255.0), (Depth::Sixteen, 1.0 / 65535.0)] {
        let image = scratch.write_and_read(|path| write_gray_png(path, &values(), depth));
        let back = image.gray().unwrap();
        for (&value, &back) in values().pixels().iter().zip(back.pixels()) {
            // Half a step, and one rounding of `f32`.
            assert!(
                (value - back).abs() <= 0.5 * step + 1e-7,
                "{value} {depth:?}"
            );
        }
        assert_eq!(png(image).transfer, Transfer::Data, "{depth:?}");
    }
}

#[test]
fn values_out_of_range_are_clamped() {
    let scratch = Scratch::new("clamped.png");
    let odd = [f32::NAN, -1.0, 0.0, 0.5, 1.0, 2.0, f32::INFINITY];
    let odd = Raster::from_vec([7, 1], odd.to_vec()).unwrap();
    let image = scratch.write_and_read(|path| write_gray_png(path, &odd, Depth::Eight));
    let codes = vec![0, 0, 0, 128, 255, 255, 255];
    let expected = PngPixels::Gray8(Raster::from_vec([7, 1], codes).unwrap());
    assert_eq!(png(image).pixels, expected, "NaN is 0");
}

#[test]
fn color_png_is_srgb_and_says_so() {
    let scratch = Scratch::new("color.png");
    let image = scratch.write_and_read(|path| write_color_png(path, &colors(), Depth::Eight));
    let codes = colors().map(|color| color.to_srgb::<u8>());
    let expected = PngImage {
        pixels: PngPixels::Rgb8(codes),
        transfer: Transfer::Srgb,
        space: png(image.clone()).space,
    };
    assert_eq!(png(image), expected, "8 bits");
    let image = scratch.write_and_read(|path| write_color_png(path, &colors(), Depth::Sixteen));
    let back = image.color().unwrap().map(|color| color.to_srgb::<u16>());
    assert_eq!(
        back,
        colors().map(|color| color.to_srgb::<u16>()),
        "16 bits"
    );
    assert!(image.gray().is_err(), "color is not gray");
}

#[test]
fn alpha_png_comes_back_and_is_not_dropped() {
    let scratch = Scratch::new("alpha.png");
    let image =
        scratch.write_and_read(|path| write_color_alpha_png(path, &covered(), Depth::Sixteen));
    let back = image
        .color_alpha()
        .unwrap()
        .map(|color| color.to_srgb::<u16>());
    assert_eq!(
        back,
        covered().map(|color| color.to_srgb::<u16>()),
        "16 bits"
    );
    let error = image.color().unwrap_err();
    assert!(
        matches!(error.kind(), ImageErrorKind::Channels { .. }),
        "{error}"
    );
    let opaque = colors().map(|&color| LinearRgba::opaque(color));
    let image = scratch.write_and_read(|path| write_color_alpha_png(path, &opaque, Depth::Eight));
    assert!(
        image.color().is_ok(),
        "alpha that is 1 everywhere says nothing"
    );
}

#[test]
fn normal_png_is_data() {
    let scratch = Scratch::new("normal.png");
    let flat = Raster::filled([3, 2], Normal::FLAT).unwrap();
    let image = scratch.write_and_read(|path| write_normal_png(path, &flat, Depth::Eight));
    let expected = PngImage {
        pixels: PngPixels::Rgb8(Raster::filled([3, 2], [128, 128, 255]).unwrap()),
        transfer: Transfer::Data,
        space: ColorSpace::default(),
    };
    assert_eq!(png(image), expected, "flat");
}

#[test]
fn exr_keeps_every_number() {
    let scratch = Scratch::new("image.exr");
    let wide = values().map(|value| value * 1e6 - 3.0);
    let image = scratch.write_and_read(|path| write_gray_exr(path, &wide));
    assert_eq!(image.gray().unwrap(), wide, "gray");
    let image = scratch.write_and_read(|path| write_color_exr(path, &colors()));
    assert_eq!(image.color().unwrap(), colors(), "color");
    let image = scratch.write_and_read(|path| write_color_alpha_exr(path, &covered()));
    // An alpha of one half loses nothing.
    assert_eq!(image.color_alpha().unwrap(), covered(), "color with alpha");
    assert!(image.color().is_err(), "alpha is not dropped");
    assert_eq!(image.size(), [9, 4], "the size");
}

#[test]
fn gray_is_read_as_color_under_the_curve() {
    let codes = Raster::from_vec([3, 1], vec![0_u8, 188, 255]).unwrap();
    let bytes = encode_png(codes.view(), Transfer::Data).unwrap();
    let image = decode_image(&bytes, &Limits::default()).unwrap();
    let gray = [0_u8, 188, 255].map(|code| LinearRgb::from_srgb([code; 3]));
    assert_eq!(image.color().unwrap().pixels(), gray, "grays");
    assert_eq!(
        image.gray().unwrap().pixels()[1],
        188.0 / 255.0,
        "and data without it"
    );
}

#[test]
fn other_formats_are_refused_by_name() {
    for bytes in [
        b"".as_slice(),
        b"GIF89a",
        &[0xff, 0xd8],
        &[0x89, b'P', b'N'],
    ] {
        let error = decode_image(bytes, &Limits::default()).unwrap_err();
        assert_eq!(error.kind(), &ImageErrorKind::UnknownFormat, "{bytes:?}");
    }
}

#[test]
fn the_same_pixels_make_the_same_bytes_with_any_number_of_threads() {
    let image = Raster::from_fn([300, 70], |x, y| (x * y % 17) as f32).unwrap();
    let bytes = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let write = || {
            [Encoding::Png(Depth::Sixteen), Encoding::Exr].map(|encoding| {
                let sink = Cursor::new(Vec::new());
                let mut writer =
                    RowWriter::new(sink, image.size(), Content::Gray, encoding).unwrap();
                writer.write_gray(image.view()).unwrap();
                writer.finish().unwrap().into_inner()
            })
        };
        pool.build().unwrap().install(write)
    };
    let one = bytes(1);
    for threads in [2, 7] {
        assert!(bytes(threads) == one, "{threads} threads");
    }
}
