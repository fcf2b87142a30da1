//! A terrain of stone, grass and soil: linear splatting, and blending by tiles.
//!
//! Stone lies where the land is steep or high, grass where it is low and flat, soil between. On the left the textures fade
//! into each other; on the right each place is given to one of them by the features of a small tile of wavelet noise, and
//! what contrast is left to lose is kept.

use super::super::fractal::FractalNoise;
use super::grass::grass;
use super::patch::Edges;
use super::soil::soil;
use super::stone::stone;
use super::tile_side;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_color::{NormalOptions, normal_map};
use dapple_pups::hash::Seed;
use dapple_raster::{Raster, Window};
use dapple_tile::{
    Blend, Layer, Map, Mixing, Weighting, blend, blend_by_tile, rank_equalize, repeat,
};
use dapple_wavelet::wavelet_tile;
use glam::DVec3;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("textures", "three tiles of 256 × 256"),
        ("blend tile", "128 × 128, three bands of wavelet noise"),
        ("gain of the mask", "5"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let window = Window::unit([size; 2])?;
    let noise = FractalNoise::new(0.45, Seed(12))?;
    let land = Raster::from_window(&window, |at| noise.at(at))?;
    let normals = normal_map(
        &land,
        &NormalOptions {
            strength: 0.3,
            ..NormalOptions::default()
        },
    )?;
    let weights = weights(&land, &normals.map(|normal| normal.z))?;
    let side = 2 * tile_side(size);
    let tiles = [
        stone(side, Seed(1), Edges::Repeating)?,
        grass(side, Seed(1), Edges::Repeating)?,
        soil(side, Seed(1), Edges::Repeating)?,
    ];
    let mut maps = Vec::new();
    for tile in &tiles {
        maps.push([Map::Color(repeat(&tile.color, [size; 2])?)]);
    }
    let layers: Vec<Layer<'_>> = maps
        .iter()
        .zip(&weights)
        .map(|(maps, weight)| Layer {
            maps,
            weight,
            height: None,
        })
        .collect();
    let tile = wavelet_tile([tile_side(size); 2], &[0.1, 0.3, 1.0], Seed(6))?;
    let mask = repeat(&rank_equalize(&tile)?, [size; 2])?;
    let by_tile = Blend::new(Weighting::Mask { gain: 5.0 }, Mixing::KeepVariance);
    // The textures are lit as level ground, which stays as it is.
    let toward = DVec3::new(-0.5, 0.5, 1.0);
    [
        ("linear splatting", blend(&layers, &Blend::default())?),
        ("by tiles", blend_by_tile(&layers, &mask, &by_tile)?),
    ]
    .into_iter()
    .map(|(label, maps)| {
        let Some(Map::Color(color)) = maps.into_iter().next() else {
            anyhow::bail!("colors became something else");
        };
        let lit = color.zip_map(&normals, |&color, normal| {
            let normal = DVec3::from_array(normal.to_array().map(f64::from));
            color * (0.2 + 0.8 * normal.dot(toward).max(0.0)) as f32
        })?;
        Ok(Panel::color(label, lit))
    })
    .collect()
}

/// How much stone, grass and soil there is at each place, from how much of the land is lower, and how level it is.
fn weights(land: &Raster<f32>, level: &Raster<f32>) -> anyhow::Result<[Raster<f32>; 3]> {
    let rise = |from: f32, to: f32, value: f32| ((value - from) / (to - from)).clamp(0.0, 1.0);
    let lower = rank_equalize(land)?;
    let stone = lower.zip_map(level, |&lower, &level| {
        rise(0.8, 0.65, level).max(rise(0.6, 0.9, lower))
    })?;
    let soil = lower.zip_map(&stone, |&lower, &stone| {
        rise(0.3, 0.6, lower) * (1.0 - stone)
    })?;
    let grass = soil.zip_map(&stone, |&soil, &stone| (1.0 - soil - stone).max(0.0))?;
    Ok([stone, grass, soil])
}
