//! The tile group: filling a large blend map from a stored tile, compared with computing it pixel by pixel.
//!
//! The map has 4096×4096 pixels in preallocated memory (the feature map allocates its own, which takes a tenth of its
//! time), and the tile has 128×128. Confirmed: every copy in the map equals the tile.

#[cfg(feature = "peers")]
mod beside_peers;

use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use crate::sets::SEED;
use anyhow::{Result, ensure};
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_tile::{BlendMap, repeat_into};
use dapple_wavelet::wavelet_tile;

/// Width and height of the map in pixels.
const MAP: u32 = 4096;

/// Width and height of the tile in pixels.
const TILE: u32 = 128;

/// Note about memory: a stored tile compared with a stored map.
const MEMORY: &str = "the stored tile has 64 KiB, a stored map of this size 64 MiB";

const FEATURES: Case = Case {
    group: "tile",
    case: "blend map 4096×4096 from a tile of 128×128",
    peer: "ours, the feature map of a texture, per pixel",
    unit: Unit::NsPerPixel,
    must: Goal::Faster(10.0),
    note: MEMORY,
};

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    beside_peers::run(bench)?;
    if bench.wants(&FEATURES) {
        feature_map(bench)?;
    }
    Ok(())
}

fn feature_map(bench: &mut Bench) -> Result<()> {
    let tile = tile()?;
    let texture = map_of(&tile)?.map(|&value| LinearRgb::gray(0.5 + 0.2 * value));
    let blend_map = BlendMap::default();
    let theirs = Side::new(Raster::filled([1, 1], 0.0)?, |map| {
        *map = blend_map
            .apply_color(&texture)
            .expect("the texture is finite");
    });
    bench.beside(&FEATURES, 5, splat(&tile)?, theirs, |ours, theirs| {
        confirm(&tile, ours)?;
        let range = theirs.statistics();
        ensure!(range.deviation > 0.01, "the feature map is flat");
        Ok(Done {
            ours: ours.pixels().len(),
            theirs: theirs.pixels().len(),
        })
    })
}

/// Computes a seamless tile.
fn tile() -> Result<Raster<f32>> {
    Ok(wavelet_tile([TILE; 2], &[0.3, 0.5, 0.7, 1.0], SEED)?)
}

/// Fills a blend map with copies of a tile.
fn map_of(tile: &Raster<f32>) -> Result<Raster<f32>> {
    let mut map = Raster::filled([MAP; 2], 0.0)?;
    repeat_into(tile, [0, 0], map.view_mut());
    Ok(map)
}

/// Returns our side: it fills a map with copies of a tile.
fn splat(tile: &Raster<f32>) -> Result<Side<'_, Raster<f32>>> {
    Ok(Side::new(map_of(tile)?, move |map: &mut Raster<f32>| {
        repeat_into(tile, [0, 0], map.view_mut());
    })
    .prepared(|map| map.pixels_mut().fill(0.0))
    .times(8))
}

/// Fails if a map does not consist of copies of the tile.
fn confirm(tile: &Raster<f32>, map: &Raster<f32>) -> Result<()> {
    for row in 0..MAP {
        let expected = tile.row(row % TILE);
        let found = map.row(row).chunks_exact(TILE as usize);
        ensure!(
            found.into_iter().all(|copy| copy == expected),
            "row {row} of the map is not made of the tile"
        );
    }
    Ok(())
}
