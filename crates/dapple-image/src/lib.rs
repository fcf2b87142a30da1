//! Image files for textures: PNG with 8 or 16 bits and OpenEXR, and JPEG, TIFF, WebP, TGA and Radiance HDR (reading),
//! with typed errors and limits. Images larger than memory are written row by row.
//!
//! ```no_run
//! use dapple_image::{Depth, Limits, color::Palette, read_image, write_color_png, write_gray_png};
//!
//! // A height from a file of any format, as the numbers that the file has.
//! let height = read_image("height.exr", &Limits::default())?.gray()?;
//!
//! // The height with 16 bits, and colors for it with 8, which are written as sRGB.
//! write_gray_png("height.png", &height, Depth::Sixteen)?;
//! write_color_png("colors.png", &Palette::Terrain.ramp().apply(&height), Depth::Eight)?;
//!
//! // The content of a file, and its colors in linear light.
//! let photo = read_image("photo.jpg", &Limits::default())?;
//! println!("{}: {:?} pixels, {} bits", photo.format(), photo.size(), photo.bits());
//! let colors = photo.color()?;
//! # Ok::<(), dapple_image::ImageError>(())
//! ```
//!
//! # Ways to use it
//!
//! | to write | in one call | with more choice |
//! |---|---|---|
//! | data from 0 to 1 | [`write_gray_png`], [`write_normal_png`] | [`write_png`], [`encode_png`] |
//! | color | [`write_color_png`], [`write_color_alpha_png`] | [`write_png`], [`encode_png`] |
//! | any numbers | [`write_gray_exr`], [`write_color_exr`], [`write_color_alpha_exr`] | [`write_exr`], [`encode_exr`] |
//! | row by row, for images larger than memory | [`RowWriter`] | PNG, OpenEXR in tiles, NumPy arrays, raw 16-bit heights |
//!
//! A [`RowWriter`] takes two MiB of memory per thread for PNG, and 64 rows for OpenEXR.
//!
//! | to read | call |
//! |---|---|
//! | a file, or bytes | [`read_image`], [`decode_image`] |
//! | size and format without pixels | [`read_header`] |
//! | a rectangle | [`decode_png_region`], [`decode_exr_region`] |
//! | pixels as data, colors, normals | [`Image::gray`], [`Image::color`], [`Image::color_alpha`], [`Image::normals`] |
//! | a layer of an OpenEXR file | [`Image::layer`] |
//! | NumPy arrays, raw heights | [`decode_npy`], [`decode_r16`] |
//!
//! # Formats
//!
//! A file is recognized by its first bytes; its name does not matter.
//!
//! | format | read | gives | not read |
//! |---|---|---|---|
//! | PNG | 8 and 16 bits, palettes | codes | frames after the first |
//! | JPEG | baseline and progressive, gray and color | codes | CMYK, other depths, arithmetic and lossless coding |
//! | OpenEXR | all layers and channels | planes | deep data, subsampled channels |
//! | TIFF | gray and RGB with 8 and 16 bits, floating point; LZW, Deflate, `PackBits`; `BigTIFF` | codes, or planes | palettes, CMYK, JPEG compression, several pages |
//! | WebP | lossy and lossless | codes | animations |
//! | Radiance HDR | RGBE and XYZE | planes | `EXPOSURE` |
//! | TGA | gray, color and palettes, run-length encoded | codes | the extension area |
//!
//! Codes are whole numbers that encode color with the curve of their color space, a [`PngImage`]. Planes hold
//! floating-point numbers in linear light, an [`ExrImage`]. Photographs are turned upright according to the orientation
//! that JPEG, TIFF and WebP declare.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `png` | on | reads and writes PNG |
//! | `exr` | on | reads and writes OpenEXR |
//! | `jpeg` | on | reads JPEG |
//! | `tiff` | on | reads TIFF |
//! | `webp` | on | reads WebP |
//! | `rayon` | on | compresses and converts on all cores; the bits do not change |
//!
//! Each format feature adds its codec. Without it, reading a file of that format gives an error that names the
//! format. Radiance HDR and TGA need no codec.
//!
//! # Limits
//!
//! * By default [`Limits`] allow 2^28 pixels and 4 GiB. They are checked before memory for pixels is allocated.
//! * Any bytes are safe to read. Damaged, truncated and empty files give an [`ImageError`].
//! * Data (heights, masks, normals) is written as it is, and read without any transfer curve.
//! * Color is linear in memory and in OpenEXR, and sRGB in PNG. It is converted from the color space that a file
//!   declares: `cICP`, `iCCP`, `sRGB`, `gAMA` and `cHRM` of PNG, the ICC profile or the Exif color space of JPEG and
//!   WebP, the ICC profile of TIFF with codes, the chromaticities of OpenEXR and Radiance HDR. Profiles with lookup
//!   tables, PQ and HLG give errors. Floating-point TIFF is linear BT.709; its profile is ignored.
//! * OpenEXR is read with the pixels of its display window, and written with `f32`.
//! * A file is written under a temporary name and then renamed, so a partial file is never visible.
//!
//! # Without std
//!
//! Not possible: the crate reads and writes files.

#![forbid(unsafe_code)]
mod changes;
mod channels;
#[cfg_attr(
    not(all(feature = "png", any(feature = "jpeg", feature = "webp"))),
    expect(
        dead_code,
        reason = "each format declares its colors in some of the ways"
    )
)]
mod color_space;
mod content;
mod error;
#[cfg(any(feature = "jpeg", feature = "webp"))]
mod exif;
mod exr;
mod file;
mod format;
mod hdr;
mod header;
#[cfg(any(feature = "png", feature = "jpeg", feature = "tiff", feature = "webp"))]
mod icc;
mod image;
#[cfg(feature = "jpeg")]
mod jpeg;
mod limits;
mod orientation;
mod png;
mod raw;
mod rows;
mod tga;
#[cfg(feature = "tiff")]
mod tiff;
#[cfg(feature = "webp")]
mod webp;

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
pub use format::Format;
pub use header::{ImageHeader, read_header};
pub use limits::Limits;
pub use raw::{decode_npy, decode_r16};
pub use rows::RowWriter;
