//! cow.
//!
//! The coat of a cow: Caron and Mould's partition-of-unity noise, cut in two at one of its values, in short hair.
//!
//! The tile is 2 × 2 units of the plane. Made from a recipe; needs the crate `dapple`.

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
    let swirl_field = wavelet::WaveletNoise2::new(4, seed.child("swirl", 0))?.with_weights(&[0.1490712, 0.0745356])?;
    let strands_field = worley::Worley2::new(seed.child("strands", 0)).with_period([Some(128), Some(8)])?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 2, gain: 0.6, ..worley::Octaves::default() })?;
    let tufts_field = worley::Worley2::new(seed.child("tufts", 0)).with_period([Some(24), Some(6)])?.combine(worley::Combination::F2_MINUS_F1);
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.15, color: LinearRgb::from_srgb([0xb0_u8, 0x9c, 0x84]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0xd8_u8, 0xcc, 0xba]) }, color::ColorStop { position: 0.85, color: LinearRgb::from_srgb([0xef_u8, 0xe9, 0xde]) }])?;
    let ramp_2 = color::ColorRamp::new([color::ColorStop { position: 0.2, color: LinearRgb::from_srgb([0x16_u8, 0x11, 0x0e]) }, color::ColorStop { position: 0.55, color: LinearRgb::from_srgb([0x26_u8, 0x1d, 0x18]) }, color::ColorStop { position: 0.9, color: LinearRgb::from_srgb([0x3c_u8, 0x30, 0x29]) }])?;
    let values_field = pups::noise(&pups::NoiseOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.24), net: pups::NetOptions { orientations: pups::Orientations::Random, strength: 0.45, ..pups::NetOptions::default() }, ..pups::NoiseOptions::default() }, seed.child("values", 0))?;
    Ok(move |at: DVec2| {
        let swirl: f32 = (0.5 + swirl_field.sample(at * DVec2::new(2.0, 2.0))).clamp(0.0, 1.0);
        let sway: f32 = recipe::levels(swirl, [0.0, 1.0], [-0.12, 0.12], recipe::LevelsCurve::Linear);
        let hair: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(sway), 0.0);
            strands_field.sample(at * DVec2::new(64.0, 4.0))
        };
        let strand: f32 = recipe::levels(hair, [0.1, 1.3], [0.75, 0.0], recipe::LevelsCurve::Linear);
        let lock: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(sway), 0.0);
            tufts_field.sample(at * DVec2::new(12.0, 3.0))
        };
        let clump: f32 = recipe::levels(lock, [0.0, 0.4], [0.0, 0.25], recipe::LevelsCurve::Smooth);
        let height: f32 = strand + clump;
        let white: LinearRgb = ramp_1.at(height);
        let dark: LinearRgb = ramp_2.at(height);
        let tips: f32 = recipe::levels(hair, [0.1, 1.2], [0.05, -0.03], recipe::LevelsCurve::Linear);
        let laid: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(sway), f64::from(tips));
            values_field.sample(at)
        };
        let stray: f32 = recipe::levels(hair, [0.1, 1.2], [0.05, -0.05], recipe::LevelsCurve::Linear);
        let frayed: f32 = laid + stray;
        let black: f32 = recipe::levels(frayed, [0.53, 0.56], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let albedo: LinearRgb = recipe::mix_colors(white, dark, black);
        let roughness: f32 = recipe::mix(0.75, 0.5, black);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
