//! Large blend maps, each tiled from Rn: eight copies of a blend tile of a texture, and of one of Perlin noise. One
//! level softens the seams but does not remove them.

use super::{BLEND_TILE, originals, report, tile_side, tiled};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_tile::{Method, Seamless};

pub(super) const FIGURE: Figure = Figure {
    number: "2",
    parameters: &[
        ("tile", "128 × 128"),
        ("map", "512 × 256"),
        (
            "filters",
            "quadratic B-spline, one level, Cook and DeRose's phase",
        ),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let [stone, _, _, clouds] = originals(tile_side(size))?;
    let seamless = Seamless::new(Method::SplineProject(BLEND_TILE));
    [stone, clouds]
        .into_iter()
        .map(|(name, original)| {
            let tile = seamless.apply(&original)?;
            let picture = tiled(&tile, size)?;
            Ok(Panel::gray(name, picture).with_note(report(&original, &tile)?))
        })
        .collect()
}
