//! Colors of a palette at the control points, interpolated: values may be vectors.

use super::square;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_pups::{ColorNoiseOptions, Spacing, color_noise, hash::Seed};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[("minimum distance", "0.2"), ("colors", "4")],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let options = ColorNoiseOptions {
        spacing: Spacing::from(0.2),
        ..ColorNoiseOptions::default()
    };
    let texture = color_noise(&options, Seed(18))?;
    let colors = texture.to_raster(&square(size)?)?;
    let colors = colors.map(|&[red, green, blue]| LinearRgb::new(red, green, blue));
    Ok(vec![Panel::color("", colors).repeating()])
}
