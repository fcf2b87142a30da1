//! Multiple scales of Perlin-noise type textures, before and after folding: a corner of the square, an eighth of its
//! area.
//!
//! In the whole square, the control points of the last octave would be three pixels apart.

use crate::figure::source;
use crate::{Figure, Panel};
use dapple_points::Domain;
use dapple_pups::{OctavesOptions, hash::Seed, octaves};
use dapple_raster::{Field, Window};

pub(super) const FIGURE: Figure = Figure {
    number: "7",
    parameters: &[
        ("minimum distance", "0.1 · 2^−i"),
        ("folding", "T′ = 2 |T − 0.5|"),
        ("shown", "a corner, 0.7 wide, of the square [−1, 1]²"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let square = Domain::paper_torus();
    let corner = Window::new(square.origin, square.size * 0.35, [size; 2])?;
    let plain = octaves(&OctavesOptions::default(), Seed(7))?;
    let folded = plain.clone().folded();
    let mut panels = Vec::new();
    for (name, octaves) in [("", plain), (", folded", folded)] {
        for (i, octave) in octaves.layers().iter().enumerate() {
            let label = format!("octave {i}{name}");
            panels.push(Panel::gray(label, octave.to_raster(&corner)?));
        }
    }
    Ok(panels)
}
