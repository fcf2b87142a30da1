//! Draws overlapping rounded lumps, for pebbles and crumbs. Lengths are in parts, as defined in `patch`.

use super::patch::{Dice, Patch, Spot};
use crate::draw::smooth_step;
use crate::figures::fractal::FractalNoise;
use dapple_color::LinearRgb;
use dapple_points::{hash::Seed, poisson_disk};
use dapple_raster::Raster;
use glam::DVec2;

/// A layer of adjacent lumps of about the same size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer {
    /// Minimum distance between lump centers.
    pub(super) spacing: f64,
    /// Minimum and maximum radius of a lump.
    pub(super) radius: [f64; 2],
    /// Height of the ground under the layer, from 0 to 1.
    pub(super) ground: f64,
    /// Height of a lump divided by its radius. Heights are in multiples of the relief's depth.
    pub(super) steepness: f64,
    /// Probability that a position of the layer has a lump, from 0 to 1.
    pub(super) share: f64,
    /// Roughness of the surface, at least 0.
    pub(super) roughness: f64,
    /// Number of repetitions of the roughness noise across the torus, an integer.
    pub(super) noise_scale: f64,
    /// Maximum ratio of a lump's length to its width.
    pub(super) elongation: f64,
    /// Width of the dark gap around each lump.
    pub(super) gap: f64,
    /// Darkness of the gap, from 0 to 1.
    pub(super) darkness: f64,
}

/// A lump of a layer.
struct Lump {
    center: DVec2,
    radius: f64,
    /// Vector along the longer axis.
    axis: DVec2,
    elongation: f64,
    /// Amplitudes of the outline's deviation from an ellipse, for two and three lobes.
    lobes: [DVec2; 2],
    color: LinearRgb,
    surface: DVec2,
    rank: f64,
}

/// Draws the lumps of all layers over the spots, in the order of the layers. `color` returns the color of each lump.
pub(super) fn lay(
    layers: &[Layer],
    patch: &Patch,
    spots: &mut Raster<Spot>,
    noise: &FractalNoise,
    seed: Seed,
    color: impl Fn(&mut Dice) -> LinearRgb,
) -> anyhow::Result<()> {
    for (number, layer) in (0..).zip(layers) {
        layer.lay(patch, spots, noise, seed.child("layer", number), &color)?;
    }
    Ok(())
}

impl Layer {
    /// Draws the lumps of the layer over the spots. `color` returns the color of each lump.
    fn lay(
        &self,
        patch: &Patch,
        spots: &mut Raster<Spot>,
        noise: &FractalNoise,
        seed: Seed,
        color: impl Fn(&mut Dice) -> LinearRgb,
    ) -> anyhow::Result<()> {
        let centers = poisson_disk(patch.domain, self.spacing, seed.child("centers", 0))?;
        let mut lumps: Vec<Lump> = (0..)
            .zip(centers.positions())
            .map(|(index, &center)| (Dice::new(seed.child("lumps", 0), index), center))
            .filter_map(|(mut dice, center)| {
                let there = dice.between(0.0, 1.0) < self.share;
                there.then(|| self.lump(&mut dice, center, &color))
            })
            .collect();
        lumps.sort_by(|a, b| a.rank.total_cmp(&b.rank));
        for lump in &lumps {
            self.paint(patch, spots, noise, lump);
        }
        Ok(())
    }

    fn lump(&self, dice: &mut Dice, center: DVec2, color: impl Fn(&mut Dice) -> LinearRgb) -> Lump {
        Lump {
            center,
            radius: dice.between(self.radius[0], self.radius[1]),
            axis: dice.direction(),
            elongation: dice.between(1.0, self.elongation),
            lobes: [0.10, 0.06].map(|size| dice.direction() * dice.between(0.0, size)),
            color: color(dice),
            surface: DVec2::new(dice.between(0.0, 1.0), dice.between(0.0, 1.0)),
            rank: dice.between(0.0, 1.0),
        }
    }

    fn paint(&self, patch: &Patch, spots: &mut Raster<Spot>, noise: &FractalNoise, lump: &Lump) {
        let soft = 0.5 * patch.pixel().max(1.0);
        let shadow_shift = DVec2::new(0.35, 0.45) * self.gap;
        let unevenness = self.roughness * lump.radius;
        let margin = 0.1 * lump.radius + 0.5 * unevenness + 1.6 * self.gap;
        let reach = lump.half_size() + DVec2::splat(margin);
        patch.paint(spots, lump.center, reach, |at, spot| {
            let (outside, part) = lump.outline(at);
            if outside > margin {
                return;
            }
            let place = ((lump.center + at) / patch.period() + lump.surface) * self.noise_scale;
            let lumpy = f64::from(noise.at(place)) - 0.5;
            let (outside, part) = (outside + unevenness * lumpy, part + self.roughness * lumpy);
            let cover = 1.0 - smooth_step(-soft, soft, outside);
            if cover < 1.0 {
                let (outside_shadow, _) = lump.outline(at - shadow_shift);
                let shadow = 1.0 - smooth_step(-0.3, 1.0, outside_shadow / self.gap);
                let dark = 1.0 - smooth_step(0.3, 1.0, outside / self.gap);
                spot.color = spot.color * (1.0 - self.darkness * shadow.max(dark)) as f32;
                // A lump must not end at higher ground, which would be lit like a wall.
                let near = 1.0 - smooth_step(0.0, 0.6, outside / self.gap);
                spot.height -= (spot.height - self.ground as f32).max(0.0) * near as f32;
                spot.gap = spot.gap.max(dark as f32);
            }
            if cover > 0.0 {
                let grain = f64::from(noise.at(place * 4.0)) - 0.5;
                spot.cover(self.body(lump, part, lumpy, grain), cover as f32);
            }
        });
    }

    /// Returns the appearance of a lump at `part`, the fraction of the way from its center to its outline.
    fn body(&self, lump: &Lump, part: f64, lumpy: f64, grain: f64) -> Spot {
        let part = part.clamp(0.0, 1.0);
        let dome = (1.0 - part * part * part).sqrt();
        let relief = dome + self.roughness * (lumpy + 0.4 * grain);
        let tone = (1.0 + 0.8 * lumpy + 0.5 * grain) * (0.4 + 0.6 * dome);
        Spot {
            height: (self.ground + self.steepness * lump.radius * relief) as f32,
            color: lump.color * tone.max(0.0) as f32,
            gap: 0.0,
        }
    }
}

impl Lump {
    /// Returns half the width and half the height of the ellipse that the outline follows.
    fn half_size(&self) -> DVec2 {
        let (long, short) = (self.axis * self.elongation, self.axis.perp());
        (long * long + short * short).map(f64::sqrt) * self.radius
    }

    /// Returns two measures of a position relative to the lump's center: its approximate distance from the outline,
    /// negative inside, and its distance from the center as a fraction of the outline's distance.
    fn outline(&self, at: DVec2) -> (f64, f64) {
        let along = DVec2::new(
            at.dot(self.axis) / self.elongation,
            at.dot(self.axis.perp()),
        );
        let length = along.length();
        let way = along / length.max(1e-9);
        // Direction vectors at two and three times the angle.
        let twice = way.rotate(way);
        let thrice = twice.rotate(way);
        let radius = self.radius * (1.0 + self.lobes[0].dot(twice) + self.lobes[1].dot(thrice));
        (length - radius, length / radius)
    }
}
