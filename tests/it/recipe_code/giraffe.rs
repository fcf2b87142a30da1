//! giraffe.
//!
//! The coat of a giraffe: the space giraffe of Caron and Mould's partition-of-unity textures, in short hair.
//!
//! The tile is 2 × 2 units of the plane. Made from a recipe; needs the crate `dapple`.

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
    let seed = Seed(6);
    let curl_field = wavelet::WaveletNoise2::new(8, seed.child("curl", 0))?.with_weights(&[0.14547859, 0.072739296, 0.036369648])?;
    let strands_field = wavelet::WaveletNoise2::new(32, seed.child("strands", 0))?.with_weights(&[0.1490712, 0.0745356])?;
    let tone_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.3333333333333333), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("tone", 0))?.normalized();
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0xcf_u8, 0xae, 0x7c]) }, color::ColorStop { position: 0.7, color: LinearRgb::from_srgb([0xe0_u8, 0xc8, 0x9d]) }])?;
    let ramp_2 = color::ColorRamp::new([color::ColorStop { position: 0.25, color: LinearRgb::from_srgb([0x4a_u8, 0x27, 0x12]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0x7a_u8, 0x45, 0x20]) }, color::ColorStop { position: 0.75, color: LinearRgb::from_srgb([0xa0_u8, 0x65, 0x2f]) }])?;
    let spots_field = pups::space_giraffe(&pups::SpaceGiraffeOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.28), pairs: [5, 8], values: [0.0, 1.0], ..pups::SpaceGiraffeOptions::default() }, seed.child("spots", 0))?;
    Ok(move |at: DVec2| {
        let across: f32 = recipe::coordinate(at, DVec2::new(0.0, 0.0), DVec2::new(11.0, 0.0));
        let curl: f32 = (0.5 + curl_field.sample(at * DVec2::new(4.0, 4.0))).clamp(0.0, 1.0);
        let bend: f32 = recipe::levels(curl, [0.0, 1.0], [-0.6, 0.6], recipe::LevelsCurve::Linear);
        let comb: f32 = across + bend;
        let coat: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(comb), 0.0);
            (0.5 + strands_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0)
        };
        let height: f32 = recipe::levels(coat, [0.05, 0.95], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let tone: f32 = tone_field.sample(at);
        let cream: LinearRgb = ramp_1.at(tone);
        let brown: LinearRgb = ramp_2.at(tone);
        let tips: f32 = recipe::levels(coat, [0.0, 1.0], [-2.0, 2.0], recipe::LevelsCurve::Linear);
        let spot: f32 = {
            let at = at + 0.01 * DVec2::new(f64::from(bend), f64::from(tips));
            let up: f32 = {
                let at = at + 0.04 * DVec2::new(0.0, 1.0);
                spots_field.sample(at)
            };
            let left: f32 = {
                let at = at + 0.04 * DVec2::new(0.8700000047683716, -0.5);
                spots_field.sample(at)
            };
            let right: f32 = {
                let at = at + 0.04 * DVec2::new(-0.8700000047683716, -0.5);
                spots_field.sample(at)
            };
            recipe::maximum(recipe::maximum(up, left), right)
        };
        let color: LinearRgb = recipe::mix_colors(cream, brown, spot);
        let shade: f32 = recipe::levels(height, [0.0, 1.0], [0.65, 1.1], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(color, LinearRgb::gray(shade));
        Surface {
            height,
            albedo,
            roughness: 0.7,
            metallic: 0.0,
        }
    })
}
