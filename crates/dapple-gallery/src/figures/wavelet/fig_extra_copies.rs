//! Maps of more than one tile: copies of one tile, copies whose interiors are changed, different tiles with the same
//! borders, and corner tiles.
//!
//! Copies show their repetition. A changed copy has the tile's border, and another piece of the tile inside.
//! Different tiles fit in any order once they all have the border of one of them. Corner tiles fit because an edge
//! depends only on the colors of its two ends. All are joined along cuts where the pieces are most similar, without
//! blending.

use super::patch::Edges;
use super::pebble::pebble;
use super::tile_side;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_pups::hash::Seed;
use dapple_tile::{CornerTiles, Disturbance, Map, MatchBorders, repeat};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("tile, map", "128 × 128, 512 × 512"),
        ("tiles", "pebbles, of three seeds"),
        ("frozen, margin", "4, 36 pixels"),
        ("width of matched borders", "40 pixels"),
        ("width of the cuts of corner tiles", "0.9"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let side = tile_side(size);
    let tile = |seed| pebble(side, Seed(seed), Edges::Repeating);
    let tiles = [tile(1)?.color, tile(2)?.color, tile(3)?.color];
    let maps = tiles.each_ref().map(|tile| vec![Map::Color(tile.clone())]);
    let disturbance = Disturbance {
        frozen: side / 32,
        margin: side * 9 / 32,
        seed: Seed(2),
    };
    let matched = MatchBorders {
        width: side * 5 / 16,
        ..MatchBorders::default()
    };
    let corners = CornerTiles::new(&maps)?.with_width(0.9)?;
    let (first, map) = ([0, 0], [size; 2]);
    // Maps of whole copies tile.
    let whole = [size.is_multiple_of(side); 2];
    Ok(vec![
        Panel::color("copies of one tile", repeat(&tiles[0], map)?).repeating_along(whole),
        panel(
            "disturbed inside of their borders",
            disturbance.render_maps(&maps[0], first, map)?,
        )?
        .repeating_along(whole),
        panel(
            "three tiles with the same borders",
            matched.render(&maps, Seed(4), first, map)?,
        )?
        .repeating_along(whole),
        panel(
            "corner tiles of three",
            corners.render(Seed(3), first, map)?,
        )?,
    ])
}

/// Builds the panel for the only map in `maps`.
fn panel(label: &str, maps: Vec<Map>) -> anyhow::Result<Panel> {
    match maps.into_iter().next() {
        Some(Map::Color(color)) => Ok(Panel::color(label, color)),
        other => anyhow::bail!("colors became {other:?}"),
    }
}
