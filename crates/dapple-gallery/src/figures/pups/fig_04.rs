//! The same point set with (a) normal axis length and (b) axes twice as long.

use super::picture;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_graph::delaunay;
use dapple_points::{Domain, poisson_disk};
use dapple_pups::{Pups, PupsOptions, hash::Seed, random_values};

pub(super) const FIGURE: Figure = Figure {
    number: "4a, 4b",
    parameters: &[
        ("minimum distance", "0.2"),
        ("values", "random"),
        ("axis scale", "1 (a), 2 (b)"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let points = poisson_disk(Domain::paper_torus(), 0.2, Seed(4))?;
    let graph = delaunay(&points)?;
    let values = random_values(points.len(), Seed(4));

    let mut panels = Vec::new();
    for (label, axis_scale) in [("a", 1.0), ("b", 2.0)] {
        let options = PupsOptions {
            axis_scale,
            ..PupsOptions::default()
        };
        let texture = Pups::new(&points, &graph, options)?.texture(values.clone())?;
        panels.push(picture(label, &texture, size)?);
    }
    Ok(panels)
}
