//! A test card for the drawing helpers: a ring of points with labels, the graph between them, and the contours of the
//! distance from their center.

use crate::draw::{Canvas, label_color};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_raster::{Field, Raster, Window, glam::DVec2};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[("points", "12"), ("contours", "every 0.1")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let window = Window::new(DVec2::splat(-1.0), DVec2::splat(2.0), [size; 2])?;
    let pixel = f64::from(size) / 512.0;

    let mut contours = Canvas::new(&window, 1.0)?;
    let distance = Distance.to_raster(&window)?;
    let levels: Vec<f32> = (1..14).map(|level| level as f32 * 0.1).collect();
    contours.iso_lines(&distance, &levels, 2.0 * pixel, 0.0)?;

    let mut graph = Canvas::new(&window, LinearRgb::WHITE)?;
    let points: Vec<DVec2> = (0..12).map(ring).collect();
    let pairs = points
        .iter()
        .flat_map(|&a| points.iter().map(move |&b| [a, b]));
    graph.lines(
        &pairs.collect::<Vec<_>>(),
        1.5 * pixel,
        LinearRgb::gray(0.4),
    );
    for (label, &point) in (0..).zip(&points) {
        graph.disk(point, 14.0 * pixel, LinearRgb::BLACK);
        graph.disk(point, 12.0 * pixel, label_color(label));
    }

    let stripes = Raster::from_window(&window, |at| label_color((at.x * 6.0 + 6.0) as u32))?;
    Ok(vec![
        Panel::gray("contours", contours.into_raster()),
        Panel::color("graph", graph.into_raster()),
        Panel::color("labels", stripes),
    ])
}

struct Distance;

impl Field for Distance {
    fn value(&self, position: [f64; 2]) -> f32 {
        DVec2::from(position).length() as f32
    }
}

/// Returns corner number `corner` of a regular dodecagon, rotated by 30° from the previous one; no sine is needed.
fn ring(corner: u32) -> DVec2 {
    let (cos, sin) = (0.75_f64.sqrt(), 0.5);
    let turn = |at: DVec2| DVec2::new(cos * at.x - sin * at.y, sin * at.x + cos * at.y);
    (0..corner).fold(DVec2::new(0.8, 0.0), |at, _| turn(at))
}
