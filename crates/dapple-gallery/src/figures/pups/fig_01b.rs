//! Isovalues in the scalar field of a point's weight.

use super::weight::Star;
use crate::draw::Canvas;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::PupsOptions;
use dapple_raster::Raster;

pub(super) const FIGURE: Figure = Figure {
    number: "1b",
    parameters: &[("isovalues", "0.01, then 0.1 to 0.9")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let star = Star::new()?;
    let window = star.window(size)?;
    let pixel = f64::from(size) / 512.0;

    let pups = star.pups(PupsOptions::default())?;
    let weights = Raster::from_window(&window, |at| pups.weight(star.center, at))?;
    let mut canvas = Canvas::new(&window, 1.0)?;
    let tenths: Vec<f32> = (1..10).map(|tenth| tenth as f32 / 10.0).collect();
    canvas.iso_lines(&weights, &tenths, 2.0 * pixel, 0.0)?;
    canvas.iso_lines(&weights, &[0.01], 2.0 * pixel, 0.6)?;
    canvas.disk(star.points.position(star.center), 5.0 * pixel, 0.0);
    Ok(vec![Panel::gray("", canvas.into_raster())])
}
