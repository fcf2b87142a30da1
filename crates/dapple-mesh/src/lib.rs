//! Triangle meshes for textures.

#![forbid(unsafe_code)]

mod adjacency;
mod cell;
mod connect;
mod error;
mod graph;
mod grid;
mod hierarchy;
mod idx;
mod mesh;
mod operations;
mod parallel;
mod repair;
mod report;
mod sites;
mod star;
mod surface;
#[cfg(test)]
mod testing;
mod walk;

pub use adjacency::{Adjacency, FaceEdge};
pub use connect::Connected;
pub use error::{MeshError, MeshErrorKind};
pub use glam;
pub use graph::SiteGraph;
pub use grid::SiteGrid;
pub use hierarchy::{Blend, Hierarchy, HierarchyOptions, Level};
pub use idx::{FaceIdx, SiteIdx, VertexIdx};
pub use mesh::Mesh;
pub use operations::INTERPOLATION_RADIUS;
pub use repair::Repair;
pub use report::MeshReport;
pub use sites::Sites;
pub use star::STAR_RADIUS;
pub use surface::{Surface, SurfacePoint};
pub use walk::Walk;
