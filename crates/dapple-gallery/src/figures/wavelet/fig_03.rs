//! Maps tiled by blend tiles: (a) the original tiles, (b) the paper's, halved and doubled once, (c) ours, made periodic
//! before that. Below each map stands what was measured at its seams.
//!
//! The paper says that b1 to b4 have "nearly no discontinuities". One level leaves a third of a step (0.34 in this phase),
//! and of the finest octave a third of the power. With the periodic part first, the seams are gone at all scales.

use super::{BLEND_TILE, beside, originals, report, tile_side};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_raster::Raster;
use dapple_tile::{Method, Seamless, repeat};

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
            panels.push(panel(label, original, &tile)?);
        }
    }
    Ok(panels)
}

fn panel(label: String, original: &Raster<f32>, tile: &Raster<f32>) -> anyhow::Result<Panel> {
    let map = repeat(tile, tile.size().map(|side| 2 * side))?;
    let picture = beside(tile, &map, 1.0)?;
    Ok(Panel::gray(label, picture).with_note(report(original, tile)?))
}
