//! Iterative process to assign points to groups: each iteration has twice as many points, and uses the interpolated
//! image of the previous one as its reference image. The boundary becomes fractal.

use super::flower::flower;
use super::{picture, square};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{IteratedOptions, ReferenceImage, hash::Seed, iterated_reference};

pub(super) const FIGURE: Figure = Figure {
    number: "14",
    parameters: &[
        ("iterations", "4"),
        ("minimum distance", "0.1 · 2^(−i/2)"),
        ("reference image", "that of figure 13"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let image = ReferenceImage::new(flower(&square(256)?)?)?;
    let iterations = iterated_reference(&image, &IteratedOptions::default(), Seed(14))?;
    let mut panels = Vec::new();
    for (number, texture) in (1..).zip(&iterations) {
        panels.push(picture(format!("iteration {number}"), texture, size)?);
    }
    Ok(panels)
}
