//! mountains.
//!
//! A mountain range from above: Worley's fractal F1, whose cones meet in sharp ridges, colored by height.
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
    let seed = Seed(8);
    let wind_x_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.5), ..pups::OctavesOptions::default() }, seed.child("wind_x", 0))?.normalized();
    let wind_y_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.5), ..pups::OctavesOptions::default() }, seed.child("wind_y", 0))?.normalized();
    let massif_field = worley::Worley4::new(seed.child("massif", 0)).with_period([Some(4), Some(4), None, Some(1)])?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 2, ..worley::Octaves::default() })?;
    let crags_field = worley::Worley2::new(seed.child("crags", 0)).with_period([Some(16), Some(16)])?.combine(worley::Combination::F1).fractal(worley::Octaves::default())?;
    let weather_field = wavelet::WaveletNoise2::new(64, seed.child("weather", 0))?.with_weights(&[0.120741345, 0.08451894, 0.059163257, 0.041414283, 0.028989997])?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.06, color: LinearRgb::from_srgb([0x6d_u8, 0x7a, 0x45]) }, color::ColorStop { position: 0.12, color: LinearRgb::from_srgb([0x5d_u8, 0x6d, 0x3c]) }, color::ColorStop { position: 0.16, color: LinearRgb::from_srgb([0x2f_u8, 0x45, 0x27]) }, color::ColorStop { position: 0.27, color: LinearRgb::from_srgb([0x2b_u8, 0x3f, 0x25]) }, color::ColorStop { position: 0.33, color: LinearRgb::from_srgb([0x5f_u8, 0x5d, 0x44]) }, color::ColorStop { position: 0.4, color: LinearRgb::from_srgb([0x7b_u8, 0x72, 0x65]) }, color::ColorStop { position: 0.6, color: LinearRgb::from_srgb([0x6d_u8, 0x67, 0x5f]) }, color::ColorStop { position: 0.8, color: LinearRgb::from_srgb([0x8c_u8, 0x86, 0x7d]) }])?;
    Ok(move |at: DVec2| {
        let wind_x: f32 = wind_x_field.sample(at);
        let right: f32 = recipe::levels(wind_x, [0.0, 1.0], [-0.4, 0.4], recipe::LevelsCurve::Linear);
        let wind_y: f32 = wind_y_field.sample(at);
        let down: f32 = recipe::levels(wind_y, [0.0, 1.0], [-0.4, 0.4], recipe::LevelsCurve::Linear);
        let range: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(right), f64::from(down));
            { let p: DVec2 = at; massif_field.value([p.x, p.y, 0.0, 0.0]) }
        };
        let crags: f32 = crags_field.sample(at * DVec2::new(4.0, 4.0));
        let spurs: f32 = recipe::levels(crags, [0.3, 1.3], [-0.15, 0.2], recipe::LevelsCurve::Unclamped);
        let relief: f32 = range + spurs;
        let above: f32 = recipe::levels(relief, [0.22, 1.2], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let height: f32 = recipe::power(above, 1.2);
        let weather: f32 = (0.5 + weather_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let uneven: f32 = recipe::levels(weather, [0.0, 1.0], [-0.04, 0.04], recipe::LevelsCurve::Linear);
        let zone: f32 = height + uneven;
        let land: LinearRgb = ramp_1.at(zone);
        let shade: f32 = recipe::levels(weather, [0.2, 0.8], [0.75, 1.2], recipe::LevelsCurve::Linear);
        let ground: LinearRgb = recipe::multiply_colors(land, LinearRgb::gray(shade));
        let sunward: f32 = {
            let at = at + 1.0 * DVec2::new(-0.009999999776482582, -0.009999999776482582);
            crags_field.sample(at * DVec2::new(4.0, 4.0))
        };
        let rise: f32 = sunward - crags;
        let shady: f32 = recipe::levels(rise, [-0.08, 0.08], [-0.16, 0.16], recipe::LevelsCurve::Linear);
        let snow_line: f32 = zone + shady;
        let snow: f32 = recipe::levels(snow_line, [0.6, 0.64], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::mix_colors(ground, LinearRgb::from_srgb([0xee_u8, 0xf1, 0xf4]), snow);
        let roughness: f32 = recipe::mix(0.95, 0.6, snow);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
