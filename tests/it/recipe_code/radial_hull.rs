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
    let small_field = worley::Worley2::new(seed.child("small_seam", 0)).with_period([Some(144), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.2 })?.cell_values();
    let large_field = worley::Worley2::new(seed.child("large_seam", 0)).with_period([Some(24), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.0 })?.cell_values();
    let middle_field = worley::Worley2::new(seed.child("middle_seam", 0)).with_period([Some(48), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.0 })?.cell_values();
    let district_field = worley::Worley2::new(seed.child("channel", 0)).with_period([Some(12), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.cell_values();
    let small_seam_field = worley::Worley2::new(seed.child("small_seam", 0)).with_period([Some(144), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.2 })?.combine(worley::Combination::F2_MINUS_F1);
    let large_seam_field = worley::Worley2::new(seed.child("large_seam", 0)).with_period([Some(24), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.0 })?.combine(worley::Combination::F2_MINUS_F1);
    let middle_seam_field = worley::Worley2::new(seed.child("middle_seam", 0)).with_period([Some(48), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.0 })?.combine(worley::Combination::F2_MINUS_F1);
    let channel_field = worley::Worley2::new(seed.child("channel", 0)).with_period([Some(12), None])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.combine(worley::Combination::F2_MINUS_F1);
    let ramp_1 = color::ColorRamp::even(&[LinearRgb::from_srgb([0xa3_u8, 0xa6, 0xa8]), LinearRgb::from_srgb([0xb0_u8, 0xb2, 0xb3]), LinearRgb::from_srgb([0x98_u8, 0x9c, 0x9f]), LinearRgb::from_srgb([0xa9_u8, 0xac, 0xad])])?;
    Ok(move |at: DVec2| {
        let small: f32 = small_field.sample(at * DVec2::new(6.0, 9.0));
        let small_step: f32 = recipe::levels(small, [0.3, 1.0], [0.0, 0.14], recipe::LevelsCurve::Linear);
        let bottom: f32 = small_step * 0.8;
        let large: f32 = large_field.sample(at);
        let step: f32 = recipe::levels(large, [0.0, 1.0], [0.0, 0.05], recipe::LevelsCurve::Linear);
        let middle: f32 = middle_field.sample(at * DVec2::new(2.0, 3.0));
        let middle_step: f32 = recipe::levels(middle, [0.0, 1.0], [0.0, 0.06], recipe::LevelsCurve::Linear);
        let divided: f32 = recipe::levels(large, [0.3, 0.301], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let middle_tier: f32 = middle_step * divided;
        let district: f32 = district_field.sample(at * DVec2::new(0.5, 0.5));
        let busy: f32 = district + middle;
        let crowded: f32 = recipe::levels(busy, [1.05, 1.051], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let built: f32 = divided * crowded;
        let small_seam: f32 = small_seam_field.sample(at * DVec2::new(6.0, 9.0));
        let small_line: f32 = recipe::levels(small_seam, [0.08, 0.2], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let tower: f32 = small_step * built * small_line;
        let large_seam: f32 = large_seam_field.sample(at);
        let large_groove: f32 = recipe::levels(large_seam, [0.02, 0.045], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let middle_seam: f32 = middle_seam_field.sample(at * DVec2::new(2.0, 3.0));
        let middle_line: f32 = recipe::levels(middle_seam, [0.03, 0.07], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let middle_groove: f32 = recipe::mix(1.0, middle_line, divided);
        let small_groove: f32 = recipe::mix(1.0, small_line, built);
        let groove: f32 = recipe::minimum(recipe::minimum(large_groove, middle_groove), small_groove);
        let line: f32 = groove * 0.03;
        let channel: f32 = channel_field.sample(at * DVec2::new(0.5, 0.5));
        let gaps: f32 = recipe::levels(channel, [0.012, 0.024], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let latitude: f32 = recipe::coordinate(at, DVec2::new(0.0, 6.0), DVec2::new(0.0, 1.0));
        let from_equator: f32 = latitude.abs();
        let rings: f32 = recipe::wave(from_equator, 0.5, 0.5, recipe::Waveform::Triangle);
        let ring: f32 = recipe::levels(rings, [0.015, 0.03], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let trenches: f32 = recipe::minimum(gaps, ring);
        let rut: f32 = trenches * 0.1;
        let plating: f32 = step + middle_tier + tower + line + rut;
        let from_dish: f32 = recipe::distance(at, DVec2::new(7.0, 3.4), DVec2::new(24.0, 12.0), [true, false]);
        let outside_dish: f32 = recipe::levels(from_dish, [1.48, 1.54], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let surface: f32 = plating * outside_dish;
        let bowl: f32 = worley::Profile::Channels { width: 1.5 }.height(from_dish);
        let base: f32 = bowl * 0.5;
        let whole: f32 = surface + base;
        let equator: f32 = recipe::levels(from_equator, [0.16, 0.19], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let height: f32 = recipe::mix(bottom, whole, equator);
        let large_paint: LinearRgb = ramp_1.at(large);
        let middle_tint: f32 = recipe::levels(middle, [0.0, 1.0], [0.8, 1.1], recipe::LevelsCurve::Linear);
        let middle_paint: f32 = recipe::mix(1.0, middle_tint, divided);
        let small_tint: f32 = recipe::levels(small, [0.0, 1.0], [0.6, 1.15], recipe::LevelsCurve::Linear);
        let small_paint: f32 = recipe::mix(1.0, small_tint, built);
        let tint: f32 = recipe::levels(district, [0.0, 1.0], [0.7, 1.1], recipe::LevelsCurve::Linear);
        let cut: f32 = recipe::minimum(trenches, groove);
        let dark: f32 = recipe::levels(cut, [0.0, 1.0], [0.4, 1.0], recipe::LevelsCurve::Linear);
        let painted: LinearRgb = recipe::multiply_colors(recipe::multiply_colors(recipe::multiply_colors(recipe::multiply_colors(large_paint, LinearRgb::gray(middle_paint)), LinearRgb::gray(small_paint)), LinearRgb::gray(tint)), LinearRgb::gray(dark));
        let dish_gray: LinearRgb = recipe::mix_colors(LinearRgb::from_srgb([0x83_u8, 0x87, 0x8a]), painted, outside_dish);
        let albedo: LinearRgb = recipe::mix_colors(LinearRgb::from_srgb([0x3d_u8, 0x40, 0x43]), dish_gray, equator);
        let roughness: f32 = recipe::levels(middle, [0.0, 1.0], [0.35, 0.6], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 1.0,
        }
    })
}
