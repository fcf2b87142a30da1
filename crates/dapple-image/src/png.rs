//! PNG files: the pixels they hold, writing and reading.
//!
//! The format is that of the W3C recommendation "Portable Network Graphics (PNG) Specification (Third Edition)", 2025,
//! <https://www.w3.org/TR/png-3/>; the codec is the crate `png`.

mod decode;
mod encode;
mod pixel;
mod stream;
mod values;

pub use decode::{PngImage, PngPixels, decode_png};
pub use encode::{encode_png, write_png};
pub use pixel::PngPixel;
pub(crate) use stream::PngStream;

/// The bytes that every PNG file begins with.
pub(crate) const SIGNATURE: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];

/// The `gAMA` of sRGB, 0.45455 times 100 000, as the specification has it.
const GAMMA_OF_SRGB: u32 = 45_455;

/// What the numbers in an 8- or 16-bit file mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Transfer {
    /// Values as they are: heights, masks, normals. The file says nothing about color.
    Data,
    /// Colors under the sRGB curve. The file says so.
    Srgb,
}

#[cfg(test)]
mod tests;
