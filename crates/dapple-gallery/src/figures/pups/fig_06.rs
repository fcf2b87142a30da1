//! Multiscale Perlin noise textures (four octaves).
//!
//! Equation 5: every octave has separate control points, at half the distance and with half the amplitude of the
//! previous octave. The paper does not say how the sum, which reaches 1.875, becomes a shade. Hardly any of it is near
//! its bounds, so here the mean is a middle gray, and black and white are 2.5 standard deviations away from it.

use super::picture;
use crate::figure::source;
use crate::{Figure, Panel, Picture};
use dapple_pups::{OctavesOptions, hash::Seed, octaves};

pub(super) const FIGURE: Figure = Figure {
    number: "6",
    parameters: &[
        ("octaves", "4"),
        ("minimum distance", "0.1 · 2^−i"),
        ("amplitude", "2^−i"),
        ("black to white", "mean ± 2.5 standard deviations"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let mut panels = Vec::new();
    for (label, seed) in [("first", Seed(6)), ("second", Seed(66))] {
        let sum = octaves(&OctavesOptions::default(), seed)?;
        let mut panel = picture(label, &sum, size)?;
        if let Picture::Gray(shades) = &mut panel.picture {
            let values = shades.statistics();
            let [mean, reach] = [values.mean, 2.5 * values.deviation].map(|value| value as f32);
            *shades = shades.map(|value| 0.5 + 0.5 * (value - mean) / reach);
        }
        panels.push(panel);
    }
    Ok(panels)
}
