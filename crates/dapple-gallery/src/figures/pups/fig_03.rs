//! The weight shifting as the orientation is (a) almost aligned with the z-axis to be (c) almost aligned with the
//! x-axis; ε = 0.1.
//!
//! The lines are isovalues of the shifted weight: 0.1 and 0.3 in white, 0.5, 0.7 and 0.9 in black. With the paper's ε
//! the shift is small; the second row has its default of 0.5.

use super::weight::Star;
use crate::draw::Canvas;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{Orientation, PupsOptions};
use dapple_raster::Raster;
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "3a–c",
    parameters: &[
        ("ε", "0.1; in the second row 0.5"),
        ("orientation, x : z", "1 : 9 (a), 1 : 1 (b), 9 : 1 (c)"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let star = Star::new()?;
    let window = star.window(size)?;
    let pixel = f64::from(size) / 512.0;

    let mut panels = Vec::new();
    for (label, strength, [x, z]) in [
        ("a", 0.1, [1.0, 9.0]),
        ("b", 0.1, [1.0, 1.0]),
        ("c", 0.1, [9.0, 1.0]),
        ("a, ε = 0.5", 0.5, [1.0, 9.0]),
        ("b, ε = 0.5", 0.5, [1.0, 1.0]),
        ("c, ε = 0.5", 0.5, [9.0, 1.0]),
    ] {
        let vectors = vec![DVec3::new(x, 0.0, z)];
        let pups = star.pups(PupsOptions {
            orientation: Some(Orientation { vectors, strength }),
            ..PupsOptions::default()
        })?;
        let weights = Raster::from_window(&window, |at| pups.weight(star.center, at))?;
        let mut canvas = Canvas::over(&window, weights.clone())?;
        canvas.iso_lines(&weights, &[0.1, 0.3], 1.5 * pixel, 1.0)?;
        canvas.iso_lines(&weights, &[0.5, 0.7, 0.9], 1.5 * pixel, 0.0)?;
        canvas.disk(star.points.position(star.center), 4.0 * pixel, 0.0);
        panels.push(Panel::gray(label, canvas.into_raster()));
    }
    Ok(panels)
}
