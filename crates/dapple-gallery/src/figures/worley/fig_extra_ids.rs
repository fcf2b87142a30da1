//! Data of the nearest feature point: its identity, as one color for each Voronoi cell, and the borders between cells,
//! where F2 − F1 is zero.
//!
//! A border of constant width needs the distance to it, which is (F2² − F1²) / 2d for feature points that are d apart.

use crate::draw::shrink;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_raster::{Raster, Window};
use dapple_worley::{Worley2, hash::Seed};
use glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("cells across", "4"),
        ("width of the borders", "0.03 cells"),
        ("color", "from the identity of the nearest point"),
    ],
    source: source!(),
    render,
};

/// Number of samples along each side of a pixel.
const SIDE: u32 = 3;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let fine = [size.saturating_mul(SIDE); 2];
    let window = Window::new(DVec2::ZERO, DVec2::splat(4.0), fine)?;
    let colors = [
        "#26456e", "#3f8f8c", "#a7c796", "#f3d98b", "#e08e4f", "#a23b45",
    ];
    let colors = ColorRamp::from_hex(&colors)?;
    let worley = Worley2::new(Seed(2));
    let cells = Raster::from_window(&window, |at| {
        let [first, second] = worley.sample(at);
        let apart = (first.vector - second.vector).length();
        let squares = second.vector.length_squared() - first.vector.length_squared();
        if squares / (2.0 * apart) < 0.015 {
            LinearRgb::gray(0.01)
        } else {
            colors.at(first.cell_value())
        }
    })?;
    Ok(vec![Panel::color("", shrink(&cells, SIDE)?)])
}
