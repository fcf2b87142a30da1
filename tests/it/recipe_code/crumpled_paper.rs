//! crumpled-paper.
//!
//! A sheet that was crumpled and smoothed out again: Worley's fractal sum of F1 as a relief, pressed in from both sides.
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
    let seed = Seed(12);
    let front_field = worley::Worley4::new(seed.child("front", 0)).with_period([Some(4), Some(4), None, Some(1)])?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 4, gain: 0.33, ..worley::Octaves::default() })?;
    let back_field = worley::Worley4::new(seed.child("back", 0)).with_period([Some(4), Some(4), None, Some(1)])?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 4, gain: 0.33, ..worley::Octaves::default() })?;
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.1, color: LinearRgb::from_srgb([0xd6_u8, 0xcf, 0xc0]) }, color::ColorStop { position: 0.45, color: LinearRgb::from_srgb([0xe6_u8, 0xe1, 0xd6]) }, color::ColorStop { position: 0.9, color: LinearRgb::from_srgb([0xec_u8, 0xe8, 0xdf]) }])?;
    let fiber_field = wavelet::WaveletNoise2::new(128, seed.child("fiber", 0))?.with_weights(&[0.11641641, 0.09313313, 0.0745065])?;
    Ok(move |at: DVec2| {
        let front: f32 = { let p: DVec2 = at; front_field.value([p.x, p.y, 0.0, 0.0]) };
        let back: f32 = { let p: DVec2 = at; back_field.value([p.x, p.y, 0.0, 0.0]) };
        let folds: f32 = front - back;
        let height: f32 = recipe::levels(folds, [-0.72, 0.72], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let sheet: LinearRgb = ramp_1.at(height);
        let fiber: f32 = (0.5 + fiber_field.sample(at * DVec2::new(32.0, 32.0))).clamp(0.0, 1.0);
        let speck: f32 = recipe::levels(fiber, [0.0, 1.0], [0.92, 1.05], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(sheet, LinearRgb::gray(speck));
        Surface {
            height,
            albedo,
            roughness: 0.85,
            metallic: 0.0,
        }
    })
}
