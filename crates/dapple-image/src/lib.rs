//! Image files: PNG with 8 or 16 bits, OpenEXR and JPEG, with typed errors and limits.
//!
//! This is the only crate of dapple that knows image formats. Data (heights, masks, normals) is written unchanged;
//! color is linear inside of dapple and in OpenEXR, and sRGB in PNG and JPEG. A file is written under a temporary name
//! and then renamed, so that half a file is never visible. Any bytes can be read: the result is an image or an
//! [`ImageError`], within the [`Limits`].
//!
//! | to write | in one call | with more choice |
//! |---|---|---|
//! | data from 0 to 1 | [`write_gray_png`], [`write_normal_png`] | [`write_png`], [`encode_png`] |
//! | color | [`write_color_png`], [`write_color_alpha_png`] | [`write_png`], [`encode_png`] |
//! | any numbers | [`write_gray_exr`], [`write_color_exr`], [`write_color_alpha_exr`] | [`write_exr`], [`encode_exr`] |
//!
//! An image that is too large for memory is written row by row with a [`RowWriter`], as PNG, as OpenEXR in tiles, as a
//! NumPy array or as raw heights, according to its [`Content`] and its [`Encoding`].
//!
//! [`read_image`] reads images back, including JPEG:
//!
//! ```no_run
//! use dapple_image::{Depth, Limits, read_image, write_gray_png};
//!
//! let height = read_image("height.exr", &Limits::default())?.gray()?;
//! write_gray_png("height.png", &height, Depth::Sixteen)?;
//! # Ok::<(), dapple_image::ImageError>(())
//! ```
//!
//! Each format is a feature of its own (`png`, `exr`, `jpeg`, all on by default) and adds its codec; other formats are
//! then errors that name the format.
//!
//! [`Image::format`], [`Image::channels`], [`Image::bits`] and [`Image::size`] describe the content of a file.

#![forbid(unsafe_code)]
#![cfg_attr(
    not(any(feature = "png", feature = "exr", feature = "jpeg")),
    expect(
        dead_code,
        reason = "without a format, what formats share is left over"
    )
)]

mod changes;
mod channels;
#[cfg_attr(
    all(
        any(feature = "png", feature = "exr", feature = "jpeg"),
        not(all(feature = "png", feature = "jpeg"))
    ),
    expect(
        dead_code,
        reason = "each format declares its colors in some of the ways"
    )
)]
mod color_space;
mod content;
mod error;
mod exr;
mod file;
mod header;
#[cfg(any(feature = "png", feature = "jpeg"))]
mod icc;
mod image;
#[cfg(feature = "jpeg")]
mod jpeg;
mod limits;
mod png;
mod raw;
mod rows;

pub use self::exr::{ExrImage, ExrPlane};
#[cfg(feature = "exr")]
pub use self::exr::{
    decode_exr, decode_exr_region, encode_exr, write_color_alpha_exr, write_color_exr, write_exr,
    write_gray_exr,
};
pub use self::image::{Image, decode_image, read_image};
#[cfg(feature = "jpeg")]
pub use self::jpeg::decode_jpeg;
pub use self::png::{PngImage, PngPixel, PngPixels, Transfer};
#[cfg(feature = "png")]
pub use self::png::{
    decode_png, decode_png_region, encode_png, write_color_alpha_png, write_color_png,
    write_gray_png, write_normal_png, write_png,
};
pub use changes::{FileChanges, FileStamp};
pub use channels::Channels;
pub use color_space::ColorSpace;
pub use content::{Content, Depth, Encoding};
pub use dapple_color as color;
pub use dapple_raster as raster;
pub use error::{ImageError, ImageErrorKind};
pub use file::{AtomicFile, open_regular, remove_left_behind, replace, sync_folder};
pub use header::{ImageHeader, read_header};
pub use limits::Limits;
pub use raw::{decode_npy, decode_r16};
pub use rows::RowWriter;
