//! The channels of an image, its format and its depth, for reports and decisions.

use crate::{ExrImage, Image, PngImage, PngPixels};
use core::fmt;

/// The channels of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Channels {
    /// One number: [`Image::gray`] reads it.
    Gray,
    /// One number and alpha.
    GrayAlpha,
    /// Red, green and blue: [`Image::color`] reads them.
    Rgb,
    /// Red, green, blue and alpha: [`Image::color_alpha`] reads them.
    Rgba,
    /// Planes of an OpenEXR file with other names: [`ExrImage::plane`] reads them.
    Planes,
}

impl Channels {
    /// Whether there is an alpha channel.
    #[must_use]
    pub const fn has_alpha(self) -> bool {
        matches!(self, Self::GrayAlpha | Self::Rgba)
    }
}

impl fmt::Display for Channels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gray => "gray",
            Self::GrayAlpha => "gray with alpha",
            Self::Rgb => "RGB",
            Self::Rgba => "RGB with alpha",
            Self::Planes => "named planes",
        })
    }
}

impl Image {
    /// The name of the format: `PNG`, `JPEG` or `OpenEXR`.
    #[must_use]
    pub const fn format(&self) -> &'static str {
        match self {
            Self::Png(_) => "PNG",
            Self::Jpeg(_) => "JPEG",
            Self::Exr(_) => "OpenEXR",
        }
    }

    /// The channels that the file has.
    #[must_use]
    pub fn channels(&self) -> Channels {
        match self {
            Self::Png(image) | Self::Jpeg(image) => image.channels(),
            Self::Exr(image) => image.channels(),
        }
    }

    /// The bits of a channel: 8 or 16, and 32 for OpenEXR, whose numbers are all read as `f32`.
    #[must_use]
    pub const fn bits(&self) -> u32 {
        match self {
            Self::Png(image) | Self::Jpeg(image) => image.bits(),
            Self::Exr(_) => 32,
        }
    }
}

impl PngImage {
    fn channels(&self) -> Channels {
        match self.pixels {
            PngPixels::Gray8(_) | PngPixels::Gray16(_) => Channels::Gray,
            PngPixels::GrayAlpha8(_) | PngPixels::GrayAlpha16(_) => Channels::GrayAlpha,
            PngPixels::Rgb8(_) | PngPixels::Rgb16(_) => Channels::Rgb,
            PngPixels::Rgba8(_) | PngPixels::Rgba16(_) => Channels::Rgba,
        }
    }

    const fn bits(&self) -> u32 {
        match self.pixels {
            PngPixels::Gray8(_)
            | PngPixels::GrayAlpha8(_)
            | PngPixels::Rgb8(_)
            | PngPixels::Rgba8(_) => u8::BITS,
            PngPixels::Gray16(_)
            | PngPixels::GrayAlpha16(_)
            | PngPixels::Rgb16(_)
            | PngPixels::Rgba16(_) => u16::BITS,
        }
    }
}

impl ExrImage {
    fn channels(&self) -> Channels {
        let layer = self.color_layer();
        let has = |channel: &str| self.has(&format!("{layer}{channel}"));
        let has_alpha = has("A");
        if ["R", "G", "B"].iter().all(|name| has(name)) {
            if has_alpha {
                Channels::Rgba
            } else {
                Channels::Rgb
            }
        } else if self.gray().is_ok() {
            Channels::Gray
        } else {
            Channels::Planes
        }
    }
}

#[cfg(all(test, feature = "png"))]
mod tests {
    use crate::{
        Channels, ExrImage, ExrPlane, Image, PngImage, PngPixel, PngPixels, Transfer, decode_image,
        encode_png,
    };
    use dapple_raster::Raster;

    #[test]
    fn files_say_what_they_hold() {
        fn check<P: PngPixel>(pixel: P, channels: Channels, bits: u32) {
            let raster = Raster::filled([2, 3], pixel).unwrap();
            let bytes = encode_png(raster.view(), Transfer::Data).unwrap();
            let image = decode_image(&bytes, &crate::Limits::default()).unwrap();
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
        let photo = Image::Jpeg(PngImage { pixels, transfer });
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
            let image = Image::Exr(ExrImage { planes });
            let found = (image.format(), image.channels(), image.bits());
            assert_eq!(found, ("OpenEXR", channels, 32), "{names:?}");
            let has_alpha = channels == Channels::Rgba;
            assert_eq!(channels.has_alpha(), has_alpha, "{names:?}");
        }
    }
}
