//! Tests of color spaces declared by files. The expected constants were computed with NumPy from the definitions, and
//! confirmed by littlecms.

use crate::png::{chunk, naive_png, stored};
use dapple_color::LinearRgb;
use dapple_image::{ExrImage, ExrPlane, Format, Image, ImageErrorKind, Limits, decode_image};
use dapple_raster::Raster;
use image_webp::WebPEncoder;
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use std::io::Cursor;
use tiff::encoder::TiffEncoder;
use tiff::encoder::colortype::RGB8;
use tiff::tags::Tag;

/// Test colors as 8-bit codes.
const CODES: [[u8; 3]; 6] = [
    [200, 80, 60],
    [120, 160, 90],
    [255, 255, 255],
    [128, 128, 128],
    [10, 20, 200],
    [0, 255, 0],
];

/// An ICC matrix profile: the columns of its matrix in XYZ of D50, its curve, and the expected linear BT.709 light of
/// the test colors.
struct Profile {
    columns: [[f64; 3]; 3],
    curve: Curve,
    light: [[f32; 3]; 6],
}

#[derive(Clone, Copy)]
enum Curve {
    /// A power function, stored as the tag `curv` with one number.
    Power(f64),
    /// The sRGB curve, stored as the tag `para` of type 3.
    Srgb,
}

const DISPLAY_P3: Profile = Profile {
    columns: [
        [0.51512, 0.24120, -0.00105],
        [0.29198, 0.69225, 0.04189],
        [0.15710, 0.06657, 0.78407],
    ],
    curve: Curve::Srgb,
    light: [
        [0.68945, 0.05931, 0.03198],
        [0.15099, 0.35843, 0.08096],
        [0.99996, 1.00004, 1.00001],
        [0.21585, 0.21587, 0.21586],
        [0.00214, 0.00717, 0.63373],
        [-0.22495, 1.04207, -0.07862],
    ],
};

const ADOBE_RGB: Profile = Profile {
    columns: [
        [0.60974, 0.31111, 0.01947],
        [0.20528, 0.62567, 0.06087],
        [0.14919, 0.06322, 0.74457],
    ],
    curve: Curve::Power(563.0 / 256.0),
    light: [
        [0.78843, 0.07812, 0.03993],
        [0.12358, 0.35878, 0.09017],
        [1.00003, 0.99999, 1.00001],
        [0.21964, 0.21964, 0.21964],
        [-0.00035, 0.00371, 0.61109],
        [-0.39832, 0.99998, -0.04293],
    ],
};

const PROPHOTO: Profile = Profile {
    columns: [
        [0.79767, 0.28804, 0.0],
        [0.13519, 0.71188, 0.0],
        [0.03134, 0.00009, 0.82491],
    ],
    // 1.8, as profiles round it.
    curve: Curve::Power(461.0 / 256.0),
    light: [
        [1.20054, 0.00479, 0.06128],
        [0.16216, 0.47279, 0.10968],
        [0.99998, 1.00002, 1.00001],
        [0.28904, 0.28905, 0.28905],
        [-0.19949, 0.01002, 0.74856],
        [-0.72755, 1.23174, -0.15329],
    ],
};

const SRGB_COLUMNS: [[f64; 3]; 3] = [
    [0.4360747, 0.2225045, 0.0139322],
    [0.3850649, 0.7168786, 0.0971045],
    [0.1430804, 0.0606169, 0.7141733],
];

fn fixed(number: f64) -> [u8; 4] {
    ((number * 65536.0).round() as i32).to_be_bytes()
}

