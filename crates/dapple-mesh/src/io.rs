//! Mesh files.
//!
//! Every format reads from bytes and writes to bytes; only [`read_model`] and [`write_model`] touch files. A format is
//! a module behind a feature of the same name, and the feature `io`, on by default, has them all:
//!
//! | format | reads | writes | numbers in a file |
//! |---|---|---|---|
//! | [`obj`] | text, with its MTL and textures | the same | shortest digits that read back as the same `f64` |
//! | [`ply`] | text, binary of both byte orders | text and binary, little-endian | `f32` if that loses nothing, else `f64` |
//! | [`gltf`] | glTF, GLB | GLB | `f32` |
//! | [`off`] | text | - | |
//!
//! * Colors of vertices are coded as sRGB in OBJ, PLY and OFF, in whole numbers and in fractions alike, and linear in
//!   glTF.
//! * A polygon becomes a fan of triangles around its first corner, which is right for convex ones. One with fewer than
//!   three corners is left out.
//! * No file makes a reader panic. A reader takes at most 256 bytes of memory for each byte of the file, and of what
//!   it is given beside it, and 1 GiB more, whatever the file says about its counts.

#[cfg(any(feature = "obj", feature = "ply", feature = "off"))]
mod colors;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(any(feature = "obj", feature = "off"))]
mod line;
#[cfg(feature = "obj")]
pub mod obj;
#[cfg(feature = "off")]
pub mod off;
mod paths;
#[cfg(feature = "ply")]
pub mod ply;
#[cfg(any(feature = "obj", feature = "ply", feature = "gltf", feature = "off"))]
mod polygon;
#[cfg(any(feature = "gltf", feature = "ply"))]
mod split;
#[cfg(any(feature = "obj", feature = "ply", feature = "off"))]
mod text;

#[cfg(all(
    test,
    feature = "obj",
    feature = "ply",
    feature = "gltf",
    feature = "off"
))]
mod tests;

pub use paths::read_model;
#[cfg(any(feature = "obj", feature = "ply", feature = "gltf"))]
pub use paths::write_model;

/// Gives the content of another file by the name that a file has for it, if there is such a file.
///
/// Readers of formats that are spread over several files take one. A name is as in the file, with slashes and without
/// percent codes; it may try to lead anywhere, so whoever opens files has to look at it first.
pub type Beside<'a> = dyn FnMut(&str) -> Option<Vec<u8>> + 'a;
