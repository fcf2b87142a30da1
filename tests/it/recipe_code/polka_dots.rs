//! polka-dots.
//!
//! Printed cotton with raised dots: spots about the feature points of Worley's F1, where it is small.
//!
//! The tile is 8 × 8 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::{self, LinearRgb};
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
    let seed = Seed(1);
    let lint_field = wavelet::WaveletNoise2::new(128, seed.child("lint", 0))?.with_weights(&[0.12261039, 0.08582727, 0.06007909, 0.04205536])?;
    let center_field = worley::Worley2::new(seed.child("center", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.35 })?.combine(worley::Combination::F1);
    let cell_field = worley::Worley2::new(seed.child("center", 0)).with_period([Some(8), Some(8)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.35 })?.cell_values();
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.0, color: LinearRgb::from_srgb([0xc8_u8, 0x37, 0x2d]) }, color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0xe3_u8, 0xa3, 0x2b]) }, color::ColorStop { position: 0.55, color: LinearRgb::from_srgb([0x2c_u8, 0x7a, 0x78]) }, color::ColorStop { position: 0.8, color: LinearRgb::from_srgb([0xd9_u8, 0x69, 0x4a]) }])?.with_interpolation(color::Interpolation::Stepped);
    Ok(move |at: DVec2| {
        let along: f32 = recipe::coordinate(at, DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.0));
        let warp_threads: f32 = recipe::wave(along, 16.0, 0.0, recipe::Waveform::Sine);
        let down: f32 = recipe::coordinate(at, DVec2::new(0.0, 0.0), DVec2::new(0.0, 1.0));
        let weft_threads: f32 = recipe::wave(down, 16.0, 0.0, recipe::Waveform::Sine);
        let weave: f32 = warp_threads * weft_threads;
        let cloth: f32 = weave * 0.16;
        let lint: f32 = (0.5 + lint_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let fuzz: f32 = recipe::levels(lint, [0.0, 1.0], [0.0, 0.2], recipe::LevelsCurve::Linear);
        let flat: f32 = cloth + fuzz;
        let center: f32 = center_field.sample(at);
        let dome: f32 = worley::Profile::Spots { radius: 0.3 }.height(center);
        let raised: f32 = recipe::power(dome, 0.35);
        let paint: f32 = recipe::levels(raised, [0.0, 1.0], [0.3, 0.92], recipe::LevelsCurve::Linear);
        let dot: f32 = recipe::levels(center, [0.3, 0.27], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let height: f32 = recipe::mix(flat, paint, dot);
        let shade: f32 = recipe::levels(flat, [0.0, 0.32], [0.78, 1.05], recipe::LevelsCurve::Linear);
        let ground: LinearRgb = recipe::multiply_colors(LinearRgb::from_srgb([0xe8_u8, 0xdf, 0xcd]), LinearRgb::gray(shade));
        let cell: f32 = cell_field.sample(at);
        let colors: LinearRgb = ramp_1.at(cell);
        let albedo: LinearRgb = recipe::mix_colors(ground, colors, dot);
        let roughness: f32 = recipe::mix(0.9, 0.35, dot);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
