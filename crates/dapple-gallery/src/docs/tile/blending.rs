//! Rows of documentation images that show blend maps, and two textures blended along a ramp.

use super::pebbles;
use crate::Panel;
use crate::docs::Strip;
use crate::docs::picture::{COLORS, GRAYS, colored, shaded};
use dapple_color::{LinearRgb, Palette};
use dapple_raster::Raster;
use dapple_tile::{
    Blend, BlendMap, Layer, Map, Mixing, Pyramid, Weighting, blend, blend_by_tile, rank_equalize,
};
use dapple_worley::hash::Seed;

/// Width and height of an image, in pixels.
const SMALL: u32 = 72;

pub(super) const BLEND_MAP: Strip = Strip {
    name: "blend-map",
    caption: "",
    render: || {
        let texture = grains(SMALL)?;
        let map = BlendMap::new(18.0).apply_color(&texture)?;
        Ok(vec![
            colored("a texture", &texture, COLORS),
            shaded("its blend map", &map, GRAYS),
        ])
    },
};

pub(super) const RANK_EQUALIZE: Strip = Strip {
    name: "rank-equalize",
    caption: "White is what is above one half",
    render: || {
        let tile = pebbles(5, SMALL, true, Seed(8))?;
        let above = |raster: &Raster<f32>| raster.map(|&value| f32::from(value > 0.5));
        Ok(vec![
            shaded("a tile", &tile, GRAYS),
            shaded("the tile", &above(&tile), 2.0),
            shaded(
                "its ranks: one half of the area",
                &above(&rank_equalize(&tile)?),
                2.0,
            ),
        ])
    },
};

pub(super) const WEIGHTING: Strip = Strip {
    name: "weighting",
    caption: "Two textures, from the one on the left to the one on the right",
    render: || {
        [
            ("given", Weighting::Given),
            ("height, depth 0.1", Weighting::Height { depth: 0.1 }),
            ("mask, gain 4", Weighting::Mask { gain: 4.0 }),
        ]
        .into_iter()
        .map(|(label, weighting)| blended(label, &Blend::new(weighting, Mixing::Linear)))
        .collect()
    },
};

pub(super) const MIXING: Strip = Strip {
    name: "mixing",
    caption: "Two textures, from the one on the left to the one on the right",
    render: || {
        [
            ("linear", Mixing::Linear),
            ("variance kept", Mixing::KeepVariance),
            ("pyramid", Mixing::Pyramid(Pyramid::default())),
        ]
        .into_iter()
        .map(|(label, mixing)| blended(label, &Blend::new(Weighting::Given, mixing)))
        .collect()
    },
};

/// Returns brown grains with dark gaps.
fn grains(side: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let height = pebbles(7, side, true, Seed(4))?;
    Ok(Palette::Ember
        .ramp()
        .apply(&height.map(|value| 0.3 + 0.5 * value)))
}

/// Blends grains on the left with a coarser blue texture on the right, by the method `how`.
fn blended(label: &str, how: &Blend) -> anyhow::Result<Panel> {
    let left = [Map::Color(grains(SMALL)?)];
    let coarse = pebbles(4, SMALL, true, Seed(5))?.map(|value| 0.2 + 0.6 * value);
    let right = [Map::Color(Palette::Lagoon.ramp().apply(&coarse))];
    let rise = Raster::from_fn([SMALL; 2], |column, _| {
        let along = (column as f32 + 0.5) / SMALL as f32;
        (1.6 * along - 0.3).clamp(0.0, 1.0)
    })?;
    let fall = rise.map(|weight| 1.0 - weight);
    let layer = |maps, weight| Layer {
        maps,
        weight,
        height: None,
    };
    let layers = [layer(&left, &fall), layer(&right, &rise)];
    let maps = if how.weighting == Weighting::Given {
        blend(&layers, how)?
    } else {
        let tile = rank_equalize(&pebbles(7, SMALL, true, Seed(4))?)?;
        blend_by_tile(&layers, &tile, how)?
    };
    match maps.into_iter().next() {
        Some(Map::Color(color)) => Ok(colored(label, &color, COLORS)),
        other => anyhow::bail!("colors became {other:?}"),
    }
}
