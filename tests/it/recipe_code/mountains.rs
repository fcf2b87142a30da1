//! mountains.
//!
//! A mountain range from above: Worley's fractal F1, whose cones meet in sharp ridges, colored by height.
//!
//! The tile is 4 × 4 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::{self, LinearRgb};
use dapple::recipe;
use dapple::wavelet;
use dapple::worley;
use dapple::hash::Seed;
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
    let seed = Seed(8);
    let range_field = worley::Worley4::new(seed.child("range", 0)).with_period([Some(4), Some(4), None, Some(1)])?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 7, gain: 0.45, ..worley::Octaves::default() })?;
    let weather_field = wavelet::WaveletNoise2::new(32, seed.child("weather", 0))?.with_weights(&[0.11985618, 0.08389933, 0.05872953, 0.04111067, 0.028777469, 0.020144228])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.15, color: LinearRgb::from_srgb([0x4d_u8, 0x5f, 0x35]) }, color::ColorStop { position: 0.35, color: LinearRgb::from_srgb([0x3c_u8, 0x4f, 0x2b]) }, color::ColorStop { position: 0.46, color: LinearRgb::from_srgb([0x57_u8, 0x55, 0x3c]) }, color::ColorStop { position: 0.54, color: LinearRgb::from_srgb([0x74_u8, 0x69, 0x5a]) }, color::ColorStop { position: 0.66, color: LinearRgb::from_srgb([0x7d_u8, 0x76, 0x6c]) }, color::ColorStop { position: 0.7, color: LinearRgb::from_srgb([0xe8_u8, 0xec, 0xef]) }, color::ColorStop { position: 0.9, color: LinearRgb::from_srgb([0xf4_u8, 0xf6, 0xf8]) }])?;
    Ok(move |at: DVec2| {
        let range: f32 = { let p: DVec2 = at; range_field.value([p.x, p.y, 0.0, 0.0]) };
        let height: f32 = recipe::levels(range, [0.42, 1.25], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let weather: f32 = (0.5 + weather_field.sample(at * DVec2::new(8.0, 8.0))).clamp(0.0, 1.0);
        let uneven: f32 = recipe::levels(weather, [0.0, 1.0], [-0.12, 0.12], recipe::LevelsCurve::Linear);
        let zone: f32 = height + uneven;
        let land: LinearRgb = ramp_1.at(zone);
        let shade: f32 = recipe::levels(weather, [0.0, 1.0], [0.75, 1.2], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(land, LinearRgb::gray(shade));
        Surface {
            height,
            albedo,
            roughness: 0.9,
            metallic: 0.0,
        }
    })
}
