//! rock.
//!
//! Weathered granite: blocks and cracks from the fractal sum of Worley's F2 - F1, and crystals from his cells.
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
    let crystal_field = worley::Worley2::new(seed.child("crystal", 0)).with_period([Some(96), Some(96)])?.cell_values();
    let ramp_1 = color::ColorRamp::even(&[LinearRgb::from_srgb([0x8b_u8, 0x81, 0x78]), LinearRgb::from_srgb([0xa8_u8, 0x9d, 0x92]), LinearRgb::from_srgb([0x9b_u8, 0x97, 0x93]), LinearRgb::from_srgb([0xb6_u8, 0xac, 0xa0]), LinearRgb::from_srgb([0x7f_u8, 0x7a, 0x76]), LinearRgb::from_srgb([0xad_u8, 0xa2, 0x9c])])?;
    let flake_field = worley::Worley2::new(seed.child("flake", 0)).with_period([Some(192), Some(192)])?.cell_values();
    let stain_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), octaves: 5, gain: 0.65, ..pups::OctavesOptions::default() }, seed.child("stain", 0))?.normalized();
    let ramp_2 = color::ColorRamp::new([color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0x5f_u8, 0x61, 0x46]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0x8a_u8, 0x8b, 0x68]) }, color::ColorStop { position: 0.7, color: LinearRgb::from_srgb([0xb5_u8, 0xb4, 0x98]) }])?;
    Ok(move |at: DVec2| {
        let blocks: f32 = { let p: DVec2 = at; blocks_field.value([p.x, p.y, 0.0, 0.0]) };
        let crags: f32 = recipe::levels(blocks, [0.0, 0.75], [0.0, 0.95], recipe::LevelsCurve::Linear);
        let grain: f32 = (0.5 + grain_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let tooth: f32 = recipe::levels(grain, [0.0, 1.0], [-0.01, 0.05], recipe::LevelsCurve::Linear);
        let height: f32 = crags + tooth;
        let crystal: f32 = crystal_field.sample(at * DVec2::new(24.0, 24.0));
        let feldspar: LinearRgb = ramp_1.at(crystal);
        let flake: f32 = flake_field.sample(at * DVec2::new(48.0, 48.0));
        let is_mica: f32 = recipe::levels(flake, [0.87, 0.89], [0.0, 0.7], recipe::LevelsCurve::Linear);
        let granite: LinearRgb = recipe::mix_colors(feldspar, LinearRgb::from_srgb([0x3d_u8, 0x39, 0x36]), is_mica);
        let stain: f32 = stain_field.sample(at);
        let uneven: f32 = recipe::levels(grain, [0.0, 1.0], [-0.1, 0.1], recipe::LevelsCurve::Linear);
        let rind: f32 = stain + uneven;
        let iron: f32 = recipe::levels(rind, [0.5, 0.7], [0.0, 0.65], recipe::LevelsCurve::Linear);
        let rusty: LinearRgb = recipe::mix_colors(granite, LinearRgb::from_srgb([0x86_u8, 0x60, 0x3f]), iron);
        let crust: LinearRgb = ramp_2.at(grain);
        let lichen: f32 = recipe::levels(rind, [0.37, 0.33], [0.0, 0.85], recipe::LevelsCurve::Linear);
        let grown: LinearRgb = recipe::mix_colors(rusty, crust, lichen);
        let dirt: f32 = recipe::levels(blocks, [0.16, 0.05], [0.0, 0.8], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::mix_colors(grown, LinearRgb::from_srgb([0x4a_u8, 0x3d, 0x30]), dirt);
        let roughness: f32 = recipe::mix(0.95, 0.7, is_mica);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
