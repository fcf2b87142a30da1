//! Tests of the formats through the public interface. The codecs are compiled once, in the library.

#[cfg(feature = "png")]
mod arrays;
#[cfg(feature = "png")]
mod channels;
#[cfg(all(
    feature = "png",
    feature = "jpeg",
    feature = "exr",
    feature = "tiff",
    feature = "webp"
))]
mod color_space;
#[cfg(feature = "exr")]
mod exr;
mod file;
mod hdr;
#[cfg(feature = "jpeg")]
mod jpeg;
#[cfg(feature = "exr")]
mod layers;
#[cfg(not(any(
    feature = "png",
    feature = "jpeg",
    feature = "exr",
    feature = "tiff",
    feature = "webp"
)))]
mod left_out;
#[cfg(feature = "jpeg")]
mod orientation;
#[cfg(feature = "png")]
mod pixel;
#[cfg(feature = "png")]
mod png;
#[cfg(all(feature = "png", feature = "exr"))]
mod round_trips;
#[cfg(all(feature = "png", feature = "exr"))]
mod rows;
#[cfg(feature = "png")]
mod strips;
mod tga;
#[cfg(feature = "tiff")]
mod tiff;
#[cfg(feature = "webp")]
mod webp;
#[cfg(feature = "exr")]
mod windows;
