//! Triangle meshes for textures.

#![forbid(unsafe_code)]

mod adjacency;
mod between;
mod error;
mod evenness;
mod graph;
mod grid;
mod hierarchy;
mod idx;
mod mesh;
mod near;
mod nested;
mod operations;
mod parallel;
mod repair;
mod repel;
mod report;
mod scatter;
mod share;
mod sites;
mod surface;
#[cfg(test)]
mod test_shapes;
mod unstick;
mod walk;

pub use adjacency::{Adjacency, FaceEdge};
pub use error::{MeshError, MeshErrorKind};
pub use evenness::{Evenness, evenness, hexagonal_spacing};
pub use glam;
pub use graph::SiteGraph;
pub use grid::SiteGrid;
pub use hierarchy::{Blend, Hierarchy, HierarchyOptions, Level};
pub use idx::{FaceIdx, SiteIdx, VertexIdx};
pub use mesh::Mesh;
pub use nested::nested_points;
pub use operations::INTERPOLATION_RADIUS;
pub use repair::Repair;
pub use repel::repel;
pub use report::MeshReport;
pub use scatter::scatter;
pub use sites::Sites;
pub use surface::{Surface, SurfacePoint};
pub use walk::Walk;
