//! craters.
//!
//! The ground of a moon: craters of three sizes, each a profile of Worley's F1 about its feature point.
//!
//! The tile is 8 × 8 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::{self, LinearRgb};
use dapple::points;
use dapple::pups;
use dapple::recipe;
use dapple::wavelet;
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
    let seed = Seed(4);
    let large_field = worley::Worley2::new(seed.child("large", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.combine(worley::Combination::F1);
    let large_draw_field = worley::Worley2::new(seed.child("large", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.cell_values();
    let large_border_field = worley::Worley2::new(seed.child("large", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.combine(worley::Combination::F2_MINUS_F1);
    let middle_field = worley::Worley2::new(seed.child("middle", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.combine(worley::Combination::F1);
    let middle_draw_field = worley::Worley2::new(seed.child("middle", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.cell_values();
    let middle_border_field = worley::Worley2::new(seed.child("middle", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.combine(worley::Combination::F2_MINUS_F1);
    let small_field = worley::Worley2::new(seed.child("small", 0)).with_period([Some(32), Some(32)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.combine(worley::Combination::F1);
    let small_draw_field = worley::Worley2::new(seed.child("small", 0)).with_period([Some(32), Some(32)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.6 })?.cell_values();
    let ground_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(8.0, 8.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), gain: 0.6, ..pups::OctavesOptions::default() }, seed.child("ground", 0))?.normalized();
    let grit_field = wavelet::WaveletNoise2::new(128, seed.child("grit", 0))?.with_weights(&[0.13446738, 0.08068043, 0.04840826, 0.029044954])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.2, color: LinearRgb::from_srgb([0x5a_u8, 0x56, 0x51]) }, color::ColorStop { position: 0.55, color: LinearRgb::from_srgb([0x7d_u8, 0x78, 0x72]) }, color::ColorStop { position: 0.85, color: LinearRgb::from_srgb([0x98_u8, 0x92, 0x89]) }])?;
    Ok(move |at: DVec2| {
        let large: f32 = large_field.sample(at * DVec2::new(0.5, 0.5));
        let large_draw: f32 = large_draw_field.sample(at * DVec2::new(0.5, 0.5));
        let large_size: f32 = recipe::levels(large_draw, [0.2, 1.0], [0.05, 0.3], recipe::LevelsCurve::Linear);
        let large_radius: f32 = recipe::quotient(large, large_size);
        let large_bowl: f32 = worley::Profile::Channels { width: 1.0 }.height(large_radius);
        let large_floor: f32 = large_bowl * 0.34;
        let large_past: f32 = large_radius - 1.0;
        let large_ring: f32 = worley::Profile::Spots { radius: 0.7 }.height(large_past);
        let large_border: f32 = large_border_field.sample(at * DVec2::new(0.5, 0.5));
        let large_inside: f32 = worley::Profile::Channels { width: 0.3 }.height(large_border);
        let large_rim: f32 = large_ring * large_inside;
        let large_wall: f32 = large_rim * 0.16;
        let middle: f32 = middle_field.sample(at);
        let middle_draw: f32 = middle_draw_field.sample(at);
        let middle_size: f32 = recipe::levels(middle_draw, [0.4, 1.0], [0.04, 0.28], recipe::LevelsCurve::Linear);
        let middle_radius: f32 = recipe::quotient(middle, middle_size);
        let middle_bowl: f32 = worley::Profile::Channels { width: 1.0 }.height(middle_radius);
        let middle_floor: f32 = middle_bowl * 0.14;
        let middle_past: f32 = middle_radius - 1.0;
        let middle_ring: f32 = worley::Profile::Spots { radius: 0.6 }.height(middle_past);
        let middle_border: f32 = middle_border_field.sample(at);
        let middle_inside: f32 = worley::Profile::Channels { width: 0.3 }.height(middle_border);
        let middle_rim: f32 = middle_ring * middle_inside;
        let middle_wall: f32 = middle_rim * 0.07;
        let small: f32 = small_field.sample(at * DVec2::new(4.0, 4.0));
        let small_draw: f32 = small_draw_field.sample(at * DVec2::new(4.0, 4.0));
        let small_size: f32 = recipe::levels(small_draw, [0.3, 1.0], [0.03, 0.28], recipe::LevelsCurve::Linear);
        let small_radius: f32 = recipe::quotient(small, small_size);
        let small_bowl: f32 = worley::Profile::Channels { width: 1.0 }.height(small_radius);
        let small_floor: f32 = small_bowl * 0.03;
        let ground: f32 = ground_field.sample(at);
        let dust: f32 = recipe::levels(ground, [0.0, 1.0], [-0.15, 0.25], recipe::LevelsCurve::Linear);
        let grit: f32 = (0.5 + grit_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let stones: f32 = recipe::levels(grit, [0.0, 1.0], [-0.01, 0.01], recipe::LevelsCurve::Linear);
        let height: f32 = large_floor + large_wall + middle_floor + middle_wall + small_floor + dust + stones + 0.04;
        let gray: LinearRgb = ramp_1.at(ground);
        let fresh: f32 = middle_rim * middle_draw * 0.5;
        let albedo: LinearRgb = recipe::mix_colors(gray, LinearRgb::from_srgb([0xb5_u8, 0xaf, 0xa5]), fresh);
        Surface {
            height,
            albedo,
            roughness: 0.95,
            metallic: 0.0,
        }
    })
}
