//! Triangle meshes for textures: validity, repair, walking over the surface, nearest points and rays.
//!
//! A [`Mesh`] is positions and faces, whatever they are. [`Mesh::report`] counts what is wrong with it, and
//! [`Mesh::repair`] mends what can be mended. A mesh whose faces have an area and a consistent side becomes a
//! [`Surface`]: every face laid out flat, so that a [`SurfacePoint`] can [walk](Surface::walk) straight on over edges and
//! carry a direction along. It need not be closed, in one piece or manifold: an edge of one face, or of three, is a border.
//!
//! ```
//! use dapple_mesh::{FaceIdx, Mesh, Surface, glam::{DVec2, DVec3}};
//!
//! // A roof of two squares, of which the second rises where the first ends.
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0]];
//! let faces = [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]];
//! let mesh = Mesh::new(corners.map(DVec3::from).to_vec(), &faces)?;
//! assert_eq!(mesh.report().boundary_edges, 6);
//!
//! // Straight on along x: up the slope, until there is no more roof.
//! let surface = Surface::new(mesh)?;
//! let start = surface.project(FaceIdx(0), DVec3::new(0.5, 0.25, 0.0));
//! let walk = surface.walk(start, DVec2::X, 1.0);
//! assert!(surface.position(walk.point).z > 0.3);
//! assert!(surface.walk(start, DVec2::X, 9.0).left > 7.0);
//! # Ok::<(), dapple_mesh::MeshError>(())
//! ```
//!
//! A [`Bvh`] finds nearest points and first hits of rays. A [`Model`] is a mesh with colors, normals, texture coordinates and
//! a material, which is what files hold: the crate `dapple-mesh-io` reads and writes them. The crate `dapple-synth` covers
//! meshes with textures.
//!
//! Positions are `f64`, in whatever unit the caller likes, up to 1e30. All results have the same bits on every machine.

#![forbid(unsafe_code)]

mod adjacency;
mod bvh;
mod crease;
mod error;
mod idx;
mod mesh;
mod model;
mod repair;
mod report;
mod rotation;
mod surface;
#[cfg(test)]
mod test_meshes;
mod triangle;
mod walk;

pub use adjacency::{Adjacency, FaceEdge};
pub use bvh::{Bvh, NearestPoint, Ray, RayHit};
pub use crease::CREASE;
pub use dapple_color as color;
pub use dapple_raster as raster;
pub use error::{MeshError, MeshErrorKind};
pub use glam;
pub use idx::{FaceIdx, VertexIdx};
pub use mesh::{Mesh, POSITION_MAX};
pub use model::{AlphaMode, EncodedImage, ImageFormat, Material, Model, TileMaterial};
pub use repair::Repair;
pub use report::MeshReport;
pub use rotation::rotation;
pub use surface::{Surface, SurfacePoint};
pub use walk::Walk;