/// Returns the bytes of an ICC profile of version 2 with a matrix of three columns and one curve.
fn icc(columns: [[f64; 3]; 3], curve: Curve) -> Vec<u8> {
    let curve = match curve {
        Curve::Power(gamma) => {
            let gamma = ((gamma * 256.0).round() as u16).to_be_bytes();
            [b"curv\0\0\0\0\0\0\0\x01".as_slice(), &gamma, &[0, 0]].concat()
        }
        Curve::Srgb => {
            let numbers = [2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045];
            let numbers = numbers.map(fixed).concat();
            [b"para\0\0\0\0\0\x03\0\0".as_slice(), &numbers].concat()
        }
    };
    let xyz = |numbers: [f64; 3]| [b"XYZ \0\0\0\0".to_vec(), numbers.map(fixed).concat()].concat();
    let [r, g, b] = columns.map(xyz);
    let tags: [(&[u8; 4], Vec<u8>); 6] = [
        (b"rXYZ", r),
        (b"gXYZ", g),
        (b"bXYZ", b),
        (b"rTRC", curve.clone()),
        (b"gTRC", curve.clone()),
        (b"bTRC", curve),
    ];
    profile(b"RGB ", &tags)
}

/// Returns the bytes of an ICC profile with these tags.
fn profile(space: &[u8; 4], tags: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut bytes = vec![0; 128];
    bytes[12..16].copy_from_slice(b"mntr");
    bytes[16..20].copy_from_slice(space);
    bytes[20..24].copy_from_slice(b"XYZ ");
    bytes[36..40].copy_from_slice(b"acsp");
    bytes.extend((tags.len() as u32).to_be_bytes());
    let mut place = 132 + 12 * tags.len();
    for (name, data) in tags {
        bytes.extend(*name);
        bytes.extend((place as u32).to_be_bytes());
        bytes.extend((data.len() as u32).to_be_bytes());
        place += data.len();
    }
    bytes.extend(tags.iter().flat_map(|(_, data)| data));
    bytes
}

/// Returns the PNG chunk that contains an ICC profile.
fn iccp(profile: &[u8]) -> Vec<u8> {
    chunk(b"iCCP", &[b"p\0\0".as_slice(), &stored(profile)].concat())
}

/// Decodes a PNG file with one row of 8-bit colors, preceded by `chunks`.
fn png(colors: &[[u8; 3]], chunks: &[Vec<u8>]) -> Image {
    let line = [&[0], colors.concat().as_slice()].concat();
    let bytes = naive_png([colors.len() as u32, 1], [8, 2, 0], chunks, &line);
    decode_image(&bytes, &Limits::default()).unwrap()
}

/// Decodes a TIFF file of one pixel with an ICC profile.
fn tiff(color: [u8; 3], profile: &[u8]) -> Image {
    let mut sink = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut sink).unwrap();
    let mut image = encoder.new_image::<RGB8>(1, 1).unwrap();
    image.encoder().write_tag(Tag::IccProfile, profile).unwrap();
    image.write_data(&color).unwrap();
    decode_image(&sink.into_inner(), &Limits::default()).unwrap()
}

/// Decodes a WebP file of one pixel with an ICC profile.
fn webp(color: [u8; 3], profile: &[u8]) -> Image {
    let mut bytes = Vec::new();
    let mut encoder = WebPEncoder::new(&mut bytes);
    encoder.set_icc_profile(profile.to_vec());
    let rgb = image_webp::ColorType::Rgb8;
    encoder.encode(&color, 1, 1, rgb).unwrap();
    decode_image(&bytes, &Limits::default()).unwrap()
}

/// Decodes a JPEG file of one color, with an ICC profile or an Exif segment.
fn jpeg(color: [u8; 3], profile: Option<&[u8]>, exif: Option<&[u8]>) -> Image {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 100);
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    if let Some(profile) = profile {
        encoder.add_icc_profile(profile).unwrap();
    }
    if let Some(exif) = exif {
        let segment = [b"Exif\0\0".as_slice(), exif].concat();
        encoder.add_app_segment(1, segment).unwrap();
    }
    encoder
        .encode(&color.repeat(64), 8, 8, ColorType::Rgb)
        .unwrap();
    decode_image(&bytes, &Limits::default()).unwrap()
}

fn assert_near(found: LinearRgb, expected: [f32; 3], tolerance: f32, what: &str) {
    let pairs = found.to_array().into_iter().zip(expected);
    for (part, expected_part) in pairs {
        let difference = (part - expected_part).abs();
        assert!(
            difference <= tolerance,
            "{what}: {found:?} for {expected:?}"
        );
    }
}

