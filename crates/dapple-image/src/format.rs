//! Formats of image files, which are recognized by their first bytes.

use crate::{Image, ImageError, ImageErrorKind, Limits, hdr, tga};
use core::fmt;

/// Format of an image file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// PNG: codes of 8 or 16 bits.
    Png,
    /// JPEG: codes of 8 bits.
    Jpeg,
    /// OpenEXR: floating-point planes.
    Exr,
    /// TIFF: codes of 8 or 16 bits, or floating-point planes.
    Tiff,
    /// WebP: codes of 8 bits.
    WebP,
    /// Radiance HDR: floating-point planes.
    Hdr,
    /// Truevision TGA: codes of 8 bits.
    Tga,
}

/// Entry of the table of formats.
struct Entry {
    format: Format,
    name: &'static str,
    recognizes: fn(&[u8]) -> bool,
}

/// All formats, in the order of [`Format`]. TGA comes last, because it has no signature.
const FORMATS: [Entry; 7] = [
    Entry {
        format: Format::Png,
        name: "PNG",
        recognizes: |bytes| bytes.starts_with(b"\x89PNG\r\n\x1a\n"),
    },
    Entry {
        format: Format::Jpeg,
        name: "JPEG",
        recognizes: |bytes| bytes.starts_with(b"\xff\xd8\xff"),
    },
    Entry {
        format: Format::Exr,
        name: "OpenEXR",
        recognizes: |bytes| bytes.starts_with(b"\x76\x2f\x31\x01"),
    },
    Entry {
        format: Format::Tiff,
        name: "TIFF",
        // Both byte orders, of TIFF and of BigTIFF.
        recognizes: |bytes| {
            let signatures = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
            signatures
                .iter()
                .any(|&signature| bytes.starts_with(signature))
        },
    },
    Entry {
        format: Format::WebP,
        name: "WebP",
        recognizes: |bytes| bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP"),
    },
    Entry {
        format: Format::Hdr,
        name: "Radiance HDR",
        recognizes: hdr::has_signature,
    },
    Entry {
        format: Format::Tga,
        name: "TGA",
        recognizes: tga::has_header,
    },
];

impl Format {
    /// Recognizes the format of a file by its first bytes; 32 suffice.
    pub(crate) fn of(bytes: &[u8]) -> Result<Self, ImageError> {
        let mut entries = FORMATS.iter();
        let entry = entries.find(|entry| (entry.recognizes)(bytes));
        entry
            .map(|entry| entry.format)
            .ok_or_else(|| ImageError::new(ImageErrorKind::UnknownFormat))
    }

    /// Checks that the bytes are of this format.
    #[cfg(any(feature = "png", feature = "jpeg", feature = "exr"))]
    pub(crate) fn check(self, bytes: &[u8]) -> Result<(), ImageError> {
        if (FORMATS[self as usize].recognizes)(bytes) {
            Ok(())
        } else {
            Err(ImageError::new(ImageErrorKind::UnknownFormat))
        }
    }

    /// Returns the name of the format, such as `PNG` or `OpenEXR`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        FORMATS[self as usize].name
    }

    /// Decodes a file of this format.
    pub(crate) fn decode(self, bytes: &[u8], limits: &Limits) -> Result<Image, ImageError> {
        match self {
            #[cfg(feature = "png")]
            Self::Png => crate::decode_png(bytes, limits).map(|image| Image::Codes(self, image)),
            #[cfg(not(feature = "png"))]
            Self::Png => Err(left_out("PNG without the feature `png`")),
            #[cfg(feature = "jpeg")]
            Self::Jpeg => crate::decode_jpeg(bytes, limits).map(|image| Image::Codes(self, image)),
            #[cfg(not(feature = "jpeg"))]
            Self::Jpeg => Err(left_out("JPEG without the feature `jpeg`")),
            #[cfg(feature = "exr")]
            Self::Exr => crate::decode_exr(bytes, limits).map(|image| Image::Planes(self, image)),
            #[cfg(not(feature = "exr"))]
            Self::Exr => Err(left_out("OpenEXR without the feature `exr`")),
            #[cfg(feature = "tiff")]
            Self::Tiff => crate::tiff::decode(bytes, limits),
            #[cfg(not(feature = "tiff"))]
            Self::Tiff => Err(left_out("TIFF without the feature `tiff`")),
            #[cfg(feature = "webp")]
            Self::WebP => crate::webp::decode(bytes, limits).map(|image| Image::Codes(self, image)),
            #[cfg(not(feature = "webp"))]
            Self::WebP => Err(left_out("WebP without the feature `webp`")),
            Self::Hdr => hdr::decode(bytes, limits).map(|image| Image::Planes(self, image)),
            Self::Tga => tga::decode(bytes, limits).map(|image| Image::Codes(self, image)),
        }
    }
}

/// Creates the error for a format whose codec is compiled out.
#[cfg(not(all(
    feature = "png",
    feature = "jpeg",
    feature = "exr",
    feature = "tiff",
    feature = "webp"
)))]
fn left_out(feature: &'static str) -> ImageError {
    ImageError::new(ImageErrorKind::Unsupported { feature })
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
