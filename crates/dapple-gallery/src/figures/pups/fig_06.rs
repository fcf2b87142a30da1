//! Multiscale Perlin noise textures (four octaves).
//!
//! Equation 5: every octave has control points of its own, at half the distance and with half the amplitude of the
//! one before. The sum reaches 1.875, by which it is divided here.

use super::picture;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{OctavesOptions, hash::Seed, octaves};

pub(super) const FIGURE: Figure = Figure {
    number: "6",
    parameters: &[
        ("octaves", "4"),
        ("minimum distance", "0.1 · 2^−i"),
        ("amplitude", "2^−i"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let noise = |seed| octaves(&OctavesOptions::default(), seed);
    Ok(vec![
        picture("first", &noise(Seed(6))?.normalized(), size)?,
        picture("second", &noise(Seed(66))?.normalized(), size)?,
    ])
}
