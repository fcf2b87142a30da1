//! Marble, wood grain and clouds: functions of tiled Perlin noise. First the small tiles; then the functions of the
//! map of the raw tile, with sharp seams; then the functions of the map of our tile.
//!
//! Ours is the periodic part of the raw tile, halved and doubled once.

use super::functions::{cloud, marble, wood};
use super::perlin::perlin;
use super::{BLEND_TILE, enlarged, report, tile_side};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_pups::hash::Seed;
use dapple_raster::Raster;
use dapple_tile::{Method, Seamless, repeat};

pub(super) const FIGURE: Figure = Figure {
    number: "5",
    parameters: &[
        ("tile, map", "128 × 128, 512 × 512"),
        ("noise", "Perlin, five octaves"),
        ("recipe", "marble"),
        ("recipe", "wood-grain"),
        ("recipe", "clouds"),
    ],
    source: source!(),
    render,
};

/// A function that colors a map of noise.
type Function = fn(&Raster<f32>) -> anyhow::Result<Raster<LinearRgb>>;

/// Each function with its name, the number of cells across its tile, and whether its image tiles if the map does.
const FUNCTIONS: [(&str, f64, bool, Function); 3] = [
    ("marble", 2.5, true, |noise| marble(noise, 8)),
    ("wood grain", 1.5, false, |noise| wood(noise, 12)),
    ("clouds", 3.3, true, cloud),
];

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let side = tile_side(size);
    let ours = Seamless::new(Method::PeriodicThenProject(BLEND_TILE));
    let mut rows = [Vec::new(), Vec::new(), Vec::new()];
    for (name, cells, repeats, function) in FUNCTIONS {
        let raw = perlin(side, cells, 5, Seed(5).child(name, 0))?;
        let tile = ours.apply(&raw)?;
        rows[0].push(Panel::gray(
            format!("tile for {name}"),
            enlarged(&raw, size)?,
        ));
        let repeats = repeats && size.is_multiple_of(side);
        for (row, label, tile, repeats) in [
            (1, "the raw tile", &raw, false),
            (2, "our tile", &tile, repeats),
        ] {
            let picture = function(&repeat(tile, [size; 2])?)?;
            let panel =
                Panel::color(format!("{name} of {label}"), picture).repeating_along([repeats; 2]);
            rows[row].push(panel.with_note(report(&raw, tile)?));
        }
    }
    Ok(rows.into_iter().flatten().collect())
}
