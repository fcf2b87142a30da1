//! craters.
//!
//! The ground of a moon: craters of all sizes and ages about Worley's feature points, the youngest with bright rays.
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
    let old_field = worley::Worley2::new(seed.child("old", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.7 })?.combine(worley::Combination::F1);
    let rough_field = wavelet::WaveletNoise2::new(16, seed.child("rough", 0))?.with_weights(&[0.13373828, 0.08024297, 0.04814578, 0.028887467, 0.017332481])?;
    let old_draw_field = worley::Worley2::new(seed.child("old", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.7 })?.cell_values();
    let old_border_field = worley::Worley2::new(seed.child("old", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.7 })?.combine(worley::Combination::F2_MINUS_F1);
    let middle_field = worley::Worley2::new(seed.child("middle", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.combine(worley::Combination::F1);
    let middle_draw_field = worley::Worley2::new(seed.child("middle", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.cell_values();
    let middle_border_field = worley::Worley2::new(seed.child("middle", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.combine(worley::Combination::F2_MINUS_F1);
    let small_field = worley::Worley2::new(seed.child("small", 0)).with_period([Some(40), Some(40)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.9 })?.combine(worley::Combination::F1);
    let small_draw_field = worley::Worley2::new(seed.child("small", 0)).with_period([Some(40), Some(40)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.9 })?.cell_values();
    let young_field = worley::Worley2::new(seed.child("young", 0)).with_period([Some(2), Some(2)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.7 })?.combine(worley::Combination::F1);
    let ground_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(8.0, 8.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), octaves: 5, gain: 0.6, ..pups::OctavesOptions::default() }, seed.child("ground", 0))?.normalized();
    let grit_field = wavelet::WaveletNoise2::new(128, seed.child("grit", 0))?.with_weights(&[0.12261039, 0.08582727, 0.06007909, 0.04205536])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0x4b_u8, 0x48, 0x45]) }, color::ColorStop { position: 0.45, color: LinearRgb::from_srgb([0x5f_u8, 0x5b, 0x57]) }, color::ColorStop { position: 0.55, color: LinearRgb::from_srgb([0x7f_u8, 0x7a, 0x74]) }, color::ColorStop { position: 0.8, color: LinearRgb::from_srgb([0x8f_u8, 0x8a, 0x83]) }])?;
    let young_border_field = worley::Worley2::new(seed.child("young", 0)).with_period([Some(2), Some(2)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.7 })?.combine(worley::Combination::F2_MINUS_F1);
    Ok(move |at: DVec2| {
        let old: f32 = old_field.sample(at * DVec2::new(0.5, 0.5));
        let rough: f32 = (0.5 + rough_field.sample(at * DVec2::new(2.0, 2.0))).clamp(0.0, 1.0);
        let wobble: f32 = recipe::levels(rough, [0.0, 1.0], [-0.05, 0.05], recipe::LevelsCurve::Linear);
        let old_way: f32 = old + wobble;
        let old_draw: f32 = old_draw_field.sample(at * DVec2::new(0.5, 0.5));
        let old_size: f32 = recipe::levels(old_draw, [0.0, 1.0], [0.06, 0.3], recipe::LevelsCurve::Linear);
        let old_radius: f32 = recipe::quotient(old_way, old_size);
        let old_square: f32 = recipe::power(old_radius, 2.0);
        let old_bowl: f32 = recipe::levels(old_square, [0.3, 1.0], [-0.45, 0.4], recipe::LevelsCurve::Unclamped);
        let old_floor: f32 = recipe::maximum(old_bowl, -0.35);
        let old_border: f32 = old_border_field.sample(at * DVec2::new(0.5, 0.5));
        let old_inside: f32 = recipe::levels(old_border, [0.0, 0.4], [0.0, 0.4], recipe::LevelsCurve::Smooth);
        let old_cube: f32 = recipe::power(old_radius, 3.0);
        let old_blanket: f32 = recipe::quotient(old_inside, old_cube);
        let old_shape: f32 = recipe::minimum(old_floor, old_blanket);
        let old_relief: f32 = old_shape * old_size * 1.1;
        let middle: f32 = middle_field.sample(at);
        let middle_way: f32 = middle + wobble;
        let middle_draw: f32 = middle_draw_field.sample(at);
        let middle_size: f32 = recipe::levels(middle_draw, [0.0, 1.0], [0.04, 0.3], recipe::LevelsCurve::Linear);
        let middle_radius: f32 = recipe::quotient(middle_way, middle_size);
        let middle_square: f32 = recipe::power(middle_radius, 2.0);
        let middle_bowl: f32 = recipe::levels(middle_square, [0.0, 1.0], [-0.9, 0.3], recipe::LevelsCurve::Unclamped);
        let middle_border: f32 = middle_border_field.sample(at);
        let middle_inside: f32 = recipe::levels(middle_border, [0.0, 0.4], [0.0, 0.3], recipe::LevelsCurve::Smooth);
        let middle_cube: f32 = recipe::power(middle_radius, 3.0);
        let middle_blanket: f32 = recipe::quotient(middle_inside, middle_cube);
        let middle_shape: f32 = recipe::minimum(middle_bowl, middle_blanket);
        let youth: f32 = recipe::wave(middle_draw, 8.0, 0.0, recipe::Waveform::Sawtooth);
        let middle_depth: f32 = recipe::levels(youth, [0.0, 1.0], [0.2, 0.6], recipe::LevelsCurve::Linear);
        let middle_relief: f32 = middle_shape * middle_size * middle_depth;
        let small: f32 = small_field.sample(at * DVec2::new(5.0, 5.0));
        let small_draw: f32 = small_draw_field.sample(at * DVec2::new(5.0, 5.0));
        let small_size: f32 = recipe::levels(small_draw, [0.3, 1.0], [0.02, 0.26], recipe::LevelsCurve::Linear);
        let small_radius: f32 = recipe::quotient(small, small_size);
        let small_bowl: f32 = worley::Profile::Channels { width: 1.0 }.height(small_radius);
        let small_hole: f32 = small_bowl - 1.0;
        let small_relief: f32 = small_hole * small_size * 0.14;
        let young: f32 = young_field.sample(at * DVec2::new(0.25, 0.25));
        let young_way: f32 = recipe::levels(rough, [0.0, 1.0], [-0.012, 0.012], recipe::LevelsCurve::Linear);
        let young_sum: f32 = young + young_way;
        let young_radius: f32 = recipe::quotient(young_sum, 0.075);
        let young_square: f32 = recipe::power(young_radius, 2.0);
        let young_bowl: f32 = recipe::levels(young_square, [0.0, 1.0], [-0.9, 0.3], recipe::LevelsCurve::Unclamped);
        let young_cube: f32 = recipe::power(young_radius, 3.0);
        let young_blanket: f32 = recipe::quotient(0.3, young_cube);
        let young_shape: f32 = recipe::minimum(young_bowl, young_blanket);
        let young_relief: f32 = young_shape * 0.1;
        let ground: f32 = ground_field.sample(at);
        let dust: f32 = recipe::levels(ground, [0.0, 1.0], [-0.1, 0.1], recipe::LevelsCurve::Linear);
        let grit: f32 = (0.5 + grit_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let stones: f32 = recipe::levels(grit, [0.0, 1.0], [-0.012, 0.012], recipe::LevelsCurve::Linear);
        let height: f32 = old_relief + middle_relief + small_relief + young_relief + dust + stones + 0.45;
        let gray: LinearRgb = ramp_1.at(ground);
        let filled: f32 = recipe::levels(old_radius, [0.85, 0.7], [0.0, 0.6], recipe::LevelsCurve::Linear);
        let plain: LinearRgb = recipe::mix_colors(gray, LinearRgb::from_srgb([0x4e_u8, 0x4b, 0x48]), filled);
        let speckle: f32 = recipe::levels(grit, [0.2, 0.8], [0.85, 1.15], recipe::LevelsCurve::Linear);
        let regolith: LinearRgb = recipe::multiply_colors(plain, LinearRgb::gray(speckle));
        let right: f32 = {
            let at = at + 0.02 * DVec2::new(1.0, 0.0);
            young_field.sample(at * DVec2::new(0.25, 0.25))
        };
        let growth_x: f32 = right - young;
        let back: f32 = recipe::levels(young, [0.0, 1.0], [320.0, -480.0], recipe::LevelsCurve::Unclamped);
        let ray_x: f32 = growth_x * back;
        let below: f32 = {
            let at = at + 0.02 * DVec2::new(0.0, 1.0);
            young_field.sample(at * DVec2::new(0.25, 0.25))
        };
        let growth_y: f32 = below - young;
        let ray_y: f32 = growth_y * back;
        let streaks: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(ray_x), f64::from(ray_y));
            (0.5 + rough_field.sample(at * DVec2::new(2.0, 2.0))).clamp(0.0, 1.0)
        };
        let ray: f32 = recipe::levels(streaks, [0.5, 0.75], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let reach: f32 = recipe::levels(young, [0.05, 0.42], [1.0, 0.0], recipe::LevelsCurve::Linear);
        let young_border: f32 = young_border_field.sample(at * DVec2::new(0.25, 0.25));
        let young_inside: f32 = recipe::levels(young_border, [0.0, 0.2], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let rays: f32 = ray * reach * young_inside;
        let thrown: f32 = recipe::levels(middle_radius, [2.2, 0.9], [0.0, 0.6], recipe::LevelsCurve::Linear);
        let fresh: f32 = recipe::levels(youth, [0.5, 1.0], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let middle_bright: f32 = thrown * fresh * middle_inside * 3.0;
        let young_bright: f32 = recipe::levels(young_radius, [2.2, 0.8], [0.0, 0.75], recipe::LevelsCurve::Linear);
        let bright: f32 = recipe::maximum(recipe::maximum(rays, middle_bright), young_bright);
        let albedo: LinearRgb = recipe::mix_colors(regolith, LinearRgb::from_srgb([0xc4_u8, 0xbe, 0xb5]), bright);
        Surface {
            height,
            albedo,
            roughness: 0.95,
            metallic: 0.0,
        }
    })
}
