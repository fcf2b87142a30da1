//! Tests of images that declare their color space.

use crate::support::{Folder, assert_done, assert_refused, stdout};
use dapple::image::{Limits, Transfer, encode_png, read_image, replace};
use dapple::raster::Raster;

/// `cICP` chunks of PNG for Display P3, and for BT.2020 with PQ, with their checksums (CRC-32 of name and data).
const DISPLAY_P3: [u8; 16] = *b"\0\0\0\x04cICP\x0c\x0d\0\x01\x6e\x03\xe3\xef";
const PQ: [u8; 16] = *b"\0\0\0\x04cICP\x09\x10\0\x01\x4d\x23\x23\xfe";

/// Writes a PNG image of one color, and inserts a chunk after the header, which ends at byte 33.
fn write(folder: &Folder, name: &str, chunk: [u8; 16]) {
    let raster = Raster::filled([16, 16], [120_u8, 160, 90]).unwrap();
    let mut bytes = encode_png(raster.view(), Transfer::Data).unwrap();
    bytes.splice(33..33, chunk);
    replace(&folder.path(name), &bytes).unwrap();
}

#[test]
fn colors_are_read_as_the_file_declares() {
    let folder = Folder::new("declared");
    write(&folder, "p3.png", DISPLAY_P3);
    write(&folder, "pq.png", PQ);
    let info = folder.run(&["info", "p3.png"]);
    assert!(
        stdout(&info).contains("colors by cICP"),
        "{}",
        stdout(&info)
    );
    assert_done(&folder.run(&["blend", "p3.png", "-o", "o.png"]), "blend");
    let image = read_image(folder.path("o.png"), &Limits::default()).unwrap();
    let color = image.color().unwrap().pixels()[0].to_array();
    // Computed by NumPy; half a step of a code of 8 bits is at most 0.003 here.
    for (part, expected) in color.into_iter().zip([0.151, 0.35842, 0.08096]) {
        assert!((part - expected).abs() < 0.003, "{color:?}");
    }
    let info = folder.run(&["info", "pq.png"]);
    assert!(stdout(&info).contains("PQ"), "{}", stdout(&info));
    let refused = folder.run(&["blend", "pq.png", "-o", "pq_out.png"]);
    assert_refused(&refused, 1, "PQ", "blend");
}
