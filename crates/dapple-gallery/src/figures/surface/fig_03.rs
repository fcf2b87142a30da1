//! Relative distance along the vector field of vertices v and w.
//!
//! Both are projected onto their consensus orientation; Δ is how much further downstream v is than w.

use crate::draw::Canvas;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_raster::Window;
use glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    number: "3",
    parameters: &[("consensus orientation", "(O(v) + O(w)) / 2, of length 1")],
    source: source!(),
    render,
};

/// A vertex of the diagram: its position and its orientation, which need not have length 1.
const V: [DVec2; 2] = [DVec2::new(0.70, 0.22), DVec2::new(0.95, 0.10)];
const W: [DVec2; 2] = [DVec2::new(0.26, 0.40), DVec2::new(0.85, 0.45)];

/// The other edges of the mesh, which are drawn only as context.
const MESH: [[DVec2; 2]; 8] = {
    let [v, w] = [V[0], W[0]];
    let [above, below] = [DVec2::new(0.42, 0.08), DVec2::new(0.62, 0.56)];
    let [left, right] = [DVec2::new(0.06, 0.20), DVec2::new(0.95, 0.42)];
    [
        [above, v],
        [above, w],
        [below, v],
        [below, w],
        [left, above],
        [left, w],
        [right, v],
        [right, below],
    ]
};

/// Start of the line that shows the consensus orientation.
const START: DVec2 = DVec2::new(0.10, 0.62);

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let window = Window::unit([size; 2])?;
    let pixel = f64::from(size) / 512.0;
    let mut canvas = Canvas::new(&window, 1.0)?;

    let [[v, v_field], [w, w_field]] = [V, W];
    let consensus = (v_field.normalize() + w_field.normalize()).normalize();
    let foot = |vertex: DVec2| START + (vertex - START).dot(consensus) * consensus;

    canvas.lines(&MESH, 1.5 * pixel, 0.8);
    canvas.lines(&[[v, w]], 3.0 * pixel, 0.0);
    for [vertex, field] in [V, W] {
        canvas.arrow([vertex, vertex + 0.16 * field], 2.0 * pixel, 0.55);
        let drop = [vertex, foot(vertex)];
        let n_dashes = (24.0 * drop[0].distance(drop[1])) as u32;
        canvas.dashes(drop, n_dashes, 2.0 * pixel, 0.0);
        canvas.disk(vertex, 8.0 * pixel, 0.0);
    }
    let end = START + 0.86 * consensus;
    canvas.arrow([START, end], 3.0 * pixel, 0.0);
    // Δ is drawn below the line.
    let below = 0.07 * consensus.perp();
    let bracket = [foot(w), foot(v)].map(|end| end + below);
    canvas.lines(&[bracket], 2.0 * pixel, 0.0);
    for end in bracket {
        canvas.lines(&[[end - 0.3 * below, end + 0.3 * below]], 2.0 * pixel, 0.0);
    }
    for (start, text) in [
        (v + DVec2::new(-0.01, -0.05), "v"),
        (w + DVec2::new(-0.08, -0.02), "w"),
    ] {
        canvas.text(start, 34.0 * pixel, text, 0.0);
    }
    with_subscript(&mut canvas, end + DVec2::new(-0.11, -0.11), pixel, "O");
    let middle = bracket[0].midpoint(bracket[1]);
    with_subscript(&mut canvas, middle + DVec2::new(-0.03, 0.11), pixel, "Δ");
    Ok(vec![Panel::gray("", canvas.into_raster())])
}

/// Draws a letter with the subscript "vw", which stands for both vertices.
fn with_subscript(canvas: &mut Canvas<f32>, start: DVec2, pixel: f64, letter: &str) {
    canvas.text(start, 34.0 * pixel, letter, 0.0);
    let below = start + DVec2::new(0.065, 0.02);
    canvas.text(below, 22.0 * pixel, "vw", 0.0);
}
