//! A terrain of stone, grass and soil: linear splatting, and blending by the blend tiles of the ground.
//!
//! Stone is placed where the land is steep or high, grass where it is low and flat, and soil between. Splatting fades
//! the textures into each other, and grass shines through the stones. With the paper's method grass and soil "growth
//! around the pebbles and stone, or growth from the cracks". The stone's blend tile, computed from its features, halved
//! and doubled, determines where other textures appear first on it; the blend tile of the soil does the same for
//! grass. At every position both images have the same fractions of stone, soil and grass.

use super::super::fractal::FractalNoise;
use super::fig_04::blend_tile;
use super::grass::grass;
use super::patch::Edges;
use super::soil::soil;
use super::stone::stone;
use super::{stone_px, tile_side};
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{HeightPlane, LinearRgb, Normal, normal_map};
use dapple_pups::hash::Seed;
use dapple_raster::{Raster, Window};
use dapple_tile::{
    Blend, Layer, Map, Mixing, Weighting, blend, blend_by_tile, rank_equalize, repeat,
};
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("textures", "three tiles of 256 × 256"),
        ("blend tiles", "of the stone and of the soil"),
        ("gain of the masks", "8"),
    ],
    source: source!(),
    render,
};

/// Size of a soil crumb, as a fraction of a stone's size.
const CRUMB: f64 = 0.4;

/// Textures over the whole terrain, and blend tiles for the stone and the soil, which other textures cover.
struct Ground {
    stone: Raster<LinearRgb>,
    grass: Raster<LinearRgb>,
    soil: Raster<LinearRgb>,
    stone_mask: Raster<f32>,
    soil_mask: Raster<f32>,
}

/// Fraction of stone on the terrain, and fraction of grass on the remaining ground, at each pixel.
struct Shares {
    stone: Raster<f32>,
    grass: Raster<f32>,
}

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let window = Window::unit([size; 2])?;
    let noise = FractalNoise::new(0.45, Seed(12))?;
    let land = Raster::from_window(&window, |at| noise.at(at))?;
    let plane = HeightPlane {
        strength: 0.3,
        ..HeightPlane::default()
    };
    let normals = normal_map(&land, &plane.into())?;
    let shares = shares(&land, &normals.map(|normal| normal.z))?;
    let ground = Ground::new(size)?;
    [
        ("linear splatting", ground.splatted(&shares)?),
        ("by blend tiles", ground.by_tiles(&shares)?),
    ]
    .into_iter()
    .map(|(label, color)| Ok(Panel::color(label, lit(&color, &normals)?)))
    .collect()
}

impl Ground {
    fn new(size: u32) -> anyhow::Result<Self> {
        let side = 2 * tile_side(size);
        let [stone, grass, soil] =
            [stone, grass, soil].map(|make| make(side, Seed(1), Edges::Repeating));
        let (stone, grass, soil) = (stone?.color, grass?.color, soil?.color);
        let feature = stone_px(side);
        let large = |tile: &Raster<LinearRgb>| repeat(tile, [size; 2]);
        Ok(Self {
            stone_mask: repeat(&blend_tile(&stone, feature)?, [size; 2])?,
            soil_mask: repeat(&blend_tile(&soil, CRUMB * feature)?, [size; 2])?,
            stone: large(&stone)?,
            grass: large(&grass)?,
            soil: large(&soil)?,
        })
    }

    /// Blends stone, grass and soil linearly by their fractions.
    fn splatted(&self, shares: &Shares) -> anyhow::Result<Raster<LinearRgb>> {
        let lower = over([&self.grass, &self.soil], &shares.grass, None)?;
        over([&self.stone, &lower], &shares.stone, None)
    }

    /// Blends with blend tiles. Grass first covers soil where the soil's tile is low; both first cover stone where the
    /// stone's tile is low.
    fn by_tiles(&self, shares: &Shares) -> anyhow::Result<Raster<LinearRgb>> {
        let lower = over(
            [&self.grass, &self.soil],
            &shares.grass,
            Some(&self.soil_mask),
        )?;
        let other = shares.stone.map(|stone| 1.0 - stone);
        over([&lower, &self.stone], &other, Some(&self.stone_mask))
    }
}

