//! Two textures blended by the repeatable blend tile of one of them: (c1) stone with grass, (c2) pebble with grass.
//!
//! The blend tile is computed from the stones' features, and grass appears first where it is low. So grass grows from
//! the cracks and around the pebbles, and only the tile controls this. It covers exactly 35 % of the ground.
//!
//! The textures are crops that do not repeat, like photographs. They are cut to tiles first. The features of a tile
//! then repeat, and halving and doubling smooths them.

use super::grass::grass;
use super::patch::Edges;
use super::pebble::pebble;
use super::stone::stone;
use super::{BLEND_TILE, cut, enlarged, report, stone_px, tile_side};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::LinearRgb;
use dapple_pups::hash::Seed;
use dapple_raster::Raster;
use dapple_tile::{
    Blend, BlendMap, Layer, Map, Method, Mixing, Seamless, Weighting, blend_by_tile, rank_equalize,
    repeat,
};

pub(super) const FIGURE: Figure = Figure {
    number: "4",
    parameters: &[
        ("tile, map", "128 × 128, 256 × 256"),
        ("margin of the cut", "32 pixels"),
        ("grass", "35 % of the area"),
        ("gain of the mask", "8"),
        ("recipe", "stone-and-grass"),
    ],
    source: source!(),
    render,
};

/// Fraction of the ground covered by grass.
const GRASS: f32 = 0.35;

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let side = tile_side(size);
    let map = [2 * side; 2];
    let (margin, cut) = cut(side);
    let seamless = Seamless::new(cut);
    let stones = stone(side + margin, Seed(1), Edges::Cropped)?.color;
    let pebbles = pebble(side + margin, Seed(1), Edges::Cropped)?.color;
    let (stone, pebble) = (
        seamless.apply_color(&stones)?,
        seamless.apply_color(&pebbles)?,
    );
    let (margin, cut) = super::cut(map[0]);
    let wide = grass(map[0] + margin, Seed(1), Edges::Cropped)?.color;
    let grass = Seamless::new(cut).apply_color(&wide)?;
    let feature = stone_px(stones.width());
    let on_stone = overgrown(&stone, feature, &grass)?;
    let on_pebble = overgrown(&pebble, feature, &grass)?;
    let features = rank_equalize(&BlendMap::new(feature).apply_color(&stone)?)?;
    let tile = blend_tile(&stone, feature)?;
    let panel = |label: &str, color: &Raster<LinearRgb>| -> anyhow::Result<Panel> {
        Ok(Panel::color(label, enlarged(&repeat(color, map)?, size)?).repeating())
    };
    Ok(vec![
        panel("stone", &stone)?,
        panel("pebble", &pebble)?,
        panel("grass", &grass)?,
        Panel::gray("blend tile of the stone", enlarged(&tile, size)?)
            .repeating()
            .with_note(report(&features, &tile)?),
        panel("c1: stone with grass", &on_stone)?,
        panel("c2: pebble with grass", &on_pebble)?,
    ])
}

/// Computes the blend tile of a texture: its features, which are `feature` pixels large, are halved and doubled once,
/// then replaced by ranks.
pub(super) fn blend_tile(ground: &Raster<LinearRgb>, feature: f64) -> anyhow::Result<Raster<f32>> {
    let features = BlendMap::new(feature).apply_color(ground)?;
    let tile = Seamless::new(Method::SplineProject(BLEND_TILE)).apply(&features)?;
    Ok(rank_equalize(&tile)?)
}

/// Tiles the ground, and adds grass where the blend tile of the ground is low.
fn overgrown(
    ground: &Raster<LinearRgb>,
    feature: f64,
    grass: &Raster<LinearRgb>,
) -> anyhow::Result<Raster<LinearRgb>> {
    let size = grass.size();
    let mask = repeat(&blend_tile(ground, feature)?, size)?;
    let maps = [
        [Map::Color(grass.clone())],
        [Map::Color(repeat(ground, size)?)],
    ];
    let weights = [GRASS, 1.0 - GRASS].map(|weight| Raster::filled(size, weight));
    let [of_grass, of_ground] = weights;
    let (of_grass, of_ground) = (of_grass?, of_ground?);
    let layer = |maps, weight| Layer {
        maps,
        weight,
        height: None,
    };
    let layers = [layer(&maps[0], &of_grass), layer(&maps[1], &of_ground)];
    let how = Blend::new(Weighting::Mask { gain: 8.0 }, Mixing::Linear);
    let mut blended = blend_by_tile(&layers, &mask, &how)?;
    match blended.swap_remove(0) {
        Map::Color(color) => Ok(color),
        other => anyhow::bail!("colors became {other:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Edges, GRASS, overgrown, pebble, stone, stone_px};
    use dapple_color::LinearRgb;
    use dapple_pups::hash::Seed;
    use dapple_raster::Raster;

    #[test]
    fn grass_grows_in_the_cracks_and_not_on_the_stones() {
        for (name, ground) in [
            ("stone", stone(128, Seed(1), Edges::Repeating).unwrap()),
            ("pebble", pebble(128, Seed(1), Edges::Repeating).unwrap()),
        ] {
            // A pixel is grass if it changes with the grass color.
            let [on_black, on_white] = [0.0, 1.0].map(|gray| {
                let grass = Raster::filled([128; 2], LinearRgb::gray(gray)).unwrap();
                overgrown(&ground.color, stone_px(128), &grass).unwrap()
            });
            let grass = on_black.zip_map(&on_white, |a, b| b.g - a.g).unwrap();
            let covered = grass.statistics().mean;
            // The soft edges of the mask are symmetric, except at its ends.
            assert!(
                (covered - f64::from(GRASS)).abs() < 0.01,
                "grass covers {covered} of {name}"
            );
            let mean_where = |in_gap: bool| {
                let pixels = ground.gap.pixels().iter().zip(grass.pixels());
                let here: Vec<f32> = pixels
                    .filter(|(gap, _)| (**gap > 0.5) == in_gap)
                    .map(|(_, grass)| *grass)
                    .collect();
                here.iter().sum::<f32>() / here.len() as f32
            };
            // If grass ignored the stones, both fractions would be 0.35. Gaps between pebbles are two pixels wide, the
            // minimum width that survives halving.
            let [in_gaps, on_stones] = [true, false].map(mean_where);
            assert!(
                in_gaps > 0.6 && on_stones < 0.27,
                "grass covers {in_gaps} of the gaps and {on_stones} of the stones: {name}"
            );
        }
    }
}
