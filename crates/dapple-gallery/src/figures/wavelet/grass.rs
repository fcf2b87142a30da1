//! Draws short grass from above: many bent blades, drawn over each other, with dark roots and light tips.

use super::patch::{Dice, Edges, Material, Patch, Spot};
use crate::draw::smooth_step;
use crate::figures::fractal::FractalNoise;
use dapple_color::{ColorRamp, LinearRgb};
use dapple_points::{hash::Seed, white_noise};
use dapple_raster::Raster;
use glam::DVec2;

/// Image area per blade of grass, in square parts. A part is 1/256 of the image's side.
const AREA: f64 = 8.0;
/// Number of straight segments per blade.
const N_PIECES: u32 = 4;
/// Depth of the relief, in units of 1/256 of the image side.
const DEPTH: f64 = 7.0;

/// A blade of grass: a curve from the root over a bend to the tip, relative to the root.
struct Blade {
    root: DVec2,
    bend: DVec2,
    tip: DVec2,
    width: f64,
    color: LinearRgb,
    /// Height rank among all blades, from 0 to 1; higher blades cover lower ones.
    rank: f64,
}

/// Draws grass, `size` pixels wide.
pub(super) fn grass(size: u32, seed: Seed, edges: Edges) -> anyhow::Result<Material> {
    let patch = Patch::new(size, edges)?;
    let noise = patch.noise(70.0, seed.child("noise", 0))?;
    let greens = ColorRamp::from_hex(&[
        "#46662a", "#557733", "#65853b", "#789345", "#909f54", "#aba465",
    ])?;
    let ground = LinearRgb::from_srgb([30_u8, 32, 16]);
    let mut spots = patch.spots(|_| Spot {
        height: 0.0,
        color: ground,
        gap: 1.0,
    })?;
    let n_blades = (patch.domain.area() / AREA) as u32;
    let roots = white_noise(patch.domain, n_blades, seed.child("roots", 0))?;
    let mut blades: Vec<Blade> = (0..)
        .zip(roots.positions())
        .map(|(index, &root)| {
            let dice = Dice::new(seed.child("blades", 0), index);
            Blade::new(dice, root, &noise, root / patch.period(), &greens)
        })
        .collect();
    blades.sort_by(|a, b| a.rank.total_cmp(&b.rank));
    for blade in &blades {
        blade.paint(&patch, &mut spots);
    }
    patch.finish(&spots, DEPTH)
}

impl Blade {
    fn new(
        mut dice: Dice,
        root: DVec2,
        noise: &FractalNoise,
        place: DVec2,
        greens: &ColorRamp,
    ) -> Self {
        // Adjacent blades lean in similar directions.
        let lean = DVec2::new(
            noise.at(place).into(),
            noise.at(place + DVec2::splat(0.4)).into(),
        );
        let lean = (lean - DVec2::splat(0.5)) * 2.5;
        let way = (dice.direction() + lean).normalize_or(DVec2::X);
        let length = dice.between(9.0, 24.0);
        let sideways = way.perp() * dice.between(-0.22, 0.22);
        let lush = f64::from(noise.at(place + DVec2::splat(0.7)));
        let tone = 0.75 * lush + dice.between(-0.1, 0.35);
        Self {
            root,
            bend: (way * 0.55 - sideways) * length,
            tip: (way + sideways) * length,
            width: dice.between(1.6, 2.8),
            color: greens.at(tone as f32) * dice.between(0.75, 1.15) as f32,
            rank: dice.between(0.0, 1.0),
        }
    }

    fn paint(&self, patch: &Patch, spots: &mut Raster<Spot>) {
        let curve = |t: f64| self.root + self.bend * (2.0 * t * (1.0 - t)) + self.tip * (t * t);
        for piece in 0..N_PIECES {
            let parts = [piece, piece + 1].map(|end| f64::from(end) / f64::from(N_PIECES));
            self.paint_piece(patch, spots, parts, parts.map(curve));
        }
    }

    /// Paints the nearly straight part of a blade between two positions on it.
    fn paint_piece(
        &self,
        patch: &Patch,
        spots: &mut Raster<Spot>,
        parts: [f64; 2],
        [from, to]: [DVec2; 2],
    ) {
        let soft = 0.5 * patch.pixel().max(1.0);
        let (middle, way) = (0.5 * (from + to), to - from);
        let (length, reach) = (way.length(), DVec2::splat(0.5 * self.width + soft));
        patch.paint(spots, middle, 0.5 * way.abs() + reach, |at, spot| {
            let t = (at.dot(way) / (length * length) + 0.5).clamp(0.0, 1.0);
            let along = parts[0] + (parts[1] - parts[0]) * t;
            let off = at - way * (t - 0.5);
            let half = 0.5 * self.width * (1.0 - along * along * along);
            let cover = 1.0 - smooth_step(-soft, soft, off.length() - half);
            if cover > 0.0 {
                let side = way.perp_dot(off) / (length * self.width);
                spot.cover(self.spot(along, side), cover as f32);
            }
        });
    }

    fn spot(&self, along: f64, across: f64) -> Spot {
        // A blade is folded along its middle, and one half is lit.
        let light = 1.0 + 0.35 * across.signum() * smooth_step(0.0, 0.2, across.abs());
        let tone = (0.25 + 0.55 * self.rank) * (0.45 + 0.9 * along) * light;
        Spot {
            height: (0.6 * self.rank + 0.4 * along) as f32,
            color: self.color * (1.6 * tone) as f32,
            gap: 0.0,
        }
    }
}
