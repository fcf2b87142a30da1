//! The method `synth` of `dapple tile`: re-synthesizes a strip along the seam.

use super::method::Resynthesis;
use crate::encode::map_raster;
use crate::error::{Hint, usage};
use crate::exemplar::exemplar_of;
use anyhow::{Error, Result};
use core::ops::ControlFlow;
use dapple::synth::{Edges, Exemplar, Options, SynthError, tile_plane};
use dapple::tile::Map;

/// Maximum side of the exemplar for matching, in pixels. Larger images are downscaled for matching; their tiles copy
/// blocks of the original pixels.
const MOST: u32 = 512;

/// Minimum shorter side of the exemplar at which matching uses four levels instead of three, in pixels.
const LARGE: u32 = 384;

/// Returns a tile of each map. All tiles copy their pixels from the same source positions.
///
/// # Errors
///
/// If the synthesis fails.
pub(super) fn tiles(maps: &[Map], axes: [bool; 2], how: &Resynthesis) -> Result<Vec<Map>> {
    // Reduce the exemplar to the maximum side.
    let exemplar = exemplar(maps)?;
    let [width, height] = exemplar.size();
    let factor = width.max(height).div_ceil(MOST);
    let exemplar = exemplar.reduced(factor)?;
    let size = exemplar.size();
    let shorter = size[0].min(size[1]);
    let strip = match how.margin {
        Some(margin) => margin.div_ceil(factor),
        None => shorter * 3 / 16,
    };
    let options = Options {
        seed: how.seed,
        n_levels: if shorter < LARGE { 3 } else { 4 },
        ..Options::default()
    };
    let texture = tile_plane(&exemplar, axes, strip, &options, |_| {
        ControlFlow::Continue(())
    });
    let texture = texture.map_err(advise)?;
    // Transfer the original pixels of each map.
    let size = size.map(|side| side * factor);
    let tile = |map: &Map| -> Result<Map> {
        Ok(map_raster!(map, raster => texture.transfer(&raster.crop([0; 2], size)?)?))
    };
    maps.iter().map(tile).collect()
}

/// Builds the exemplar of a material, which has the channels of all its maps.
fn exemplar(maps: &[Map]) -> Result<Exemplar> {
    let mut exemplars = maps.iter().map(|map| exemplar_of(map, Edges::Cut));
    let Some(first) = exemplars.next() else {
        return Err(usage("missing image"));
    };
    let joined = exemplars.try_fold(first?, |all, map| all.with_channels(&map?, 1.0));
    Ok(joined?)
}

/// Adds a hint to an error about a size.
fn advise(error: SynthError) -> Error {
    Error::new(error)
        .hint("take a larger image, or another --margin")
        .wrong_value()
}
