//! coastline.
//!
//! Islands in a shallow sea: partition-of-unity noise that is made finer near the shore alone, after Caron and Mould's iterated reference.
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
    let seed = Seed(41);
    let reference_field = pups::noise(&pups::NoiseOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.7), ..pups::NoiseOptions::default() }, seed.child("reference", 0))?;
    let first_field = pups::noise(&pups::NoiseOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.35), ..pups::NoiseOptions::default() }, seed.child("first", 0))?;
    let second_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.175), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("second", 0))?.normalized();
    let fine_field = wavelet::WaveletNoise2::new(128, seed.child("fine", 0))?.with_weights(&[0.13655698, 0.08193419, 0.049160514])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.05, color: LinearRgb::from_srgb([0x0b_u8, 0x2a, 0x4a]) }, color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0x12_u8, 0x47, 0x6b]) }, color::ColorStop { position: 0.44, color: LinearRgb::from_srgb([0x2a_u8, 0x7f, 0x94]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0x77_u8, 0xb7, 0xac]) }])?;
    let ramp_2 = color::ColorRamp::new([color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0xd5_u8, 0xc3, 0x9a]) }, color::ColorStop { position: 0.525, color: LinearRgb::from_srgb([0xc9_u8, 0xb9, 0x8a]) }, color::ColorStop { position: 0.55, color: LinearRgb::from_srgb([0x6f_u8, 0x84, 0x48]) }, color::ColorStop { position: 0.7, color: LinearRgb::from_srgb([0x4c_u8, 0x67, 0x35]) }, color::ColorStop { position: 0.85, color: LinearRgb::from_srgb([0x6c_u8, 0x63, 0x49]) }, color::ColorStop { position: 1.0, color: LinearRgb::from_srgb([0x8d_u8, 0x82, 0x71]) }])?;
    Ok(move |at: DVec2| {
        let reference: f32 = reference_field.sample(at);
        let undecided: f32 = recipe::levels(reference, [0.0, 1.0], [-0.5, 0.5], recipe::LevelsCurve::Linear);
        let near: f32 = worley::Profile::Spots { radius: 0.5 }.height(undecided);
        let first: f32 = first_field.sample(at);
        let first_part: f32 = recipe::levels(first, [0.0, 1.0], [-0.25, 0.25], recipe::LevelsCurve::Linear);
        let first_shift: f32 = near * first_part;
        let second: f32 = second_field.sample(at);
        let second_part: f32 = recipe::levels(second, [0.0, 1.0], [-0.3, 0.3], recipe::LevelsCurve::Linear);
        let second_shift: f32 = near * second_part;
        let fine: f32 = (0.5 + fine_field.sample(at * DVec2::new(32.0, 32.0))).clamp(0.0, 1.0);
        let fine_part: f32 = recipe::levels(fine, [0.0, 1.0], [-0.06, 0.06], recipe::LevelsCurve::Linear);
        let fine_shift: f32 = near * fine_part;
        let land: f32 = reference + first_shift + second_shift + fine_shift;
        let ground_height: f32 = recipe::levels(land, [0.5, 1.15], [0.06, 1.0], recipe::LevelsCurve::Linear);
        let dry: f32 = recipe::levels(land, [0.497, 0.503], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let height: f32 = recipe::mix(0.04, ground_height, dry);
        let sea: LinearRgb = ramp_1.at(land);
        let ground: LinearRgb = ramp_2.at(land);
        let shade: f32 = recipe::levels(fine, [0.0, 1.0], [0.8, 1.2], recipe::LevelsCurve::Linear);
        let soil: LinearRgb = recipe::multiply_colors(ground, LinearRgb::gray(shade));
        let albedo: LinearRgb = recipe::mix_colors(sea, soil, dry);
        let roughness: f32 = recipe::mix(0.15, 0.9, dry);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
