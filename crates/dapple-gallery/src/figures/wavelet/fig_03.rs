//! Maps tiled by blend tiles: (a) the original tiles, (b) the paper's, halved and doubled once, (c) ours, made periodic
//! before that. Below each map stands what was measured at its seams.
//!
//! The paper says that b1 to b4 have "nearly no discontinuities". One level leaves a third of a step (0.34 in this phase).
//! With the periodic part first, the seams are gone at all scales. Where the original has next to nothing in the finest
//! octave, as the smooth noise, a little that doubling brings in counts as many times its power.

use super::{BLEND_TILE, beside, originals, report, tile_side};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_tile::{Method, Seamless};

pub(super) const FIGURE: Figure = Figure {
    number: "3",
    parameters: &[
        ("1, 2", "blend tiles of stone and pebble"),
        ("3, 4", "Perlin noise of one octave and of five"),
        ("tile, map", "128 × 128, 256 × 256"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let originals = originals(tile_side(size))?;
    let mut panels = Vec::new();
    for (letter, method) in [
        ('a', None),
        ('b', Some(Method::SplineProject(BLEND_TILE))),
        ('c', Some(Method::PeriodicThenProject(BLEND_TILE))),
    ] {
        for (number, (name, original)) in (1..).zip(&originals) {
            let tile = match method {
                Some(method) => Seamless::new(method).apply(original)?,
                None => original.clone(),
            };
            let label = format!("{letter}{number}: {name}");
            let picture = beside(&tile, size)?;
            panels.push(Panel::gray(label, picture).with_note(report(original, &tile)?));
        }
    }
    Ok(panels)
}
