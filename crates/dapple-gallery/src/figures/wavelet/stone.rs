//! Draws rubble paving: irregular stones with individual tones and rounded edges, and dark cracks between them.
//!
//! The stones are the Voronoi cells of a Poisson-disk set whose radius varies, seen through a warp.

use super::patch::{Dice, Edges, Material, Patch, Spot};
use crate::draw::smooth_step;
use crate::figures::fractal::FractalNoise;
use dapple_color::{ColorRamp, LinearRgb};
use dapple_graph::{Graph, delaunay};
use dapple_points::hash::Seed;
use dapple_points::{PointIdx, VariablePoissonOptions, variable_poisson_disk};
use dapple_raster::Varying;
use dapple_worley::FeatureSet;
use glam::DVec2;
use std::sync::Arc;

/// Minimum and maximum distance between the centers of adjacent stones, in parts (1/256 of the image side).
const SPACING: [f64; 2] = [22.0, 42.0];
/// Distance by which the warp moves the outlines, in parts (1/256 of the image side).
const WARP: f64 = 22.0;
/// Minimum and maximum width of the cracks, in parts (1/256 of the image side).
const CRACK: [f64; 2] = [3.0, 5.5];
/// Width of the rounded edge of a stone, in parts (1/256 of the image side).
const ROUNDING: f64 = 9.0;
/// Depth of the relief, in parts (1/256 of the image side).
const DEPTH: f64 = 13.0;

/// Draws stones, `size` pixels wide.
pub(super) fn stone(size: u32, seed: Seed, edges: Edges) -> anyhow::Result<Material> {
    let patch = Patch::new(size, edges)?;
    let stones = Stones::new(&patch, seed)?;
    patch.finish(&patch.spots(|at| stones.spot(at))?, DEPTH)
}

/// All stones of a patch.
struct Stones {
    period: f64,
    pixel: f64,
    middles: FeatureSet<2>,
    neighbors: Graph,
    looks: Vec<Look>,
    noise: FractalNoise,
    dirt: LinearRgb,
}

/// Appearance of a stone.
struct Look {
    color: LinearRgb,
    /// Height of the stone's center.
    height: f64,
    /// Slope of the stone's top, as change of height per part.
    tilt: DVec2,
    /// Offset into the noise for the stone's surface.
    surface: DVec2,
}

impl Stones {
    fn new(patch: &Patch, seed: Seed) -> anyhow::Result<Self> {
        let period = patch.period();
        let sizes = patch.noise(90.0, seed.child("sizes", 0))?;
        let radius = Varying::Function(Arc::new(move |at: DVec2| {
            let part = smooth_step(0.0, 1.0, sizes.at(at / period).into());
            SPACING[0] + (SPACING[1] - SPACING[0]) * part
        }));
        let options = VariablePoissonOptions::default();
        let points =
            variable_poisson_disk(patch.domain, &radius, &options, seed.child("middles", 0))?;
        let tones = ColorRamp::from_hex(&[
            "#6f675c", "#8b8072", "#7c7a76", "#a29684", "#75685a", "#94908a", "#b0a28c", "#665f58",
        ])?;
        let looks = (0..points.len() as u32)
            .map(|index| Look::new(Dice::new(seed.child("looks", 0), index), &tones))
            .collect();
        Ok(Self {
            period,
            pixel: patch.pixel(),
            middles: FeatureSet::new(points.positions(), [Some(period); 2])?,
            neighbors: delaunay(&points)?,
            looks,
            noise: patch.noise(48.0, seed.child("noise", 0))?,
            dirt: LinearRgb::from_srgb([46_u8, 38, 31]),
        })
    }

    fn spot(&self, at: DVec2) -> Spot {
        let noise = |scale: f64, shift: f64| {
            f64::from(
                self.noise
                    .at(at / self.period * scale + DVec2::splat(shift)),
            )
        };
        let warp = DVec2::new(noise(1.0, 0.0), noise(1.0, 0.37)) - DVec2::splat(0.5);
        let (index, from_middle, border) = self.border(at + warp * WARP);
        let Some(look) = self.looks.get(index as usize) else {
            return self.crack(noise(4.0, 0.5));
        };
        let width = CRACK[0] + (CRACK[1] - CRACK[0]) * smooth_step(0.3, 0.7, noise(1.0, 0.71));
        let inside = border - 0.5 * width;
        let soft = 0.5 * self.pixel.max(1.0);
        let body = smooth_step(-soft, soft, inside);
        let mut spot = self.crack(noise(4.0, 0.5));
        spot.cover(self.body(look, at, from_middle, inside), body as f32);
        spot
    }

    /// Returns the id of the stone at a position, the offset of the position from the stone's center, and the distance
    /// to the nearest border with another stone. Corners of borders are rounded.
    fn border(&self, at: DVec2) -> (u64, DVec2, f64) {
        let [own] = self.middles.sample::<1>(at);
        let axes = self.neighbors.axes(PointIdx(own.id as u32));
        let border = axes.iter().fold(f64::INFINITY, |nearest, axis| {
            let way = axis.vector.length();
            smooth_min(nearest, 0.5 * way - own.vector.dot(axis.vector) / way, 7.0)
        });
        (own.id, own.vector, border)
    }

    fn body(&self, look: &Look, at: DVec2, from_middle: DVec2, inside: f64) -> Spot {
        let noise = |scale: f64| f64::from(self.noise.at(at / self.period * scale + look.surface));
        let (lumps, grain) = (noise(1.0), noise(5.0));
        let slope = 1.0 - (inside / ROUNDING).clamp(0.0, 1.0);
        let edge = (1.0 - slope * slope).sqrt();
        let surface =
            look.height + look.tilt.dot(from_middle) + 0.4 * (lumps - 0.5) + 0.16 * (grain - 0.5);
        let tone = (0.4 + 0.7 * lumps + 0.5 * grain) * (0.55 + 0.45 * edge);
        Spot {
            height: (0.1 + (surface - 0.1) * edge) as f32,
            color: look.color * tone as f32,
            gap: 0.0,
        }
    }

    fn crack(&self, grain: f64) -> Spot {
        Spot {
            height: (0.1 * grain) as f32,
            color: self.dirt * (0.25 + 0.5 * grain) as f32,
            gap: 1.0,
        }
    }
}

impl Look {
    fn new(mut dice: Dice, tones: &ColorRamp) -> Self {
        Self {
            color: tones.at(dice.between(0.0, 1.0) as f32) * dice.between(0.8, 1.15) as f32,
            height: dice.between(0.6, 0.8),
            tilt: dice.direction() * dice.between(0.0, 0.006),
            surface: DVec2::new(dice.between(0.0, 1.0), dice.between(0.0, 1.0)),
        }
    }
}

/// Returns the smaller of two numbers, blended smoothly if they differ by less than `reach`.
fn smooth_min(a: f64, b: f64, reach: f64) -> f64 {
    let near = (1.0 - (a - b).abs() / reach).max(0.0);
    a.min(b) - 0.25 * reach * near * near
}
