//! Triangle meshes for textures: validity, walking, even points and their hierarchies, closest points, models and files.
//!
//! A [`Mesh`] is positions and faces, whatever they are. [`Mesh::report`] counts what is wrong with it, and
//! [`Mesh::repair`] mends what can be mended. A mesh whose faces have an area and a consistent side becomes a
//! [`Surface`]: every face laid out flat, so that a [`SurfacePoint`] can [walk](Surface::walk) straight on over edges and
//! carry a direction along. It need not be closed, in one piece or manifold: an edge of one face, or of three, is a border.
//!
//! On a surface live *sites*, which are to a texture what pixels are to an image. [`scatter`] throws points with one
//! density everywhere, [`repel`] lets them push each other apart, [`nested_points`] does both for sets of n, 4n, 16n …
//! points in which the coarse points stay. A [`Hierarchy`] connects the sites of each level with their neighbors
//! ([`SiteGraph`]) and has the operations on columns of values: [interpolation](Hierarchy::interpolate), a [`LowPass`]
//! filter, [down](Hierarchy::downsample)- and [upsampling](Hierarchy::upsample). Level 0 is the finest.
//!
//! ```
//! use dapple_mesh::{Hierarchy, HierarchyOptions, Surface, models};
//!
//! let tori = models::blended_tori(1000)?;
//! assert_eq!(tori.report().boundary_edges, 0, "it is closed");
//! let surface = Surface::new(tori)?;
//!
//! let options = HierarchyOptions { n_sites: 1000, n_levels: 2, ..HierarchyOptions::default() };
//! let hierarchy = Hierarchy::new(&surface, &options)?;
//! assert_eq!(hierarchy.levels()[1].n_sites(), 250);
//!
//! // Heights at the sites, those of the coarser level, and one between sites.
//! let heights: Vec<f64> = hierarchy.sites().positions().iter().map(|at| at.y).collect();
//! let coarse = hierarchy.downsample(0, &heights)?;
//! let at = surface.point(dapple_mesh::FaceIdx(0), [1.0 / 3.0; 3]);
//! let (position, normal) = (surface.position(at), surface.normal(at));
//! let height = hierarchy.interpolate(1, &coarse, position, normal)?;
//! assert!(height.is_some_and(|height| (height - position.y).abs() < 0.2));
//! # Ok::<(), dapple_mesh::MeshError>(())
//! ```
//!
//! Sites, their neighbors and the operations are those of Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001,
//! section 3, <https://doi.org/10.1145/383259.383297>, on the repulsion of his "Generating Textures on Arbitrary Surfaces
//! Using Reaction-Diffusion", SIGGRAPH 1991. Turk's meshes are graphs; [`Hierarchy::triangles`] makes triangles of one, for
//! export. The crate `dapple-synth` puts textures on them.
//!
//! A [`Bvh`] finds nearest points and first hits of rays. [`solid`] has shapes given by distance functions, which
//! [`polygonize()`] makes to meshes, and [`models`] six creatures and objects made of them.
//!
//! Positions are `f64`, in whatever unit the caller likes, up to 1e30. All results have the same bits on every machine and
//! on any number of threads.
//!
//! # Files
//!
//! A [`Model`] is a mesh with colors, normals, texture coordinates and a material. Files are in [`io`], one module and one
//! feature for each format, all on by default. With `default-features = false` none is there, and neither are `serde` and
//! `serde_json`, which only glTF needs.

#![forbid(unsafe_code)]

mod adjacency;
mod between;
mod blend;
mod bvh;
mod cell;
mod connect;
mod crease;
mod error;
mod evenness;
mod graph;
mod grid;
mod hierarchy;
mod idx;
mod interpolation;
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
pub use crease::CREASE;
pub use error::{MeshError, MeshErrorKind};
pub use evenness::{Evenness, evenness, hexagonal_spacing};
pub use glam;
pub use graph::SiteGraph;
pub use grid::SiteGrid;
pub use hierarchy::{Hierarchy, HierarchyOptions, Level};
pub use idx::{FaceIdx, SiteIdx, VertexIdx};
pub use interpolation::INTERPOLATION_RADIUS;
pub use low_pass::LowPass;
pub use mesh::{Mesh, POSITION_MAX};
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
