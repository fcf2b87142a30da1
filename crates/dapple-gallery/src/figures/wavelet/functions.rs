//! Perlin's functions of noise for marble, wood grain and clouds.
//!
//! Ken Perlin, "An Image Synthesizer", SIGGRAPH 1985. Each function colors a map of noise, with values from 0 to 1 and
//! a mean of 0.5. A seam of the map shows as a seam of the color. On a map of n × n tiles, stripes and rings span the
//! whole map.

use dapple_color::{ColorRamp, ColorStop, Interpolation, LinearRgb};
use dapple_raster::{Raster, Wrap};
use glam::DVec2;

/// Returns marble: `n_veins` veins cross the upper edge of the map and are displaced by the noise.
pub(super) fn marble(noise: &Raster<f32>, n_veins: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let colors = [
        (0.0, "#3d4450"),
        (0.08, "#7d828b"),
        (0.25, "#c3c4c6"),
        (0.6, "#e6e3dd"),
        (1.0, "#f6f3ec"),
    ];
    let colors = ramp(&colors)?;
    paint(noise, |uv, value| {
        let phase = f64::from(n_veins) * (uv.x + 0.5 * uv.y) + 1.2 * (value - 0.5);
        colors.at(wave(phase) as f32)
    })
}

/// Returns wood: rings around an axis outside the map, perturbed by the noise, with fibers along the axis.
pub(super) fn wood(noise: &Raster<f32>, n_rings: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let colors = [
        (0.0, "#cda26c"),
        (0.5, "#bd8a52"),
        (0.8, "#96622f"),
        (0.9, "#7a4c24"),
        (1.0, "#cda26c"),
    ];
    let colors = ramp(&colors)?;
    paint(noise, |uv, value| {
        let from_axis = (uv - DVec2::new(0.42, 1.2)) * DVec2::new(1.0, 0.22);
        let ring = f64::from(n_rings) * from_axis.length() + 0.45 * (value - 0.5);
        let fibers = noise.sample_bilinear(uv * DVec2::new(9.0, 0.2), [Wrap::Repeat; 2]);
        colors.at((ring - ring.floor()) as f32) * (0.6 + 0.8 * fibers)
    })
}

/// Returns clouds: white where the noise is high, blue sky where it is low.
pub(super) fn cloud(noise: &Raster<f32>) -> anyhow::Result<Raster<LinearRgb>> {
    let colors = [
        (0.18, "#2f66b4"),
        (0.45, "#6297d8"),
        (0.58, "#cbddf1"),
        (0.70, "#fdfdfd"),
        (0.95, "#d9e0e8"),
    ];
    let colors = ramp(&colors)?.with_interpolation(Interpolation::Smooth);
    paint(noise, |_, value| colors.at(value as f32))
}

/// Colors every pixel from its position in the unit square and the noise there.
fn paint(
    noise: &Raster<f32>,
    color: impl Fn(DVec2, f64) -> LinearRgb + Sync,
) -> anyhow::Result<Raster<LinearRgb>> {
    let size = noise.size();
    let pixel = DVec2::ONE / DVec2::new(size[0].into(), size[1].into());
    Ok(Raster::from_fn(size, |column, row| {
        let uv = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) * pixel;
        color(uv, noise.row(row)[column as usize].into())
    })?)
}

fn ramp(stops: &[(f32, &str)]) -> anyhow::Result<ColorRamp> {
    let stops: Result<Vec<ColorStop>, _> = stops
        .iter()
        .map(|&(position, hex)| LinearRgb::from_hex(hex).map(|color| ColorStop { position, color }))
        .collect();
    Ok(ColorRamp::new(stops?)?)
}

/// Returns a smooth wave, from 0 at integers to 1 halfway between them; it replaces |sin|.
fn wave(phase: f64) -> f64 {
    let away = 1.0 - (2.0 * (phase - phase.floor()) - 1.0).abs();
    away * away * (3.0 - 2.0 * away)
}
