//! The square that a material is made on: its pixels, what lies past its borders, and the light on it.
//!
//! Lengths and positions are in parts: 256 parts are the side of the picture, however many pixels it has, so that a
//! small picture shows the same as a large one. A material is made on a torus. If it is to repeat, the torus is as
//! large as the picture; if not, the picture is cut out of a torus half as large again.

use super::super::fractal::FractalNoise;
use dapple_color::{HeightPlane, LinearRgb, NormalOptions, NormalY, normal_map};
use dapple_points::Domain;
use dapple_points::hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Raster, RasterError, Window};
use glam::{DVec2, DVec3};

/// The side of a picture, in parts.
const SIDE: f64 = 256.0;

/// What meets where two copies of a picture lie side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Edges {
    /// Opposite edges have nothing in common, as in a photograph.
    Cropped,
    /// Opposite edges fit: the picture repeats exactly.
    Repeating,
}

/// A material from above.
#[derive(Clone, Debug)]
pub(super) struct Material {
    /// From about 0, the lowest, to about 1, the highest.
    pub(super) height: Raster<f32>,
    /// Its color in a soft light from the upper left.
    pub(super) color: Raster<LinearRgb>,
    /// 1 in the cracks and gaps, 0 on what lies between them.
    pub(super) gap: Raster<f32>,
}

/// What is at one pixel of a material, before there is light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// From 0 to 1.
    pub(super) height: f32,
    /// Its color in even light.
    pub(super) color: LinearRgb,
    /// From 0 to 1.
    pub(super) gap: f32,
}

/// The square that a material is made on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    size: u32,
    /// The pixels of the picture and one more all around, so that the light on the last pixel knows its neighbors.
    window: Window,
    /// The torus of the material.
    pub(super) domain: Domain,
}

/// Random numbers for one thing, one after another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dice {
    hash: CellHash,
    n_rolled: u32,
}

impl Patch {
    /// A patch for a picture of `size` × `size` pixels.
    pub(super) fn new(size: u32, edges: Edges) -> Result<Self, RasterError> {
        let period = match edges {
            Edges::Cropped => 1.5 * SIDE,
            Edges::Repeating => SIDE,
        };
        let picture = Window::new(DVec2::ZERO, DVec2::splat(SIDE), [size; 2])?;
        Ok(Self {
            size,
            window: picture.crop([-1; 2], [size.saturating_add(2); 2])?,
            domain: Domain::torus(DVec2::ZERO, DVec2::splat(period)),
        })
    }

    /// The side of a pixel, in parts.
    pub(super) fn pixel(&self) -> f64 {
        self.window.pixel.x
    }

    /// The side of the torus, in parts.
    pub(super) fn period(&self) -> f64 {
        self.domain.size.x
    }

    /// Noise on the torus, from 0 to 1, whose coarsest features are about `spacing` parts apart.
    ///
    /// It is read at a position over the [`period`](Self::period).
    pub(super) fn noise(&self, spacing: f64, seed: Seed) -> anyhow::Result<FractalNoise> {
        FractalNoise::new(spacing / self.period(), seed)
    }

    /// The spots of all pixels.
    pub(super) fn spots(
        &self,
        spot: impl Fn(DVec2) -> Spot + Sync,
    ) -> Result<Raster<Spot>, RasterError> {
        Raster::from_window(&self.window, spot)
    }

    /// Changes the spots that are in the box that reaches `reach` from `center` on the torus; `paint` is told how far
    /// they are from it.
    pub(super) fn paint(
        &self,
        spots: &mut Raster<Spot>,
        center: DVec2,
        reach: DVec2,
        mut paint: impl FnMut(DVec2, &mut Spot),
    ) {
        let (columns, rows) = (
            self.within(center.x, reach.x),
            self.within(center.y, reach.y),
        );
        let width = self.window.size[0] as usize;
        for &(row, turn_y) in &rows {
            for &(column, turn_x) in &columns {
                let middle = center + DVec2::new(turn_x, turn_y);
                let pixel = row as usize * width + column as usize;
                paint(
                    self.window.position(column, row) - middle,
                    &mut spots.pixels_mut()[pixel],
                );
            }
        }
    }

    /// The columns or rows within `reach` of a coordinate or of a repeat of it, each with the way to the repeat.
    fn within(&self, coordinate: f64, reach: f64) -> Vec<(u32, f64)> {
        let (pixel, length) = (self.pixel(), f64::from(self.window.size[0]));
        let mut found = Vec::new();
        for turn in [-1.0, 0.0, 1.0].map(|turn| turn * self.period()) {
            // The window begins one pixel before the picture.
            let [first, end] =
                [-reach, reach + pixel].map(|way| (coordinate + turn + way) / pixel + 1.0);
            let [first, end] = [first, end].map(|index| index.clamp(0.0, length) as u32);
            found.extend((first..end).map(|index| (index, turn)));
        }
        found
    }

    /// The material, with light on a relief that is `depth` parts deep.
    pub(super) fn finish(&self, spots: &Raster<Spot>, depth: f64) -> anyhow::Result<Material> {
        let options = NormalOptions {
            y: NormalY::OpenGl,
            plane: HeightPlane {
                strength: depth,
                ..HeightPlane::for_window(&self.window)
            },
        };
        let height = spots.map(|spot| spot.height);
        let normals = normal_map(&height, &options)?;
        let toward = DVec3::new(-0.5, 0.6, 0.75).normalize();
        let color = spots.zip_map(&normals, |spot, normal| {
            let normal = DVec3::from_array(normal.to_array().map(f64::from));
            let light = 0.25 + 1.05 * normal.dot(toward).max(0.0);
            spot.color * light as f32
        })?;
        let (first, size) = ([1; 2], [self.size; 2]);
        Ok(Material {
            height: height.crop(first, size)?,
            color: color.crop(first, size)?,
            gap: spots.map(|spot| spot.gap).crop(first, size)?,
        })
    }
}

impl Spot {
    /// Covers a part of the spot with another one.
    pub(super) fn cover(&mut self, other: Self, part: f32) {
        self.height += (other.height - self.height) * part;
        self.color = self.color.lerp(other.color, part);
        self.gap += (other.gap - self.gap) * part;
    }
}

impl Dice {
    /// The dice of the thing with a number.
    pub(super) fn new(seed: Seed, index: u32) -> Self {
        Self {
            hash: CellHash::new(seed, [i64::from(index)]),
            n_rolled: 0,
        }
    }

    /// A number from `low` to `high`.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        let number = unit_f64(self.hash.at(self.n_rolled));
        self.n_rolled += 1;
        low + (high - low) * number
    }

    /// A vector of length 1.
    pub(super) fn direction(&mut self) -> DVec2 {
        loop {
            let at = DVec2::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            if (0.01..1.0).contains(&at.length_squared()) {
                return at.normalize();
            }
        }
    }
}