#[test]
fn matrix_profiles_become_light_of_bt709() {
    for (
        name,
        Profile {
            columns,
            curve,
            light,
        },
    ) in [
        ("P3", DISPLAY_P3),
        ("Adobe RGB", ADOBE_RGB),
        ("ProPhoto", PROPHOTO),
    ] {
        let profile = icc(columns, curve);
        let image = png(&CODES, &[iccp(&profile)]);
        let colors = image.color().unwrap();
        let alphas = image.color_alpha().unwrap();
        for (at, &expected) in light.iter().enumerate() {
            // Profiles are rounded to 16 bits behind the point, and the constants to five digits.
            assert_near(colors.pixels()[at], expected, 5e-5, name);
            assert_eq!(alphas.pixels()[at].color, colors.pixels()[at], "{name}");
            for image in [tiff(CODES[at], &profile), webp(CODES[at], &profile)] {
                let found = image.color().unwrap();
                assert_eq!(found.pixels(), [colors.pixels()[at]], "{name}");
            }
            let photo = jpeg(CODES[at], Some(&profile), None).color().unwrap();
            // A step of a code of JPEG is up to 0.015 in the light of a power of 2.2, times 1.7 by the matrix.
            assert_near(photo.pixels()[20], expected, 0.03, name);
        }
    }
}

#[test]
fn a_profile_of_srgb_changes_no_bit() {
    let plain = png(&CODES, &[]).color().unwrap();
    let image = png(&CODES, &[iccp(&icc(SRGB_COLUMNS, Curve::Srgb))]);
    assert_eq!(image.color().unwrap(), plain);
    let Image::Codes(_, image) = image else {
        panic!("no PNG");
    };
    assert!(image.space.is_srgb() && image.space.to_string().contains("sRGB"));
}

#[test]
fn curves_of_png_are_read() {
    let ramp = [0_u8, 51, 102, 153, 204, 255].map(|code| [code; 3]);
    let gama = |gamma: u32| chunk(b"gAMA", &gamma.to_be_bytes());
    let cicp = |primaries, transfer| chunk(b"cICP", &[primaries, transfer, 0, 1]);
    let linear = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
    let power = [0.0, 0.055_189, 0.192_180, 0.398_724, 0.669_209, 1.0];
    let srgb = [0.0, 0.033_105, 0.132_868, 0.318_547, 0.603_827, 1.0];
    // By the inverse of ITU-R BT.709: ((v + 0.099) / 1.099)^(1 / 0.45), and v / 4.5 below 0.081.
    let camera = [0.0, 0.055_427, 0.172_984, 0.365_837, 0.639_938, 1.0];
    for (chunks, expected) in [
        (vec![], srgb),
        (vec![gama(100_000)], linear),
        (vec![gama(55_556)], power),
        (vec![gama(45_455)], srgb),
        (vec![cicp(1, 8)], linear),
        (vec![cicp(1, 13)], srgb),
        (vec![cicp(1, 1)], camera),
        (vec![cicp(1, 8), chunk(b"sRGB", &[0]), gama(55_556)], linear),
        (vec![chunk(b"sRGB", &[0]), gama(100_000)], srgb),
        (
            vec![iccp(&icc(SRGB_COLUMNS, Curve::Power(1.0))), gama(55_556)],
            linear,
        ),
    ] {
        let colors = png(&ramp, &chunks).color().unwrap();
        for (color, value) in colors.pixels().iter().zip(expected) {
            // The columns that profiles of sRGB have are of a D50 that differs in the fourth digit.
            assert_near(
                *color,
                [value; 3],
                5e-4,
                &format!("{} chunks", chunks.len()),
            );
        }
    }
}

