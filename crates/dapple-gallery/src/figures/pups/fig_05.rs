//! Cells of (a) an original point set, (b) the same point set with all orientations pointing to the right and (c) with
//! all orientations pointing away from the center.

use crate::draw::{Canvas, graph_grays};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_graph::delaunay;
use dapple_points::{Domain, poisson_disk};
use dapple_pups::{Orientation, Pups, PupsOptions, hash::Seed, outward_orientations};
use dapple_raster::Window;
use glam::{DVec2, DVec3};

pub(super) const FIGURE: Figure = Figure {
    number: "5a–c",
    parameters: &[("minimum distance", "0.3"), ("ε", "0.5")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let domain = Domain::paper_torus();
    let points = poisson_disk(domain, 0.3, Seed(5))?;
    let graph = delaunay(&points)?;
    let shades = graph_grays(&graph);
    let outward = outward_orientations(&points, DVec2::ZERO)?;

    let window = Window::new(domain.origin, domain.size, [size; 2])?;
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
        let cells = Pups::new(&points, &graph, options)?.label_raster(&window, &shades)?;
        let mut canvas = Canvas::over(&window, cells)?;
        canvas.points(&points, 4.0 * f64::from(size) / 512.0, 0.0);
        panels.push(Panel::gray(label, canvas.into_raster()).repeating());
    }
    Ok(panels)
}
