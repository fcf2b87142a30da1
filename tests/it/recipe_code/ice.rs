//! ice.
//!
//! The ice of a lake: white cracks at several depths, which are a fractal sum of Worley's F2 - F1, in clear and cloudy blue.
//!
//! The tile is 4 × 4 units of the plane. Made from a recipe; needs the crate `dapple`.

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
    let seed = Seed(5);
    let deep_field = worley::Worley2::new(seed.child("deep", 0)).with_period([Some(4), Some(4)])?.combine(worley::Combination::F2_MINUS_F1).fractal(worley::Octaves { count: 4, gain: 0.6, ..worley::Octaves::default() })?;
    let cloud_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.6666666666666666), octaves: 5, gain: 0.6, ..pups::OctavesOptions::default() }, seed.child("cloud", 0))?.normalized();
    let cracks_field = worley::Worley2::new(seed.child("cracks", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 1.0 })?.combine(worley::Combination::F2_MINUS_F1);
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.0, color: LinearRgb::from_srgb([0xcf_u8, 0xe6, 0xee]) }, color::ColorStop { position: 0.25, color: LinearRgb::from_srgb([0x7f_u8, 0xb2, 0xc8]) }, color::ColorStop { position: 0.6, color: LinearRgb::from_srgb([0x3f_u8, 0x7f, 0x9f]) }, color::ColorStop { position: 1.0, color: LinearRgb::from_srgb([0x23_u8, 0x5b, 0x7d]) }])?;
    let frost_field = wavelet::WaveletNoise2::new(64, seed.child("frost", 0))?.with_weights(&[0.10961724, 0.087693796, 0.07015504, 0.056124028])?;
    Ok(move |at: DVec2| {
        let deep: f32 = deep_field.sample(at);
        let depth: f32 = recipe::levels(deep, [0.05, 0.9], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let swell: f32 = recipe::levels(depth, [0.0, 1.0], [0.38, 0.66], recipe::LevelsCurve::Linear);
        let cloud: f32 = cloud_field.sample(at);
        let bumps: f32 = recipe::levels(cloud, [0.0, 1.0], [-0.3, 0.3], recipe::LevelsCurve::Linear);
        let cracks: f32 = cracks_field.sample(at);
        let ragged: f32 = recipe::levels(cloud, [0.35, 0.75], [0.0, 0.06], recipe::LevelsCurve::Linear);
        let distance: f32 = cracks + ragged;
        let halo: f32 = worley::Profile::Spots { radius: 0.25 }.height(distance);
        let lips: f32 = halo * 0.3;
        let crack: f32 = worley::Profile::Spots { radius: 0.05 }.height(distance);
        let cut: f32 = crack * -0.6;
        let height: f32 = swell + bumps + lips + cut;
        let body: LinearRgb = ramp_1.at(depth);
        let air: f32 = recipe::levels(cloud, [0.5, 0.8], [0.0, 0.7], recipe::LevelsCurve::Smooth);
        let cloudy: LinearRgb = recipe::mix_colors(body, LinearRgb::from_srgb([0xb9_u8, 0xd6, 0xe0]), air);
        let frost: f32 = (0.5 + frost_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let veil: f32 = halo * frost * 0.9;
        let veiled: LinearRgb = recipe::mix_colors(cloudy, LinearRgb::from_srgb([0xe2_u8, 0xef, 0xf3]), veil);
        let albedo: LinearRgb = recipe::mix_colors(veiled, LinearRgb::from_srgb([0xf0_u8, 0xf6, 0xf8]), crack);
        let dull: f32 = frost * air * 0.6;
        let roughness: f32 = 0.06 + dull + veil;
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
