//! PNG encoder and decoder.
//!
//! The format is defined in the W3C recommendation "Portable Network Graphics (PNG) Specification (Third Edition)",
//! 2025, <https://www.w3.org/TR/png-3/>; files are decoded by the crate `png`.

#[cfg(feature = "png")]
mod decode;
#[cfg(feature = "png")]
mod encode;
#[cfg(feature = "png")]
mod filter;
mod image;
mod pixel;
#[cfg(feature = "png")]
mod shortcut;
#[cfg(feature = "png")]
mod space;
#[cfg(feature = "png")]
mod stream;
mod values;

#[cfg(feature = "png")]
pub use decode::{decode_png, decode_png_region};
#[cfg(feature = "png")]
pub use encode::{encode_png, write_png};
pub use image::{PngImage, PngPixels};
pub use pixel::PngPixel;
#[cfg(feature = "png")]
pub use shortcut::{write_color_alpha_png, write_color_png, write_gray_png, write_normal_png};
#[cfg(feature = "png")]
pub(crate) use stream::{PngStream, Samples};

/// `gAMA` value of sRGB in the specification: 0.45455 times 100 000.
#[cfg(feature = "png")]
const GAMMA_OF_SRGB: u32 = 45_455;

/// Transfer curve of the codes in an 8- or 16-bit file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Transfer {
    /// Unchanged values: heights, masks, normals. The file has no color chunk.
    Data,
    /// Colors encoded with the sRGB curve. The file has a chunk that declares it.
    Srgb,
}
