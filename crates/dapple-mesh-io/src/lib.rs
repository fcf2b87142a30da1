//! Mesh file formats: reads OBJ with MTL, PLY, glTF, GLB, OFF and STL, and writes OBJ, PLY, GLB and STL.
//!
//! ```no_run
//! use dapple_mesh_io::{MeshFormat, read_model, write_model};
//!
//! // The extension of a path determines the format.
//! let model = read_model("fish.obj")?;
//! println!("{} faces", model.mesh.faces().len());
//! for part in &model.left_out {
//!     println!("left out: {part}");
//! }
//! write_model("fish.glb", &model)?;
//!
//! // The bytes of a file that is in memory; the closure returns the files that it refers to.
//! let format = MeshFormat::of_path("fish.GLB").ok_or("no format has this extension")?;
//! let model = format.read(&std::fs::read("fish.glb")?, &mut |_name| None)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to use it
//!
//! | to | from and to paths | from and to bytes |
//! |---|---|---|
//! | read | [`read_model`] | [`MeshFormat::read`], [`obj::read`], [`ply::read`], [`gltf`](mod@gltf), [`off::read`], [`stl::read`] |
//! | write | [`write_model`] | [`MeshFormat::write`], [`obj`](mod@obj), [`ply`](mod@ply), [`stl::write`] |
//! | exchange images and change nothing else | [`replace_images`] | [`MeshFormat::replace_images`] |
//! | list formats and file extensions | [`FORMATS`] | |
//!
//! | format | reads | writes | numbers in a file |
//! |---|---|---|---|
//! | OBJ | text, with its MTL and textures | the same | shortest digits that read back as the same `f64` |
//! | PLY | text, binary of both byte orders | text and binary, little-endian | `f32` if that loses nothing, else `f64` |
//! | glTF | glTF, GLB | GLB | `f32`, from an `f64` origin where the mesh is far from zero |
//! | OFF | text | | |
//! | STL | binary and text | binary; text where the mesh is far from zero | `f32`; in text as OBJ |
//!
//! A [`Model`](dapple_mesh::Model) holds the content of a file: the mesh, linear colors of vertices, texture
//! coordinates of corners (v down), normals, and a material whose textures stay encoded bytes.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `gltf` | on | reads glTF and GLB files, and writes GLB files, with `serde` and `serde_json` |
//!
//! The other formats need no other crates and are always available.
//!
//! # Limits
//!
//! * A reader takes at most 256 bytes of memory per byte of the file and the files it refers to, plus 1 GiB, whatever
//!   counts the file states. A file on disk, and all files that it refers to, have at most 4 GiB.
//! * No file makes a reader panic. A damaged file is a [`MeshIoError`].
//! * Buffers, materials and textures are read from the folder of the file and its subfolders only.
//! * Omitted parts, such as missing textures, further materials, animations and self-intersecting polygons, are
//!   listed in [`Model::left_out`](dapple_mesh::Model::left_out). Skins, morph targets and texture transforms are
//!   applied.
//! * A convex polygon becomes a fan of triangles around its first corner, and a concave one the triangles of ear
//!   clipping in its plane. A self-intersecting polygon stays a fan. A polygon with fewer than three corners is left
//!   out.
//! * Vertex colors are encoded as sRGB in OBJ, PLY and OFF, both as integers and as fractions, and are linear in
//!   glTF.
//! * An OBJ with `<UDIM>` or `<UVTILE>` in the name of its texture has one texture for each unit square. glTF has no
//!   such names, and its writer refuses them.
//! * Writing is atomic: the file on disk is either the old one or the complete new one.
//!
//! # Without std
//!
//! Not possible: the crate reads and writes files.

#![forbid(unsafe_code)]

mod error;
mod files;
mod formats;

mod colors;
mod line;
mod polygon;
mod single;
mod split;
mod text;
mod texture;

#[cfg(test)]
use dapple_mesh::{Mesh, Surface};
#[cfg(test)]
#[expect(dead_code, reason = "the tests of meshes use more of them")]
#[path = "../../dapple-mesh/src/test_meshes.rs"]
mod test_meshes;
#[cfg(all(test, feature = "gltf"))]
mod tests;

pub use dapple_color as color;
pub use dapple_image as image;
pub use dapple_mesh as mesh;
pub use dapple_raster as raster;
pub use error::{MeshIoError, MeshIoErrorKind};
pub use files::{read_model, replace_images, write_model};
pub use formats::*;
pub use texture::tile_name;