#[test]
fn primaries_of_png_are_read() {
    let numbers = [
        31_270, 32_900, 68_000, 32_000, 26_500, 69_000, 15_000, 6_000_u32,
    ];
    let chrm = chunk(b"cHRM", &numbers.map(u32::to_be_bytes).concat());
    let light = [
        [0.68946, 0.0593, 0.03198],
        [0.151, 0.35842, 0.08096],
        [1.0, 1.0, 1.0],
        [0.21586, 0.21586, 0.21586],
        [0.00214, 0.00716, 0.63373],
        [-0.22494, 1.04206, -0.07864],
    ];
    for chunks in [vec![chunk(b"cICP", &[12, 13, 0, 1])], vec![chrm]] {
        let colors = png(&CODES, &chunks).color().unwrap();
        for (color, expected) in colors.pixels().iter().zip(light) {
            // The constants have five digits.
            assert_near(*color, expected, 1e-5, "P3");
        }
    }
}

#[test]
fn what_cannot_be_converted_is_named() {
    let lut = profile(b"RGB ", &[(b"A2B0", vec![0; 40])]);
    let mut short = icc(SRGB_COLUMNS, Curve::Srgb);
    short.truncate(200);
    for (extra, part) in [
        (chunk(b"cICP", &[9, 16, 0, 1]), "PQ"),
        (chunk(b"cICP", &[9, 18, 0, 1]), "HLG"),
        (chunk(b"cICP", &[1, 13, 0, 0]), "narrow"),
        (chunk(b"cICP", &[77, 13, 0, 1]), "primaries"),
        (chunk(b"cHRM", &[0; 32]), "chromaticities"),
        (iccp(&lut), "lookup tables"),
        (iccp(&profile(b"GRAY", &[])), "gray"),
        (iccp(&short), "damaged"),
        (iccp(b"profile"), "damaged"),
    ] {
        let image = png(&CODES, core::slice::from_ref(&extra));
        for error in [image.color().unwrap_err(), image.color_alpha().unwrap_err()] {
            assert!(
                matches!(error.kind(), ImageErrorKind::ColorSpace { .. }),
                "{error}"
            );
            assert!(error.to_string().contains(part), "{error} names {part:?}");
        }
        let Image::Codes(_, png) = &image else {
            panic!("no PNG");
        };
        assert!(png.space.to_string().contains(part), "{}", png.space);
        // Its codes can still be normals.
        assert!(image.normals().is_ok(), "{part}");
        let plain = image.without_color_space();
        assert_eq!(
            plain.color().unwrap(),
            self::png(&CODES, &[]).color().unwrap()
        );
    }
}

#[test]
fn damaged_profiles_do_no_harm() {
    let whole = icc(ADOBE_RGB.columns, ADOBE_RGB.curve);
    for at in 0..whole.len() {
        for value in [0, 1, 0x7f, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] = value;
            if let Ok(colors) = png(&CODES, &[iccp(&bytes)]).color() {
                let mut parts = colors.pixels().iter().flat_map(|color| color.to_array());
                assert!(parts.all(f32::is_finite), "byte {at} as {value}");
            }
        }
    }
}

#[test]
fn gray_and_normals_stay_codes() {
    let chunks = [iccp(&icc(ADOBE_RGB.columns, ADOBE_RGB.curve))];
    let normals = png(&CODES, &chunks).normals().unwrap();
    assert_eq!(normals, png(&CODES, &[]).normals().unwrap());
    let gray = |chunks: &[Vec<u8>]| {
        let bytes = naive_png([3, 1], [8, 0, 0], chunks, &[0, 0, 51, 255]);
        decode_image(&bytes, &Limits::default()).unwrap()
    };
    let linear = [chunk(b"gAMA", &100_000_u32.to_be_bytes())];
    assert_eq!(gray(&linear).gray().unwrap().pixels(), [0.0, 0.2, 1.0]);
    assert_eq!(gray(&linear).color().unwrap(), gray(&[]).color().unwrap());
}

