//! Perlin turbulence: the sum of the folded textures from figure 7.

use super::picture;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{OctavesOptions, hash::Seed, turbulence};

pub(super) const FIGURE: Figure = Figure {
    number: "8",
    parameters: &[
        ("octaves", "4"),
        ("minimum distance", "0.1 · 2^−i"),
        ("amplitude", "2^−i"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let sum = turbulence(&OctavesOptions::default(), Seed(7))?;
    Ok(vec![picture("", &sum.normalized(), size)?])
}
