//! The steps of the method: (a) a blend map R of a texture, (b) the half-size image Rd, (c) the full-size image Rn.
//!
//! The texture is the stone of figure 4. Pixels are enlarged four times.

use super::{BLEND_TILE, enlarged, originals, tile_side};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_raster::Raster;

pub(super) const FIGURE: Figure = Figure {
    number: "1",
    parameters: &[
        ("tile", "128 × 128 of a picture of 512"),
        ("filters", "quadratic B-spline, one level, periodic"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let side = tile_side(size);
    let [(_, map), ..] = originals(side)?;
    let half = BLEND_TILE.coarse(&map, [true; 2])?;
    let full = BLEND_TILE.refine(&half, [side; 2], [true; 2])?;
    // The half-size image is centered on a white sheet, to show that it is half as large.
    let margin = side / 4;
    let inside = |at: u32| at.checked_sub(margin).filter(|at| *at < side / 2);
    let sheet = Raster::from_fn([side; 2], |column, row| {
        inside(column)
            .zip(inside(row))
            .map_or(1.0, |(column, row)| half.row(row)[column as usize])
    })?;
    [("a: R", map), ("b: Rd", sheet), ("c: Rn", full)]
        .into_iter()
        .map(|(label, raster)| Ok(Panel::gray(label, enlarged(&raster, size)?)))
        .collect()
}
