//! Tests of round trips, limits and damage of OpenEXR files.

use dapple_color::{LinearRgb, LinearRgba};
use dapple_image::{
    Channels, ExrImage, ExrPlane, Format, ImageErrorKind, Limits, decode_exr, decode_exr_region,
    encode_exr,
};
use dapple_raster::Raster;
use exr::compression::Compression;
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image, Layer};
use exr::math::Vec2;
use exr::meta::attribute::LineOrder;
use exr::meta::header::LayerAttributes;
use proptest::prelude::*;
use std::io::Cursor;

fn decode(bytes: &[u8]) -> ExrImage {
    decode_exr(bytes, &Limits::default()).unwrap()
}

fn small() -> Vec<ExrPlane> {
    let plane = |name, factor: f32| {
        let values = Raster::from_fn([7, 5], |x, y| factor * (x * 5 + y) as f32).unwrap();
        ExrPlane::new(name, values)
    };
    vec![plane("A", 0.01), plane("height", -3.5)]
}

#[test]
fn every_number_survives_the_round_trip_bit_for_bit() {
    let odd = [
        f32::NAN,
        f32::INFINITY,
        -0.0,
        1e-45,
        f32::MAX,
        f32::from_bits(0xffc0_1234),
    ];
    let values = Raster::from_fn([6, 40], |x, y| odd[((x + y) % 6) as usize]).unwrap();
    let bytes = encode_exr(&[ExrPlane::new("Y", values.clone())]).unwrap();
    let bits = |raster: &Raster<f32>| raster.map(|value| value.to_bits());
    assert_eq!(
        bits(decode(&bytes).gray().unwrap()),
        bits(&values),
        "all bits"
    );
}

#[test]
fn planes_come_back_by_name() {
    let planes = small();
    let reversed: Vec<ExrPlane> = planes.iter().rev().cloned().collect();
    let bytes = encode_exr(&reversed).unwrap();
    assert_eq!(
        bytes,
        encode_exr(&planes).unwrap(),
        "the order does not matter"
    );
    let image = decode(&bytes);
    assert_eq!(image.planes, planes, "sorted by name");
    let missing = image.plane("depth").unwrap_err();
    let name = "depth".to_owned();
    assert_eq!(
        missing.kind(),
        &ImageErrorKind::MissingPlane { name },
        "no such plane"
    );
}

#[test]
fn colors_survive_and_alpha_is_multiplied_in_the_file() {
    let pixel = |x: u32, y: u32| LinearRgba {
        color: LinearRgb::new(x as f32, 2.0, 8.0),
        // Powers of two, so that multiplying and dividing lose nothing.
        alpha: 1.0 / (1 << y) as f32,
    };
    let colors = Raster::from_fn([4, 3], pixel).unwrap();
    let image = decode(&encode_exr(&ExrPlane::from_colors_with_alpha(&colors)).unwrap());
    assert_eq!(image.plane("B").unwrap().row(2), [2.0; 4], "multiplied");
    assert_eq!(image.color_alpha().unwrap(), colors, "and divided again");
    assert!(image.gray().is_err(), "color is not gray");
}

#[test]
fn alpha_of_zero_keeps_the_color_of_the_file() {
    let glow = |name, value| ExrPlane::new(name, Raster::filled([1, 1], value).unwrap());
    let planes = [
        glow("R", 3.0),
        glow("G", 2.0),
        glow("B", 1.0),
        glow("A", 0.0),
    ];
    let color = decode(&encode_exr(&planes).unwrap()).color_alpha().unwrap();
    assert_eq!(
        color.pixels()[0].color,
        LinearRgb::new(3.0, 2.0, 1.0),
        "light without cover"
    );
}

