//! giraffe.
//!
//! The coat of a giraffe: the cells of Caron and Mould's partition-of-unity textures, with cream lines between, in short hair.
//!
//! The tile is 2 × 2 units of the plane. Made from a recipe; needs the crate `dapple`.

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
    let seed = Seed(6);
    let swirl_field = wavelet::WaveletNoise2::new(4, seed.child("swirl", 0))?.with_weights(&[0.1490712, 0.0745356])?;
    let strands_field = worley::Worley2::new(seed.child("strands", 0)).with_period([Some(144), Some(10)])?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 2, gain: 0.6, ..worley::Octaves::default() })?;
    let tufts_field = worley::Worley2::new(seed.child("tufts", 0)).with_period([Some(24), Some(6)])?.combine(worley::Combination::F2_MINUS_F1);
    let tone_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.3333333333333333), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("tone", 0))?.normalized();
    let ramp_1 = color::ColorRamp::new([color::ColorStop { position: 0.3, color: LinearRgb::from_srgb([0xcf_u8, 0xae, 0x7c]) }, color::ColorStop { position: 0.7, color: LinearRgb::from_srgb([0xe0_u8, 0xc8, 0x9d]) }])?;
    let wander_x_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.16666666666666666), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("wander_x", 0))?.normalized();
    let wander_y_field = pups::octaves(&pups::OctavesOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.16666666666666666), octaves: 3, ..pups::OctavesOptions::default() }, seed.child("wander_y", 0))?.normalized();
    let cells_field = pups::cells(&pups::CellsOptions { domain: points::Domain { origin: DVec2::new(0.0, 0.0), size: DVec2::new(2.0, 2.0), wrap: [true, true] }, spacing: pups::Spacing::from(0.34), ..pups::CellsOptions::default() }, seed.child("cells", 0))?;
    let ramp_2 = color::ColorRamp::new([color::ColorStop { position: 0.25, color: LinearRgb::from_srgb([0x4f_u8, 0x2a, 0x14]) }, color::ColorStop { position: 0.5, color: LinearRgb::from_srgb([0x74_u8, 0x40, 0x1f]) }, color::ColorStop { position: 0.75, color: LinearRgb::from_srgb([0x96_u8, 0x59, 0x2b]) }])?;
    Ok(move |at: DVec2| {
        let swirl: f32 = (0.5 + swirl_field.sample(at * DVec2::new(2.0, 2.0))).clamp(0.0, 1.0);
        let sway: f32 = recipe::levels(swirl, [0.0, 1.0], [-0.12, 0.12], recipe::LevelsCurve::Linear);
        let hair: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(sway), 0.0);
            strands_field.sample(at * DVec2::new(72.0, 5.0))
        };
        let strand: f32 = recipe::levels(hair, [0.1, 1.3], [0.75, 0.0], recipe::LevelsCurve::Linear);
        let lock: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(sway), 0.0);
            tufts_field.sample(at * DVec2::new(12.0, 3.0))
        };
        let clump: f32 = recipe::levels(lock, [0.0, 0.4], [0.0, 0.25], recipe::LevelsCurve::Smooth);
        let height: f32 = strand + clump;
        let tone: f32 = tone_field.sample(at);
        let cream: LinearRgb = ramp_1.at(tone);
        let wander_x: f32 = wander_x_field.sample(at);
        let aside: f32 = recipe::levels(wander_x, [0.0, 1.0], [-0.09, 0.09], recipe::LevelsCurve::Linear);
        let x: f32 = aside + sway;
        let wander_y: f32 = wander_y_field.sample(at);
        let along: f32 = recipe::levels(wander_y, [0.0, 1.0], [-0.09, 0.09], recipe::LevelsCurve::Linear);
        let tips: f32 = recipe::levels(hair, [0.1, 1.2], [0.03, -0.02], recipe::LevelsCurve::Linear);
        let y: f32 = along + tips;
        let laid: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(x), f64::from(y));
            cells_field.sample(at)
        };
        let own: f32 = recipe::levels(laid, [0.0, 1.0], [-0.15, 0.15], recipe::LevelsCurve::Linear);
        let tan: f32 = tone + own;
        let brown: LinearRgb = ramp_2.at(tan);
        let y_up: f32 = y - 0.024;
        let up: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(x), f64::from(y_up));
            cells_field.sample(at)
        };
        let y_down: f32 = y + 0.024;
        let down: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(x), f64::from(y_down));
            cells_field.sample(at)
        };
        let x_left: f32 = x - 0.024;
        let left: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(x_left), f64::from(y));
            cells_field.sample(at)
        };
        let x_right: f32 = x + 0.024;
        let right: f32 = {
            let at = at + 1.0 * DVec2::new(f64::from(x_right), f64::from(y));
            cells_field.sample(at)
        };
        let most: f32 = recipe::maximum(recipe::maximum(recipe::maximum(up, down), left), right);
        let least: f32 = recipe::minimum(recipe::minimum(recipe::minimum(up, down), left), right);
        let differ: f32 = most - least;
        let spot: f32 = recipe::levels(differ, [0.001, 0.0], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let color: LinearRgb = recipe::mix_colors(cream, brown, spot);
        let shade: f32 = recipe::levels(height, [0.0, 1.0], [0.6, 1.15], recipe::LevelsCurve::Linear);
        let albedo: LinearRgb = recipe::multiply_colors(color, LinearRgb::gray(shade));
        Surface {
            height,
            albedo,
            roughness: 0.7,
            metallic: 0.0,
        }
    })
}
