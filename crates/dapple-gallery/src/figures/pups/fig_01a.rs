//! The weight of a point: brighter means more weight.
//!
//! It is 1 on the control point and falls to 0 along each of its axes (drawn thinly, with dots where they end).

use super::weight::Star;
use crate::draw::Canvas;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::PupsOptions;
use dapple_raster::Raster;

pub(super) const FIGURE: Figure = Figure {
    number: "1a",
    parameters: &[("axial weight", "(1 − p)² (1 + 2p)"), ("axis scale", "1")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let star = Star::new()?;
    let window = star.window(size)?;
    let pixel = f64::from(size) / 512.0;

    let pups = star.pups(PupsOptions::default())?;
    let weights = Raster::from_window(&window, |at| pups.weight(star.center, at))?;
    let mut canvas = Canvas::over(&window, weights)?;
    let center = star.points.position(star.center);
    for axis in star.graph.axes(star.center) {
        let end = center + axis.vector;
        canvas.lines(&[[center, end]], pixel, 0.5);
        canvas.disk(end, 5.0 * pixel, 0.5);
    }
    Ok(vec![Panel::gray("", canvas.into_raster())])
}
