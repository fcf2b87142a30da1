//! Draws river pebbles of several sizes, which lie on top of each other with dark gaps between them.

use super::lump::{Layer, lay};
use super::patch::{Dice, Edges, Material, Patch, Spot};
use dapple_color::{ColorRamp, LinearRgb};
use dapple_points::hash::Seed;

/// Depth of the relief, in parts (1/256 of the image side).
const DEPTH: f64 = 30.0;

/// Layers from the lowest to the highest: small pebbles everywhere, larger ones on top of them.
const LAYERS: [Layer; 3] = [
    Layer {
        spacing: 9.0,
        radius: [5.0, 7.0],
        ground: 0.1,
        steepness: 0.02,
        share: 1.0,
        roughness: 0.25,
        noise_scale: 1.0,
        elongation: 1.4,
        gap: 1.8,
        darkness: 0.8,
    },
    Layer {
        spacing: 20.0,
        radius: [8.0, 12.0],
        ground: 0.2,
        steepness: 0.02,
        share: 0.8,
        roughness: 0.2,
        noise_scale: 1.0,
        elongation: 1.45,
        gap: 2.5,
        darkness: 0.8,
    },
    Layer {
        spacing: 38.0,
        radius: [13.0, 20.0],
        ground: 0.3,
        steepness: 0.02,
        share: 0.75,
        roughness: 0.15,
        noise_scale: 1.0,
        elongation: 1.4,
        gap: 3.2,
        darkness: 0.8,
    },
];

/// Draws pebbles, `size` pixels wide.
pub(super) fn pebble(size: u32, seed: Seed, edges: Edges) -> anyhow::Result<Material> {
    let patch = Patch::new(size, edges)?;
    let noise = patch.noise(40.0, seed.child("noise", 0))?;
    let colors = ColorRamp::from_hex(&[
        "#8d8f91", "#b3aca0", "#75706b", "#a58d74", "#cfc7b8", "#5f6468", "#8f6f5c", "#9a958c",
    ])?;
    let mud = LinearRgb::from_srgb([40_u8, 34, 28]);
    let mut spots = patch.spots(|_| Spot {
        height: 0.0,
        color: mud,
        gap: 1.0,
    })?;
    let color =
        |dice: &mut Dice| colors.at(dice.between(0.0, 1.0) as f32) * dice.between(0.8, 1.15) as f32;
    lay(&LAYERS, &patch, &mut spots, &noise, seed, color)?;
    patch.finish(&spots, DEPTH)
}