#[test]
fn bad_planes_are_refused() {
    let plane = |name: &str, size| ExrPlane::new(name, Raster::filled(size, 0.0).unwrap());
    let kind = |planes: &[ExrPlane]| encode_exr(planes).unwrap_err().kind().clone();
    for name in ["", "naïve", "two words", &"n".repeat(256)] {
        let expected = ImageErrorKind::PlaneName {
            name: name.to_owned(),
        };
        assert_eq!(kind(&[plane(name, [1, 1])]), expected, "{name:?}");
    }
    let twice = [plane("Y", [1, 1]), plane("Y", [1, 1])];
    assert_eq!(
        kind(&twice),
        ImageErrorKind::PlaneName { name: "Y".into() },
        "twice"
    );
    let sizes = [plane("X", [2, 1]), plane("Y", [1, 2])];
    let expected = ImageErrorKind::SizeMismatch {
        size: [1, 2],
        needed: [2, 1],
    };
    assert_eq!(kind(&sizes), expected, "two sizes");
    assert_eq!(
        kind(&[]),
        ImageErrorKind::Empty { size: [0, 0] },
        "no plane"
    );
}

#[test]
fn a_long_name_survives() {
    let plane = ExrPlane::new("n".repeat(255), Raster::filled([2, 2], 1.0).unwrap());
    let image = decode(&encode_exr(core::slice::from_ref(&plane)).unwrap());
    assert_eq!(image.planes, [plane], "255 bytes");
}

/// Returns a file with two named parts, one with 16-bit floats and one with integers, in tiles with the given
/// compression.
fn parts(compression: Compression) -> Vec<u8> {
    let part = |name: &str, samples: FlatSamples| {
        let encoding = Encoding {
            compression,
            blocks: Blocks::Tiles(Vec2(16, 16)),
            line_order: LineOrder::Increasing,
        };
        let channels = AnyChannels::sort([AnyChannel::new("Y", samples)].into_iter().collect());
        Layer::new((20, 18), LayerAttributes::named(name), encoding, channels)
    };
    let halves = (0..360)
        .map(|at| exr::prelude::f16::from_f32(at as f32))
        .collect();
    let image = Image::empty(exr::meta::header::ImageAttributes::with_size((20, 18)))
        .with_layer(part("near", FlatSamples::F16(halves)))
        .with_layer(part("far", FlatSamples::U32((0..360).collect())));
    let mut bytes = Vec::new();
    image
        .write()
        .non_parallel()
        .to_buffered(Cursor::new(&mut bytes))
        .unwrap();
    bytes
}

#[test]
fn parts_tiles_and_other_numbers_are_read() {
    let expected = Raster::from_fn([20, 18], |x, y| (20 * y + x) as f32).unwrap();
    for compression in [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
    ] {
        let image = decode(&parts(compression));
        for name in ["near.Y", "far.Y"] {
            assert_eq!(
                image.plane(name).unwrap(),
                &expected,
                "{name} {compression}"
            );
        }
    }
}

#[test]
fn a_region_is_the_crop_of_the_whole_in_all_compressions() {
    let wide = Raster::from_fn([300, 150], |x, y| (x * 7 + y * 1009) as f32 / 3.0).unwrap();
    let mut files = vec![encode_exr(&[ExrPlane::new("Y", wide)]).unwrap()];
    files.extend(
        [
            Compression::Uncompressed,
            Compression::RLE,
            Compression::ZIP1,
            Compression::ZIP16,
            Compression::PIZ,
        ]
        .map(parts),
    );
    for bytes in files {
        let whole = decode(&bytes);
        let [width, height] = whole.planes[0].values.size();
        for (first, size) in [
            ([0, 0], [width, height]),
            ([0, 0], [1, 1]),
            ([width - 1, height - 1], [1, 1]),
            ([15, 15], [3, 2]),
            ([3, 7], [12, 11]),
        ] {
            // The pixels of the region are enough.
            let pixels = u64::from(size[0]) * u64::from(size[1]);
            let limits = Limits {
                pixels,
                ..Limits::default()
            };
            let part = decode_exr_region(&bytes, first, size, &limits).unwrap();
            assert_eq!(part.planes.len(), whole.planes.len());
            for (part, whole) in part.planes.iter().zip(&whole.planes) {
                assert_eq!(part.name, whole.name);
                assert_eq!(part.values, whole.values.crop(first, size).unwrap());
            }
        }
        let outside = decode_exr_region(&bytes, [1, 0], [width, 1], &Limits::default());
        let outside = outside.unwrap_err();
        assert!(
            matches!(outside.kind(), ImageErrorKind::Outside { .. }),
            "{outside}"
        );
    }
}

