//! Tests of the row writer against the writers of whole images, and of its errors.
//!
//! Reference: for the bytes of tiles, Academy Software Foundation, "OpenEXR File Layout", <https://openexr.com>.

use crate::pixel::Pixel;
use dapple_color::{LinearRgb, LinearRgba, Normal};
use dapple_image::{
    Content, Depth, Encoding, ExrPlane, Image, ImageError, ImageErrorKind, Limits, RowWriter,
    Transfer, decode_exr, decode_image, encode_png,
};
use dapple_raster::Raster;
use proptest::prelude::*;
use std::io::{self, Cursor, Seek, SeekFrom, Write};

const ENCODINGS: [Encoding; 4] = [
    Encoding::Png(Depth::Eight),
    Encoding::Png(Depth::Sixteen),
    Encoding::Exr,
    Encoding::Npy,
];

fn gray(size: [u32; 2]) -> Raster<f32> {
    Raster::from_fn(size, |x, y| {
        ((x * 7919 + y * 104_729) % 1009) as f32 / 1008.0
    })
    .unwrap()
}

fn colors(size: [u32; 2]) -> Raster<LinearRgb> {
    gray(size).map(|&value| LinearRgb::new(value, 1.0 - value, 0.5 * value))
}

fn covered(size: [u32; 2]) -> Raster<LinearRgba> {
    colors(size).map(|&color| LinearRgba {
        color,
        alpha: color.g,
    })
}

fn normals(size: [u32; 2]) -> Raster<Normal> {
    gray(size).map(|&x| Normal {
        x,
        y: -0.25,
        z: 1.0 - x,
    })
}

/// Encodes an image in bands. Their heights are `heights`, repeated.
fn encode<T: Pixel>(image: &Raster<T>, encoding: Encoding, heights: &[u32]) -> Vec<u8> {
    let [width, height] = image.size();
    let sink = Cursor::new(Vec::new());
    let mut writer = RowWriter::new(sink, image.size(), T::CONTENT, encoding).unwrap();
    let mut row = 0;
    for &band in heights.iter().cycle() {
        let band = band.min(height - row);
        let rows = image.view().crop([0, row], [width, band]).unwrap();
        T::write(&mut writer, rows).unwrap();
        row += band;
        if row == height {
            break;
        }
    }
    writer.finish().unwrap().into_inner()
}

fn check_png<T: Pixel>(image: &Raster<T>, heights: &[u32]) {
    let transfer = match T::CONTENT {
        Content::Color | Content::ColorAlpha => Transfer::Srgb,
        _ => Transfer::Data,
    };
    let eight = encode_png(image.map(T::eight).view(), transfer).unwrap();
    let sixteen = encode_png(image.map(T::sixteen).view(), transfer).unwrap();
    for (depth, whole) in [(Depth::Eight, eight), (Depth::Sixteen, sixteen)] {
        let bytes = encode(image, Encoding::Png(depth), heights);
        assert!(bytes == whole, "{:?} {depth:?} {heights:?}", image.size());
    }
}

fn check_exr<T: Pixel>(image: &Raster<T>, heights: &[u32], planes: &[ExrPlane]) {
    let bytes = encode(image, Encoding::Exr, heights);
    let mut found = decode_exr(&bytes, &Limits::default()).unwrap().planes;
    found.reverse();
    assert!(found == planes, "{:?} {heights:?}", image.size());
}

#[test]
fn rows_equal_the_whole_image_for_odd_sizes_and_bands() {
    for size in [[1, 1], [1, 130], [130, 1], [63, 65], [64, 64], [150, 129]] {
        for heights in [[1, 1], [7, 64], [1000, 1]] {
            check_png(&gray(size), &heights);
            check_png(&colors(size), &heights);
            check_png(&covered(size), &heights);
            check_png(&normals(size), &heights);
            check_exr(&gray(size), &heights, &[ExrPlane::new("Y", gray(size))]);
            check_exr(
                &colors(size),
                &heights,
                &ExrPlane::from_colors(&colors(size)),
            );
            let planes = ExrPlane::from_colors_with_alpha(&covered(size));
            check_exr(&covered(size), &heights, &planes);
            let half = normals(size).map(|&Normal { x, y, z }| {
                let [r, g, b] = [x, y, z].map(|part| part * 0.5 + 0.5);
                LinearRgb { r, g, b }
            });
            check_exr(&normals(size), &heights, &ExrPlane::from_colors(&half));
        }
    }
}

