//! vein-tracery.
//!
//! The back of a leaf: a latticework of connected ridges along the borders of Worley's cells, in three sizes.
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
    let wander_x_field = wavelet::WaveletNoise2::new(12, seed.child("wander_x", 0))?.with_weights(&[0.1490712, 0.0745356])?;
    let wander_y_field = wavelet::WaveletNoise2::new(12, seed.child("wander_y", 0))?.with_weights(&[0.1490712, 0.0745356])?;
    let side_cells_field = worley::Worley2::new(seed.child("side_cells", 0)).with_period([Some(12), Some(12)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.85 })?;
    let net_field = worley::Worley2::new(seed.child("net", 0)).with_period([Some(48), Some(48)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.combine(worley::Combination::F2_MINUS_F1);
    let flesh_field = wavelet::WaveletNoise2::new(128, seed.child("flesh", 0))?.with_weights(&[0.11641641, 0.09313313, 0.0745065])?;
    let main_cells_field = worley::Worley2::new(seed.child("main_cells", 0)).with_period([Some(4), Some(4)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.7 })?;
    let tone_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(4.0, 4.0), wrap: [true, true] }, spacing: pups::Spacing::from(1.0), ..pups::OctavesOptions::default() }, seed.child("tone", 0))?.normalized();
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.25, color: LinearRgb::from_srgb([0x35_u8, 0x59, 0x1f]) }, color::ColorStop { position: 0.55, color: LinearRgb::from_srgb([0x4d_u8, 0x73, 0x28]) }, color::ColorStop { position: 0.8, color: LinearRgb::from_srgb([0x7d_u8, 0x8f, 0x37]) }])?;
    let areole_field = worley::Worley2::new(seed.child("net", 0)).with_period([Some(48), Some(48)])?.with_scatter(worley::Scatter::Jittered { jitter: 0.8 })?.cell_values();
    Ok(move |at: DVec2| {
        let wander_x: f32 = (0.5 + wander_x_field.sample(at * DVec2::new(3.0, 3.0))).clamp(0.0, 1.0);
        let right: f32 = recipe::levels(wander_x, [0.0, 1.0], [-0.13, 0.13], recipe::LevelsCurve::Linear);
        let wander_y: f32 = (0.5 + wander_y_field.sample(at * DVec2::new(3.0, 3.0))).clamp(0.0, 1.0);
        let down: f32 = recipe::levels(wander_y, [0.0, 1.0], [-0.13, 0.13], recipe::LevelsCurve::Linear);
        let side: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(right), f64::from(down));
            side_cells_field.edge_distance(at * DVec2::new(3.0, 3.0))
        };
        let cushion: f32 = recipe::levels(side, [0.0, 0.45], [0.05, 0.25], recipe::LevelsCurve::Smooth);
        let net: f32 = net_field.sample(at * DVec2::new(12.0, 12.0));
        let pillow: f32 = recipe::levels(net, [0.0, 0.6], [0.0, 0.07], recipe::LevelsCurve::Smooth);
        let flesh: f32 = (0.5 + flesh_field.sample(at * DVec2::new(32.0, 32.0))).clamp(0.0, 1.0);
        let skin: f32 = recipe::levels(flesh, [0.0, 1.0], [-0.03, 0.03], recipe::LevelsCurve::Linear);
        let main: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(right), f64::from(down));
            main_cells_field.edge_distance(at)
        };
        let thick: f32 = worley::Profile::Spots { radius: 0.06 }.height(main);
        let middle: f32 = worley::Profile::Spots { radius: 0.075 }.height(side);
        let middle_part: f32 = middle * 0.55;
        let thin: f32 = worley::Profile::Spots { radius: 0.16 }.height(net);
        let thin_part: f32 = thin * 0.25;
        let ridge: f32 = recipe::maximum(recipe::maximum(thick, middle_part), thin_part);
        let raised: f32 = ridge * 0.65;
        let height: f32 = cushion + pillow + skin + raised + 0.04;
        let tone: f32 = tone_field.sample(at);
        let leaf: LinearRgb = ramp_1.at(tone);
        let areole: f32 = areole_field.sample(at * DVec2::new(12.0, 12.0));
        let shade: f32 = recipe::levels(areole, [0.0, 1.0], [0.82, 1.15], recipe::LevelsCurve::Linear);
        let speckle: f32 = recipe::levels(flesh, [0.2, 0.8], [0.85, 1.15], recipe::LevelsCurve::Linear);
        let blade: LinearRgb = recipe::multiply_colors(recipe::multiply_colors(leaf, LinearRgb::gray(shade)), LinearRgb::gray(speckle));
        let near: f32 = recipe::levels(main, [0.3, 0.05], [0.0, 0.35], recipe::LevelsCurve::Smooth);
        let lit: LinearRgb = recipe::mix_colors(blade, LinearRgb::from_srgb([0x9f_u8, 0xb3, 0x5c]), near);
        let sap: f32 = recipe::levels(ridge, [0.0, 0.8], [0.0, 0.95], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::mix_colors(lit, LinearRgb::from_srgb([0xc9_u8, 0xd1, 0x96]), sap);
        let roughness: f32 = recipe::levels(ridge, [0.0, 1.0], [0.6, 0.42], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo,
            roughness,
            metallic: 0.0,
        }
    })
}
