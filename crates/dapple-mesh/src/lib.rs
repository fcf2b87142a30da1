//! Triangle meshes for textures.

#![forbid(unsafe_code)]

mod adjacency;
mod error;
mod graph;
mod grid;
mod hierarchy;
mod idx;
mod mesh;
mod operations;
mod polygonize;
mod repair;
mod report;
mod sites;
mod surface;
mod walk;

pub mod models;
pub mod solid;

pub use adjacency::{Adjacency, FaceEdge};
pub use error::{MeshError, MeshErrorKind};
pub use glam;
pub use graph::SiteGraph;
pub use grid::SiteGrid;
pub use hierarchy::{Blend, Hierarchy, HierarchyOptions, Level};
pub use idx::{FaceIdx, SiteIdx, VertexIdx};
pub use mesh::Mesh;
pub use operations::INTERPOLATION_RADIUS;
pub use polygonize::{TOLERANCE, polygonize, polygonize_n};
pub use repair::Repair;
pub use report::MeshReport;
pub use sites::Sites;
pub use surface::{Surface, SurfacePoint};
pub use walk::Walk;