#[test]
fn public_methods_write_their_content() {
    let size = [5, 3];
    for encoding in ENCODINGS {
        let start =
            |content| RowWriter::new(Cursor::new(Vec::new()), size, content, encoding).unwrap();
        let check = |writer: RowWriter<Cursor<Vec<u8>>>, expected: Vec<u8>| {
            assert!(
                writer.finish().unwrap().into_inner() == expected,
                "{encoding:?}"
            );
        };
        let mut writer = start(Content::Gray);
        writer.write_gray(gray(size).view()).unwrap();
        check(writer, encode(&gray(size), encoding, &[3]));
        let mut writer = start(Content::Color);
        writer.write_color(colors(size).view()).unwrap();
        check(writer, encode(&colors(size), encoding, &[3]));
        let mut writer = start(Content::ColorAlpha);
        writer.write_color_alpha(covered(size).view()).unwrap();
        check(writer, encode(&covered(size), encoding, &[3]));
        let mut writer = start(Content::Normal);
        writer.write_normals(normals(size).view()).unwrap();
        check(writer, encode(&normals(size), encoding, &[3]));
    }
}

#[test]
fn every_number_survives_in_tiles_bit_for_bit() {
    let odd = [f32::NAN, f32::INFINITY, -0.0, 1e-45, f32::MAX];
    let values = Raster::from_fn([70, 66], |x, y| odd[((x + y) % 5) as usize]).unwrap();
    let bytes = encode(&values, Encoding::Exr, &[5]);
    let found = decode_exr(&bytes, &Limits::default()).unwrap();
    let bits = |raster: &Raster<f32>| raster.map(|value| value.to_bits());
    assert_eq!(bits(found.gray().unwrap()), bits(&values), "all bits");
}

#[test]
fn value_stability_exr_tiles() {
    let bytes = encode(
        &Raster::filled([2, 1], 1.0_f32).unwrap(),
        Encoding::Exr,
        &[1],
    );
    assert_eq!(
        bytes[..8],
        [0x76, 0x2f, 0x31, 0x01, 2, 2, 0, 0],
        "one part in tiles"
    );
    // The bytes of both numbers are 0, 0, 128, 63; all even ones and then all odd ones are 0, 128, 0, 128, 0, 63, 0, 63; the
    // steps between them, plus 128, are five times 0 (a run, of 4 + 1) and 191, 65, 191 (-3 for three as they are).
    let runs = [4, 0, 253, 191, 65, 191];
    // Before them stand tile and level, and the length.
    let tile = [vec![0; 16], vec![6, 0, 0, 0], runs.to_vec()].concat();
    let start = bytes.len() - tile.len();
    assert_eq!(bytes[start..], tile, "the only tile");
    let place = (start as u64).to_le_bytes();
    assert_eq!(bytes[start - 8..start], place, "the table");
}

#[test]
fn rows_that_do_not_fit_are_refused_and_do_no_harm() {
    let image = gray([6, 5]);
    let sink = || Cursor::new(Vec::new());
    for encoding in ENCODINGS {
        let mut writer = RowWriter::new(sink(), [6, 5], Content::Gray, encoding).unwrap();
        let kind = |result: Result<(), ImageError>| result.unwrap_err().kind().clone();
        writer
            .write_gray(image.view().crop([0, 0], [6, 3]).unwrap())
            .unwrap();
        let refused = kind(writer.write_gray(gray([7, 1]).view()));
        let expected = ImageErrorKind::RowWidth {
            width: 7,
            needed: 6,
        };
        assert_eq!(refused, expected, "{encoding:?}");
        let refused = kind(writer.write_gray(gray([6, 3]).view()));
        let expected = ImageErrorKind::TooManyRows { rows: 6, needed: 5 };
        assert_eq!(refused, expected, "{encoding:?}");
        let refused = kind(writer.write_color(colors([6, 1]).view()));
        let expected = ImageErrorKind::Channels {
            found: "RGB",
            needed: "gray",
        };
        assert_eq!(refused, expected, "{encoding:?}");
        writer
            .write_gray(image.view().crop([0, 3], [6, 2]).unwrap())
            .unwrap();
        let bytes = writer.finish().unwrap().into_inner();
        assert_eq!(bytes, encode(&image, encoding, &[5]), "{encoding:?}");
    }
}

