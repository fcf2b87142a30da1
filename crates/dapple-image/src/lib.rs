//! Image files: PNG with 8 or 16 bits and OpenEXR, with typed errors and limits.
//!
//! This is the only crate of dapple that knows an image format. Data (heights, masks, normals) is written as it is;
//! color is linear inside of dapple and in OpenEXR, and sRGB in PNG. A file is written under a temporary name and then
//! renamed, so that half a file is never seen. Whatever the bytes that are read: the result is an image or an
//! [`ImageError`], within the [`Limits`].

#![forbid(unsafe_code)]

mod error;
mod exr;
mod file;
mod image;
mod limits;
mod png;
mod shortcut;

pub use self::exr::{ExrImage, ExrPlane, decode_exr, encode_exr, write_exr};
pub use self::image::{Image, decode_image, read_image};
pub use self::png::{PngImage, PngPixel, PngPixels, Transfer, decode_png, encode_png, write_png};
pub use error::{ImageError, ImageErrorKind};
pub use limits::Limits;
pub use shortcut::{Depth, write_color_alpha_png, write_color_png, write_gray_png};