#[test]
fn a_region_needs_only_its_blocks_and_keeps_the_limits() {
    let bytes = parts(Compression::ZIP16);
    let size = [2, 2];
    let region = |bytes: &[u8], first, limits| {
        decode_exr_region(bytes, first, size, &limits).map_err(|error| error.kind().clone())
    };
    // The last tiles are those of the second part.
    let mut damaged = bytes.clone();
    let end = damaged.len();
    damaged[end - 8..].fill(0xff);
    assert!(decode_exr(&damaged, &Limits::default()).is_err());
    assert!(region(&damaged, [0, 0], Limits::default()).is_ok());
    assert!(region(&damaged, [18, 16], Limits::default()).is_err());
    let limits = |pixels, bytes| Limits { pixels, bytes };
    let pixels = ImageErrorKind::TooManyPixels {
        size: [2, 2],
        limit: 3,
    };
    assert_eq!(region(&bytes, [0, 0], limits(3, 1 << 20)), Err(pixels));
    // Two planes of 4 pixels, and a tile of 256 whole numbers.
    assert!(region(&bytes, [0, 0], limits(4, 32 + 1024)).is_ok());
    let memory = region(&bytes, [0, 0], limits(4, 31 + 1024)).unwrap_err();
    assert!(
        matches!(memory, ImageErrorKind::TooManyBytes { .. }),
        "{memory:?}"
    );
}

/// Returns a file with these named parts, each with the color 1, 2, 3.
fn colored_parts(names: &[&str]) -> Vec<u8> {
    let part = |name: &&str| {
        let plane = |(channel, value)| AnyChannel::new(channel, FlatSamples::F32(vec![value; 2]));
        let channels = [("B", 3.0), ("G", 2.0), ("R", 1.0)].map(plane);
        let channels = AnyChannels::sort(channels.into_iter().collect());
        let attributes = LayerAttributes::named(*name);
        Layer::new((2, 1), attributes, Encoding::default(), channels)
    };
    let parts: Vec<_> = names.iter().map(part).collect();
    let attributes = exr::meta::header::ImageAttributes::with_size((2, 1));
    let mut bytes = Vec::new();
    let image = Image::from_layers(attributes, parts);
    let sink = Cursor::new(&mut bytes);
    image.write().non_parallel().to_buffered(sink).unwrap();
    bytes
}

#[test]
fn the_only_part_is_read_whatever_its_name() {
    for name in ["", "rgba", "View Layer.Combined"] {
        let image = decode(&colored_parts(&[name]));
        let names: Vec<_> = image.planes.iter().map(|plane| &plane.name).collect();
        assert_eq!(names, ["B", "G", "R"], "{name:?}");
        let image = dapple_image::Image::Planes(Format::Exr, image);
        assert_eq!(image.channels(), Channels::Rgb, "{name:?}");
        let colors = image.color().unwrap();
        assert_eq!(colors.pixels(), [LinearRgb::new(1.0, 2.0, 3.0); 2]);
    }
}

