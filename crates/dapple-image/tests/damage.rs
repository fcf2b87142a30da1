//! Tests of damaged files in every format. They must give an image within the limits or an error, without a panic and
//! with little memory. This is a separate binary because it measures its peak memory.

use dapple_image::{
    Content, Depth, Encoding, ExrPlane, Limits, RowWriter, Transfer, decode_image, encode_exr,
    encode_png,
};
use dapple_raster::Raster;
use image_webp::WebPEncoder;
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::io::Cursor;
use tiff::encoder::colortype::{Gray32Float, RGBA8};
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder};

/// The limits for reading a damaged file.
const LIMITS: Limits = Limits {
    pixels: 1 << 16,
    bytes: 1 << 20,
};

/// Maximum additional memory for reading, in bytes. It is larger than the limit on pixels because codecs need tables
/// and copies, but not by orders of magnitude.
const MEMORY: u64 = 48 << 20;

/// Returns complete files, small enough that most changes hit an important part.
fn files() -> Vec<Vec<u8>> {
    let size = [21, 18];
    let gray = Raster::from_fn(size, |x, y| (x * 5 + y * 7) as f32 / 255.0).unwrap();
    let codes = gray.map(|&value| (255.0 * value) as u8);
    let colors = codes.map(|&code| [code, 255 - code, 7, code / 2]);
    let planes = [
        ExrPlane::new("Y", gray.clone()),
        ExrPlane::new("Z", gray.clone()),
    ];
    let mut files = vec![
        encode_png(codes.view(), Transfer::Data).unwrap(),
        encode_png(colors.view(), Transfer::Srgb).unwrap(),
        encode_exr(&planes).unwrap(),
    ];
    for encoding in [Encoding::Png(Depth::Sixteen), Encoding::Exr] {
        let sink = Cursor::new(Vec::new());
        let mut writer = RowWriter::new(sink, size, Content::Gray, encoding).unwrap();
        writer.write_gray(gray.view()).unwrap();
        files.push(writer.finish().unwrap().into_inner());
    }
    for (is_progressive, restart, sampling) in [
        (false, 0, SamplingFactor::F_1_1),
        (false, 1, SamplingFactor::F_2_2),
        (true, 0, SamplingFactor::F_2_1),
        (true, 1, SamplingFactor::F_1_1),
    ] {
        let samples: Vec<u8> = colors
            .pixels()
            .iter()
            .flat_map(|&[r, g, b, _]| [r, g, b])
            .collect();
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, 80);
        encoder.set_progressive(is_progressive);
        encoder.set_restart_interval(restart);
        encoder.set_sampling_factor(sampling);
        encoder.encode(&samples, 21, 18, ColorType::Rgb).unwrap();
        files.push(bytes);
    }
    files.extend(other_files(gray.pixels(), colors.pixels().as_flattened()));
    files
}

/// Returns complete files of the formats that are only read.
fn other_files(gray: &[f32], rgba: &[u8]) -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    for compression in [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Packbits,
    ] {
        let mut sink = Cursor::new(Vec::new());
        let encoder = TiffEncoder::new(&mut sink).unwrap();
        let mut encoder = encoder.with_compression(compression);
        encoder.write_image::<RGBA8>(21, 18, rgba).unwrap();
        files.push(sink.into_inner());
    }
    let mut sink = Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut sink).unwrap();
    let mut encoder = encoder.with_compression(Compression::Deflate(DeflateLevel::Fast));
    encoder.write_image::<Gray32Float>(21, 18, gray).unwrap();
    files.push(sink.into_inner());
    let mut bytes = Vec::new();
    let encoder = WebPEncoder::new(&mut bytes);
    encoder
        .encode(rgba, 21, 18, image_webp::ColorType::Rgba8)
        .unwrap();
    files.push(bytes);
    // Run-length encoded rows of TGA, and scan lines of Radiance HDR by channel.
    let tga = [0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 21, 0, 18, 0, 32, 40];
    let rows = [[148, 1, 2, 3, 4]; 18];
    files.push([tga.as_slice(), rows.as_flattened()].concat());
    let lines = [[2, 2, 0, 21, 149, 9, 149, 9, 149, 9, 149, 130]; 18];
    let start = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 18 +X 21\n";
    files.push([start.as_slice(), lines.as_flattened()].concat());
    files
}

/// A change to a file, at a fraction of its length.
#[derive(Clone, Debug)]
enum Change {
    Set(f64, u8),
    Flip(f64, u8),
    Insert(f64, u8),
    Remove(f64, usize),
    Repeat(f64, usize),
    Cut(f64),
}

fn change() -> impl Strategy<Value = Change> {
    let part = || 0.0..1.0;
    let byte = || {
        prop_oneof![
            any::<u8>(),
            prop::sample::select(vec![0, 1, 0x7f, 0x80, 0xff])
        ]
    };
    prop_oneof![
        4 => (part(), byte()).prop_map(|(at, byte)| Change::Set(at, byte)),
        4 => (part(), 0_u8..8).prop_map(|(at, bit)| Change::Flip(at, bit)),
        1 => (part(), byte()).prop_map(|(at, byte)| Change::Insert(at, byte)),
        1 => (part(), 1_usize..30).prop_map(|(at, n)| Change::Remove(at, n)),
        1 => (part(), 1_usize..30).prop_map(|(at, n)| Change::Repeat(at, n)),
        1 => (0.5..1.0).prop_map(Change::Cut),
    ]
}

fn apply(change: &Change, bytes: &mut Vec<u8>) {
    let length = bytes.len();
    let at = |part: f64| (part * length as f64) as usize;
    match *change {
        _ if length == 0 => (),
        Change::Set(part, byte) => bytes[at(part)] = byte,
        Change::Flip(part, bit) => bytes[at(part)] ^= 1 << bit,
        Change::Insert(part, byte) => bytes.insert(at(part), byte),
        Change::Remove(part, n) => drop(bytes.drain(at(part)..length.min(at(part) + n))),
        Change::Repeat(part, n) => bytes.extend_from_within(at(part)..length.min(at(part) + n)),
        Change::Cut(part) => bytes.truncate(at(part)),
    }
}

/// Returns the peak memory of this process so far, in bytes; `None` if the system does not report it.
#[expect(clippy::disallowed_methods, reason = "the test asks the system")]
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let number: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(number << 10)
}

#[test]
fn damaged_files_give_an_image_within_the_limits_or_an_error() {
    let files = files();
    for bytes in &files {
        assert_eq!(
            decode_image(bytes, &LIMITS).unwrap().size(),
            [21, 18],
            "a whole file"
        );
    }
    let before = peak();
    let changes = (0..files.len(), proptest::collection::vec(change(), 1..6));
    let mut runner = TestRunner::new(ProptestConfig::with_cases(20_000));
    runner
        .run(&changes, |(file, changes)| {
            let mut bytes = files[file].clone();
            changes.iter().for_each(|change| apply(change, &mut bytes));
            if let Ok(image) = decode_image(&bytes, &LIMITS) {
                let [width, height] = image.size().map(u64::from);
                prop_assert!(width * height <= LIMITS.pixels, "{width} × {height}");
            }
            Ok(())
        })
        .unwrap();
    match before.zip(peak()) {
        Some((before, peak)) => assert!(peak - before < MEMORY, "{before} and {peak} bytes"),
        None => println!("skipped: this system does not say how much memory was taken"),
    }
}
