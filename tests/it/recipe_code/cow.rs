//! cow.
//!
//! The coat of a cow: random labels of the control points of Caron and Mould's partition-of-unity textures, in short hair.
//!
//! The tile is 2 × 2 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::LinearRgb;
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
    let seed = Seed(2);
    let curl_field = wavelet::WaveletNoise2::new(8, seed.child("curl", 0))?.with_weights(&[0.14547859, 0.072739296, 0.036369648])?;
    let strands_field = wavelet::WaveletNoise2::new(32, seed.child("strands", 0))?.with_weights(&[0.1490712, 0.0745356])?;
    let patches_field = pups::cow(&pups::CowOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.2), probability: dapple::raster::Varying::Constant(0.45), net: pups::NetOptions { orientations: pups::Orientations::Random, ..pups::NetOptions::default() }, ..pups::CowOptions::default() }, seed.child("patches", 0))?;
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
        let sway: f32 = recipe::levels(curl, [0.0, 1.0], [-5.0, 5.0], recipe::LevelsCurve::Linear);
        let tips: f32 = recipe::levels(coat, [0.0, 1.0], [-2.0, 2.0], recipe::LevelsCurve::Linear);
        let black: f32 = {
            let at = at + 0.015 * DVec2::new(f64::from(sway), f64::from(tips));
            patches_field.sample(at)
        };
        let color: LinearRgb = recipe::mix_colors(LinearRgb::from_srgb([0xe9_u8, 0xe2, 0xd6]), LinearRgb::from_srgb([0x2e_u8, 0x26, 0x21]), black);
        let shade: f32 = recipe::levels(height, [0.0, 1.0], [0.75, 1.1], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(color, LinearRgb::gray(shade));
        let roughness: f32 = recipe::mix(0.8, 0.55, black);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