#[test]
fn of_several_parts_the_only_one_of_color_is_read() {
    let planes = |names: &[&str]| {
        let plane = |name: &&str| ExrPlane::new(*name, Raster::filled([1, 1], 0.5).unwrap());
        ExrImage {
            planes: names.iter().map(plane).collect(),
            ..ExrImage::default()
        }
    };
    let image = planes(&["depth.Z", "beauty.A", "beauty.B", "beauty.G", "beauty.R"]);
    let half = LinearRgba {
        color: LinearRgb::gray(1.0),
        alpha: 0.5,
    };
    assert_eq!(image.color_alpha().unwrap().pixels(), [half]);
    let channels = dapple_image::Image::Planes(Format::Exr, image).channels();
    assert_eq!(channels, Channels::Rgba, "as it is read");
    let layers = ["near", "far"].map(str::to_owned).to_vec();
    let two = decode(&colored_parts(&["near", "far"]));
    assert_eq!(
        two.color_alpha().unwrap_err().kind(),
        &ImageErrorKind::AmbiguousLayer { layers },
        "nobody says which of the two"
    );
}

#[test]
fn limits_are_kept_to_the_pixel_and_the_byte() {
    let bytes = encode_exr(&small()).unwrap();
    let kind = |pixels, bytes_limit| {
        let limits = Limits {
            pixels,
            bytes: bytes_limit,
        };
        decode_exr(&bytes, &limits).map_err(|error| error.kind().clone())
    };
    assert!(kind(35, 280).is_ok(), "exactly the limits");
    let size = [7, 5];
    let pixels = ImageErrorKind::TooManyPixels { size, limit: 34 };
    assert_eq!(kind(34, 280), Err(pixels), "one pixel less");
    let memory = ImageErrorKind::TooManyBytes {
        bytes: 280,
        limit: 279,
    };
    assert_eq!(kind(35, 279), Err(memory), "one byte less");
}

#[test]
fn a_header_that_claims_a_huge_size_is_refused() {
    let mut bytes = encode_exr(&small()).unwrap();
    let name = b"dataWindow\0box2i\0";
    let at = bytes
        .windows(name.len())
        .position(|window| window == name)
        .unwrap();
    // After the names and the length come the first and last column and row.
    let corner = at + name.len() + 4 + 8;
    bytes[corner..corner + 8].copy_from_slice(&[0xff, 0xff, 0xff, 0x3e, 0xff, 0xff, 0xff, 0x3e]);
    let refused = decode_exr(&bytes, &Limits::default()).unwrap_err();
    assert!(
        matches!(
            refused.kind(),
            ImageErrorKind::TooManyPixels { .. } | ImageErrorKind::Damaged { .. }
        ),
        "{refused}"
    );
}

#[test]
fn every_truncation_is_refused() {
    let bytes = encode_exr(&small()).unwrap();
    for length in 0..bytes.len() {
        let refused = decode_exr(&bytes[..length], &Limits::default());
        assert!(refused.is_err(), "{length} of {} bytes", bytes.len());
    }
}

#[test]
fn a_flipped_bit_in_every_byte_gives_an_image_or_an_error() {
    for bytes in [
        encode_exr(&small()).unwrap(),
        parts(Compression::PIZ),
        parts(Compression::RLE),
    ] {
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << (at % 8);
            let limits = Limits {
                pixels: 1 << 20,
                bytes: 1 << 24,
            };
            if let Ok(part) = decode_exr_region(&damaged, [1, 1], [3, 2], &limits) {
                let mut planes = part.planes.iter();
                assert!(
                    planes.all(|plane| plane.values.size() == [3, 2]),
                    "byte {at}"
                );
            }
            if let Ok(image) = decode_exr(&damaged, &limits) {
                let pixels = |plane: &ExrPlane| plane.values.pixels().len();
                let total: usize = image.planes.iter().map(pixels).sum();
                assert!(total <= 1 << 22, "byte {at}: {total} values");
            }
        }
    }
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(body in proptest::collection::vec(any::<u8>(), 0..300)) {
        let bytes = [b"\x76\x2f\x31\x01".as_slice(), &[2, 0, 0, 0], &body].concat();
        prop_assert!(decode_exr(&bytes, &Limits::default()).is_err());
        prop_assert!(decode_exr(&body, &Limits::default()).is_err());
        prop_assert!(decode_exr_region(&bytes, [0, 0], [1, 1], &Limits::default()).is_err());
    }
}
