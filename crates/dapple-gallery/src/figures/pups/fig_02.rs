//! The Delaunay triangulation of the control points. It wraps around, so that textures on it repeat.

use crate::draw::Canvas;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_graph::delaunay;
use dapple_points::{Domain, poisson_disk};
use dapple_pups::hash::Seed;
use dapple_raster::Window;

pub(super) const FIGURE: Figure = Figure {
    number: "2",
    parameters: &[("minimum distance", "0.2"), ("domain", "[−1, 1]², wrapped")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let domain = Domain::paper_torus();
    let points = poisson_disk(domain, 0.2, Seed(2))?;
    let graph = delaunay(&points)?;

    let window = Window::new(domain.origin, domain.size, [size; 2])?;
    let pixel = f64::from(size) / 512.0;
    let mut canvas = Canvas::new(&window, 1.0)?;
    canvas.graph(&points, &graph, 1.5 * pixel, 0.45);
    canvas.points(&points, 5.0 * pixel, 0.0);
    Ok(vec![Panel::gray("", canvas.into_raster()).repeating()])
}
