//! wood-grain.
//!
//! A sawn board: stretched cells of Worley's are its year rings, its fibers and its pores.
//!
//! The tile is 4 × 4 units of the plane. Made from a recipe; needs the crate `dapple`.

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
    let seed = Seed(11);
    let growth_field = worley::Worley4::new(seed.child("growth", 0)).with_period([Some(4), Some(1), None, Some(1)])?.combine(worley::Combination::new([0.25, 0.25, 0.25, 0.25]));
    let fiber_field = worley::Worley2::new(seed.child("fiber", 0)).with_period([Some(128), Some(4)])?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 2, gain: 0.6, ..worley::Octaves::default() })?;
    let pore_field = worley::Worley2::new(seed.child("pore", 0)).with_period([Some(256), Some(16)])?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.combine(worley::Combination::F1);
    let tone_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), octaves: 2, ..pups::OctavesOptions::default() }, seed.child("tone", 0))?.normalized();
    let ramp_1 = color::ColorRamp::even(&[LinearRgb::from_srgb([0xb9_u8, 0x8a, 0x58]), LinearRgb::from_srgb([0xc9_u8, 0x9b, 0x69])])?;
    Ok(move |at: DVec2| {
        let growth: f32 = { let p: DVec2 = at * DVec2::new(1.0, 0.25); growth_field.value([p.x, p.y, 0.0, 0.0]) };
        let rise: f32 = growth * 30.0;
        let across: f32 = recipe::coordinate(at, DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.0));
        let straight: f32 = across * 4.0;
        let years: f32 = rise + straight;
        let ring: f32 = recipe::wave(years, 1.0, 0.0, recipe::Waveform::Sawtooth);
        let late: f32 = recipe::levels(ring, [0.25, 1.0], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let jump: f32 = recipe::levels(ring, [0.0, 0.45], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let dark: f32 = late * jump;
        let hard: f32 = recipe::levels(dark, [0.0, 1.0], [0.35, 0.75], recipe::LevelsCurve::Linear);
        let fiber: f32 = fiber_field.sample(at * DVec2::new(32.0, 1.0));
        let threads: f32 = recipe::levels(fiber, [0.1, 1.3], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let stripes: f32 = recipe::levels(threads, [0.0, 1.0], [0.1, -0.15], recipe::LevelsCurve::Linear);
        let pore: f32 = pore_field.sample(at * DVec2::new(64.0, 4.0));
        let pores: f32 = recipe::levels(pore, [0.2, 0.08], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let holes: f32 = pores * -0.3;
        let sum: f32 = hard + stripes + holes;
        let height: f32 = recipe::levels(sum, [-0.1, 0.85], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let tone: f32 = tone_field.sample(at);
        let pale: LinearRgb = ramp_1.at(tone);
        let rings: LinearRgb = recipe::mix_colors(pale, LinearRgb::from_srgb([0x94_u8, 0x60, 0x2f]), dark);
        let shade: f32 = recipe::levels(threads, [0.0, 1.0], [1.12, 0.82], recipe::LevelsCurve::Linear);
        let striped: LinearRgb = recipe::multiply_colors(rings, LinearRgb::gray(shade));
        let dent: f32 = pores * 0.6;
        let albedo: LinearRgb = recipe::mix_colors(striped, LinearRgb::from_srgb([0x4a_u8, 0x2c, 0x14]), dent);
        let roughness: f32 = recipe::levels(dark, [0.0, 1.0], [0.62, 0.42], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
