//! Maps tiled by blend tiles: (a) the original tiles, (b) the paper's tiles, halved and doubled once, (c) our tiles,
//! cut along the line of minimum difference. Below each map are the measurements at its seams, and its defects.
//!
//! The paper says that b1 to b4 have "nearly no discontinuities". One level leaves a third of a step (0.34 in this
//! phase), and removes the finest detail. A cut removes the step and preserves the detail, but needs a margin, here a
//! quarter of the tile, in which the original continues.

use super::{BLEND_TILE, cut, originals, report, tile_side, tiled};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_tile::{Method, Seamless};

pub(super) const FIGURE: Figure = Figure {
    number: "3",
    parameters: &[
        ("1, 2", "blend tiles of stone and pebble"),
        ("3, 4", "Perlin noise of one octave and of five"),
        ("tile, map", "128 × 128, 512 × 256"),
        ("margin of the cut", "32 pixels"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let side = tile_side(size);
    let (margin, cut) = cut(side);
    let wide = originals(side + margin)?;
    let mut panels = Vec::new();
    for letter in ['a', 'b', 'c'] {
        for (number, (name, wide)) in (1..).zip(&wide) {
            let original = wide.crop([0; 2], [side; 2])?;
            let tile = match letter {
                'a' => original.clone(),
                'b' => Seamless::new(Method::SplineProject(BLEND_TILE)).apply(&original)?,
                _ => Seamless::new(cut).apply(wide)?,
            };
            let label = format!("{letter}{number}: {name}");
            let picture = tiled(&tile, size)?;
            let source = if letter == 'c' { wide } else { &original };
            panels.push(Panel::gray(label, picture).with_note(report(source, &tile)?));
        }
    }
    Ok(panels)
}
