//! radial-hull.
//!
//! The hull of a moon-sized station, for a sphere: Worley's Manhattan cells in azimuth and polar angle, which wrap around once.
//!
//! The tile is 24 × 12 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::{self, LinearRgb};
use dapple::recipe;
use dapple::worley;
use dapple::hash::Seed;
use dapple::raster::Field as _;
use dapple::raster::glam::DVec2;

/// What a material is at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The height, from 0 to 1 where the recipe keeps to it.
    pub height: f32,
    /// The color, linear.
    pub albedo: LinearRgb,
    /// From 0, a mirror, to 1, chalk.
    pub roughness: f32,
    /// From 0, no metal, to 1, all metal.
    pub metallic: f32,
}

/// The material at every position of the plane.
///
/// # Errors
///
/// If a number of the recipe is out of its range.
pub fn material()
-> Result<impl Fn(DVec2) -> Surface + Send + Sync, Box<dyn std::error::Error + Send + Sync>> {
    let seed = Seed(77);
    let panel_field = worley::Worley2::new(seed.child("seam", 0)).with_period([Some(24), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.cell_values();
    let plate_field = worley::Worley2::new(seed.child("channel", 0)).with_period([Some(12), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.cell_values();
    let seam_field = worley::Worley2::new(seed.child("seam", 0)).with_period([Some(24), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.combine(worley::Combination::F2_MINUS_F1);
    let channel_field = worley::Worley2::new(seed.child("channel", 0)).with_period([Some(12), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.combine(worley::Combination::F2_MINUS_F1);
    let ramp_1 = color::ColorRamp::even(&[LinearRgb::from_srgb([0x9a_u8, 0x9e, 0xa1]), LinearRgb::from_srgb([0xa8_u8, 0xac, 0xae]), LinearRgb::from_srgb([0xb4_u8, 0xb7, 0xb8]), LinearRgb::from_srgb([0x8f_u8, 0x94, 0x97])])?;
    Ok(move |at: DVec2| {
        let panel: f32 = panel_field.sample(at * DVec2::new(1.0, 4.0));
        let tier: f32 = recipe::levels(panel, [0.0, 1.0], [0.0, 0.1], recipe::LevelsCurve::Linear);
        let plate: f32 = plate_field.sample(at * DVec2::new(0.5, 0.5));
        let step: f32 = recipe::levels(plate, [0.0, 1.0], [0.0, 0.12], recipe::LevelsCurve::Linear);
        let seam: f32 = seam_field.sample(at * DVec2::new(1.0, 4.0));
        let groove: f32 = recipe::levels(seam, [0.04, 0.08], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let line: f32 = groove * 0.05;
        let channel: f32 = channel_field.sample(at * DVec2::new(0.5, 0.5));
        let gaps: f32 = recipe::levels(channel, [0.02, 0.035], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let latitude: f32 = recipe::coordinate(at, DVec2::new(0.0, 6.0), DVec2::new(0.0, 1.0));
        let from_equator: f32 = latitude.abs();
        let rings: f32 = recipe::wave(from_equator, 0.5, 0.5, recipe::Waveform::Triangle);
        let ring: f32 = recipe::levels(rings, [0.02, 0.05], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let trenches: f32 = recipe::minimum(gaps, ring);
        let rut: f32 = trenches * 0.14;
        let plating: f32 = step + tier + line + rut;
        let from_dish: f32 = recipe::distance(at, DVec2::new(7.0, 3.4), DVec2::new(24.0, 12.0), [true, false]);
        let outside_dish: f32 = recipe::levels(from_dish, [1.45, 1.55], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let surface: f32 = plating * outside_dish;
        let bowl: f32 = worley::Profile::Channels { width: 1.5 }.height(from_dish);
        let base: f32 = bowl * 0.5;
        let whole: f32 = surface + base;
        let equator: f32 = recipe::levels(from_equator, [0.16, 0.2], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let height: f32 = recipe::mix(tier, whole, equator);
        let paint: LinearRgb = ramp_1.at(panel);
        let tint: f32 = recipe::levels(plate, [0.0, 1.0], [0.65, 1.15], recipe::LevelsCurve::Linear);
        let cut: f32 = recipe::minimum(recipe::minimum(trenches, groove), equator);
        let dark: f32 = recipe::levels(cut, [0.0, 1.0], [0.5, 1.0], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(recipe::multiply_colors(paint, LinearRgb::gray(tint)), LinearRgb::gray(dark));
        let roughness: f32 = recipe::levels(panel, [0.0, 1.0], [0.4, 0.6], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 1.0,
        }
    })
}
