//! Tests of the reported channels of images.

use dapple_image::{
    Channels, ColorSpace, ExrImage, ExrPlane, Format, Image, Limits, PngImage, PngPixel, PngPixels,
    Transfer, decode_image, encode_png,
};
use dapple_raster::Raster;

#[test]
fn files_say_what_they_hold() {
    fn check<P: PngPixel>(pixel: P, channels: Channels, bits: u32) {
        let raster = Raster::filled([2, 3], pixel).unwrap();
        let bytes = encode_png(raster.view(), Transfer::Data).unwrap();
        let image = decode_image(&bytes, &Limits::default()).unwrap();
        let found = (image.format(), image.channels(), image.bits());
        assert_eq!(found, ("PNG", channels, bits), "{channels}");
    }
    check(1_u8, Channels::Gray, 8);
    check(1_u16, Channels::Gray, 16);
    check([1_u8; 2], Channels::GrayAlpha, 8);
    check([1_u16; 2], Channels::GrayAlpha, 16);
    check([1_u8; 3], Channels::Rgb, 8);
    check([1_u16; 3], Channels::Rgb, 16);
    check([1_u8; 4], Channels::Rgba, 8);
    check([1_u16; 4], Channels::Rgba, 16);
    let pixels = PngPixels::Gray8(Raster::filled([1, 1], 0).unwrap());
    let transfer = Transfer::Srgb;
    let photo = Image::Codes(
        Format::Jpeg,
        PngImage {
            pixels,
            transfer,
            space: ColorSpace::default(),
        },
    );
    assert_eq!((photo.format(), photo.bits()), ("JPEG", 8), "a photograph");
}

#[test]
fn planes_are_known_by_their_names() {
    for (names, channels) in [
        (["Y"].as_slice(), Channels::Gray),
        (&["height"], Channels::Gray),
        (&["B", "G", "R"], Channels::Rgb),
        (&["A", "B", "G", "R"], Channels::Rgba),
        (&["B", "G"], Channels::Planes),
        (&["X", "Y2", "Z"], Channels::Planes),
    ] {
        let plane = |name: &&str| ExrPlane::new(*name, Raster::filled([1, 1], 0.0).unwrap());
        let planes = names.iter().map(plane).collect();
        let image = Image::Planes(
            Format::Exr,
            ExrImage {
                planes,
                ..ExrImage::default()
            },
        );
        let found = (image.format(), image.channels(), image.bits());
        assert_eq!(found, ("OpenEXR", channels, 32), "{names:?}");
        let has_alpha = channels == Channels::Rgba;
        assert_eq!(channels.has_alpha(), has_alpha, "{names:?}");
    }
}
