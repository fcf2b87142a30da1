//! The square that a material is made on: its pixels, the area past its borders, and the light on it.
//!
//! Lengths and positions are in parts: the side of the picture is 256 parts, however many pixels it has, so that a
//! small picture shows the same as a large one. A material is made on a torus. If the picture is to repeat, the torus
//! has its size; otherwise the picture is cut out of a torus half as large again.

use super::super::fractal::FractalNoise;
use dapple_color::{HeightPlane, LinearRgb, NormalOptions, NormalY, normal_map};
use dapple_points::Domain;
use dapple_points::hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Raster, RasterError, Window, Wrap};
use glam::{DVec2, DVec3};

/// The side of a picture, in parts.
const SIDE: f64 = 256.0;

/// How two copies of a picture meet when they lie side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Edges {
    /// Opposite edges do not fit, as in a photograph.
    Cropped,
    /// Opposite edges fit: the picture repeats exactly.
    Repeating,
}

/// A finished material, seen from above.
#[derive(Clone, Debug)]
pub(super) struct Material {
    /// The height, from about 0 at the lowest to about 1 at the highest.
    pub(super) height: Raster<f32>,
    /// The color under a soft light from the upper left.
    pub(super) color: Raster<LinearRgb>,
    /// A mask of the gaps: 1 in cracks and gaps, 0 elsewhere.
    pub(super) gap: Raster<f32>,
}

/// The properties of a material at one pixel, before lighting.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// The height, from 0 to 1.
    pub(super) height: f32,
    /// The color under even light.
    pub(super) color: LinearRgb,
    /// The gap mask, from 0 to 1.
    pub(super) gap: f32,
}

/// The square that a material is made on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    size: u32,
    /// The pixels of the picture and a border of one pixel, so that lighting knows the neighbors of every pixel.
    window: Window,
    /// The torus of the material.
    pub(super) domain: Domain,
}

/// A sequence of random numbers for one object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dice {
    hash: CellHash,
    n_rolled: u32,
}

impl Patch {
    /// Returns a patch for a picture of `size` × `size` pixels.
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
        self.window.pixel[0]
    }

    /// The side of the torus, in parts.
    pub(super) fn period(&self) -> f64 {
        self.domain.size.x
    }

    /// Returns noise on the torus, from 0 to 1, whose coarsest features are about `spacing` parts apart.
    ///
    /// Its positions are divided by the [`period`](Self::period).
    pub(super) fn noise(&self, spacing: f64, seed: Seed) -> anyhow::Result<FractalNoise> {
        FractalNoise::new(spacing / self.period(), seed)
    }

    /// Returns the spots of all pixels.
    pub(super) fn spots(
        &self,
        spot: impl Fn(DVec2) -> Spot + Sync,
    ) -> Result<Raster<Spot>, RasterError> {
        Raster::from_window(&self.window, spot)
    }

    /// Changes the spots in the box that reaches `reach` from `center` on the torus. `paint` gets their offset from the
    /// center.
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
                    DVec2::from(self.window.position(column, row)) - middle,
                    &mut spots.pixels_mut()[pixel],
                );
            }
        }
    }

    /// Returns the columns or rows within `reach` of a coordinate or of one of its repeats, each with the offset of that
    /// repeat from the coordinate.
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

    /// Returns the material, lit as a relief that is `depth` parts deep.
    pub(super) fn finish(&self, spots: &Raster<Spot>, depth: f64) -> anyhow::Result<Material> {
        let options = NormalOptions {
            y: NormalY::OpenGl,
            plane: HeightPlane {
                strength: depth,
                ..HeightPlane::for_window(&self.window, [Wrap::Repeat; 2])
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
    /// Blends another spot over this one; `part` is its opacity.
    pub(super) fn cover(&mut self, other: Self, part: f32) {
        self.height += (other.height - self.height) * part;
        self.color = self.color.lerp(other.color, part);
        self.gap += (other.gap - self.gap) * part;
    }
}

impl Dice {
    /// Returns the random numbers of the object with an index.
    pub(super) fn new(seed: Seed, index: u32) -> Self {
        Self {
            hash: CellHash::new(seed, [i64::from(index)]),
            n_rolled: 0,
        }
    }

    /// Returns a random number from `low` to `high`.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        let number = unit_f64(self.hash.at(self.n_rolled));
        self.n_rolled += 1;
        low + (high - low) * number
    }

    /// Returns a random vector of length 1.
    pub(super) fn direction(&mut self) -> DVec2 {
        loop {
            let at = DVec2::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            if (0.01..1.0).contains(&at.length_squared()) {
                return at.normalize();
            }
        }
    }
}
