//! Delaunay (planar and periodic), Yao, Gabriel and nearest-neighbor graphs of a point set, and their axes.
//!
//! A [`Graph`] holds, for each point of a set, its [`Axis`] list: which points it is connected to, and the vector that
//! leads there. On a domain that wraps, the vector goes around where the edge does, an axis may lead to another image
//! of the point itself, and several axes may lead to different images of the same point.
//!
//! A [`Voronoi`] diagram is the dual of the [`delaunay`] graph: cells, vertices, and the nearest point of a position.
//!
//! Positions are snapped to a fine lattice first (2^-50 of the domain's larger side, see [`Graph`]). On the lattice
//! every difference and every image is an exact number, and all decisions are made by exact predicates: the same
//! graph on every machine, and the same axes on both ends of an edge.

#![forbid(unsafe_code)]

mod error;
mod graph;
mod sanity;

mod delaunay;
mod gabriel;
mod nearest;
mod voronoi;
mod yao;

mod angle;
mod build;
#[cfg(feature = "serde")]
mod data;
mod grid;
mod lattice;

pub use build::EdgeDirection;
pub use dapple_points as points;
pub use dapple_points::{IsCancelled, PointIdx, PointSet, glam};
pub use dapple_raster as raster;
pub use delaunay::{
    EditableDelaunay, Star, Triangle, delaunay, delaunay_cancellable, delaunay_triangles,
    delaunay_triangles_cancellable,
};
pub use error::{GraphError, GraphErrorKind};
pub use gabriel::{gabriel, gabriel_cancellable};
pub use graph::{Axis, Graph};
pub use nearest::{k_nearest, k_nearest_cancellable};
#[doc(alias("dirichlet", "thiessen", "circumcenter", "point location"))]
pub use voronoi::Voronoi;
pub use voronoi::{NearestSite, VoronoiCell, VoronoiSide, VoronoiVertex};
pub use yao::{yao, yao_cancellable};
