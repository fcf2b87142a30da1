//! Fractal noise used by the figures of several papers.

use dapple_points::Domain;
use dapple_pups::{OctavesOptions, Spacing, hash::Seed, octaves};
use dapple_raster::{Field, Raster, Window, Wrap};
use glam::DVec2;

/// A tile of fractal noise with a period of 1 along both axes and values from 0 to 1.
#[derive(Clone, Debug)]
pub(super) struct FractalNoise {
    tile: Raster<f32>,
}

impl FractalNoise {
    /// Sums octaves of noise; the control points of the first octave are `spacing` apart.
    pub(super) fn new(spacing: f64, seed: Seed) -> anyhow::Result<Self> {
        let options = OctavesOptions {
            domain: Domain::torus(DVec2::ZERO, DVec2::ONE),
            spacing: Spacing::from(spacing),
            octaves: 5,
            ..OctavesOptions::default()
        };
        let tile = octaves(&options, seed)?.to_raster(&Window::unit([512; 2])?)?;
        let range = tile.statistics();
        let scale = 1.0 / (range.max - range.min).max(f32::MIN_POSITIVE);
        Ok(Self {
            tile: tile.map(|value| (value - range.min) * scale),
        })
    }

    /// Returns the noise at a position of the plane.
    pub(super) fn at(&self, position: DVec2) -> f32 {
        self.tile.sample_bilinear(position, [Wrap::Repeat; 2])
    }
}
