//! rock.
//!
//! Weathered rock: blocks and cracks from the fractal sum of Worley's F2 - F1.
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
    let seed = Seed(21);
    let blocks_field = worley::Worley4::new(seed.child("blocks", 0)).with_period([Some(4), Some(4), None, Some(1)])?.combine(worley::Combination::F2_MINUS_F1).fractal(worley::Octaves { gain: 0.46, ..worley::Octaves::default() })?;
    let grain_field = wavelet::WaveletNoise2::new(64, seed.child("grain", 0))?.with_weights(&[0.10961724, 0.087693796, 0.07015504, 0.056124028])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.02, color: LinearRgb::from_srgb([0x2e_u8, 0x2a, 0x26]) }, color::ColorStop { position: 0.14, color: LinearRgb::from_srgb([0x5c_u8, 0x55, 0x4e]) }, color::ColorStop { position: 0.35, color: LinearRgb::from_srgb([0x87_u8, 0x7d, 0x72]) }, color::ColorStop { position: 0.75, color: LinearRgb::from_srgb([0xaa_u8, 0xa0, 0x94]) }])?;
    let stain_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), gain: 0.65, ..pups::OctavesOptions::default() }, seed.child("stain", 0))?.normalized();
    Ok(move |at: DVec2| {
        let blocks: f32 = { let p: DVec2 = at; blocks_field.value([p.x, p.y, 0.0, 0.0]) };
        let crags: f32 = recipe::levels(blocks, [0.0, 0.75], [0.0, 0.95], recipe::LevelsCurve::Linear);
        let grain: f32 = (0.5 + grain_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let tooth: f32 = recipe::levels(grain, [0.0, 1.0], [-0.01, 0.05], recipe::LevelsCurve::Linear);
        let height: f32 = crags + tooth;
        let stone: LinearRgb = ramp_1.at(height);
        let stain: f32 = stain_field.sample(at);
        let iron: f32 = recipe::levels(stain, [0.52, 0.8], [0.0, 0.7], recipe::LevelsCurve::Linear);
        let rusty: LinearRgb = recipe::mix_colors(stone, LinearRgb::from_srgb([0x7d_u8, 0x5f, 0x45]), iron);
        let lichen: f32 = recipe::levels(stain, [0.36, 0.2], [0.0, 0.5], recipe::LevelsCurve::Linear);
        let grown: LinearRgb = recipe::mix_colors(rusty, LinearRgb::from_srgb([0x8b_u8, 0x8c, 0x6d]), lichen);
        let speckle: f32 = recipe::levels(grain, [0.0, 1.0], [0.6, 1.35], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(grown, LinearRgb::gray(speckle));
        let roughness: f32 = recipe::levels(height, [0.0, 1.0], [0.98, 0.75], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
