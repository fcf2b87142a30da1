//! Multiple scales of Perlin-noise type textures, before and after folding.

use super::picture;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::{OctavesOptions, hash::Seed, octaves};

pub(super) const FIGURE: Figure = Figure {
    number: "7",
    parameters: &[
        ("minimum distance", "0.1 · 2^−i"),
        ("folding", "T′ = 2 |T − 0.5|"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let plain = octaves(&OctavesOptions::default(), Seed(7))?;
    let folded = plain.clone().folded();
    let mut panels = Vec::new();
    for (name, octaves) in [("", plain), (", folded", folded)] {
        for (i, octave) in octaves.layers().iter().enumerate() {
            panels.push(picture(format!("octave {i}{name}"), octave, size)?);
        }
    }
    Ok(panels)
}
