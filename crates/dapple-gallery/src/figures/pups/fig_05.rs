//! Cells of (a) an original point set, (b) the same point set with all orientations pointing to the right and (c) with
//! all orientations pointing away from the center.

use super::{SIDE, fine_square, square};
use crate::draw::{Canvas, graph_grays, shrink};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_graph::delaunay;
use dapple_points::{Domain, poisson_disk};
use dapple_pups::{Orientation, Pups, PupsOptions, hash::Seed, outward_orientations, own_labels};
use glam::{DVec2, DVec3};

pub(super) const FIGURE: Figure = Figure {
    number: "5a–c",
    parameters: &[("minimum distance", "0.3"), ("ε", "0.5")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let points = poisson_disk(Domain::paper_torus(), 0.3, Seed(5))?;
    let graph = delaunay(&points)?;
    let shades = graph_grays(&graph, &own_labels(points.len()));
    let outward = outward_orientations(&points, DVec2::ZERO)?;

    let mut panels = Vec::new();
    for (label, orientation) in [
        ("a", None),
        ("b", Some(Orientation::new(vec![DVec3::X]))),
        ("c", Some(Orientation::new(outward))),
    ] {
        let options = PupsOptions {
            orientation,
            ..PupsOptions::default()
        };
        let pups = Pups::new(&points, &graph, options)?;
        let cells = pups.label_raster(&fine_square(size)?, &shades)?;
        let mut canvas = Canvas::over(&square(size)?, shrink(&cells, SIDE)?)?;
        canvas.points(&points, 4.0 * f64::from(size) / 512.0, 0.0);
        panels.push(Panel::gray(label, canvas.into_raster()).repeating());
    }
    Ok(panels)
}
