//! Point sets in domains that may wrap: domains, sampling, statistics, and graphs.

mod domain;
mod graphs;
mod placing;
mod set;
mod varying;

pub(crate) use domain::Domain;
pub(crate) use graphs::{
    _graph_from_description, Graph, GraphMade, delaunay, gabriel, k_nearest, yao,
};
pub(crate) use placing::{
    extend_poisson_disk, jittered_grid, nested_poisson_disk, poisson_disk, white_noise,
};
pub(crate) use set::{Points, spectrum};
pub(crate) use varying::varying;
