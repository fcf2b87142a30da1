//! vein-tracery.
//!
//! The back of a leaf: a latticework of connected ridges along the cell borders of Worley's F2 - F1, in three sizes.
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
    let seed = Seed(23);
    let side_field = worley::Worley2::new(seed.child("side", 0)).with_period([Some(8), Some(8)])?.combine(worley::Combination::F2_MINUS_F1);
    let flesh_field = wavelet::WaveletNoise2::new(64, seed.child("flesh", 0))?.with_weights(&[0.12261039, 0.08582727, 0.06007909, 0.04205536])?;
    let main_field = worley::Worley2::new(seed.child("main", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.75 })?.combine(worley::Combination::F2_MINUS_F1);
    let net_field = worley::Worley2::new(seed.child("net", 0)).with_period([Some(32), Some(32)])?.combine(worley::Combination::F2_MINUS_F1);
    let tone_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("tone", 0))?.normalized();
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.25, color: LinearRgb::from_srgb([0x3f_u8, 0x64, 0x27]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0x56_u8, 0x7a, 0x30]) }, color::ColorStop { position: 0.8, color: LinearRgb::from_srgb([0x7c_u8, 0x8f, 0x3d]) }])?;
    Ok(move |at: DVec2| {
        let side: f32 = side_field.sample(at * DVec2::new(2.0, 2.0));
        let cushion: f32 = recipe::levels(side, [0.0, 0.5], [0.05, 0.25], recipe::LevelsCurve::Smooth);
        let flesh: f32 = (0.5 + flesh_field.sample(at * DVec2::new(16.0, 16.0))).clamp(0.0, 1.0);
        let skin: f32 = recipe::levels(flesh, [0.0, 1.0], [-0.06, 0.06], recipe::LevelsCurve::Linear);
        let main: f32 = main_field.sample(at);
        let thick: f32 = worley::Profile::Spots { radius: 0.16 }.height(main);
        let middle: f32 = worley::Profile::Spots { radius: 0.16 }.height(side);
        let middle_part: f32 = middle * 0.6;
        let net: f32 = net_field.sample(at * DVec2::new(8.0, 8.0));
        let thin: f32 = worley::Profile::Spots { radius: 0.2 }.height(net);
        let thin_part: f32 = thin * 0.32;
        let ridge: f32 = recipe::maximum(recipe::maximum(thick, middle_part), thin_part);
        let raised: f32 = ridge * 0.7;
        let height: f32 = cushion + skin + raised + 0.05;
        let tone: f32 = tone_field.sample(at);
        let leaf: LinearRgb = ramp_1.at(tone);
        let shade: f32 = recipe::levels(flesh, [0.0, 1.0], [0.75, 1.2], recipe::LevelsCurve::Linear);
        let blade: LinearRgb = recipe::multiply_colors(leaf, LinearRgb::gray(shade));
        let albedo: LinearRgb = recipe::mix_colors(blade, LinearRgb::from_srgb([0xc3_u8, 0xcf, 0x8c]), ridge);
        let roughness: f32 = recipe::levels(ridge, [0.0, 1.0], [0.6, 0.42], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
