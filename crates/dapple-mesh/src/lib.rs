//! Triangle meshes for textures.

#![forbid(unsafe_code)]

mod adjacency;
mod blend;
mod cell;
mod connect;
mod error;
mod graph;
mod grid;
mod hierarchy;
mod idx;
mod interpolation;
mod low_pass;
mod mesh;
mod operations;
mod oriented;
mod parallel;
mod repair;
mod report;
mod sites;
mod star;
mod surface;
#[cfg(test)]
mod testing;
mod triangles;
mod walk;

pub use adjacency::{Adjacency, FaceEdge};
pub use blend::Blend;
pub use connect::Connected;
pub use error::{MeshError, MeshErrorKind};
pub use glam;
pub use graph::SiteGraph;
pub use grid::SiteGrid;
pub use hierarchy::{Hierarchy, HierarchyOptions, Level};
pub use idx::{FaceIdx, SiteIdx, VertexIdx};
pub use interpolation::INTERPOLATION_RADIUS;
pub use low_pass::LowPass;
pub use mesh::Mesh;
pub use operations::{DOWNSAMPLE_STEPS, DOWNSAMPLE_T};
pub use repair::Repair;
pub use report::MeshReport;
pub use sites::Sites;
pub use star::STAR_RADIUS;
pub use surface::{Surface, SurfacePoint};
pub use triangles::SiteTriangles;
pub use walk::Walk;