#[test]
fn missing_rows_are_refused() {
    for encoding in ENCODINGS {
        let sink = Cursor::new(Vec::new());
        let mut writer = RowWriter::new(sink, [4, 100], Content::Gray, encoding).unwrap();
        writer.write_gray(gray([4, 99]).view()).unwrap();
        let error = writer.finish().unwrap_err();
        let expected = ImageErrorKind::MissingRows {
            rows: 99,
            needed: 100,
        };
        assert_eq!(error.kind(), &expected, "{encoding:?}");
    }
}

#[test]
fn sizes_that_do_not_fit_are_refused() {
    let kind = |size, encoding| {
        let sink = Cursor::new(Vec::new());
        let writer = RowWriter::new(sink, size, Content::Color, encoding);
        writer.map(|_| ()).map_err(|error| error.kind().clone())
    };
    for encoding in ENCODINGS {
        for size in [[0, 3], [3, 0]] {
            let expected = ImageErrorKind::Empty {
                size: size.map(u64::from),
            };
            assert_eq!(kind(size, encoding), Err(expected), "{encoding:?}");
        }
        let limit = match encoding {
            Encoding::Png(_) => 0x7fff_ffff,
            Encoding::Exr => 0x3fff_fffe,
            // Any size that a `u32` has.
            _ => continue,
        };
        for size in [[limit + 1, 1], [1, limit + 1], [u32::MAX, u32::MAX]] {
            let refused = kind(size, encoding).unwrap_err();
            assert!(
                matches!(refused, ImageErrorKind::TooLarge { limit: found, .. } if found == limit),
                "{encoding:?} {refused}"
            );
        }
        assert_eq!(kind([1 << 16, 1 << 16], encoding), Ok(()), "{encoding:?}");
        assert_eq!(kind([1, limit], encoding), Ok(()), "{encoding:?}");
        let widest = kind([limit, limit], encoding).unwrap_err();
        assert!(
            matches!(
                widest,
                ImageErrorKind::TooManyBytes { .. } | ImageErrorKind::Unsupported { .. }
            ),
            "{encoding:?} {widest}"
        );
    }
}

/// A sink that accepts some bytes and then fails.
#[derive(Debug)]
struct Full {
    bytes: Cursor<Vec<u8>>,
    limit: u64,
}

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.bytes.position() + bytes.len() as u64 > self.limit {
            return Err(io::Error::from(io::ErrorKind::StorageFull));
        }
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Full {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

#[test]
fn a_sink_that_fails_at_any_byte_gives_an_error_and_never_a_file() {
    let image = gray([65, 70]);
    for encoding in ENCODINGS {
        let whole = encode(&image, encoding, &[9]).len() as u64;
        for limit in (0..whole).step_by(13) {
            let bytes = Cursor::new(Vec::new());
            let result = RowWriter::new(Full { bytes, limit }, [65, 70], Content::Gray, encoding);
            let Ok(mut writer) = result else { continue };
            let first = writer.write_gray(image.view());
            if first.is_err() {
                let again = writer.write_gray(image.view()).unwrap_err();
                assert_eq!(again.kind(), &ImageErrorKind::Io, "{encoding:?} {limit}");
            }
            let error = writer.finish().unwrap_err();
            assert_eq!(error.kind(), &ImageErrorKind::Io, "{encoding:?} {limit}");
        }
    }
}

#[test]
fn a_file_of_rows_says_what_it_is() {
    let read = |bytes: &[u8]| decode_image(bytes, &Limits::default()).unwrap();
    let png = Encoding::Png(Depth::Eight);
    for (bytes, transfer) in [
        (encode(&gray([3, 3]), png, &[1]), Transfer::Data),
        (encode(&normals([3, 3]), png, &[1]), Transfer::Data),
        (encode(&colors([3, 3]), png, &[1]), Transfer::Srgb),
        (encode(&covered([3, 3]), png, &[1]), Transfer::Srgb),
    ] {
        let Image::Codes(_, image) = read(&bytes) else {
            panic!("the file is not PNG");
        };
        assert_eq!(image.transfer, transfer, "the chunk for color");
    }
    let color = read(&encode(&colors([70, 3]), Encoding::Exr, &[1]));
    assert_eq!(color.color().unwrap(), colors([70, 3]), "linear");
}

proptest! {
    #[test]
    fn bands_of_any_height_make_the_same_bytes(
        size in [1_u32..140, 1_u32..140],
        heights in proptest::collection::vec(1_u32..80, 1..5),
    ) {
        let image = colors(size);
        for encoding in ENCODINGS {
            let whole = encode(&image, encoding, &[size[1]]);
            prop_assert!(encode(&image, encoding, &heights) == whole, "{encoding:?}");
        }
    }
}
