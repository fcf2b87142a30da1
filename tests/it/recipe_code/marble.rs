//! marble.
//!
//! Polished marble: waves along a diagonal that turbulence bends, Perlin's marble on Caron and Mould's partition-of-unity noise.
//!
//! The tile is 4 × 4 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::{self, LinearRgb};
use dapple::points;
use dapple::pups;
use dapple::recipe;
use dapple::wavelet;
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
    let seed = Seed(14);
    let turbulence_field = pups::turbulence(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.2), octaves: 6, ..pups::OctavesOptions::default() }, seed.child("turbulence", 0))?.normalized();
    let cloud_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), octaves: 5, ..pups::OctavesOptions::default() }, seed.child("cloud", 0))?.normalized();
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0xd3_u8, 0xd0, 0xca]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0xe6_u8, 0xe3, 0xdd]) }, color::ColorStop { position: 0.7, color: LinearRgb::from_srgb([0xee_u8, 0xec, 0xe8]) }])?;
    let grain_field = wavelet::WaveletNoise2::new(128, seed.child("grain", 0))?.with_weights(&[0.10613128, 0.09551816, 0.08596634])?;
    Ok(move |at: DVec2| {
        let bedding: f32 = recipe::coordinate(at, DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.5));
        let turbulence: f32 = turbulence_field.sample(at);
        let push: f32 = turbulence * 1.8;
        let bent: f32 = bedding + push;
        let veins: f32 = recipe::wave(bent, 1.0, 0.0, recipe::Waveform::Triangle);
        let thin: f32 = recipe::levels(veins, [0.1, 0.0], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let cloud: f32 = cloud_field.sample(at);
        let strength: f32 = recipe::levels(cloud, [0.35, 0.65], [0.1, 1.0], recipe::LevelsCurve::Linear);
        let vein: f32 = thin * strength * 0.85;
        let height: f32 = recipe::levels(vein, [0.0, 0.85], [0.97, 0.03], recipe::LevelsCurve::Linear);
        let body: LinearRgb = ramp_1.at(cloud);
        let shadow: f32 = recipe::levels(veins, [0.6, 0.0], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let gray: f32 = shadow * strength * 0.6;
        let shaded: LinearRgb = recipe::mix_colors(body, LinearRgb::from_srgb([0x9a_u8, 0x9b, 0x9d]), gray);
        let veined: LinearRgb = recipe::mix_colors(shaded, LinearRgb::from_srgb([0x55_u8, 0x56, 0x5a]), vein);
        let grain: f32 = (0.5 + grain_field.sample(at * DVec2::new(32.0, 32.0))).clamp(0.0, 1.0);
        let crystals: f32 = recipe::levels(grain, [0.0, 1.0], [0.93, 1.06], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(veined, LinearRgb::gray(crystals));
        let roughness: f32 = recipe::levels(vein, [0.0, 1.0], [0.12, 0.3], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
