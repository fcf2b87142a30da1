//! Cells with one point per cell, with random orientations.

use super::picture_of_labels;
use crate::draw::graph_grays;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_graph::delaunay;
use dapple_points::{Domain, poisson_disk};
use dapple_pups::{LabelTexture, NetOptions, hash::Seed, own_labels};

pub(super) const FIGURE: Figure = Figure {
    number: "9a",
    parameters: &[
        ("minimum distance", "0.2"),
        ("orientations", "random"),
        ("ε", "0.5"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let points = poisson_disk(Domain::paper_torus(), 0.2, Seed(9))?;
    let graph = delaunay(&points)?;
    let labels = own_labels(points.len());
    let shades = graph_grays(&graph, &labels);

    let pups = NetOptions::randomly_oriented().with_graph(&points, &graph, Seed(9))?;
    let texture = LabelTexture::new(pups, labels, shades)?;
    Ok(vec![picture_of_labels("", &texture, size)?])
}
