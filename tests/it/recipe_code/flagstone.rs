//! flagstone.
//!
//! Paving of split stone in sandy joints: Worley's F2 - F1 for the joints, and a shade of its own for each cell.
//!
//! The tile is 6 × 6 units of the plane. Made from a recipe; needs the crate `dapple`.

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
    let seed = Seed(3);
    let grain_field = wavelet::WaveletNoise2::new(48, seed.child("grain", 0))?.with_weights(&[0.12751697, 0.08288603, 0.053875923, 0.03501935, 0.022762576])?;
    let stone_field = worley::Worley2::new(seed.child("joint", 0)).with_period([Some(6), Some(6)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.65 })?.cell_values();
    let swell_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(6.0, 6.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.5), ..pups::OctavesOptions::default() }, seed.child("swell", 0))?.normalized();
    let joint_field = worley::Worley2::new(seed.child("joint", 0)).with_period([Some(6), Some(6)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.65 })?.combine(worley::Combination::F2_MINUS_F1);
    let reach_field = worley::Worley2::new(seed.child("joint", 0)).with_period([Some(6), Some(6)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.65 })?.combine(worley::Combination::F1_PLUS_F2);
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.2, color: LinearRgb::from_srgb([0x3b_u8, 0x32, 0x26]) }, color::ColorStop { position: 0.8, color: LinearRgb::from_srgb([0x6b_u8, 0x5c, 0x47]) }])?;
    let ramp_2 = color::ColorRamp::even(&[LinearRgb::from_srgb([0x85_u8, 0x7b, 0x6c]), LinearRgb::from_srgb([0x9c_u8, 0x8e, 0x78]), LinearRgb::from_srgb([0x77_u8, 0x78, 0x74]), LinearRgb::from_srgb([0xa9_u8, 0x9a, 0x80]), LinearRgb::from_srgb([0x6d_u8, 0x69, 0x64]), LinearRgb::from_srgb([0x8f_u8, 0x7d, 0x68]), LinearRgb::from_srgb([0x93_u8, 0x91, 0x88])])?;
    Ok(move |at: DVec2| {
        let grain: f32 = (0.5 + grain_field.sample(at * DVec2::new(8.0, 8.0))).clamp(0.0, 1.0);
        let sand: f32 = recipe::levels(grain, [0.0, 1.0], [0.0, 0.26], recipe::LevelsCurve::Linear);
        let stone: f32 = stone_field.sample(at);
        let level: f32 = recipe::levels(stone, [0.0, 1.0], [0.46, 0.7], recipe::LevelsCurve::Linear);
        let swell: f32 = swell_field.sample(at);
        let waves: f32 = recipe::levels(swell, [0.0, 1.0], [-0.2, 0.2], recipe::LevelsCurve::Linear);
        let pits: f32 = recipe::levels(grain, [0.0, 1.0], [-0.08, 0.08], recipe::LevelsCurve::Linear);
        let joint: f32 = joint_field.sample(at);
        let reach: f32 = reach_field.sample(at);
        let border: f32 = joint * reach;
        let round: f32 = recipe::levels(border, [0.0, 1.2], [0.0, 0.14], recipe::LevelsCurve::Linear);
        let top: f32 = level + waves + pits + round;
        let chips: f32 = recipe::levels(grain, [0.0, 1.0], [-0.05, 0.05], recipe::LevelsCurve::Linear);
        let wander: f32 = recipe::levels(swell, [0.0, 1.0], [-0.18, 0.18], recipe::LevelsCurve::Linear);
        let edge: f32 = border + chips + wander;
        let plate: f32 = recipe::levels(edge, [0.06, 0.14], [0.0, 1.0], recipe::LevelsCurve::Smooth);
        let height: f32 = recipe::mix(sand, top, plate);
        let soil: LinearRgb = ramp_1.at(grain);
        let tint: LinearRgb = ramp_2.at(stone);
        let stain: f32 = recipe::levels(swell, [0.5, 0.8], [0.0, 0.7], recipe::LevelsCurve::Linear);
        let stained: LinearRgb = recipe::mix_colors(tint, LinearRgb::from_srgb([0x86_u8, 0x68, 0x4a]), stain);
        let shade: f32 = recipe::levels(grain, [0.1, 0.9], [0.6, 1.3], recipe::LevelsCurve::Linear);
        let faces: LinearRgb = recipe::multiply_colors(stained, LinearRgb::gray(shade));
        let albedo: LinearRgb = recipe::mix_colors(soil, faces, plate);
        let worn: f32 = recipe::levels(grain, [0.0, 1.0], [0.85, 0.5], recipe::LevelsCurve::Linear);
        let roughness: f32 = recipe::mix(0.95, worn, plate);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
