//! clouds.
//!
//! Fair-weather clouds: octaves of Caron and Mould's partition-of-unity noise, each half as high as the one before.
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
    let seed = Seed(19);
    let banks_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.9), octaves: 5, ..pups::OctavesOptions::default() }, seed.child("banks", 0))?.normalized();
    let puffs_field = pups::turbulence(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.35), ..pups::OctavesOptions::default() }, seed.child("puffs", 0))?.normalized();
    let wisps_field = wavelet::WaveletNoise2::new(64, seed.child("wisps", 0))?.with_weights(&[0.13446738, 0.08068043, 0.04840826, 0.029044954])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.2, color: LinearRgb::from_srgb([0x2f_u8, 0x66, 0xa8]) }, color::ColorStop { position: 0.6, color: LinearRgb::from_srgb([0x4f_u8, 0x86, 0xc0]) }])?;
    let ramp_2 = color::ColorRamp::new([color::ColorStop { position: 0.0, color: LinearRgb::from_srgb([0xe8_u8, 0xed, 0xf2]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0xf5_u8, 0xf5, 0xf3]) }, color::ColorStop { position: 1.0, color: LinearRgb::from_srgb([0xd5_u8, 0xd7, 0xda]) }])?;
    Ok(move |at: DVec2| {
        let banks: f32 = banks_field.sample(at);
        let puffs: f32 = puffs_field.sample(at);
        let torn: f32 = recipe::levels(puffs, [0.0, 1.0], [0.1, -0.2], recipe::LevelsCurve::Linear);
        let wisps: f32 = (0.5 + wisps_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let fine: f32 = recipe::levels(wisps, [0.0, 1.0], [-0.06, 0.06], recipe::LevelsCurve::Linear);
        let density: f32 = banks + torn + fine;
        let cover: f32 = recipe::levels(density, [0.47, 0.66], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let thick: f32 = recipe::levels(banks, [0.42, 0.8], [0.15, 1.0], recipe::LevelsCurve::Linear);
        let height: f32 = cover * thick;
        let sky: LinearRgb = ramp_1.at(banks);
        let cloud: LinearRgb = ramp_2.at(thick);
        let albedo: LinearRgb = recipe::mix_colors(sky, cloud, cover);
        Surface {
            height,
            albedo,
            roughness: 1.0,
            metallic: 0.0,
        }
    })
}
