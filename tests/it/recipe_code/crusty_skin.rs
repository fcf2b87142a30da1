//! crusty-skin.
//!
//! The hide of a reptile: scales from Worley's fractal F2 - F1, each with a shade of its own.
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
    let seed = Seed(17);
    let scales_field = worley::Worley2::new(seed.child("furrow", 0)).with_period([Some(8), Some(8)])?.combine(worley::Combination::F2_MINUS_F1).fractal(worley::Octaves { count: 4, gain: 0.45, ..worley::Octaves::default() })?;
    let furrow_field = worley::Worley2::new(seed.child("furrow", 0)).with_period([Some(8), Some(8)])?.combine(worley::Combination::F2_MINUS_F1);
    let pore_field = worley::Worley2::new(seed.child("pore", 0)).with_period([Some(128), Some(128)])?.combine(worley::Combination::F1);
    let crust_field = wavelet::WaveletNoise2::new(64, seed.child("crust", 0))?.with_weights(&[0.1134812, 0.085110895, 0.06383318, 0.04787488, 0.03590616])?;
    let scale_field = worley::Worley2::new(seed.child("furrow", 0)).with_period([Some(8), Some(8)])?.cell_values();
    let ramp_1 = color::ColorRamp::even(&[LinearRgb::from_srgb([0x68_u8, 0x71, 0x3c]), LinearRgb::from_srgb([0x7b_u8, 0x7d, 0x42]), LinearRgb::from_srgb([0x8a_u8, 0x8a, 0x51]), LinearRgb::from_srgb([0x72_u8, 0x79, 0x4a])])?;
    let ramp_2 = color::ColorRamp::even(&[LinearRgb::from_srgb([0x6b_u8, 0x4f, 0x32]), LinearRgb::from_srgb([0x7d_u8, 0x5f, 0x3b]), LinearRgb::from_srgb([0x5d_u8, 0x46, 0x30])])?;
    let patches_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(8.0, 8.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.3333333333333333), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("patches", 0))?.normalized();
    Ok(move |at: DVec2| {
        let scales: f32 = scales_field.sample(at);
        let bumps: f32 = recipe::levels(scales, [0.0, 0.75], [0.0, 0.55], recipe::LevelsCurve::Smooth);
        let furrow: f32 = furrow_field.sample(at);
        let dome: f32 = worley::Profile::Channels { width: 0.2 }.height(furrow);
        let back: f32 = dome * 0.35;
        let pore: f32 = pore_field.sample(at * DVec2::new(16.0, 16.0));
        let pits: f32 = recipe::levels(pore, [0.15, 0.4], [0.0, 0.05], recipe::LevelsCurve::Linear);
        let crust: f32 = (0.5 + crust_field.sample(at * DVec2::new(8.0, 8.0))).clamp(0.0, 1.0);
        let flakes: f32 = recipe::levels(crust, [0.0, 1.0], [-0.06, 0.06], recipe::LevelsCurve::Linear);
        let height: f32 = bumps + back + pits + flakes;
        let scale: f32 = scale_field.sample(at);
        let olive: LinearRgb = ramp_1.at(scale);
        let brown: LinearRgb = ramp_2.at(scale);
        let patches: f32 = patches_field.sample(at);
        let chance: f32 = recipe::levels(scale, [0.0, 1.0], [-0.14, 0.14], recipe::LevelsCurve::Linear);
        let kind: f32 = patches + chance;
        let is_brown: f32 = recipe::levels(kind, [0.42, 0.62], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let hide: LinearRgb = recipe::mix_colors(olive, brown, is_brown);
        let wear: f32 = back + flakes;
        let worn: f32 = recipe::levels(wear, [0.34, 0.4], [0.0, 0.6], recipe::LevelsCurve::Linear);
        let horny: LinearRgb = recipe::mix_colors(hide, LinearRgb::from_srgb([0xb5_u8, 0xa7, 0x77]), worn);
        let freckle: f32 = recipe::levels(crust, [0.34, 0.28], [0.0, 0.6], recipe::LevelsCurve::Linear);
        let freckled: LinearRgb = recipe::mix_colors(horny, LinearRgb::from_srgb([0x3f_u8, 0x3a, 0x22]), freckle);
        let seam: f32 = recipe::levels(furrow, [0.06, 0.02], [0.0, 0.8], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::mix_colors(freckled, LinearRgb::from_srgb([0x4a_u8, 0x3a, 0x26]), seam);
        let roughness: f32 = recipe::levels(wear, [0.1, 0.5], [0.9, 0.5], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