/// Returns Exif bytes with a color space and an interoperability rule.
fn exif(space: u16, rule: &[u8; 4]) -> Vec<u8> {
    let entry = |tag: u16, kind: u16, count: u32, value: [u8; 4]| {
        [
            tag.to_be_bytes().as_slice(),
            &kind.to_be_bytes(),
            &count.to_be_bytes(),
            &value,
        ]
        .concat()
    };
    let long = |place: u32| place.to_be_bytes();
    let [high, low] = space.to_be_bytes();
    let mut bytes = b"MM\0\x2a\0\0\0\x08".to_vec();
    // A directory takes 2 bytes, 12 for each entry, and 4 for the place of the next.
    bytes.extend([&[0, 1], entry(0x8769, 4, 1, long(26)).as_slice(), &[0; 4]].concat());
    bytes.extend([0, 2]);
    bytes.extend(entry(0xa001, 3, 1, [high, low, 0, 0]));
    bytes.extend(entry(0xa005, 4, 1, long(56)));
    bytes.extend([0; 4]);
    bytes.extend([&[0, 1], entry(1, 2, 4, *rule).as_slice(), &[0; 4]].concat());
    bytes
}

#[test]
fn exif_names_adobe_rgb() {
    let color = CODES[0];
    let plain = jpeg(color, None, None).color().unwrap();
    for (space, rule, is_adobe) in [
        (u16::MAX, b"R03\0", true),
        (2, b"R98\0", true),
        (1, b"R98\0", false),
        (u16::MAX, b"R98\0", false),
    ] {
        let found = jpeg(color, None, Some(&exif(space, rule))).color().unwrap();
        if is_adobe {
            // As above: the step of a code, times the matrix.
            assert_near(found.pixels()[20], ADOBE_RGB.light[0], 0.03, "Exif");
        } else {
            assert_eq!(found, plain, "{space}");
        }
    }
    let profile = icc(SRGB_COLUMNS, Curve::Srgb);
    let both = jpeg(color, Some(&profile), Some(&exif(u16::MAX, b"R03\0")));
    assert_eq!(both.color().unwrap(), plain, "the profile comes first");
}

/// Returns an OpenEXR image of one pixel with these chromaticities.
fn exr(parts: [f32; 3], chromaticities: [[f32; 2]; 4]) -> Image {
    let plane =
        |(name, value): (&str, f32)| ExrPlane::new(name, Raster::filled([1, 1], value).unwrap());
    let planes = ["R", "G", "B"].into_iter().zip(parts).chain([("A", 1.0)]);
    Image::Planes(
        Format::Exr,
        ExrImage {
            planes: planes.map(plane).collect(),
            chromaticities: Some(chromaticities),
            ..ExrImage::default()
        },
    )
}

#[test]
fn chromaticities_of_exr_are_read() {
    let third = 1.0 / 3.0;
    let xyz = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [third, third]];
    let bt2020 = [
        [0.708, 0.292],
        [0.17, 0.797],
        [0.131, 0.046],
        [0.3127, 0.329],
    ];
    let ap1 = [
        [0.713, 0.293],
        [0.165, 0.83],
        [0.128, 0.044],
        [0.32168, 0.33767],
    ];
    let bt709 = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]];
    for (parts, chromaticities, expected) in [
        ([0.412_391, 0.212_639, 0.019_331], xyz, [1.0, 0.0, 0.0]),
        ([0.627_404, 0.069_097, 0.016_391], bt2020, [1.0, 0.0, 0.0]),
        ([1.0, 0.0, 0.0], ap1, [1.705_05, -0.130_26, -0.024]),
        ([1.0, 1.0, 1.0], ap1, [1.0, 1.0, 1.0]),
        ([0.3, 0.2, 0.1], bt709, [0.3, 0.2, 0.1]),
    ] {
        let image = exr(parts, chromaticities);
        let color = image.color().unwrap().pixels()[0];
        // The constants have five or six digits.
        assert_near(color, expected, 1e-5, "chromaticities");
        assert_eq!(image.color_alpha().unwrap().pixels()[0].alpha, 1.0);
        let normals = image.normals().unwrap();
        assert_eq!(
            normals,
            exr(parts, bt709).normals().unwrap(),
            "vectors are no colors"
        );
    }
    let same = exr([0.3, 0.2, 0.1], bt709).color().unwrap();
    assert_eq!(same.pixels(), [LinearRgb::new(0.3, 0.2, 0.1)], "not a bit");
    let none = exr([0.3; 3], [[0.0; 2]; 4]).color().unwrap_err();
    assert!(
        matches!(none.kind(), ImageErrorKind::ColorSpace { .. }),
        "{none}"
    );
}
