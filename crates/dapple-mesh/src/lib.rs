//! Triangle meshes for textures, with defect reports and repair, straight walks over the surface, nearest-point
//! queries and ray casting.
//!
//! A [`Mesh`] holds arbitrary positions and faces. [`Mesh::report`] counts its defects, and [`Mesh::repair`] fixes
//! those that can be fixed. A mesh whose faces have nonzero area and consistent winding becomes a [`Surface`]. There,
//! every face is unfolded into a plane, so that a [`SurfacePoint`] can [walk](Surface::walk) straight across edges
//! and transport a direction along the path.
//!
//! ```
//! use dapple_mesh::{Bvh, FaceIdx, Mesh, Surface, glam::{DVec2, DVec3}};
//!
//! // A roof of two squares. The second one rises from the end of the first.
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0]];
//! let faces = [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]];
//! let (mesh, repair) = Mesh::new(corners.map(DVec3::from).to_vec(), &faces)?.repair();
//! assert_eq!(repair.before.boundary_edges, 6);
//!
//! // Straight on along x: up the slope.
//! let surface = Surface::new(mesh)?;
//! let start = surface.project(FaceIdx(0), DVec3::new(0.5, 0.25, 0.0));
//! let walk = surface.walk(start, DVec2::X, 1.0);
//! assert!(surface.position(walk.point).z > 0.3);
//!
//! // The point of the mesh that is nearest to a position above the roof.
//! let nearest = Bvh::new(surface.mesh()).nearest_point(DVec3::new(0.5, 0.5, 2.0));
//! assert!(nearest.is_some_and(|nearest| nearest.distance_sq < 4.0));
//! # Ok::<(), dapple_mesh::MeshError>(())
//! ```
//!
//! # Ways to use it
//!
//! | to | use | cost |
//! |---|---|---|
//! | count defects | [`Mesh::report`] | |
//! | repair them | [`Mesh::repair`] | |
//! | find neighbors over edges | [`Adjacency`] | |
//! | follow a straight path | [`Surface::walk`] | one step for each edge that is crossed, at most 65,536 |
//! | find the nearest point, or the first hit of a ray | [`Bvh`] | a search in a hierarchy of boxes, built once |
//! | shade creases | [`Mesh::corner_normals`], [`Mesh::vertex_normals`] | |
//! | hold the content of a mesh file | [`Model`] | textures stay encoded bytes |
//!
//! `dapple-mesh-io` reads and writes files. `dapple-synth` covers meshes with textures.
//!
//! # Features
//!
//! None. The crate starts no threads and enables no features of its dependencies.
//!
//! # Limits
//!
//! * Coordinates are at most 1e30 in absolute value. Units are up to the caller.
//! * A mesh has at most 2^31 vertices and as many faces, which are triangles.
//! * A surface need not be closed, in one piece or manifold. An edge with one face or with three or more is a border,
//!   and ends a path.
//! * Repair merges vertices at the same position, drops degenerate and duplicate faces, and makes the winding
//!   consistent. It fills no holes and removes no self-intersections.
//! * Positions are `f64`. All results have the same bits on every machine.
//!
//! # Without std
//!
//! Not possible today. `dapple-color`, `dapple-raster` and `glam` are used with std, and `floor` of `f64` is a method
//! of std.

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
