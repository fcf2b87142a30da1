//! Cells with three or four points per cell, connected by the graph.

use super::picture_of_labels;
use crate::draw::graph_grays;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_graph::delaunay;
use dapple_points::{Domain, poisson_disk};
use dapple_pups::{LabelTexture, NetOptions, grouped_labels, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "9b",
    parameters: &[
        ("minimum distance", "0.1"),
        ("points per cell", "3 or 4"),
        ("orientations", "random"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let points = poisson_disk(Domain::paper_torus(), 0.1, Seed(9))?;
    let graph = delaunay(&points)?;
    let groups = grouped_labels(&graph, [3, 4], Seed(9))?;
    let shades = graph_grays(&graph, &groups);

    let pups = NetOptions::randomly_oriented().with_graph(&points, &graph, Seed(9))?;
    let texture = LabelTexture::new(pups, groups, shades)?;
    Ok(vec![picture_of_labels("", &texture, size)?])
}
