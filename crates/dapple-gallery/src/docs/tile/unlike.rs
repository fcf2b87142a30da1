//! Rows of images about maps in which the interiors of a tile's copies differ.

use super::pebbles;
use crate::docs::Strip;
use crate::docs::picture::{GRAYS, shaded};
use dapple_raster::Raster;
use dapple_tile::{CornerTiles, Disturbance, Map, MatchBorders, repeat};
use dapple_worley::hash::Seed;

/// Width and height of a tile, in pixels.
const TILE: u32 = 40;

/// Size of an image in pixels; it is three tiles wide and high.
const MAP: [u32; 2] = [3 * TILE; 2];

pub(super) const DISTURBANCE: Strip = Strip {
    name: "disturbance",
    caption: "Three by three copies",
    render: || {
        let [tile, _] = tiles()?;
        let disturbance = Disturbance {
            frozen: 3,
            margin: 16,
            seed: Seed(2),
        };
        let disturbed = disturbance.render(&tile, [0, 0], MAP)?;
        Ok(vec![
            shaded("of one tile", &repeat(&tile, MAP)?, GRAYS),
            shaded("disturbed inside", &disturbed, GRAYS),
        ])
    },
};

pub(super) const MATCH_BORDERS: Strip = Strip {
    name: "match-borders",
    caption: "Two tiles in turns",
    render: || {
        let tiles = tiles()?;
        let matched = MatchBorders {
            width: TILE / 8 * 3,
            ..MatchBorders::default()
        };
        let matched = matched.apply(&tiles)?;
        Ok(vec![
            shaded("as they are", &board(&tiles)?, GRAYS),
            shaded("with the same borders", &board(&matched)?, GRAYS),
        ])
    },
};

pub(super) const CORNER_TILES: Strip = Strip {
    name: "corner-tiles",
    caption: "",
    render: || {
        let tiles = tiles()?.map(|tile| vec![Map::Value(tile)]);
        let maps = CornerTiles::new(&tiles)?.render(Seed(3), [0, 0], MAP)?;
        let [Map::Value(map)] = maps.as_slice() else {
            anyhow::bail!("numbers became something else");
        };
        Ok(vec![shaded("corner tiles of two textures", map, GRAYS)])
    },
};

/// Returns two tiles with different cells.
fn tiles() -> anyhow::Result<[Raster<f32>; 2]> {
    Ok([
        pebbles(3, TILE, true, Seed(8))?,
        pebbles(5, TILE, true, Seed(8))?,
    ])
}

/// Lays two tiles out as a checkerboard.
fn board(tiles: &[Raster<f32>]) -> anyhow::Result<Raster<f32>> {
    Ok(Raster::from_fn(MAP, |column, row| {
        let tile = &tiles[((column / TILE + row / TILE) % 2) as usize];
        tile.row(row % TILE)[(column % TILE) as usize]
    })?)
}