/// Blends the first texture over the second one by the fraction `share`: linearly if `mask` is `None`, otherwise where
/// the mask is lowest.
fn over(
    textures: [&Raster<LinearRgb>; 2],
    share: &Raster<f32>,
    mask: Option<&Raster<f32>>,
) -> anyhow::Result<Raster<LinearRgb>> {
    let maps = textures.map(|texture| [Map::Color(texture.clone())]);
    let rest = share.map(|share| 1.0 - share);
    let layer = |maps, weight| Layer {
        maps,
        weight,
        height: None,
    };
    let layers = [layer(&maps[0], share), layer(&maps[1], &rest)];
    let by_tile = Blend::new(Weighting::Mask { gain: 8.0 }, Mixing::Linear);
    let blended = match mask {
        Some(mask) => blend_by_tile(&layers, mask, &by_tile)?,
        None => blend(&layers, &Blend::default())?,
    };
    match blended.into_iter().next() {
        Some(Map::Color(color)) => Ok(color),
        other => anyhow::bail!("colors became {other:?}"),
    }
}

/// Shades the colors by the slopes of the terrain. The textures are lit as level ground, so level ground is
/// unchanged.
fn lit(color: &Raster<LinearRgb>, normals: &Raster<Normal>) -> anyhow::Result<Raster<LinearRgb>> {
    let toward = DVec3::new(-0.5, 0.5, 1.0);
    Ok(color.zip_map(normals, |&color, normal| {
        let normal = DVec3::from_array(normal.to_array().map(f64::from));
        color * (0.2 + 0.8 * normal.dot(toward).max(0.0)) as f32
    })?)
}

/// Computes the fractions of stone and of grass from the height rank and the levelness of the terrain.
fn shares(land: &Raster<f32>, level: &Raster<f32>) -> anyhow::Result<Shares> {
    let rise = |from: f32, to: f32, value: f32| ((value - from) / (to - from)).clamp(0.0, 1.0);
    let lower = rank_equalize(land)?;
    let stone = lower.zip_map(level, |&lower, &level| {
        rise(0.85, 0.6, level).max(rise(0.45, 0.9, lower))
    })?;
    let grass = lower.map(|&lower| rise(0.65, 0.25, lower));
    Ok(Shares { stone, grass })
}

#[cfg(test)]
mod tests {
    use super::{Ground, Shares};
    use dapple_color::LinearRgb;
    use dapple_raster::Raster;

    #[test]
    fn what_is_not_stone_comes_from_the_cracks_and_leaves_the_stones_whole() {
        let size = 256;
        let mut ground = Ground::new(size).unwrap();
        let flat = |color| Raster::filled([size; 2], color).unwrap();
        // Everything except stone is white, so a pixel's brightness is the fraction that is not stone.
        ground.stone = flat(LinearRgb::BLACK);
        (ground.grass, ground.soil) = (flat(LinearRgb::WHITE), flat(LinearRgb::WHITE));
        let shares = Shares {
            stone: Raster::filled([size; 2], 0.6).unwrap(),
            grass: Raster::filled([size; 2], 0.5).unwrap(),
        };
        let mean_where = |picture: &Raster<LinearRgb>, low: bool| {
            let pixels = picture.pixels().iter().zip(ground.stone_mask.pixels());
            let here = pixels.filter(|(_, mask)| (**mask < 0.5) == low);
            let values: Vec<f32> = here.map(|(color, _)| color.g).collect();
            values.iter().sum::<f32>() / values.len() as f32
        };
        let splatted = ground.splatted(&shares).unwrap();
        let by_tiles = ground.by_tiles(&shares).unwrap();
        for low in [false, true] {
            assert!(
                (mean_where(&splatted, low) - 0.4).abs() < 1e-3,
                "everywhere alike"
            );
        }
        let [cracks, stones] = [true, false].map(|low| mean_where(&by_tiles, low));
        // Grass and soil cover 40 % of the area, entirely in the lower half of the mask.
        assert!(
            cracks > 0.75 && stones < 0.05,
            "{cracks} in cracks, {stones} on stones"
        );
        assert!(
            (0.5 * (cracks + stones) - 0.4).abs() < 0.01,
            "the same share"
        );
    }
}
