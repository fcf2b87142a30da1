//! Files of triangle meshes: OBJ with MTL, PLY, glTF and GLB, OFF, STL.
//!
//! [`read_model`] and [`write_model`] take a path, whose ending determines the format. All other functions work on
//! bytes: each format is a module with its functions, and an entry of [`FORMATS`], from which paths, errors and help
//! texts take the names and endings of all formats.
//!
//! ```
//! use dapple_mesh::{Mesh, Model, glam::DVec3};
//! use dapple_mesh_io::{MeshFormat, ply};
//!
//! let mesh = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
//! let bytes = ply::write(&Model::from(mesh.clone()))?;
//! assert_eq!(ply::read(&bytes)?.mesh, mesh);
//!
//! let format = MeshFormat::of_path("fish.PLY").ok_or("no format has this ending")?;
//! assert_eq!(format.name(), "PLY");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! * Colors of vertices are coded as sRGB in OBJ, PLY and OFF, in whole numbers and in fractions alike, and linear in
//!   glTF.
//! * A convex polygon becomes a fan of triangles around its first corner, and a concave one the triangles of ear clipping
//!   in its plane. One that crosses itself stays a fan, and is listed in [`Model::left_out`](dapple_mesh::Model::left_out).
//!   One with fewer than three corners is left out.
//! * No file makes a reader panic. A reader takes at most 256 bytes of memory for each byte of the file, and of what
//!   it is given beside it, and 1 GiB more, whatever the file says about its counts.
//!
//! The feature `gltf`, on by default, needs `serde` and `serde_json`; the other formats have no dependencies and are
//! always available.

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
