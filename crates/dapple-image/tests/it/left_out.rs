//! Tests of formats whose codec is compiled out.

use dapple_image::{ImageErrorKind, Limits, decode_image};

/// Signatures of formats, and the start of the error message for each.
const LEFT_OUT: [(&[u8], &str); 5] = [
    (b"\x89PNG\r\n\x1a\n", "PNG without the feature `png`"),
    (b"\xff\xd8\xff", "JPEG without the feature `jpeg`"),
    (b"\x76\x2f\x31\x01", "OpenEXR without the feature `exr`"),
    (b"II*\0", "TIFF without the feature `tiff`"),
    (b"RIFF\0\0\0\0WEBP", "WebP without the feature `webp`"),
];

#[test]
fn a_format_whose_codec_is_left_out_is_named() {
    for (signature, format) in LEFT_OUT {
        let error = decode_image(signature, &Limits::default()).unwrap_err();
        assert!(error.to_string().starts_with(format), "{error}");
    }
    let error = decode_image(b"GIF89a", &Limits::default()).unwrap_err();
    assert_eq!(error.kind(), &ImageErrorKind::UnknownFormat);
}
