//! Triangle meshes for textures.
//!
//! Files are in [`io`], one module and one feature for each format, all on by default. With `default-features = false` none
//! is there, and neither are `serde` and `serde_json`, which only glTF needs.

#![forbid(unsafe_code)]

mod adjacency;
mod between;
mod blend;
mod bvh;
mod cell;
mod connect;
mod error;
mod evenness;
mod graph;
mod grid;
mod hierarchy;
mod idx;
mod interpolation;
#[cfg(any(feature = "obj", feature = "ply", feature = "gltf", feature = "off"))]
pub mod io;
mod low_pass;
mod mesh;
mod model;
mod near;
mod nested;
mod operations;
mod oriented;
mod parallel;
mod polygonize;
mod repair;
mod repel;
mod report;
mod scatter;
mod share;
mod sites;
mod star;
mod surface;
#[cfg(test)]
mod test_meshes;
#[cfg(test)]
mod test_shapes;
#[cfg(test)]
mod testing;
mod triangle;
mod triangles;
mod unstick;
mod walk;

pub mod models;
pub mod solid;

pub use adjacency::{Adjacency, FaceEdge};
pub use blend::Blend;
pub use bvh::{Bvh, NearestPoint, Ray, RayHit};
pub use connect::Connected;
pub use error::{MeshError, MeshErrorKind};
pub use evenness::{Evenness, evenness, hexagonal_spacing};
pub use glam;
pub use graph::SiteGraph;
pub use grid::SiteGrid;
pub use hierarchy::{Hierarchy, HierarchyOptions, Level};
pub use idx::{FaceIdx, SiteIdx, VertexIdx};
pub use interpolation::INTERPOLATION_RADIUS;
pub use low_pass::LowPass;
pub use mesh::Mesh;
pub use model::{EncodedImage, ImageFormat, Material, Model};
pub use nested::nested_points;
pub use operations::{DOWNSAMPLE_STEPS, DOWNSAMPLE_T};
pub use polygonize::{TOLERANCE, polygonize, polygonize_n};
pub use repair::Repair;
pub use repel::repel;
pub use report::MeshReport;
pub use scatter::scatter;
pub use sites::Sites;
pub use star::STAR_RADIUS;
pub use surface::{Surface, SurfacePoint};
pub use triangles::SiteTriangles;
pub use walk::Walk;
