//! Delaunay graphs and Voronoi cells of points, on a plane or on a torus that tiles; Yao, Gabriel and nearest-neighbor
//! graphs.
//!
//! A [`Graph`] holds a list of [`Axis`] values for each point of a set. An axis has a target point and the vector to
//! it. On a wrapping domain, the vector crosses the border where the edge does. An axis may lead to another image of
//! the point itself, and several axes may lead to different images of the same point.
//!
//! ```
//! use dapple_graph::{PointIdx, Voronoi, delaunay, points::{Domain, hash::Seed, jittered_grid}, glam::DVec2};
//!
//! // Points on a unit square whose opposite sides are joined, and their Delaunay edges.
//! let points = jittered_grid(Domain::torus(DVec2::ZERO, DVec2::ONE), [10, 10], 0.9, Seed(7))?;
//! let graph = delaunay(&points)?;
//! for axis in graph.axes(PointIdx(0)) {
//!     println!("to {:?}: {}", axis.to, axis.vector);
//! }
//!
//! // The Voronoi cell of a point, and the point that is nearest to a position.
//! let voronoi = Voronoi::of_graph(graph)?;
//! let cell = voronoi.cell(PointIdx(0));
//! for corner in cell.polygon().expect("cells of a torus are bounded") {
//!     println!("{}", cell.position() + corner);
//! }
//! let nearest = voronoi.locate([0.3, 0.9], cell.site())?;
//! println!("site {} at a distance of {}", nearest.site.0, nearest.offset.length());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to use it
//!
//! | to get | use | cost |
//! |---|---|---|
//! | a Delaunay graph | [`delaunay`] | 457 ns/point for a million points on a torus, 286 for 700 |
//! | its triangles | [`Graph::triangles`], [`delaunay_triangles`] | |
//! | Voronoi cells, vertices, sides | [`Voronoi`] | the Delaunay graph first |
//! | the nearest point of a position | [`Voronoi::locate`] | a walk from a cell nearby, such as the result of the last query |
//! | a cell within a rectangle | [`VoronoiCell::clipped`] | |
//! | the nearest points of each point | [`k_nearest`] | |
//! | one neighbor in each of some cones | [`yao`] | |
//! | edges with empty circles | [`gabriel`] | |
//! | a graph of your own | [`Graph::from_adjacency`] | |
//!
//! Times are from one thread of a server processor (AMD EPYC). Functions named `…_cancellable` take a callback that
//! can cancel them.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | builds large graphs on all cores; the bits do not change |
//! | `serde` | off | reads and writes options and graphs as data; reading checks them |
//!
//! For `poisson_disk` and related functions, also depend on `dapple-points` directly. This crate does not enable
//! them, which saves a third of the build.
//!
//! # Limits
//!
//! * Points are in the plane, on a rectangle, a cylinder or a torus. Two points at the same position are an error.
//! * Positions are snapped to a fine lattice first (2^-50 of the domain's larger side, see [`Graph`]). On this
//!   lattice, every difference is exact, and all decisions are made by exact predicates. The two ends of an edge have
//!   the same axis.
//! * A wrapping domain must not be too thin, relative to the distance between its points.
//! * In the plane the outermost Voronoi cells are unbounded. Their sides end in rays.
//! * [`k_nearest`] takes 1 to 4096 neighbors, and [`yao`] 1 to 32 cones.
//! * The graph is the same on every machine and for any number of threads.
//!
//! # Without std
//!
//! Not possible today, although `spade` and `robust` can do without. Square roots and `floor` of `f64` are methods of
//! std, a grid that is built on demand needs its `OnceLock`, and `dapple-points` and `dapple-raster` need std.

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
    Triangle, delaunay, delaunay_cancellable, delaunay_triangles, delaunay_triangles_cancellable,
};
pub use error::{GraphError, GraphErrorKind};
pub use gabriel::{gabriel, gabriel_cancellable};
pub use graph::{Axis, Graph};
pub use nearest::{k_nearest, k_nearest_cancellable};
#[doc(alias("dirichlet", "thiessen", "circumcenter", "point location"))]
pub use voronoi::Voronoi;
pub use voronoi::{NearestSite, VoronoiCell, VoronoiSide, VoronoiVertex};
pub use yao::{yao, yao_cancellable};
