//! Sites on a surface: evenly spaced sample points on several levels, their neighbor graphs, and operations on columns
//! of per-site values. Sites correspond to the pixels of an image.
//!
//! [`scatter`] draws random points of uniform density, and [`repel`] makes them push each other apart.
//! [`nested_points`] does both for sets of n, 4n, 16n … points, where each set contains the coarser ones. A
//! [`Hierarchy`] connects the sites of each level with their neighbors ([`SiteGraph`]). It also has the operations on
//! columns: [interpolation](Hierarchy::interpolate), a [`LowPass`] filter, [down](Hierarchy::downsample)- and
//! [upsampling](Hierarchy::upsample). Level 0 is the finest.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.

mod site;

mod scatter;

mod grid;
mod near;

mod repel;

mod between;
mod nested;
mod share;
mod unstick;

mod cell;
mod connect;
mod graph;
mod star;

mod hierarchy;

mod blend;
mod interpolation;
mod low_pass;
mod operations;
mod oriented;

mod evenness;
mod triangles;

pub use blend::Blend;
pub use connect::Connected;
pub use evenness::{Evenness, evenness, hexagonal_spacing};
pub use graph::SiteGraph;
pub use grid::SiteGrid;
pub use hierarchy::{
    Hierarchy, HierarchyOptions, Level, repeats_of_sites, sites_for_exemplar, sites_for_repeats,
};
pub use interpolation::INTERPOLATION_RADIUS;
pub(crate) use interpolation::{weight, weights};
pub use low_pass::LowPass;
pub use nested::nested_points;
pub use operations::{DOWNSAMPLE_STEPS, DOWNSAMPLE_T};
pub use repel::repel;
pub use scatter::scatter;
pub use site::{SiteIdx, Sites};
pub use star::STAR_RADIUS;
pub use triangles::SiteTriangles;
