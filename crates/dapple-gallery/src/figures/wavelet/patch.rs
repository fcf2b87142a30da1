//! The square area that a material is drawn on: its pixels, the area past its borders, and its lighting.
//!
//! Lengths and positions are in parts. The side of the image is 256 parts for any number of pixels, so that a small
//! image shows the same content as a large one. A material is drawn on a torus. If the image must tile, the torus is
//! the same size as the image; otherwise the image is cropped from a torus half as large again.

use super::super::fractal::FractalNoise;
use dapple_color::{HeightPlane, LinearRgb, NormalOptions, NormalY, normal_map};
use dapple_points::Domain;
use dapple_points::hash::{CellHash, Seed, unit_f64};
use dapple_raster::{Raster, RasterError, Window, Wrap};
use glam::{DVec2, DVec3};

/// Side of an image, in parts (1/256 of the image side).
const SIDE: f64 = 256.0;

/// Behavior at the edges of an image when two copies are placed next to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Edges {
    /// Opposite edges do not match, as in a photograph.
    Cropped,
    /// Opposite edges match, so that the image tiles exactly.
    Repeating,
}

/// A finished material, seen from above.
#[derive(Clone, Debug)]
pub(super) struct Material {
    /// Height, from about 0 at the lowest point to about 1 at the highest.
    pub(super) height: Raster<f32>,
    /// Color under a soft light from the upper left.
    pub(super) color: Raster<LinearRgb>,
    /// Mask of the gaps: 1 in cracks and gaps, 0 elsewhere.
    pub(super) gap: Raster<f32>,
}

/// The properties of a material at one pixel, before lighting.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// Height, from 0 to 1.
    pub(super) height: f32,
    /// Color under uniform light.
    pub(super) color: LinearRgb,
    /// Gap mask, from 0 to 1.
    pub(super) gap: f32,
}

/// The square area on which a material is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    size: u32,
    /// Pixels of the image plus a border of one pixel, so that lighting has the neighbors of every pixel.
    window: Window,
    /// Torus on which the material is drawn.
    pub(super) domain: Domain,
}

/// A random number generator for one object, such as a stone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dice {
    hash: CellHash,
    n_rolled: u32,
}

impl Patch {
    /// Returns a patch for an image of `size` × `size` pixels.
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

    /// Returns the side of a pixel, in parts (1/256 of the image side).
    pub(super) fn pixel(&self) -> f64 {
        self.window.pixel[0]
    }

    /// Returns the side of the torus, in parts (1/256 of the image side).
    pub(super) fn period(&self) -> f64 {
        self.domain.size.x
    }

    /// Returns noise on the torus, from 0 to 1, whose coarsest features are about `spacing` parts apart.
    ///
    /// Positions in this noise are divided by the [`period`](Self::period).
    pub(super) fn noise(&self, spacing: f64, seed: Seed) -> anyhow::Result<FractalNoise> {
        FractalNoise::new(spacing / self.period(), seed)
    }

    /// Returns the appearance of all pixels. `spot` receives a position in parts.
    pub(super) fn spots(
        &self,
        spot: impl Fn(DVec2) -> Spot + Sync,
    ) -> Result<Raster<Spot>, RasterError> {
        Raster::from_window(&self.window, spot)
    }

    /// Repaints the pixels of a square on the torus that extends from `center` by `reach` to each side. `paint`
    /// receives each spot with its offset from the center.
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

    /// Returns the columns or rows within `reach` of a coordinate or of one of its copies on the torus, each with its
    /// offset from that copy.
    fn within(&self, coordinate: f64, reach: f64) -> Vec<(u32, f64)> {
        let (pixel, length) = (self.pixel(), f64::from(self.window.size[0]));
        let mut found = Vec::new();
        for turn in [-1.0, 0.0, 1.0].map(|turn| turn * self.period()) {
            // The window starts one pixel before the image.
            let [first, end] =
                [-reach, reach + pixel].map(|way| (coordinate + turn + way) / pixel + 1.0);
            let [first, end] = [first, end].map(|index| index.clamp(0.0, length) as u32);
            found.extend((first..end).map(|index| (index, turn)));
        }
        found
    }

    /// Lights the spots as a relief that is `depth` parts deep, and returns the finished material.
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
    /// Returns the random number generator for the object with the given index.
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
