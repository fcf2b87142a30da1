//! Three different pixel neighborhoods: (a) full square, (b) Wei-Levoy causal, (c) half square.
//!
//! The circle marks the pixel whose color is determined; this pixel is not compared. The squares mark the pixels that
//! `dapple-synth` compares.

use crate::draw::Canvas;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_raster::Window;
use dapple_synth::{Part, Reads, Shape};
use glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    number: "4a–c",
    parameters: &[("side", "5 pixels")],
    source: source!(),
    render,
};

/// Width and height of a neighborhood, in pixels.
const SIDE: u32 = 5;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    // Leave a margin of half a neighborhood pixel on all sides.
    let reach = 0.5 * f64::from(SIDE + 1);
    let window = Window::new(DVec2::splat(-reach), DVec2::splat(2.0 * reach), [size; 2])?;
    let pixel = f64::from(size) / 512.0;
    let mut panels = Vec::new();
    for (label, shape) in [("a", Shape::Full), ("b", Shape::Causal), ("c", Shape::Half)] {
        let mut canvas = Canvas::new(&window, 1.0)?;
        for [i, j] in Part::new(shape, SIDE, Reads::Same).offsets() {
            let center = DVec2::new(f64::from(i), f64::from(j));
            canvas.outline(&square(center), 3.0 * pixel, 0.0);
        }
        canvas.outline(&square(DVec2::ZERO), 3.0 * pixel, 0.0);
        canvas.disk(DVec2::ZERO, 24.0 * pixel, 0.0);
        canvas.disk(DVec2::ZERO, 21.0 * pixel, 1.0);
        panels.push(Panel::gray(label, canvas.into_raster()));
    }
    Ok(panels)
}

/// Returns the corners of the pixel centered at `center`.
fn square(center: DVec2) -> [DVec2; 4] {
    [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|corner| center + DVec2::from(corner))
}
