//! Draws brown soil: rough crumbs of several sizes, coarse ones on fine ones, and a few pale stones.

use super::lump::{Layer, lay};
use super::patch::{Dice, Edges, Material, Patch, Spot};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_points::hash::Seed;

/// Depth of the relief, in parts (1/256 of the image side).
const DEPTH: f64 = 14.0;

/// Layers from the lowest to the highest: fine crumbs everywhere, coarser ones on top of them.
const LAYERS: [Layer; 3] = [
    CRUMBS,
    Layer {
        spacing: 7.5,
        radius: [2.5, 4.5],
        ground: 0.25,
        share: 0.6,
        gap: 1.6,
        ..CRUMBS
    },
    Layer {
        spacing: 15.0,
        radius: [4.0, 9.0],
        ground: 0.35,
        share: 0.45,
        gap: 2.4,
        ..CRUMBS
    },
];

/// Layer of fine crumbs.
const CRUMBS: Layer = Layer {
    spacing: 4.4,
    radius: [1.6, 3.0],
    ground: 0.15,
    steepness: 0.05,
    share: 1.0,
    roughness: 1.0,
    noise_scale: 3.0,
    elongation: 1.5,
    gap: 1.2,
    darkness: 0.4,
};

/// Draws soil, `size` pixels wide.
pub(super) fn soil(size: u32, seed: Seed, edges: Edges) -> anyhow::Result<Material> {
    let patch = Patch::new(size, edges)?;
    let noise = patch.noise(40.0, seed.child("noise", 0))?;
    let browns = ColorRamp::from_hex(&[
        "#4f3a28", "#5e4630", "#6d5138", "#59422f", "#7a5c40", "#65503c",
    ])?;
    let pale = LinearRgb::from_srgb([146_u8, 128, 106]);
    let deep = LinearRgb::from_srgb([48_u8, 34, 23]);
    let mut spots = patch.spots(|at| Spot {
        height: 0.2 * noise.at(at / patch.period()),
        color: deep,
        gap: 1.0,
    })?;
    let color = |dice: &mut Dice| {
        if dice.between(0.0, 1.0) < 0.02 {
            pale
        } else {
            browns.at(dice.between(0.0, 1.0) as f32) * dice.between(0.75, 1.2) as f32
        }
    };
    lay(&LAYERS, &patch, &mut spots, &noise, seed, color)?;
    patch.finish(&spots, DEPTH)
}
