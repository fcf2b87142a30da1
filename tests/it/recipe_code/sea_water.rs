//! sea-water.
//!
//! Choppy sea: Worley's fractal F1, whose creases are the crests of waves, under a surface that mirrors the sky.
//!
//! The tile is 8 × 8 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::{self, LinearRgb};
use dapple::points;
use dapple::pups;
use dapple::recipe;
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
    let seed = Seed(9);
    let waves_field = worley::Worley4::new(seed.child("waves", 0)).with_period([Some(4), Some(8), None, Some(2)])?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 5, gain: 0.42, ..worley::Octaves::default() })?;
    let swell_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(8.0, 8.0), wrap: [true, true] }, spacing: pups::Spacing::from(2.0), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("swell", 0))?.normalized();
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.15, color: LinearRgb::from_srgb([0x06_u8, 0x22, 0x2f]) }, color::ColorStop { position: 0.45, color: LinearRgb::from_srgb([0x0a_u8, 0x3a, 0x48]) }, color::ColorStop { position: 0.75, color: LinearRgb::from_srgb([0x14_u8, 0x60, 0x6a]) }, color::ColorStop { position: 1.0, color: LinearRgb::from_srgb([0x4b_u8, 0x9a, 0x98]) }])?;
    Ok(move |at: DVec2| {
        let waves: f32 = { let p: DVec2 = at * DVec2::new(0.5, 1.0); waves_field.value([p.x, p.y, 0.0, 0.0]) };
        let chop: f32 = recipe::levels(waves, [0.45, 1.35], [0.0, 0.75], recipe::LevelsCurve::Linear);
        let swell: f32 = swell_field.sample(at);
        let roll: f32 = recipe::levels(swell, [0.0, 1.0], [0.0, 0.25], recipe::LevelsCurve::Linear);
        let height: f32 = chop + roll;
        let albedo: LinearRgb = ramp_1.at(height);
        Surface {
            height,
            albedo,
            roughness: 0.08,
            metallic: 0.0,
        }
    })
}
