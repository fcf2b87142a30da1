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
    let leather_field = wavelet::WaveletNoise2::new(128, seed.child("leather", 0))?.with_weights(&[0.12261039, 0.08582727, 0.06007909, 0.04205536])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.05, color: LinearRgb::from_srgb([0x3d_u8, 0x33, 0x24]) }, color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0x5c_u8, 0x56, 0x34]) }, color::ColorStop { position: 0.6, color: LinearRgb::from_srgb([0x86_u8, 0x80, 0x4d]) }, color::ColorStop { position: 0.95, color: LinearRgb::from_srgb([0xb3_u8, 0xa8, 0x78]) }])?;
    let patches_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(8.0, 8.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), ..pups::OctavesOptions::default() }, seed.child("patches", 0))?.normalized();
    let scale_field = worley::Worley2::new(seed.child("furrow", 0)).with_period([Some(8), Some(8)])?.cell_values();
    Ok(move |at: DVec2| {
        let scales: f32 = scales_field.sample(at);
        let bumps: f32 = recipe::levels(scales, [0.0, 0.75], [0.0, 0.55], recipe::LevelsCurve::Smooth);
        let furrow: f32 = furrow_field.sample(at);
        let dome: f32 = worley::Profile::Channels { width: 0.22 }.height(furrow);
        let back: f32 = dome * 0.35;
        let leather: f32 = (0.5 + leather_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let pores: f32 = recipe::levels(leather, [0.0, 1.0], [-0.03, 0.07], recipe::LevelsCurve::Linear);
        let height: f32 = bumps + back + pores;
        let hide: LinearRgb = ramp_1.at(height);
        let darker: LinearRgb = recipe::multiply_colors(hide, LinearRgb::from_srgb([0xc4_u8, 0x9a, 0x72]));
        let patches: f32 = patches_field.sample(at);
        let blotch: f32 = recipe::levels(patches, [0.4, 0.65], [0.0, 0.7], recipe::LevelsCurve::Smooth);
        let spotted: LinearRgb = recipe::mix_colors(hide, darker, blotch);
        let scale: f32 = scale_field.sample(at);
        let shade: f32 = recipe::levels(scale, [0.0, 1.0], [0.7, 1.25], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(spotted, LinearRgb::gray(shade));
        let roughness: f32 = recipe::levels(height, [0.1, 0.8], [0.9, 0.45], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
